"""Tests of tools/league: what it flies, prints and writes, and that it goes on where it was."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LEAGUE = ROOT / "tools/league"
PREFIX = pathlib.Path(os.environ.get("GOSHAWK_PREFIX", ROOT / "install"))
ROW = {"world", "runs", "arrived", "contacts", "violations", "time_s", "length_m", "mean_speed_m_s",
       "top_speed_m_s", "replan_p50_ms", "replan_p99_ms", "peer", "peer_time_s"}


def league(*words):
    return subprocess.run([str(w) for w in (LEAGUE, "--prefix", PREFIX, *words)],
                          capture_output=True, text=True, check=False)


class League(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fly(self, *words):
        result = league("--output", self.folder, "--json", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout), result.stderr

    def test_a_quick_league_arrives_and_touches_nothing(self):
        printed, _ = self.fly("--quick", "--worlds", "standardized", "--latency", "0.005")
        self.assertEqual([r["tracking"] for r in printed["rows"]], ["true", "ideal"])
        for row in printed["rows"]:
            self.assertLessEqual(ROW, set(row))
            self.assertEqual((row["runs"], row["arrived"], row["contacts"], row["violations"]),
                             (1, 1, 0, 0))
            self.assertGreater(row["time_s"], row["floor_s"])
            self.assertLess(row["time_s"], row["peer_time_s"])
            self.assertGreater(row["top_speed_m_s"], row["mean_speed_m_s"])
        page = (self.folder / "report.html").read_text()
        self.assertIn("standardized from above", page)
        self.assertIn("SANDO", page)

    def test_what_was_flown_is_not_flown_again(self):
        words = ("--worlds", "standardized", "--runs", "2", "--known-runs", "1", "--tracking",
                 "true", "--latency", "0")
        first, said = self.fly(*words)
        self.assertIn("3/3", said)
        second, said = self.fly(*words)
        self.assertIn("3 flights are there already", said)
        self.assertEqual(first["rows"], second["rows"])
        next(self.folder.glob("flights/standardized_true_1_0_cost_0.json")).unlink()
        third, said = self.fly(*words)
        self.assertIn("1/1 standardized_true_1", said)
        for key in ("time_s", "length_m", "of_known_speed"):
            self.assertEqual(first["rows"][0][key], third["rows"][0][key])
        _, said = self.fly("--worlds", "standardized", "--runs", "1", "--known-runs", "0",
                           "--tracking", "true", "--latency", "0.01")
        self.assertIn("1/1 standardized_true_0", said, "plans that cost more make another flight")

    def test_what_it_does_not_know_is_refused(self):
        for words, said in [(("--worlds", "jungle"), "forest_hard"),
                            (("--tracking", "perfect"), "ideal"), (("--runs", "0"), "at least 1")]:
            result = league("--output", self.folder, *words)
            self.assertEqual(result.returncode, 2)
            self.assertIn(said, result.stderr)

    def test_it_says_what_to_do_before_it_is_built(self):
        result = league("--output", self.folder, "--prefix", self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("run tools/setup, then tools/build", result.stderr)


if __name__ == "__main__":
    unittest.main()
