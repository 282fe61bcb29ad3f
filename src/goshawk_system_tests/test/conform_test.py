#!/usr/bin/python3
"""`goshawk conform`: our stages pass every item, a stage that is too simple fails at the right ones."""

import json

import harness
from harness import SystemTest, note


class Conform(SystemTest):
    def conform(self, *arguments):
        outcome = self.sandbox.goshawk("conform", *arguments, "--json", timeout_s=60)
        self.assert_civil(outcome)
        return outcome, self.json_object(outcome)

    def failed(self, report):
        return {item["name"]: item["detail"] for item in report["items"] if not item["passed"]}

    def test_every_stage_of_ours_passes(self):
        for stage in ("path_search", "corridor_builder", "trajectory_optimizer", "tracker",
                      "map_server"):
            with self.subTest(stage=stage):
                outcome, report = self.conform(stage, "-n", "20")
                self.assertEqual(self.failed(report), {})
                self.assertEqual(outcome.status, 0)
                self.assertGreaterEqual(len(report["items"]), 15)
                note(f"{stage}: {len(report['items'])} items, {report['latency']['p50_ms']:.2f} ms")

    def test_the_simple_search_in_c_plans_well_and_checks_little(self):
        file = self.sandbox.folder / "bfs.yaml"
        program = harness.PREFIX / "bin" / "goshawk_cyclone_search"
        file.write_text(json.dumps({"stages": [{"command": [str(program)], "name": "bfs"}]}))
        outcome, report = self.conform("path_search", "--launch", file, "-n", "10")
        self.assertEqual(outcome.status, 1)
        self.assertEqual(report["implementation"], "cyclone_bfs")
        items = {item["name"]: item["passed"] for item in report["items"]}
        for name in ("answers every request", "reports every result", "echoes the request whole",
                     "results are valid", "refuses a goal that is cut off",
                     "lives on after garbage"):
            self.assertTrue(items[name], (name, report))
        for name in ("refuses a request in another frame", "refuses a speed limit below zero",
                     "refuses a deadline that has passed"):
            self.assertFalse(items[name], (name, report))

    def test_wrong_calls_and_an_empty_domain_are_sentences(self):
        outcome, report = self.conform("path_serch")
        self.assertEqual((outcome.status, report["code"]), (2, "invalid_parameter"))
        self.assertIn("path_search", report["message"])


if __name__ == "__main__":
    harness.main()
