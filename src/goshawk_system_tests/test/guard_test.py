#!/usr/bin/python3
"""The tracker over DDS: what the map, or the second opinion, says no to is not flown. The test is
the navigator, and may write what it likes."""

import json
import time

import harness
import second_opinion
from harness import GOSHAWK, Publisher, SystemTest, node_of, note, until, words
from stack import Launch, position_of

START, GOAL = (3.0, 0.0, 1.0), (3.0, 8.0, 2.0)
MODES = words("TrackingState", "mode")
FLIGHT_CHECK = 8  # STAGE_FLIGHT_CHECK
BEGINS_S = 10.0   # from a commit to its start: time for it, and for its verdict, to come


def point(x, y, z):
    return {"x": x, "y": y, "z": z}


def stamp(time_s):
    return {"sec": int(time_s), "nanosec": int((time_s % 1.0) * 1e9)}


class GuardCase(SystemTest):
    """A map, a vehicle and a tracker; committed trajectories come from the test."""

    stages = ("map_server", "simulator", "tracker")
    params = {}

    def setUp(self):
        super().setUp()
        world = self.sandbox.folder / "world.bt"
        made = self.sandbox.goshawk("world", world, "--json")
        self.assertEqual(made.status, 0, str(made))
        self.world = world
        file = self.sandbox.folder / "guard.yaml"
        file.write_text(json.dumps({"stages": [{"component": s} for s in self.stages]}))
        arguments = [word for name, value in self.params.items()
                     for word in ("-p", f"tracker:{name}:={value}")]
        self.reports = self.echo("stage_report")
        self.odom = self.echo("odom", "--no-arr")
        self.tracking = self.echo("tracking_state")
        self.launch = Launch(self.sandbox, file, "-p", f"map_server:map_file:={world}", *arguments)
        ready = until(lambda: {node_of(r) for r in self.reports.lines()} >= set(self.stages) and
                      self.tracking.lines() and self.odom.lines(), 60.0)
        self.assertTrue(ready, self.launch.tails())
        self.commits = Publisher(self.sandbox, "committed_trajectory",
                                 "goshawk_msgs/msg/CommittedTrajectory")
        self.verdicts = Publisher(self.sandbox, "stage_report", "goshawk_msgs/msg/StageReport",
                                  readers=2)
        self.number = 100

    def echo(self, topic, *options):
        return self.sandbox.start(GOSHAWK, "topic", "echo", topic, "--json", "--timeout", "120",
                                  *options)

    def commit(self, goal, duration=8.0, version=1, number=None, begins_in_s=1.0):
        """From where the vehicle hovers, straight to a goal, from rest to rest. @return its id"""
        self.number = number or self.number + 1
        start = [float(x) for x in self.place()]
        limits = {"v_max": 50.0, "a_max": 50.0}
        header = {"frame_id": "map", "stamp": stamp(time.time())}
        room = {"normals": [float(n) for n in (1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1,
                                               0, 0, -1)], "offsets": [100.0] * 6}
        request = {"header": header, "id": self.number, "start": {"position": point(*start)},
                   "goal": {"position": point(*goal)}, "limits": limits}
        piece = {"duration": duration, "polytope": 0,
                 "control_points": [point(*start)] * 3 + [point(*goal)] * 3}
        nominal = {"header": header, "request": request, "map_version": version,
                   "pieces": [piece], "polytopes": [room]}
        self.commits.send({"header": header, "start_time": stamp(time.time() + begins_in_s),
                           "map_version": version, "nominal": nominal})
        return self.number

    def place(self):
        return position_of(self.odom.lines()[-1])

    def answer(self, number, timeout_s=20.0):
        """@return what the tracker says of a trajectory first"""
        found = until(lambda: next((r for r in self.reports.lines() if node_of(r) == "tracker" and
                                    r["request_id"] == number), None), timeout_s)
        self.assertIsNotNone(found, f"no answer to {number}: {self.launch.tails()}")
        return found

    def answers(self, number):
        return [r for r in self.reports.lines()
                if node_of(r) == "tracker" and r["request_id"] == number]

    def judge(self, number, code, message):
        self.verdicts.send({"header": {"frame_id": "map"}, "stage": FLIGHT_CHECK,
                            "node": "/flight_check", "implementation": "test",
                            "request_id": number, "code": code, "message": message})

    def mode(self):
        return MODES[self.tracking.lines()[-1]["mode"]]

    def stays_near(self, place, radius_m=0.2):
        return max(max(abs(a - b) for a, b in zip(position_of(m), place))
                   for m in self.odom.lines()) < radius_m

    def assert_nothing_touched(self):
        track = [position_of(m) for m in self.odom.lines()]
        clearance = second_opinion.smallest_clearance(self.world, track, 0.02)
        self.assertGreater(clearance, harness.BODY_RADIUS_M)


