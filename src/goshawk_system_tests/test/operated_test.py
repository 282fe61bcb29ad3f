#!/usr/bin/python3
"""What an operator commands a launched flight: missions, hold, resume, land and take off."""

import json
import math
import os
import signal

import harness
from harness import GOSHAWK, until, words
from stack import PLACES, StackTest

PASSED = (3.5, 6.1, 1.1)
FAR, HOME = PLACES


class OperatedFlight(StackTest):
    launch_file = "flight_mission"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.words = words("MissionState", "state")
        cls.missions = cls.stack.echo("mission_state")

    def send(self, *waypoints):
        """The verb as a process of its own, for a mission with these lines."""
        path = self.sandbox.folder / "mission.csv"
        path.write_text("x_m,y_m,z_m,v_max_m_s,pass_within_m\n" + "\n".join(waypoints) + "\n")
        return self.sandbox.start(GOSHAWK, "mission", path, "--json", "--ready", "30",
                                  "--timeout", "120")

    def missions_said(self, since=0):
        """(state, waypoint), as the stage says."""
        return [(self.words[m["state"]], m["waypoint"]) for m in self.missions.lines()[since:]]

    def check_done(self, verb, waypoints, place):
        self.assertEqual(verb.wait(90.0), 0, f"{verb.outcome()}\n{self.stack.launch.tails()}")
        self.assertEqual(json.loads(verb.out())["waypoints"], waypoints)
        self.assertLess(math.dist(self.stack.place(), place), 0.15)

    def call(self, *arguments):
        outcome = self.sandbox.goshawk(*arguments, "--json", "--ready", "30", timeout_s=90.0)
        self.assertEqual(outcome.status, 0, f"{outcome}\n{self.stack.launch.tails()}")
        return json.loads(outcome.out)

    def test_1_a_mission_passes_a_waypoint_in_flight_and_survives_the_stage_that_flies_it(self):
        verb = self.send("{},{},{},,0.5".format(*PASSED), "{},{},{},0.5,".format(*FAR))
        self.assertTrue(until(lambda: ("flying", 2) in self.missions_said(), 60.0),
                        str(self.missions_said()))
        os.kill(self.stack.launch.pids()["mission"], signal.SIGKILL)
        self.check_done(verb, 2, FAR)
        rests = [s["goal"] for s in self.stack.states.lines() if s["state"] == "arrived"]
        self.assertTrue(rests and all(g["y"] == FAR[1] for g in rests),
                        f"it came to rest on the way: {rests}")
        self.assertTrue(until(lambda: self.stack.launch.events("restarted", "mission"), 15.0))
        self.check_untouched()

    def test_2_a_hold_stops_the_vehicle_and_resume_flies_on(self):
        # Slow, so that there is time for a hold on a busy machine.
        here, since = self.stack.place(), len(self.missions.lines())
        verb = self.send("{},{},{},0.5,".format(*HOME))
        self.assertTrue(until(lambda: math.dist(self.stack.place(), here) > 0.3, 60.0))
        self.call("hold")
        self.assertTrue(until(lambda: ("paused", 1) in self.missions_said(since), 15.0),
                        str(self.missions_said(since)))
        self.assertGreater(math.dist(self.stack.place(), HOME), 0.5)
        why = self.call("why")
        self.assertEqual(why["binds"], "operator_hold", str(why))
        self.call("resume")
        self.check_done(verb, 1, HOME)
        self.check_untouched()

    def test_3_land_and_take_off(self):
        before = self.stack.place()
        low = self.call("land")["position"]
        self.assertLess(low[2], before[2] - 0.3)
        self.assertLess(math.dist(low[:2], before[:2]), 0.15)
        high = self.call("takeoff", "--height", "0.6")["position"]
        self.assertAlmostEqual(high[2], low[2] + 0.6, delta=0.15)
        self.check_untouched()


if __name__ == "__main__":
    harness.main()
