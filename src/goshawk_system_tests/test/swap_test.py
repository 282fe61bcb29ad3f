#!/usr/bin/python3
"""Programs in C with Eclipse Cyclone DDS, made from idl/ alone, meet Goshawk's stages."""

import json

import harness
from harness import SystemTest, note
from stack import StackTest


class CycloneSearch(SystemTest):
    def test_a_flight_with_a_search_stage_of_another_vendor_is_safe(self):
        folder = self.sandbox.folder / "out"
        outcome = self.sandbox.goshawk("fly", "--json", "--launch", "cyclone_search", "--output",
                                       folder, timeout_s=90)
        logs = "".join(p.read_text(errors="replace")[-500:]
                       for p in (folder / "logs").glob("*.log")) if outcome.status else ""
        self.assertEqual(outcome.status, 0, str(outcome) + logs)
        flight = self.json_object(outcome)
        self.assertEqual(flight["verdict"], "safe")
        implementations = {s["name"]: s["implementation"] for s in flight["legs"][0]["stages"]}
        self.assertEqual(implementations["path_search"], "cyclone_bfs")
        self.assertNotEqual(implementations["corridor_builder"], "cyclone_bfs")
        note(f"clearance {flight['clearance']['smallest_m']:.3f} m, "
             f"{flight['legs'][0]['path']['waypoints']} waypoints")


class CycloneObserver(StackTest):
    def observe(self, *goal):
        return self.sandbox.call(harness.PREFIX / "bin" / "goshawk_cyclone_plan_observer", *goal,
                                 timeout_s=60)

    def test_the_certificate_holds_when_computed_in_c(self):
        outcome = self.observe("3", "8", "2")
        self.assertEqual(outcome.status, 0, f"{outcome}\n{self.stack.launch.tails()}")
        seen = json.loads(outcome.out)
        note(outcome.out.strip())
        self.assertLessEqual(abs(max(seen["largest_violation"], 0.0)), 1e-6)
        self.assertGreaterEqual(seen["polytopes"], 1)
        self.assertEqual(seen["polytopes"] + 1, seen["waypoints"])
        self.assertGreaterEqual(seen["pieces"], seen["polytopes"])

    def test_the_nodes_are_told_as_ros_2_reads_them(self):
        outcome = self.sandbox.call(harness.PREFIX / "bin" / "goshawk_cyclone_ros_graph",
                                    "/navigator", "rt/plan_request", timeout_s=60)
        self.assertEqual(outcome.status, 0, f"{outcome}\n{self.stack.launch.tails()}")
        told = json.loads(outcome.out)
        self.assertEqual(told["participant_entity"], "000001c1")
        self.assertIn("rt/committed_trajectory", told["writes"])
        self.assertIn("rt/trajectory", told["reads"])
        # Each once, and nothing of the other stages.
        self.assertEqual(len(set(told["writes"])), len(told["writes"]), told)
        self.assertNotIn("rt/path", told["writes"] + told["reads"])

    def test_a_wrong_call_of_it_has_status_2(self):
        self.assertEqual(self.observe("1").status, 2)


if __name__ == "__main__":
    harness.main()
