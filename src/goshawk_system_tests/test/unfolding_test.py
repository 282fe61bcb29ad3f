#!/usr/bin/python3
"""Goals in space that nobody has seen yet, over separate processes: the vehicle flies there as its
lidar shows the way, and comes to rest when what plans is dead. Judged by the true world."""

import math
import os
import signal

import harness
import second_opinion
from harness import SystemTest, node_of, note, until
from stack import Stack

START = (3.1, 0.1, 1.1)
FAR = (3.1, 8.1, 2.1)  # beyond what the lidar sees at first
REACHED_M = 0.25


class UnfoldingFlight(SystemTest):
    def setUp(self):
        super().setUp()
        self.stack = Stack(self.sandbox, "live", world_parameter="lidar:world_file")
        self.stack.wait_ready()
        ready = until(lambda: any(node_of(r) == "lidar" and r["code"] == "ok"
                                  for r in self.stack.reports.lines()), 60.0)
        self.assertTrue(ready, self.stack.launch.tails())
        self.commits = self.stack.echo("committed_trajectory")

    def reach(self, goal, timeout_s=90.0):
        """A vehicle that came to rest because something was dead is sent again."""
        for _ in range(3):
            state = self.stack.fly_to(goal, timeout_s)
            self.assertIsNotNone(state, f"no answer\n{self.stack.launch.tails()}")
            if state["state"] == "arrived":
                break
        self.assertEqual(state["state"], "arrived", f"{state}\n{self.stack.launch.tails()}")
        self.assertLess(math.dist(self.stack.place(), goal), REACHED_M)

    def check_untouched(self):
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track(), 0.02)
        note(f"the centre came to {clearance:.3f} m of the true world")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)

    def test_1_a_goal_that_was_never_seen_is_reached_on_commits_with_a_stop(self):
        self.reach(FAR)
        self.reach(START)
        self.check_untouched()
        commits = self.commits.lines()
        with_stop = [c for c in commits if c["stop_pieces"]]
        note(f"{len(commits)} commits, {len(with_stop)} of them with a stop part")
        self.assertGreater(len(with_stop), 1)

    def test_2_when_the_optimizer_dies_in_flight_the_vehicle_rests_and_then_goes_on(self):
        since = len(self.stack.states.lines())
        self.stack.send_goal(FAR)
        flies = until(lambda: math.dist(self.stack.place(), START) > 0.5, 60.0)
        self.assertTrue(flies, self.stack.launch.tails())
        os.kill(self.stack.launch.pids()["trajectory_optimizer"], signal.SIGKILL)
        self.assertTrue(self.stack.wait_state({"arrived", "failed"}, since, 90.0),
                        self.stack.launch.tails())
        self.reach(FAR)
        self.check_untouched()


if __name__ == "__main__":
    harness.main()
