#!/usr/bin/python3
"""`goshawk param` on a stage that runs: what is set holds from the next plan on, what is wrong
changes nothing."""

import json
import math
import os
import unittest

import harness
from harness import GOSHAWK, Publisher, Sandbox, SystemTest, until

GRAVITY_M_S2 = 9.80665
TILT_RAD = 0.1


def point(x, y, z):
    return {"x": x, "y": y, "z": z}


def corridor(number):
    """One large room, and a straight way through it."""
    start, goal = point(3.0, 0.0, 1.0), point(3.0, 8.0, 2.0)
    normals = [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1]
    room = {"normals": [float(n) for n in normals], "offsets": [6.0, 0.0, 9.0, 1.0, 4.0, 0.0]}
    request = {"header": {"frame_id": "map"}, "id": number, "start": {"position": start},
               "goal": {"position": goal}, "limits": {"v_max": 2.0, "a_max": 2.0}}
    return {"header": {"frame_id": "map"}, "request": request, "map_version": 1,
            "waypoints": [start, goal], "polytopes": [room]}


def steepest_tilt(pieces):
    """[rad] that the thrust leans over, where each piece's acceleration is sampled."""
    steepest = 0.0
    for piece in pieces:
        points = [[p[k] for k in "xyz"] for p in piece["control_points"]]
        second = [[20.0 * (c - 2.0 * b + a) / piece["duration"] ** 2
                   for a, b, c in zip(points[i], points[i + 1], points[i + 2])] for i in range(4)]
        for step in range(51):
            u = step / 50.0
            weights = [math.comb(3, i) * u ** i * (1.0 - u) ** (3 - i) for i in range(4)]
            x, y, z = (sum(w * p[k] for w, p in zip(weights, second)) for k in range(3))
            steepest = max(steepest, math.atan2(math.hypot(x, y), GRAVITY_M_S2 + z))
    return steepest


class LiveParameters(unittest.TestCase):
    assert_civil = SystemTest.assert_civil

    @classmethod
    def setUpClass(cls):
        cls.sandbox = Sandbox()
        cls.stage = cls.sandbox.start(GOSHAWK, "run", "trajectory_optimizer")
        cls.trajectories = cls.sandbox.start(GOSHAWK, "topic", "echo", "trajectory", "--json",
                                             "--timeout", "60")
        cls.answers = cls.sandbox.start(GOSHAWK, "topic", "echo", "parameter_answer", "--json",
                                        "--timeout", "60")
        cls.number = 0
        cls.publishers = {}

    @classmethod
    def tearDownClass(cls):
        left = cls.sandbox.close()
        if left:
            raise AssertionError(f"processes outlived the test: {left}")

    def tearDown(self):
        self.assertTrue(self.stage.alive(), str(self.stage.outcome()))

    def param(self, *arguments, status=0):
        outcome = self.sandbox.goshawk("param", *arguments, "--json", "--timeout", "60",
                                       timeout_s=40)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, status, str(outcome))
        return json.loads(outcome.out)

    def pub(self, topic, kind, message):
        if topic not in self.publishers:
            self.publishers[topic] = Publisher(self.sandbox, topic, kind)
        self.publishers[topic].send(message)

    def plan(self):
        """Asked until it is answered: the stage and its listener may still be meeting."""
        cls = type(self)
        for _ in range(10):
            cls.number += 1
            number = cls.number
            self.pub("corridor", "goshawk_msgs/msg/Corridor", corridor(number))
            answer = until(lambda: next((t for t in self.trajectories.lines()
                                         if t["request"]["id"] == number), None), 2.0)
            if answer:
                return answer["pieces"]
        self.fail(f"no plan: {self.stage.outcome()}")

    def test_1_a_limit_set_is_obeyed_by_the_next_plan(self):
        before = self.plan()
        self.assertGreater(steepest_tilt(before), 1.2 * TILT_RAD)
        answer = self.param("set", "trajectory_optimizer", "max_tilt_rad", str(TILT_RAD),
                            "min_pieces", "12")
        self.assertEqual([(p["name"], p["old_value"], p["value"]) for p in answer["parameters"]],
                         [("min_pieces", "8", "12"), ("max_tilt_rad", "0", "0.1")])
        after = self.plan()
        self.assertLess(steepest_tilt(after), TILT_RAD + 1e-6)
        self.param("set", "trajectory_optimizer", "max_tilt_rad", "0", "min_pieces", "8")
        self.assertEqual(self.plan(), before, "the same config, the same bits")

    def test_2_what_is_wrong_is_a_sentence_and_changes_nothing(self):
        node = "trajectory_optimizer"
        before = self.param("get", node)
        for words, values in [
                ("at least 0 and at most 1.5", ["max_tilt_rad", "2"]),
                ("did you mean max_tilt_rad?", ["max_tilt", "0.1"]),
                ("takes effect at start only", ["use_sim_time", "true"]),
                ("2 parameter faults", ["min_pieces", "9", "max_tilt_rad", "-1", "yaw", "up"])]:
            with self.subTest(words):
                answer = self.param("set", node, *values, status=2)
                self.assertIs(answer["ok"], False)
                self.assertEqual(answer["code"], "invalid_parameter")
                self.assertIn(words, answer["message"])
        self.assertEqual(self.param("get", node), before)

    def test_3_malformed_requests_are_refused_and_the_stage_lives(self):
        kind = "goshawk_msgs/msg/ParameterRequest"
        good = {"id": 5, "client": "c", "node": "/trajectory_optimizer", "verb": "VERB_GET"}
        self.param("get", "trajectory_optimizer", "yaw")
        for words, changes in [("has id 0", {"id": 0}), ("neither VERB_GET nor VERB_SET", {"verb": 7}),
                               ("sets nothing", {"verb": "VERB_SET"})]:
            with self.subTest(words):
                # A latched request, again and again, until the answer was heard.
                answer = None
                for _ in range(10):
                    self.pub("parameter_request", kind, {**good, **changes})
                    answer = until(lambda w=words: next(
                        (a for a in self.answers.lines() if w in a["message"]), None), 1.0)
                    good["id"] += 1
                    if answer:
                        break
                self.assertIsNotNone(answer)
                self.assertEqual(answer["code"], "invalid_input")

    def test_4_a_node_that_is_not_there(self):
        outcome = self.sandbox.goshawk("param", "set", "no_such_node_at_all", "a", "1",
                                       "--timeout", "1", timeout_s=40)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 1, str(outcome))
        self.assertIn("there is no node /no_such_node_at_all", outcome.err)

    def test_5_another_user_changes_nothing(self):
        if os.geteuid() != 0:
            self.skipTest("only root can start a process of another user")
        before = self.param("get", "trajectory_optimizer")
        # Another user has no folder of its own here, and cannot hold the lock of the domain.
        outcome = self.sandbox.call("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups",
                                    GOSHAWK, "param", "set", "trajectory_optimizer",
                                    "max_tilt_rad", "0.2", "--json", "--timeout", "60", cwd="/",
                                    timeout_s=40)
        self.assert_civil(outcome)
        self.assertNotEqual(outcome.status, 0, str(outcome))
        answer = json.loads(outcome.out)
        self.assertEqual(answer["code"], "not_permitted", answer)
        self.assertIn("belongs to another user", answer["message"])
        self.assertEqual(self.param("get", "trajectory_optimizer"), before)


if __name__ == "__main__":
    harness.main()
