#!/usr/bin/python3
"""Another planner behind the guard, over DDS: what it sends is flown as far as it is safe, and each
plan is answered. The test is the planner."""

import harness
import second_opinion
from harness import BODY_RADIUS_M, GOSHAWK, Publisher, SystemTest, node_of, note, until, words
from stack import Launch, States, position_of

START, GOAL = (3.0, 0.0, 1.0), (3.0, 8.0, 2.0)
ABOVE = (3.0, 0.0, 1.15)
STAGES = {"map_server", "guard", "tracker", "simulator", "flight_check"}
VERDICTS = words("GuardVerdict", "verdict")
MODES = words("TrackingState", "mode")
MAP = {"frame_id": "map"}


def point(p):
    return dict(zip("xyz", (float(x) for x in p)))


def path(*points, frame="map"):
    return {"header": {"frame_id": frame},
            "poses": [{"pose": {"position": point(p), "orientation": {"w": 1.0}}} for p in points]}


def spline(begin, end, duration):
    """A cubic from rest to rest, uniform: three equal points at each end."""
    points = [begin] * 3 + [[b + k / 4 * (e - b) for b, e in zip(begin, end)] for k in (1, 2, 3)]
    points += [end] * 3
    knots = [duration / 6 * (k - 3) for k in range(len(points) + 4)]
    return {"header": MAP, "degree": 3, "control_points": [point(p) for p in points],
            "knots": knots}


def polynomial(begin, end, duration):
    """Minimum jerk from rest to rest."""
    def coefficients(b, e):
        rise = float(e - b)
        return [float(b), 0.0, 0.0, 10 * rise / duration**3, -15 * rise / duration**4,
                6 * rise / duration**5]
    x, y, z = (coefficients(b, e) for b, e in zip(begin, end))
    return {"header": MAP, "pieces": [{"duration": duration, "x": x, "y": y, "z": z}]}


def trajectory(begin, end, duration, steps=20):
    """The same in samples, with velocities and accelerations."""
    def at(k):
        s = k / steps
        shares = (10 * s**3 - 15 * s**4 + 6 * s**5,
                  (30 * s**2 - 60 * s**3 + 30 * s**4) / duration,
                  (60 * s - 180 * s**2 + 120 * s**3) / duration**2)
        rise = [e - b for b, e in zip(begin, end)]
        p = [b + shares[0] * r for b, r in zip(begin, rise)]
        time_s = duration * s
        return {"transforms": [{"translation": point(p), "rotation": {"w": 1.0}}],
                "velocities": [{"linear": point([shares[1] * r for r in rise])}],
                "accelerations": [{"linear": point([shares[2] * r for r in rise])}],
                "time_from_start": {"sec": int(time_s), "nanosec": int(time_s % 1.0 * 1e9)}}
    return {"header": MAP, "joint_names": ["base_link"],
            "points": [at(k) for k in range(steps + 1)]}


