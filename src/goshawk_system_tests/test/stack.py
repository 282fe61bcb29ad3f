"""A launched flight of the tests: the stages, what they say, and where the vehicle is."""

import json
import os
import pathlib
import re
import unittest
import uuid

import second_opinion
from harness import (BODY_RADIUS_M, GOSHAWK, STAGES, Publisher, Sandbox, SystemTest, node_of, note,
                     until, words)


class Launch:
    """`goshawk launch FILE` with JSON events, and the logs of what it starts."""

    def __init__(self, sandbox, file, *ros_args, env=None, options=()):
        self.sandbox = sandbox
        self.logs = sandbox.folder / f"logs-{uuid.uuid4().hex[:6]}"
        command = [GOSHAWK, "launch", file, "--json", "--log-dir", self.logs, *options]
        if ros_args:
            command += ["--ros-args", *ros_args]
        self.process = sandbox.start(*command, env=env)

    def events(self, event=None, stage=None):
        return [e for e in self.process.lines()
                if event in (None, e["event"]) and stage in (None, e["stage"])]

    def pids(self):
        return spawned(self.logs)

    def tails(self):
        texts = [f"--- {path.name}\n{path.read_text(errors='replace')[-600:]}"
                 for path in sorted(self.logs.glob("*.log"))]
        return "\n".join([self.process.out()[-1500:], self.process.err()[-1500:], *texts])

    def supervisor_log(self):
        return (self.logs / "supervisord.log").read_text(errors="replace")


def spawned(logs):
    """The newest process id of every program, from supervisord's log."""
    try:
        text = (pathlib.Path(logs) / "supervisord.log").read_text(errors="replace")
    except OSError:
        return {}
    return {name: int(pid) for name, pid in re.findall(r"spawned: '([^']+)' with pid (\d+)", text)}


class States:
    """navigator_state as it comes, with its state as a word: "arrived"."""

    WORDS = words("NavigatorState", "state")

    def __init__(self, echo):
        self.echo = echo

    def lines(self):
        return [{**m, "state": self.WORDS[m["state"]]} for m in self.echo.lines()]


class Stack:
    """Every stage launched in a world of its own, with the topics that tell what happens."""

    def __init__(self, sandbox, file="flight", ros_args=(), env=None, options=(),
                 world_parameter="map_server:map_file", world_options=()):
        """@param world_parameter which parameter of which node names the world
        @param world_options more words of `goshawk world`"""
        self.sandbox = sandbox
        self.world = sandbox.folder / "world.bt"
        made = sandbox.goshawk("world", self.world, "--json", *world_options)
        if made.status != 0:
            raise AssertionError(f"the world could not be made: {made}")
        self.launch = Launch(sandbox, file, "-p", f"{world_parameter}:={self.world}", *ros_args,
                             env=env, options=options)
        self.reports = self.echo("stage_report")
        self.states = States(self.echo("navigator_state"))
        self.odom = self.echo("odom", "--no-arr")
        self.publishers = {}

    def echo(self, topic, *options):
        return self.sandbox.start(GOSHAWK, "topic", "echo", topic, "--json", "--timeout", "60",
                                  *options)

    def wait_ready(self, timeout_s=30.0):
        def missing():
            ready = {node_of(r) for r in self.reports.lines()
                     if r["request_id"] == 0 and r["code"] == "ok"}
            return set(STAGES) - ready
        until(lambda: not missing() and self.states.lines() and self.place(), timeout_s)
        if missing() or not self.place():
            raise AssertionError(f"not ready: {missing()}\n{self.launch.tails()}\n"
                                 f"{self.reports.err()}")

    def place(self):
        """Where the vehicle is, by the newest whole line of odometry."""
        with open(self.odom.out_path, "rb") as file:
            file.seek(0, os.SEEK_END)
            file.seek(max(0, file.tell() - 20_000))
            lines = file.read().split(b"\n")[:-1]
        for line in reversed(lines):
            if line.startswith(b"{") and line.endswith(b"}"):
                return position_of(json.loads(line))
        return None

    def pub(self, topic, kind, message):
        result = self.sandbox.goshawk("topic", "pub", topic, kind, json.dumps(message), "--json",
                                      "--timeout", "60", "--once", timeout_s=90)
        if result.status != 0:
            raise AssertionError(f"topic pub: {result}")
        return result

    def tell(self, topic, kind, message):
        """Publishes once, by a publisher that stays: who reads the topic is found only once."""
        if topic not in self.publishers:
            self.publishers[topic] = Publisher(self.sandbox, topic, kind)
        self.publishers[topic].send(message)

    def forget_publisher(self, topic):
        """Who reads the topic has changed: the next message is for those who do so then."""
        if topic in self.publishers:
            self.publishers.pop(topic).process.stop()

    def send_goal(self, goal, frame="map"):
        self.tell("goal_pose", "geometry_msgs/msg/PoseStamped", goal_message(goal, frame))

    def wait_state(self, wanted, since, timeout_s):
        """The first navigator state of these names after `since` states. @return it, or None"""
        return until(lambda: next((s for s in self.states.lines()[since:]
                                   if s["state"] in wanted), None), timeout_s)

    def fly_to(self, goal, timeout_s=40.0):
        since = len(self.states.lines())
        self.send_goal(goal)
        return self.wait_state({"arrived", "failed"}, since, timeout_s)

    def track(self):
        """Where the vehicle was. What a test sent as odometry that is no number is left out."""
        points = [position_of(m) for m in self.odom.lines()]
        return [p for p in points if all(isinstance(x, float) for x in p)]


def position_of(odometry):
    p = odometry["pose"]["pose"]["position"]
    return (p["x"], p["y"], p["z"])


def goal_message(goal, frame="map"):
    x, y, z = goal
    return {"header": {"frame_id": frame},
            "pose": {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}}


# Free places of the default world, far from each other; a flight begins at the last one.
PLACES = [(3.0, 8.0, 2.0), (3.0, 0.0, 1.0)]


class StackTest(unittest.TestCase):
    """Tests of one launched stack that all methods share: what each does, the next must survive."""

    launch_file = "flight"
    ros_args = ()
    world_options = ()  # of the made world

    @classmethod
    def setUpClass(cls):
        cls.sandbox = Sandbox()
        try:
            cls.stack = Stack(cls.sandbox, cls.launch_file, cls.ros_args, cls.launch_env(),
                              cls.launch_options(), world_options=cls.world_options)
            cls.stack.wait_ready()
        except BaseException:
            cls.sandbox.close()
            raise

    @classmethod
    def tearDownClass(cls):
        left = cls.sandbox.close()
        if left:
            raise AssertionError(f"processes outlived the test: {left}")

    @classmethod
    def launch_env(cls):
        """More variables of the stages' environment."""
        return {}

    @classmethod
    def launch_options(cls):
        """More words of the call of `goshawk launch`."""
        return ()

    def fly(self, places=PLACES):
        """Each place is reached, one after the other."""
        for place in places:
            state = self.stack.fly_to(place)
            self.assertIsNotNone(state, "no answer to a goal\n" + self.stack.launch.tails())
            self.assertEqual(state["state"], "arrived", state)

    def check_untouched(self, track=None):
        """@param track where the vehicle was; by default what odometry said"""
        track = self.stack.track() if track is None else track
        clearance = second_opinion.smallest_clearance(self.stack.world, track, 0.02)
        note(f"smallest distance of the centre to an obstacle so far {clearance:.3f} m, over "
             f"{len(track)} states")
        self.assertGreater(clearance, BODY_RADIUS_M)

    json_object = SystemTest.json_object
    assert_civil = SystemTest.assert_civil
