"""goshawk_live_campaign goes on from its file. Nothing is flown here: all flights are in the file."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, VEHICLE = sys.argv[1:3]


def result(number, **changes):
    return {"number": number, "reachable": True, "arrived": True, "touched": False, "code": "ok",
            "max_error_m": 0.01 * (number + 1), "clearance_m": 0.3 + number, **changes}


class Resumed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "flown.jsonl"

    def call(self, lines, *options):
        self.file.write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
        return subprocess.run([PROGRAM, "--vehicle", VEHICLE, "--file", self.file, "--json",
                               *options], capture_output=True, text=True, timeout=60, check=False)

    def test_what_the_file_has_is_counted_and_not_flown_again(self):
        lines = [json.dumps(result(0)), json.dumps(result(1, arrived=False, code="no_path")),
                 json.dumps(result(2, reachable=False, arrived=False, code="no_path")),
                 json.dumps({"number": 3, "not_flown": "no place is free"}),
                 json.dumps(result(9, touched=True))]
        done = self.call(lines, "--flights", "4")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads(done.stdout)
        self.assertEqual(summary, {
            "flights": 3, "not_flown": 1, "reachable": 2, "arrived": 1, "arrived_of_reachable": 1,
            "contacts": 0, "failed_by_code": {"no_path": [1]}, "max_error_m": 0.03,
            "min_clearance_m": 0.3})
        self.assertEqual([line for line in self.file.read_text().splitlines() if line], lines)

    def test_a_contact_ends_with_status_1(self):
        done = self.call([json.dumps(result(0, touched=True))], "--flights", "1")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(json.loads(done.stdout)["contacts"], 1)

    def test_lines_that_are_no_results_are_not_counted(self):
        bad = ["", "{", "7", "[]", json.dumps({"number": 0}), json.dumps(result(0))[:40],
               json.dumps(result(0, arrived="yes")), json.dumps(result(-1))]
        done = self.call(bad, "--flights", "1", "--seconds", "1e-9")  # no time to fly any
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["flights"], 0)

    def test_a_wrong_call_is_refused_with_status_2(self):
        for options in (["--flights"], ["--flights", "x"], ["--jobs", "0"], ["--nothing", "1"]):
            with self.subTest(options):
                done = self.call([], *options)
                self.assertEqual(done.returncode, 2)
                self.assertIn("usage", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
