#!/usr/bin/python3
"""DDS Security: who may read and write what, by `goshawk secure init` and `goshawk launch --secure`."""

import json
import os
import signal
import sys
import time

import harness
from harness import SOURCE, SystemTest, until
from stack import PLACES, StackTest, goal_message

sys.path.insert(0, str(SOURCE / "src" / "goshawk_bringup" / "scripts"))
import topic_rights  # noqa: E402

PROFILE = "FASTRTPS_DEFAULT_PROFILES_FILE"
LEASE_S = 3.0  # goshawk_runtime, context.cpp
NODES = {**{name: name for name in topic_rights.STAGES
            if name not in ("vehicle", "visualizer", "sensors", "guard", "movers",
                            "obstacle_tracker")}, "simulator": "vehicle"}
# Opened only if they are needed: the map before a landing, the truth beside a sensor's error, the
# clouds and images of Goshawk's own sensors.
LATER = {"tracker": set(topic_rights.MAP), "vehicle": {*topic_rights.MAP, "odom_true"},
         "map_server": {"points", "depth/image_rect_raw", "depth/camera_info"},
         "navigator": {"bench/unheard_requests"}}


class SecuredStages(StackTest):
    """The table of rights against a stack that has none."""

    launch_file = "flight_mission"

    def info_of(self, topic):
        """Asked until it is answered: on a busy machine discovery takes longer than a call waits."""
        def asked():
            outcome = self.sandbox.goshawk("topic", "info", topic, "--json", timeout_s=40)
            return json.loads(outcome.out) if outcome.status == 0 else None
        info = until(asked, 20.0)
        self.assertIsNotNone(info, topic)
        return info

    def ends(self):
        """node: (topics that it reads, topics that it writes), as discovery tells"""
        listed = json.loads(self.sandbox.goshawk("topic", "list", "--json").out)
        found = {}
        for topic in (t["name"] for t in listed["topics"]):
            info = self.info_of(topic)
            for kind, at in (("subscribers", 0), ("publishers", 1)):
                for end in info[kind]:
                    for node in end["nodes"]:
                        found.setdefault(node.lstrip("/"), (set(), set()))[at].add(topic)
        return found

    def test_each_stage_opens_what_it_has_a_right_to_and_no_more(self):
        table = topic_rights.roles()
        def differences():
            ends = self.ends()
            wrong = {}
            for node, role in NODES.items():
                for at, word in enumerate(("reads", "writes")):
                    right = {topic_rights.wire_name(t, "/")[2:] for t in table[role][at]}
                    later = {topic_rights.wire_name(t, "/")[2:] for t in LATER.get(role, ())}
                    opened = ends.get(node, (set(), set()))[at]
                    if opened - right or right - opened - later:
                        wrong[f"{node} {word}"] = (sorted(opened - right), sorted(right - opened))
            return wrong
        # On a busy machine discovery takes longer than a call waits.
        until(lambda: not differences(), 20.0, 1.0)
        self.assertEqual(differences(), {}, "(opened without a right, right that is not used)")


