"""Tests of tools/completion.bash against a goshawk that prints a known --help."""

import pathlib
import subprocess
import tempfile
import unittest

COMPLETION = pathlib.Path(__file__).resolve().parent.parent / "completion.bash"
GOSHAWK = r"""#!/bin/bash
case "$*" in
  --help) printf 'usage\n\n  fly      make a world\n  launch   start\n  topic    list\n' ;;
  "topic --help") printf 'usage\n  list      the topics\n  echo      prints\n' ;;
  "fly --help") printf -- '  --map TEXT   a map\n  --max-speed X  other\n  -h,--help\n' ;;
  "topic echo --help") printf -- '  --once  one\n' ;;
  "launch --list") printf 'flight\nflight_container\n' ;;
  "param list") printf 'tracker\nnavigator\n' ;;
  "param describe tracker") cat <<'EOF' ;;
yaw (string)
  where to look
  range: one of plan, keep
  takes effect at run time
mass_kg (double, kg)
  takes effect at start only
EOF
  "param describe tracker yaw") printf 'yaw (string)\n  range: one of plan, keep\n' ;;
  "node list --timeout 1") printf '/tracker\n/uav1/tracker\n' ;;
  *) exit 2 ;;
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

    def test_verbs(self):
        self.assertEqual(self.complete(""), ["fly", "launch", "topic"])
        self.assertEqual(self.complete("la"), ["launch"])
        self.assertEqual(self.complete("zz"), [])

    def test_words_behind_a_verb(self):
        self.assertEqual(self.complete("topic", ""), ["list", "echo"])
        self.assertEqual(self.complete("launch", "flight_"), ["flight_container"])
        self.assertEqual(self.complete("run", ""), ["tracker", "navigator"])
        self.assertEqual(self.complete("param", "describe", "n"), ["navigator"])

    def test_nodes_parameters_and_their_words(self):
        self.assertEqual(self.complete("param", "set", "/u"), ["/uav1/tracker"])
        self.assertEqual(self.complete("param", "get", "/tracker", ""), ["yaw", "mass_kg"])
        self.assertEqual(self.complete("param", "set", "/tracker", ""), ["yaw"])
        self.assertEqual(self.complete("param", "set", "/uav1/tracker", "yaw", ""),
                         ["plan", "keep"])
        self.assertEqual(self.complete("param", "set", "/tracker", "yaw", "keep", ""), ["yaw"])
        self.assertEqual(self.complete("param", "describe", "tracker", "m"), ["mass_kg"])

    def test_options(self):
        self.assertEqual(self.complete("fly", "--m"), ["--map", "--max-speed"])
        self.assertEqual(self.complete("topic", "echo", "--"), ["--once"])
        self.assertEqual(self.complete("fly", "--map", "x.bt", "--h"), ["--help"])


if __name__ == "__main__":
    unittest.main()
