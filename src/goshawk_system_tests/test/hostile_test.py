#!/usr/bin/python3
"""A member of the domain that speaks as a stage, in flight: every row of docs/security.md."""

import itertools
import json
import signal

import harness
from harness import GOSHAWK, PREFIX, SystemTest, node_of, note, until
from stack import PLACES, StackTest, position_of

# lie: options, and a stage that must refuse it
LIES = {
    "commit": ([], "tracker"),
    "commit_of_no_map": ([], "tracker"),
    "trajectory": ([], "navigator"),
    "bad_trajectory": ([], "navigator"),
    "corridor": ([], "trajectory_optimizer"),
    "request": ([], "path_search"),
    "report": ([], "navigator"),
    "map": ([], "path_search"),
    "update": ([], "path_search"),
    "blocked_map": ([], "path_search"),
    "odom": ([], "tracker"),
    "command at 500 Hz": (["--rate", 500], "simulator"),
    "command at 5,000 Hz": (["--rate", 5000], "simulator"),
    "fallback_stop": (["--rate", 100], "simulator"),
}
MOST_LEGS = 6  # with one lie


class HostileParticipant(StackTest):
    # With a sensor that is not perfect the simulator tells the truth on a topic of its own: what a
    # lie about odometry does is judged by that one.
    ros_args = ["-p", "simulator:position_noise_m:=0.001", "-p", "navigator:set_parameters:=none"]

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.truth = cls.stack.echo("odom_true", "--no-arr")

    def refused_by(self, stage, since):
        return [r for r in self.stack.reports.lines()[since:]
                if r["code"] == "second_writer" and node_of(r) == stage]

    def fly_until_refused(self, stage, since, legs):
        """Some lies answer a request, so that one that is told too late needs another leg."""
        for _ in range(MOST_LEGS):
            self.fly([next(legs)])
            if until(lambda: self.refused_by(stage, since), 2.0):
                return
        self.fail(f"{stage} does not name the liar\n{self.stack.launch.tails()}")

    def test_1_lies_are_refused_and_every_goal_is_reached(self):
        pids = self.stack.launch.pids()
        legs = itertools.cycle(PLACES)
        for name, (options, stage) in LIES.items():
            with self.subTest(name):
                since = len(self.stack.reports.lines())
                to = ",".join(str(x) for x in PLACES[0])
                impostor = self.sandbox.start(PREFIX / "bin" / "goshawk_impostor", name.split()[0],
                                              "--to", to, *options)
                self.assertTrue(until(lambda i=impostor: i.lines(), 10.0), str(impostor.outcome()))
                self.fly_until_refused(stage, since, legs)
                self.assertEqual(impostor.stop(signal.SIGTERM)[0], 0, str(impostor.outcome()))
                note(f"{name}: {impostor.lines()[-1]['sent']} messages")
                self.assertGreater(impostor.lines()[-1]["sent"], 0)
        self.assertEqual(self.stack.launch.pids(), pids, self.stack.launch.tails())

    def test_2_parameters_that_the_launch_has_fixed_stay(self):
        outcome = self.sandbox.goshawk("param", "set", "navigator", "v_max_m_s", "9", "--json",
                                       "--timeout", "60", timeout_s=90)
        self.assertNotEqual(outcome.status, 0, str(outcome))
        self.assertEqual(json.loads(outcome.out)["code"], "not_permitted", str(outcome))

    def test_3_a_goal_after_the_liars_have_left_is_reached(self):
        self.fly()

    def test_4_nothing_was_touched(self):
        self.check_untouched([position_of(m) for m in self.truth.lines()])


class HostileClouds(SystemTest):
    """Live flights, beside a stranger whose clouds would paint walls or erase the true ones."""

    def fly(self, lie):
        """@return the summary of the flight, and what the stages said in it"""
        reports = self.sandbox.start(GOSHAWK, "topic", "echo", "stage_report", "--json",
                                     "--timeout", "240")
        flight = self.sandbox.start(GOSHAWK, "fly", "--live", "--json", "--no-record", "--output",
                                    self.sandbox.folder / lie)
        ready = until(lambda: {"lidar", "map_server"} <= {node_of(r) for r in reports.lines()}, 60.0)
        self.assertTrue(ready, str(flight.outcome()))
        impostor = self.sandbox.start(PREFIX / "bin" / "goshawk_impostor", lie, "--to", "3,8,2",
                                      "--rate", 10)
        status = flight.wait(120.0)
        self.assertEqual(impostor.stop(signal.SIGTERM)[0], 0, str(impostor.outcome()))
        self.assertGreater(impostor.lines()[-1]["sent"], 0)
        self.assertEqual(status, 0, str(flight.outcome()))
        return self.json_object(flight.outcome()), reports.lines()

    def test_clouds_of_a_stranger_are_refused_and_the_goal_is_reached(self):
        for lie in ("cloud_of_nothing", "cloud_of_wall", "cloud_of_garbage"):
            with self.subTest(lie):
                flight, reports = self.fly(lie)
                self.assertEqual((flight["code"], flight["verdict"]), ("ok", "safe"))
                self.assertTrue([r for r in reports if r["code"] == "second_writer"
                                 and node_of(r) == "map_server"], "the liar is not named")


if __name__ == "__main__":
    harness.main()