class MapGuard(GuardCase):
    def test_what_the_map_shows_blocked_is_refused(self):
        with self.subTest("forged, through obstacles, with a certificate that holds"):
            refused = self.answer(self.commit(GOAL))
            self.assertEqual(refused["code"], "trajectory_blocked", refused)
            self.assertIn("map 1 has an obstacle at", refused["message"])
        with self.subTest("out of the map"):
            refused = self.answer(self.commit((3.0, -60.0, 1.0), duration=40.0))
            self.assertEqual(refused["code"], "trajectory_blocked", refused)
        with self.subTest("a version that nobody has"):
            refused = self.answer(self.commit(GOAL, version=2**63))
            self.assertEqual(refused["code"], "no_map", refused)
            self.assertIn("9223372036854775808", refused["message"])
        with self.subTest("no version at all"):
            refused = self.answer(self.commit(GOAL, version=0))
            self.assertEqual(refused["code"], "trajectory_blocked", refused)
        with self.subTest("one that waits for a version gives way to a newer one"):
            old = self.commit(GOAL, version=999)
            new = self.commit(GOAL)
            self.assertEqual(self.answer(new)["code"], "trajectory_blocked")
            self.assertIn(self.answer(old)["code"], ("cancelled", "no_map"))
        self.assertTrue(self.stays_near(START))
        with self.subTest("a free one is flown afterwards"):
            number = self.commit((3.0, 0.0, 1.15), duration=3.0, begins_in_s=BEGINS_S)
            self.assertEqual(self.answer(number)["code"], "ok")
            self.assertTrue(until(lambda: len(self.answers(number)) > 1, 30.0))
            self.assertEqual(self.answers(number)[1]["code"], "ok", self.answers(number))
        self.assert_nothing_touched()


class NoMapGuard(GuardCase):
    stages = ("simulator", "tracker")

    def test_without_a_map_nothing_is_flown_and_the_sentence_says_so(self):
        refused = self.answer(self.commit((3.0, 0.5, 1.0)))
        self.assertEqual(refused["code"], "no_map", refused)
        self.assertIn("map_server", refused["message"])
        self.assertTrue(self.stays_near(START))


class SilentOpinionGuard(GuardCase):
    params = {"second_opinion": "require", "second_opinion_wait_s": 1.0}

    def test_what_nobody_has_judged_is_not_flown(self):
        refused = self.answer(self.commit((3.0, 0.0, 1.15)))
        self.assertEqual(refused["code"], "stage_silent", refused)
        self.assertIn("flight_check", refused["message"])
        self.assertTrue(self.stays_near(START))


class SecondOpinionGuard(GuardCase):
    # Verdict and trajectory come by two topics: whichever is first waits for the other.
    params = {"second_opinion": "require", "second_opinion_wait_s": 60.0}

    def test_only_what_was_judged_free_is_flown_and_a_veto_is_braked_for(self):
        goal = (3.0, 0.0, 1.15)
        with self.subTest("touching"):
            self.judge(self.number + 1, "collision", "planned: touches at (3, 0, 1) m")
            refused = self.answer(self.commit(goal))
            self.assertEqual(refused["code"], "collision", refused)
            self.assertIn("touches at (3, 0, 1) m", refused["message"])
        with self.subTest("free, then vetoed in flight"):
            self.judge(self.number + 1, "ok", "")
            number = self.commit(goal, duration=30.0, begins_in_s=BEGINS_S)
            self.assertEqual(self.answer(number)["code"], "ok")
            self.assertTrue(until(lambda: self.mode() == "follow", 30.0))
            self.judge(number, "collision", "planned: a newer map touches")
            lost = until(lambda: next((r for r in self.answers(number) if r["code"] != "ok"),
                                      None), 20.0)
            self.assertEqual(lost["code"], "collision", lost)
            self.assertIn("a newer map touches", lost["message"])
            self.assertTrue(until(lambda: self.mode() == "hold", 20.0))
            note(f"braked at {self.place()[2] - 1.0:.3f} of 0.15 m")
        self.assert_nothing_touched()


if __name__ == "__main__":
    harness.main()
