"""Tests of the scripts in tools/: what they say, and what they do where something is missing."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent.parent
SCRIPTS = ["setup", "build", "test", "fly", "format", "lint"]


def run(*command, **keywords):
    return subprocess.run(command, capture_output=True, text=True, check=False, **keywords)


class ScriptsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def path_with(self, *programs):
        """A PATH that has these programs and no others."""
        folder = self.folder / "bin"
        folder.mkdir()
        for program in ("bash", "dirname", "basename", "env", "sed", *programs):
            (folder / program).symlink_to(shutil.which(program))
        return {**os.environ, "PATH": str(folder)}

    def program(self, path, text):
        path.write_text("#!/bin/bash\n" + text)
        path.chmod(0o755)

    def test_each_script_explains_itself(self):
        for name in SCRIPTS:
            result = run(TOOLS / name, "--help")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn(f"tools/{name}", result.stdout)

    def test_shellcheck_finds_nothing(self):
        if shutil.which("shellcheck") is None:
            self.skipTest("shellcheck is not installed")
        scripts = [TOOLS / name for name in [*SCRIPTS, "goshawk", "common.sh"]]
        result = run("shellcheck", "-x", "--source-path", TOOLS.parent, *scripts,
                     TOOLS.parent / ".ci" / "run")
        self.assertEqual(result.returncode, 0, result.stdout)

    def test_goshawk_says_what_to_do_before_it_is_built(self):
        (self.folder / "tools").mkdir()
        for name in ("goshawk", "common.sh"):
            shutil.copy(TOOLS / name, self.folder / "tools" / name)
        result = run(self.folder / "tools" / "goshawk", "plan")
        self.assertEqual(result.returncode, 1)
        self.assertIn("run tools/setup, then tools/build", result.stderr)

    def test_goshawk_passes_its_arguments_on_unchanged(self):
        for folder in ("tools", "install/bin"):
            (self.folder / folder).mkdir(parents=True)
        for name in ("goshawk", "common.sh"):
            shutil.copy(TOOLS / name, self.folder / "tools" / name)
        self.program(self.folder / "install/bin/goshawk", "printf '<%s>' \"$@\"\nexit 3\n")
        result = run(self.folder / "tools" / "goshawk", "a b", "", "--help")
        self.assertEqual(result.stdout, "<a b><><--help>")
        self.assertEqual(result.returncode, 3)

    def test_setup_names_the_packages_where_there_is_no_apt(self):
        result = run(TOOLS / "setup", env=self.path_with())
        self.assertEqual(result.returncode, 1)
        self.assertIn("no apt", result.stderr)
        self.assertIn("libfastrtps-dev", result.stderr)

    def fake_debian(self, installed, user):
        """A PATH where dpkg knows `installed`, and apt-get and sudo write down how they are called."""
        env = self.path_with("comm", "sort", "true")
        folder = self.folder / "bin"
        self.program(folder / "dpkg-query", f"printf '%b' '{installed}'\nexit 1\n")
        self.program(folder / "id", f"echo {user}\n")
        self.program(folder / "java", "true\n")
        self.program(folder / "apt-get", f"echo \"$@\" >>'{self.folder}/calls'\n")
        return env

    def calls(self):
        path = self.folder / "calls"
        return path.read_text().splitlines() if path.exists() else []

    def all_installed(self, except_for=()):
        names = run(TOOLS / "setup", "--list").stdout.split()
        self.assertGreater(len(names), 30)
        return "".join(f"ii {name}\\n" for name in names if name not in except_for)

    def test_setup_calls_nothing_when_nothing_is_missing(self):
        result = run(TOOLS / "setup", env=self.fake_debian(self.all_installed(), user=1000))
        self.assertEqual((result.returncode, result.stdout, result.stderr), (0, "", ""))
        self.assertEqual(self.calls(), [])

    def test_setup_for_tests_wants_a_browser(self):
        env = self.fake_debian(self.all_installed(), user=1000)
        result = run(TOOLS / "setup", "--tests", env=env)
        self.assertEqual(result.returncode, 1)
        self.assertIn("apt-get install chromium iproute2 nodejs npm", result.stderr)

    def test_setup_installs_slurm_only_if_it_is_asked_to(self):
        env = self.fake_debian(self.all_installed(), user=1000)
        self.assertEqual(run(TOOLS / "setup", env=env).returncode, 0)
        result = run(TOOLS / "setup", "--slurm", env=env)
        self.assertEqual(result.returncode, 1)
        self.assertIn("apt-get install munge slurm-client slurmctld slurmd", result.stderr)

    def test_options_of_setup_are_combined_in_any_order(self):
        env = self.fake_debian(self.all_installed(), user=0)
        for options in (("--slurm", "--tests", "--check"), ("--check", "--tests", "--slurm")):
            result = run(TOOLS / "setup", *options, env=env)
            self.assertEqual(result.returncode, 1)
            self.assertIn("not installed: chromium iproute2 munge nodejs npm slurm-client slurmctld "
                          "slurmd", result.stderr)
            self.assertEqual(self.calls(), [])
        self.assertIn("munge", run(TOOLS / "setup", "--list", "--slurm").stdout.split())

    def test_setup_refuses_what_it_does_not_know_before_it_does_anything(self):
        result = run(TOOLS / "setup", "--slrum", "--check",
                     env=self.fake_debian(self.all_installed(), user=0))
        self.assertEqual(result.returncode, 1)
        self.assertIn("unknown argument '--slrum'", result.stderr)
        self.assertEqual(self.calls(), [])

    def test_setup_for_tests_does_without_npm(self):
        installed = (self.all_installed() +
                     "ii chromium\\nii iproute2\\nii nodejs\\nii npm\\n")
        result = run(TOOLS / "setup", "--tests", env=self.fake_debian(installed, user=1000))
        self.assertEqual((result.returncode, result.stderr), (0, ""))  # its tests are skipped
        self.assertEqual(self.calls(), [])

    def test_setup_installs_only_what_is_missing(self):
        env = self.fake_debian(self.all_installed(except_for=["g++", "cmake"]), user=0)
        result = run(TOOLS / "setup", env=env)
        self.assertEqual(result.returncode, 1)  # the false apt-get installs nothing
        self.assertIn("still not installed: cmake g++", result.stderr)
        update, install = self.calls()
        self.assertIn("update", update)
        self.assertIn("install", install)
        self.assertIn("--no-install-recommends cmake g++", install)
        self.assertNotIn("supervisor", install)

    def test_setup_counts_a_package_that_was_removed_as_missing(self):
        installed = self.all_installed(except_for=["ccache"]) + "rc ccache\\n"
        result = run(TOOLS / "setup", "--check", env=self.fake_debian(installed, user=0))
        self.assertEqual(result.returncode, 1)
        self.assertIn("not installed: ccache", result.stderr)
        self.assertEqual(self.calls(), [])

    def test_setup_says_so_when_it_may_not_install(self):
        env = self.fake_debian(self.all_installed(except_for=["cmake"]), user=1000)
        result = run(TOOLS / "setup", env=env)
        self.assertEqual(result.returncode, 1)
        self.assertIn("run as root: apt-get install cmake", result.stderr)
        self.assertEqual(self.calls(), [])

    def test_the_parts_of_the_tests_are_all_packages_and_share_none(self):
        whole = run(TOOLS / "test", "--list").stdout.split()
        self.assertIn("goshawk_core", whole)
        parts = [run(TOOLS / "test", "--part", f"{k}/4", "--list").stdout.split()
                 for k in range(1, 5)]
        self.assertEqual(sorted(sum(parts, [])), sorted(whole))
        self.assertIn(run(TOOLS / "test", "--part", "day/4", "--list").stdout.split(), parts)

    def test_a_part_that_does_not_exist_is_refused(self):
        for part in ("0/4", "5/4", "4", "a/b", "1/0"):
            result = run(TOOLS / "test", "--part", part, "--list")
            self.assertEqual(result.returncode, 1, part)
            self.assertIn("--part wants K/N", result.stderr)

    def test_test_and_build_refuse_an_option_without_its_value(self):
        for name in ("test", "build"):
            result = run(TOOLS / name, "--sanitize")
            self.assertEqual(result.returncode, 1)
            self.assertIn("--sanitize needs", result.stderr)


if __name__ == "__main__":
    unittest.main()