class SecuredFlight(StackTest):
    @classmethod
    def launch_options(cls):
        cls.keys, cls.others = (cls.make_keys(name) for name in ("keys", "others"))
        # What the test itself says and reads is the operator's.
        cls.sandbox.env[PROFILE] = str(cls.keys / "operator" / "profile.xml")
        return ["--secure", cls.keys]

    @classmethod
    def make_keys(cls, name):
        folder = cls.sandbox.folder / name
        made = cls.sandbox.goshawk("secure", "init", folder, "--json")
        if made.status != 0:
            raise AssertionError(str(made))
        return folder

    def test_1_a_secured_flight_reaches_its_goals(self):
        self.fly()

    def outsiders(self):
        yield "without a certificate", {PROFILE: ""}
        yield "of a foreign authority", {PROFILE: str(self.others / "operator" / "profile.xml")}

    def call_as(self, env, *arguments):
        env = {**self.sandbox.env, **env}
        if not env[PROFILE]:
            del env[PROFILE]
        before, self.sandbox.env = self.sandbox.env, env
        try:
            return self.sandbox.goshawk(*arguments, timeout_s=40)
        finally:
            type(self).sandbox.env = before

    def test_2_outsiders_see_and_deliver_nothing(self):
        for who, env in self.outsiders():
            with self.subTest(who):
                listed = self.call_as(env, "topic", "list", "--json", "--timeout", "5")
                self.assert_civil(listed)
                self.assertNotIn("committed_trajectory", listed.out)
                told = self.call_as(env, "topic", "pub", "goal_pose",
                                    "geometry_msgs/msg/PoseStamped",
                                    json.dumps(goal_message(PLACES[0])), "--once", "--timeout", "5")
                self.assertEqual(told.status, 1, str(told))
                self.assertIn("nobody reads /goal_pose", told.err)

    def test_3_a_member_writes_only_what_it_may(self):
        commit = ("committed_trajectory", "goshawk_msgs/msg/CommittedTrajectory")
        for role, (topic, kind) in (("viewer", commit), ("recorder", commit), ("operator", commit),
                                    ("path_search", ("command", "goshawk_msgs/msg/AttitudeSetpoint")),
                                    ("recorder", ("goal_pose", "geometry_msgs/msg/PoseStamped"))):
            with self.subTest(f"{role} {topic}"):
                told = self.call_as({PROFILE: str(self.keys / role / "profile.xml")}, "topic",
                                    "pub", topic, kind, "{}", "--once", "--timeout", "5")
                self.assert_civil(told)
                self.assertNotEqual(told.status, 0, str(told))
                self.assertIn("permissions", told.err)

    def test_4_a_member_reads_only_what_it_may(self):
        told = self.call_as({PROFILE: str(self.keys / "path_search" / "profile.xml")}, "topic",
                            "echo", "committed_trajectory", "--once", "--timeout", "5")
        self.assert_civil(told)
        self.assertNotEqual(told.status, 0, str(told))

    def test_5_the_operator_sets_parameters(self):
        told = self.sandbox.goshawk("param", "set", "navigator", "v_max_m_s", "1.5", "--json",
                                    "--timeout", "60", timeout_s=40)
        self.assertEqual(told.status, 0, str(told))

    def arrives(self, place):
        """Sent again until it arrives: on a busy machine handshakes may take longer than the
        navigator waits. A stage that stays deaf never flies."""
        def arrived():
            state = self.stack.fly_to(place)
            return state is not None and state["state"] == "arrived"
        return until(arrived, 120.0)

    def test_6_a_stage_that_was_killed_is_heard_again(self):
        for stage, place in (("corridor_builder", PLACES[0]), ("tracker", PLACES[1])):
            with self.subTest(stage):
                os.kill(self.stack.launch.pids()[stage], signal.SIGKILL)
                log = self.stack.launch.logs / f"{stage}.log"
                ready = until(
                    lambda f=log: f.read_text(errors="replace").count("ready: ") > 1, 30.0)
                self.assertTrue(ready, self.stack.launch.tails())
                self.assertTrue(self.arrives(place), self.stack.launch.tails())

    def test_7_a_stage_that_was_silent_for_longer_than_its_lease_is_heard_again(self):
        """The others have forgotten it and its keys, it has forgotten nothing."""
        for stage, place in (("path_search", PLACES[0]), ("navigator", PLACES[1])):
            with self.subTest(stage):
                pid = self.stack.launch.pids()[stage]
                os.kill(pid, signal.SIGSTOP)
                try:
                    time.sleep(LEASE_S + 1.0)
                finally:
                    os.kill(pid, signal.SIGCONT)
                self.assertTrue(self.arrives(place), self.stack.launch.tails())

    def test_8_nothing_was_touched(self):
        self.check_untouched()


class SecuredBench(SystemTest):
    def test_plans_are_timed_with_and_without_security(self):
        keys = self.sandbox.folder / "keys"
        made = self.sandbox.goshawk("secure", "init", keys, "--json")
        self.assertEqual(made.status, 0, str(made))
        told = self.sandbox.goshawk("bench", "plan", "--secure", keys, "-n", "3", "--json",
                                    timeout_s=120, env={"ROS_DOMAIN_ID": ""})
        self.assertEqual(told.status, 0, str(told))
        result = json.loads(told.out)
        for times in (result, result["secured"]):
            self.assertEqual(times["plans"], 3)
            self.assertGreater(times["total"]["p50_us"], 0.0)
            self.assertGreater(times["processor_share"], 0.0)

    def test_a_folder_without_the_certificate_is_refused_by_name(self):
        told = self.sandbox.goshawk("bench", "plan", "--secure", self.sandbox.folder, "--json")
        self.assertEqual(told.status, 1, str(told))
        self.assertIn("benchmark/profile.xml is missing", json.loads(told.out)["message"])


if __name__ == "__main__":
    harness.main()
