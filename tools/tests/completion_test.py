"""Tests of tools/completion.* against a goshawk that answers known words.

What the real one answers is tested in goshawk_cli."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
GOSHAWK = r"""#!/bin/bash
printf '%s\n' "$#:$*" >> "$0.calls"
case "$*" in
  "complete ") printf 'fly\nlaunch\ntopic\n' ;;
  "complete la") printf 'fly\nlaunch\ntopic\n' ;;
  "complete fly --m") printf -- '--map\n--margin\n--goal\n' ;;
  "complete topic echo ") printf '/odom\n/uav1/path\n' ;;
  *) echo "warning" >&2 ;;
esac
"""


class CompletionCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.program = pathlib.Path(folder.name) / "goshawk"
        self.program.write_text(GOSHAWK)
        self.program.chmod(0o755)

    def run_shell(self, shell, *arguments):
        if shutil.which(shell) is None:
            self.skipTest(f"{shell} is not installed")
        result = subprocess.run([shell, *arguments], capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, "")
        return result.stdout.split()

    def calls(self):
        return pathlib.Path(f"{self.program}.calls").read_text().splitlines()


class Bash(CompletionCase):
    def complete(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _goshawk; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return self.run_shell("bash", "-c", script, "bash", TOOLS / "completion.bash", self.program,
                              *words)

    def test_the_program_is_asked_with_the_words_so_far(self):
        self.assertEqual(self.complete(""), ["fly", "launch", "topic"])
        self.complete("topic", "echo", "a b")
        self.assertEqual(self.calls(), ["2:complete ", "4:complete topic echo a b"])

    def test_only_what_begins_like_the_word_is_offered(self):
        self.assertEqual(self.complete("la"), ["launch"])
        self.assertEqual(self.complete("fly", "--m"), ["--map", "--margin"])
        self.assertEqual(self.complete("topic", "echo", ""), ["/odom", "/uav1/path"])

    def test_nothing_is_offered_if_the_program_knows_nothing(self):
        self.assertEqual(self.complete("plan", "file"), [])


class Zsh(CompletionCase):
    """The shell's own functions are stubs: what it is offered, it would choose from."""

    def complete(self, *words):
        script = ('compdef() { :; }; compadd() { print -l -- "${(@P)2}"; }; '
                  '_files() { print files; }; source "$1"; shift; words=("$@"); CURRENT=$#; '
                  '_goshawk')
        return self.run_shell("zsh", "-f", "-c", script, "zsh", TOOLS / "completion.zsh",
                              self.program, *words)

    def test_the_program_is_asked_with_the_words_so_far(self):
        self.assertEqual(self.complete(""), ["fly", "launch", "topic"])
        self.assertEqual(self.complete("topic", "echo", ""), ["/odom", "/uav1/path"])
        self.assertEqual(self.calls(), ["2:complete ", "4:complete topic echo "])

    def test_files_are_offered_if_the_program_knows_nothing(self):
        self.assertEqual(self.complete("plan", "file"), ["files"])


class Fish(CompletionCase):
    def complete(self, line):
        script = f'source {TOOLS / "completion.fish"}; complete -C "{self.program} {line}"'
        return self.run_shell("fish", "--no-config", "-c", script)

    def test_the_program_is_asked_with_the_words_so_far(self):
        self.assertEqual(self.complete("topic echo "), ["/odom", "/uav1/path"])
        self.assertIn("4:complete topic echo ", self.calls())

    def test_only_what_begins_like_the_word_is_offered(self):
        self.assertEqual(self.complete("fly --m"), ["--map", "--margin"])
        self.assertEqual(self.complete("la"), ["launch"])

    def test_files_are_offered_if_the_program_knows_nothing(self):
        folder = self.program.parent / "maps"
        folder.mkdir()
        self.assertEqual(self.complete(f"plan {folder.parent}/ma"), [f"{folder}/"])


if __name__ == "__main__":
    unittest.main()
