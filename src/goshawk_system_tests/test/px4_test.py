#!/usr/bin/python3
"""Flights with PX4 as the plant, over the wire: the bridge, and a stand-in in PX4's place."""

import math
import os
import signal

import harness
from flight_test import FlightCase
from harness import node_of, note, until
from stack import StackTest

CONTROL_GOSHAWK, CONTROL_PILOT = 1, 2


class Px4Flight(FlightCase):
    def test_a_goal_is_reached_and_judged_by_the_truth(self):
        flight, _ = self.fly("--launch", "flight_px4", "--density", "0.1", "--goal", "3,1.5,1.2",
                             timeout_s=120.0)
        self.assertEqual((flight["code"], flight["verdict"]), ("ok", "safe"))
        self.assertTrue(flight["legs"][0]["arrived"], flight["legs"])
        self.assertGreater(flight["clearance"]["smallest_m"], 0.0)
        self.assertGreater(flight["clearance"]["samples"], 100)


class Px4Faults(StackTest):
    """One flight; each test does something to it while the vehicle moves."""

    launch_file = "flight_px4"
    world_options = ("--density", "0.1")
    FAR, NEAR = (3.0, 1.5, 1.2), (3.0, 0.5, 1.2)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.status = cls.stack.echo("vehicle_status")

    def told_of(self, words):
        return any(words in r["message"] for r in self.stack.reports.lines()
                   if node_of(r) == "px4")

    def control(self):
        lines = self.status.lines()
        return lines[-1]["control"] if lines else None

    def start_leg(self, goal):
        here = self.stack.place()
        since = len(self.stack.states.lines())
        self.stack.send_goal(goal)
        moving = until(lambda: math.dist(self.stack.place(), here) > 0.2, 30.0)
        self.assertTrue(moving, self.stack.launch.tails())
        return since

    def kill(self, stage):
        restarts = len(self.stack.launch.events("restarted", stage))
        os.kill(self.stack.launch.pids()[stage], signal.SIGKILL)
        self.assertTrue(until(lambda: len(self.stack.launch.events("restarted", stage)) > restarts,
                              30.0), self.stack.launch.tails())

    def expect_reached(self, goal):
        """By what was sent already, or by the same goal sent again: what was flown is over."""
        def reached():
            if math.dist(self.stack.place(), goal) < 0.2:
                return True
            state = self.stack.fly_to(goal)
            return state is not None and state["state"] == "arrived"
        self.assertTrue(until(reached, 120.0), self.stack.launch.tails())

    def test_1_the_bridge_is_killed(self):
        """PX4 holds, and lets the new bridge fly once it is there."""
        self.start_leg(self.FAR)
        self.kill("px4")
        self.assertTrue(until(lambda: self.control() == CONTROL_GOSHAWK, 60.0),
                        self.stack.launch.tails())
        self.expect_reached(self.FAR)
        self.check_untouched()

    def test_2_the_pilot_moves_the_sticks(self):
        self.start_leg(self.NEAR)
        outcome = self.sandbox.goshawk("param", "set", "simulator", "sticks", "moved", "--json",
                                       "--timeout", "60", timeout_s=90)
        self.assertEqual(outcome.status, 0, str(outcome))
        self.assertTrue(until(lambda: self.control() == CONTROL_PILOT, 60.0),
                        self.stack.launch.tails())
        # Whether the sticks or the change of mode is heard first, is chance.
        self.assertTrue(until(lambda: self.told_of("flies again when its mode is selected"), 60.0),
                        self.stack.launch.tails())
        note("the pilot has the vehicle")
        self.check_untouched()


if __name__ == "__main__":
    harness.main()
