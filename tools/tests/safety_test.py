"""docs/safety.md: every row of its hazard table is shown by tests or campaigns that exist."""

import itertools
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGE = ROOT / "docs/safety.md"
COLUMNS = ["hazard", "noticed by, within", "the vehicle", "guaranteed", "shown by"]


def cells_of(line):
    return [cell.strip() for cell in line.strip("| ").split(" | ")]


def rows(text):
    """Cells of the hazard table's rows."""
    lines = text.splitlines()
    begin = next(k for k, line in enumerate(lines) if cells_of(line) == COLUMNS)
    table = itertools.takewhile(lambda line: line.startswith("|"), lines[begin + 2:])
    return [cells_of(line) for line in table]


def known_names():
    """Suite.Test of every GoogleTest, Class and Class.test_method of every Python test, names of
    CTest, and `campaign --faults KIND`, with `--launch live` as well."""
    names = set()
    for path in ROOT.glob("src/*/**/*_test.cpp"):
        for suite, test in re.findall(r"\bTEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", path.read_text()):
            names |= {suite, f"{suite}.{test}"}
    for path in [*ROOT.glob("src/*/test/*_test.py"), *ROOT.glob("tools/tests/*_test.py")]:
        for text in re.split(r"(?m)^class ", path.read_text())[1:]:
            name = re.match(r"\w+", text).group()
            names |= {name, *(f"{name}.{test}" for test in re.findall(r"def (test_\w+)", text))}
    for path in ROOT.glob("src/*/CMakeLists.txt"):
        names |= set(re.findall(r"goshawk_(?:test|fuzz)\(NAME (\w+)", path.read_text()))
    kinds = re.search(r"KINDS = \[(.*?)\]",
                      (ROOT / "src/goshawk_bringup/scripts/faults.py").read_text()).group(1)
    return names | {f"campaign {where}--faults {kind}" for kind in re.findall(r'"(\w+)"', kinds)
                    for where in ("", "--launch live ")}


class SafetyPage(unittest.TestCase):
    def test_every_row_names_tests_that_exist(self):
        known = known_names()
        table = rows(PAGE.read_text())
        self.assertGreater(len(table), 10)
        for row in table:
            with self.subTest(hazard=row[0]):
                named = re.findall(r"`([^`]+)`", row[-1])
                self.assertTrue(named, "it names no test")
                self.assertEqual([name for name in named if name not in known], [])

    def test_a_name_that_does_not_exist_is_found(self):
        self.assertNotIn("Upsets.NoSuchTest", known_names())
        self.assertIn("Upsets.OdometryThatPausesStopsTheVehicleWhereItIs", known_names())
        self.assertEqual(rows("| hazard | noticed by, within | the vehicle | guaranteed | shown by |\n"
                              "| --- | --- | --- | --- | --- |\n| a | b | c | d | `e` |\n\n"
                              "| another | table | is | not | read |\n"),
                         [["a", "b", "c", "d", "`e`"]])


if __name__ == "__main__":
    unittest.main()
