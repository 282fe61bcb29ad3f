"""Tests of tools/test-summary, on build folders as `colcon test` leaves them."""

import pathlib
import subprocess
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parent.parent / "test-summary"


def gtest(*cases):
    return ("<testsuites><testsuite name='S'>" + "".join(cases) + "</testsuite></testsuites>")


def case(name, body="", status="run"):
    return f"<testcase name='{name}' classname='S' status='{status}'>{body}</testcase>"


def ctest(name, status, output="", **measurements):
    entries = "".join(
        f"<NamedMeasurement name='{key.replace('_', ' ')}'><Value>{value}</Value>"
        "</NamedMeasurement>" for key, value in measurements.items())
    return (f"<Test Status='{status}'><Name>{name}</Name><Results>{entries}"
            f"<Measurement><Value>{output}</Value></Measurement></Results></Test>")


class SummaryTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)

    def package(self, name, tests, reports=None, results=True):
        testing = self.build / name / "Testing"
        (testing / "20260101-0000").mkdir(parents=True)
        (testing / "TAG").write_text("20260101-0000\nExperimental\nExperimental\n")
        if results:
            (testing / "20260101-0000" / "Test.xml").write_text(
                "<Site><Testing><TestList/>" + "".join(tests) + "</Testing></Site>")
        for program, text in (reports or {}).items():
            path = self.build / name / "test_results" / name / f"{program}.gtest.xml"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    def expect(self, last_line, succeeds):
        result = subprocess.run([TOOL, self.build], capture_output=True, text=True, check=False)
        self.assertEqual(result.stdout.splitlines()[-1], last_line, result.stdout + result.stderr)
        self.assertEqual(result.returncode == 0, succeeds)
        return result.stdout

    def test_counts_the_cases_of_gtest_and_the_other_programs_of_ctest(self):
        self.package("a", [ctest("x_test", "passed"), ctest("links", "passed")],
                     {"x_test": gtest(case("One"), case("Two"), case("Three"))})
        self.package("b", [ctest("y_test", "passed")], {"y_test": gtest(case("One"))})
        self.expect("5 passed, 0 failed", True)

    def test_names_a_failed_case_and_shows_its_message(self):
        self.package("a", [ctest("x_test", "failed")],
                     {"x_test": gtest(case("One"), case("Two", "<failure>1 is not 2</failure>"))})
        output = self.expect("1 passed, 1 failed", False)
        self.assertIn("FAILED   a/x_test: S.Two", output)
        self.assertIn("    1 is not 2", output)

    def test_counts_a_crash_once_and_shows_the_end_of_the_output(self):
        output = "\n".join(f"line {i}." for i in range(100))
        self.package("a", [ctest("x_test", "failed", output, Exit_Code="SEGFAULT"),
                           ctest("links", "passed")])
        text = self.expect("1 passed, 1 failed", False)
        self.assertIn("SEGFAULT", text)
        self.assertIn("line 99.", text)
        self.assertNotIn("line 50.", text)

    def test_does_not_trust_a_report_of_a_program_that_failed_after_it(self):
        self.package("a", [ctest("x_test", "failed", "leak", Exit_Code="Failed")],
                     {"x_test": gtest(case("One"))})
        self.expect("1 passed, 1 failed", False)

    def test_lists_skipped_cases_with_their_reason(self):
        self.package("a", [ctest("x_test", "passed"),
                           ctest("y", "notrun", Completion_Status="SKIP_RETURN_CODE=77")],
                     {"x_test": gtest(case("One"), case("Two", "<skipped message='/a/b.cpp:86&#10;no map'/>"),
                                      case("Three", status="notrun"))})
        output = self.expect("1 passed, 0 failed, 3 skipped", True)
        self.assertIn("skipped  a/x_test: S.Two: no map", output)

    def test_counts_a_program_that_could_not_be_run_as_failed(self):
        self.package("a", [ctest("x", "notrun", Completion_Status="Unable to find executable"),
                           ctest("y", "passed")])
        self.expect("1 passed, 1 failed", False)

    def test_counts_a_run_that_was_broken_off_as_failed(self):
        self.package("a", [], results=False)
        self.expect("0 passed, 1 failed", False)

    def test_counts_reports_of_programs_that_ctest_does_not_know(self):
        folder = self.build / "tools" / "test_results"
        folder.mkdir(parents=True)
        (folder / "tools.xml").write_text(
            "<testsuite><testcase classname='T' name='a'/><testcase classname='T' name='b'>"
            "<error message='boom'/></testcase></testsuite>")
        self.assertIn("boom", self.expect("1 passed, 1 failed", False))
        (folder / "tools.xml").write_text("<testsuite><testca")
        self.expect("0 passed, 1 failed", False)

    def test_ends_with_the_slowest_tests_and_the_names_of_what_failed(self):
        self.package("a", [ctest(f"t{k}", "failed" if k == 3 else "passed", Execution_Time=k)
                           for k in range(1, 13)])
        lines = self.expect("11 passed, 1 failed", False).splitlines()
        self.assertEqual(lines[-12], "   12.0 s  a/t12")
        self.assertEqual(lines[-3], "    3.0 s  a/t3")
        self.assertEqual(lines[-2], "failed   a/t3")

    def test_fails_if_no_test_ran(self):
        self.assertIn("no test ran", self.expect("0 passed, 0 failed", False))
        self.build = self.build / "absent"
        self.expect("0 passed, 0 failed", False)


if __name__ == "__main__":
    unittest.main()
