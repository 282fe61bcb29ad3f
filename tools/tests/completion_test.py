"""Tests of tools/completion.bash against a goshawk that answers known words.

What the real one answers is tested in goshawk_cli."""

import pathlib
import subprocess
import tempfile
import unittest

COMPLETION = pathlib.Path(__file__).resolve().parent.parent / "completion.bash"
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


class CompletionTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.program = pathlib.Path(folder.name) / "goshawk"
        self.program.write_text(GOSHAWK)
        self.program.chmod(0o755)

    def complete(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _goshawk; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        result = subprocess.run(["bash", "-c", script, "bash", COMPLETION, self.program, *words],
                                capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, "")
        return result.stdout.split()

    def test_the_program_is_asked_with_the_words_so_far(self):
        self.assertEqual(self.complete(""), ["fly", "launch", "topic"])
        self.complete("topic", "echo", "a b")
        calls = pathlib.Path(f"{self.program}.calls").read_text().splitlines()
        self.assertEqual(calls, ["2:complete ", "4:complete topic echo a b"])

    def test_only_what_begins_like_the_word_is_offered(self):
        self.assertEqual(self.complete("la"), ["launch"])
        self.assertEqual(self.complete("fly", "--m"), ["--map", "--margin"])
        self.assertEqual(self.complete("topic", "echo", ""), ["/odom", "/uav1/path"])

    def test_nothing_is_offered_if_the_program_knows_nothing(self):
        self.assertEqual(self.complete("plan", "file"), [])


if __name__ == "__main__":
    unittest.main()
