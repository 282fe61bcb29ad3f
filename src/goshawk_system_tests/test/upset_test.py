#!/usr/bin/python3
"""Stalls, set clocks and lost odometry in flight: nothing is touched, nothing is fast, and each is said
with a code. All with processes of the real stack; the moments follow from a seed."""

import math
import os
import random
import signal
import sys
import time

import harness
from harness import PREFIX, STAGES, note
from legs_case import LegsCase

sys.path.insert(0, str(PREFIX / "lib" / "goshawk"))
import fault_control  # noqa: E402

V_MAX_M_S = 2.0  # the navigator's default
SPEED_FACTOR = 1.1
SOFTWARE = [stage for stage in STAGES if stage != "simulator"]


class UpsetFlight(LegsCase):
    """One launched flight; each test upsets it while the vehicle moves. The goal is reached all the
    same, and the next upset meets what this one left."""

    @classmethod
    def launch_env(cls):
        folder = cls.sandbox.folder / "faults"
        folder.mkdir()
        cls.controls = {stage: fault_control.FaultControl(folder, stage) for stage in STAGES}
        cls.draw = random.Random(12)
        return fault_control.environment(fault_control.shim_of(PREFIX), folder)

    def upset(self, act, *codes):
        """Flies a leg with act() in it. @param codes of which the stages must say one"""
        reports = len(self.stack.reports.lines())
        goal, since = self.start_leg()
        time.sleep(self.draw.uniform(0.0, 1.0))
        act()
        state = self.stack.wait_state({"arrived", "failed"}, since, 60.0)
        said = {f"{harness.node_of(r)}: {r['code']}" for r in self.stack.reports.lines()[reports:]
                if r["code"] != "ok"}
        note(f"navigator {self.said(since)}; said {sorted(said)}")
        self.assertIsNotNone(state, "the leg neither ends nor fails\n" + self.stack.launch.tails())
        self.assertEqual(state["state"], "arrived", state)
        self.assertLess(math.dist(self.stack.place(), goal), 0.15)
        if codes:
            self.assertTrue(said & set(codes), f"of {codes} nothing is among {said}")
        self.check_untouched()
        self.check_speed()

    def check_speed(self):
        speed = max(math.hypot(*m["twist"]["twist"]["linear"].values())
                    for m in self.stack.odom.lines())
        note(f"never faster than {speed:.2f} m/s")
        self.assertLess(speed, SPEED_FACTOR * V_MAX_M_S)

    def stall(self, stages, seconds):
        """Stops processes, and lets them go on once so much time has passed."""
        pids = [self.stack.launch.pids()[stage] for stage in stages]
        try:
            for pid in pids:
                os.kill(pid, signal.SIGSTOP)
            time.sleep(seconds)
        finally:
            for pid in pids:
                os.kill(pid, signal.SIGCONT)

    def test_1_the_tracker_stops_for_a_while(self):
        for seconds in (0.05, self.draw.uniform(0.3, 0.8), self.draw.uniform(2.0, 4.0)):
            with self.subTest(seconds=seconds):
                # What is shorter than odometry's timeout is flown through.
                said = ["tracker: process_stalled"] if seconds > 0.2 else []
                self.upset(lambda: self.stall(["tracker"], seconds), *said)

    def test_2_each_stage_that_plans_stops_for_a_while(self):
        def act():
            for stage in ("map_server", "path_search", "corridor_builder", "trajectory_optimizer",
                          "navigator", "flight_check"):
                self.stall([stage], math.exp(self.draw.uniform(math.log(0.05), 0.0)))
        self.upset(act)

    def test_3_the_navigator_stops_for_longer_than_it_may(self):
        self.upset(lambda: self.stall(["navigator"], 10.0), "tracker: stage_silent")

    def test_4_all_stages_stop_at_once(self):
        self.upset(lambda: self.stall(SOFTWARE, self.draw.uniform(0.5, 3.0)),
                   "tracker: process_stalled")

    def test_5_everything_stops_at_once_and_the_vehicle_too(self):
        """A machine that was suspended with a simulated vehicle on it."""
        self.upset(lambda: self.stall(STAGES, self.draw.uniform(0.5, 3.0)))

    def test_6_clocks_are_set(self):
        def act():
            for step_s in (-5.0, 5.0):
                for stage in ("simulator", "tracker", "navigator"):
                    self.controls[stage].step_clock(step_s)
                    time.sleep(0.3)
        self.upset(act, "tracker: clock_set")

    def test_7_a_time_server_sets_the_clock_of_all(self):
        for step_s in (5.0, -5.0):
            with self.subTest(step_s=step_s):
                self.upset(lambda: [c.step_clock(step_s) for c in self.controls.values()])

    def test_8_odometry_pauses(self):
        def act():
            self.controls["tracker"].lose(received=1.0)
            time.sleep(self.draw.uniform(0.3, 1.5))
            self.controls["tracker"].lose()
        self.upset(act, "tracker: tracking_lost", "tracker: process_stalled")


if __name__ == "__main__":
    harness.main()