class GuardedPlanner(SystemTest):
    def setUp(self):
        super().setUp()
        self.world = self.sandbox.folder / "world.bt"
        made = self.sandbox.goshawk("world", self.world, "--json")
        self.assertEqual(made.status, 0, str(made))
        self.reports = self.echo("stage_report")
        self.verdicts = self.echo("guard_verdict")
        self.states = States(self.echo("navigator_state"))
        self.odom = self.echo("odom", "--no-arr")
        self.tracking = self.echo("tracking_state")
        self.launch = Launch(self.sandbox, "guard", "-p", f"map_server:map_file:={self.world}")
        ready = until(lambda: {node_of(r) for r in self.reports.lines()} >= STAGES and
                      self.mode() == "hold" and self.states.lines(), 60.0)
        self.assertTrue(ready, self.launch.tails())
        self.publishers = {}

    def echo(self, topic, *options):
        return self.sandbox.start(GOSHAWK, "topic", "echo", topic, "--json", "--timeout", "300",
                                  *options)

    def mode(self):
        lines = self.tracking.lines()
        return MODES[lines[-1]["mode"]] if lines else None

    def place(self):
        return position_of(self.odom.lines()[-1])

    def plan(self, topic, kind, message):
        """@return the guard's verdict on it"""
        since = len(self.verdicts.lines())
        if topic not in self.publishers:
            # One planner at a time: a process keeps its place for as long as it lives.
            for other in self.publishers.values():
                other.process.stop()
            self.publishers = {topic: Publisher(self.sandbox, topic, kind)}
        self.publishers[topic].send(message)
        until(lambda: len(self.verdicts.lines()) > since, 40.0)
        lines = self.verdicts.lines()
        self.assertGreater(len(lines), since, self.launch.tails())
        verdict = lines[-1]
        verdict["verdict"] = VERDICTS[verdict["verdict"]]
        return verdict

    def wait_flown(self, verdict):
        """Until the vehicle rests at the end of what the verdict committed. @return its state"""
        number = verdict["request_id"]
        state = until(lambda: next((s for s in self.states.lines()
                                    if s["flown_request_id"] == number and
                                    s["state"] in ("arrived", "failed")), None), 60.0)
        self.assertIsNotNone(state, self.launch.tails())
        self.assertTrue(until(lambda: self.mode() == "hold", 30.0))
        return state["state"]

    def near(self, goal, within=0.1):
        place = self.place()
        return max(abs(a - b) for a, b in zip(place, goal)) < within

    def test_plans_of_every_kind_are_flown_trimmed_or_refused(self):
        with self.subTest("another frame"):
            verdict = self.plan("plan/path", "nav_msgs/msg/Path", path(START, GOAL, frame="odom"))
            self.assertEqual((verdict["verdict"], verdict["code"]), ("refused", "wrong_frame"))
            self.assertIn("'odom'", verdict["message"])
        with self.subTest("from elsewhere"):
            verdict = self.plan("plan/path", "nav_msgs/msg/Path", path(GOAL, START[:2] + (3.0,)))
            self.assertEqual((verdict["verdict"], verdict["code"]), ("refused", "not_at_start"))
            self.assertEqual(len(verdict["place"]), 1)
        self.assertTrue(self.near(START))
        kinds = [("plan/bspline", "goshawk_msgs/msg/BsplinePlan", spline),
                 ("plan/polynomial", "goshawk_msgs/msg/PolynomialPlan", polynomial),
                 ("plan/trajectory", "trajectory_msgs/msg/MultiDOFJointTrajectory", trajectory)]
        places = [START, ABOVE]
        for k, (topic, kind, made) in enumerate(kinds):
            begin, end = places[k % 2], places[(k + 1) % 2]
            with self.subTest(topic):
                verdict = self.plan(topic, kind, made(begin, end, 1.5))
                self.assertEqual((verdict["verdict"], verdict["code"]), ("passed", "ok"), verdict)
                self.assertEqual(self.wait_flown(verdict), "arrived")
                self.assertTrue(until(lambda goal=end: self.near(goal), 20.0), self.place())
        with self.subTest("too fast"):
            verdict = self.plan("plan/polynomial", "goshawk_msgs/msg/PolynomialPlan",
                                polynomial(ABOVE, START, 0.2))
            self.assertEqual(verdict["verdict"], "slowed", verdict)
            self.assertEqual(self.wait_flown(verdict), "arrived")
        with self.subTest("through obstacles"):
            verdict = self.plan("plan/path", "nav_msgs/msg/Path", path(START, GOAL))
            self.assertEqual(verdict["code"], "trajectory_blocked", verdict)
            self.assertIn("has an obstacle at", verdict["message"])
            self.assertEqual(len(verdict["place"]), 1)
            if verdict["request_id"]:
                self.assertTrue(verdict["trimmed"])
                self.assertEqual(self.wait_flown(verdict), "failed")
            self.assertFalse(self.near(GOAL, 1.0))
        track = [position_of(m) for m in self.odom.lines()]
        clearance = second_opinion.smallest_clearance(self.world, track, 0.02)
        note(f"{len(self.verdicts.lines())} plans; smallest distance of the centre to an obstacle "
             f"{clearance:.3f} m")
        self.assertGreater(clearance, BODY_RADIUS_M)
        refused = [r for r in self.reports.lines() if node_of(r) == "tracker" and
                   r["request_id"] and r["code"] != "ok"]
        self.assertEqual(refused, [])


if __name__ == "__main__":
    harness.main()
