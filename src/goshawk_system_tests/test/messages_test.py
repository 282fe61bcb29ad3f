#!/usr/bin/python3
"""Bad messages to live stages, and the tools that look at them."""

import copy
import json
import os
import time

import harness
import second_opinion
from harness import GOSHAWK, STAGES, node_of, note, until
from stack import StackTest, goal_message, position_of

PLACES = [(3.0, 0.0, 1.0), (3.0, 8.0, 2.0)]


def point(x, y, z):
    return {"x": x, "y": y, "z": z}


def request(number, **changes):
    return {"header": {"frame_id": "map"}, "id": number,
            "start": {"position": point(*PLACES[0])}, "goal": {"position": point(*PLACES[1])},
            "limits": {"v_max": 2.0, "a_max": 2.0}, **changes}


def fed(*inputs):
    """Remappings by which stages read what the test says, and nobody else: "node:topic"."""
    return [word for given in inputs
            for word in ("-r", f"{given}:=fed/{given.split(':')[1]}")]


class BadMessageCase(StackTest):
    """Each is answered with a code and a sentence; every process lives on."""

    def setUp(self):
        self.pids = self.stack.launch.pids()
        self.number = int(time.time() * 1000) % 10**9 + 5  # far from the navigator's own

    def tearDown(self):
        self.assertEqual(self.stack.launch.pids(), self.pids, "a stage was restarted\n" +
                         self.stack.launch.tails())
        for stage, pid in self.pids.items():
            self.assertTrue(os.path.exists(f"/proc/{pid}"), stage)

    def expect_report(self, topic, kind, message, stage, code, *words):
        since = len(self.stack.reports.lines())
        self.stack.tell("fed/" + topic, kind, message)
        report = until(lambda: next((r for r in self.stack.reports.lines()[since:]
                                     if node_of(r) == stage and r["code"] != "ok"), None), 5.0)
        self.assertIsNotNone(report, f"{stage} said nothing to {json.dumps(message)[:300]}: "
                                     f"{self.stack.reports.lines()[since:]}")
        self.assertEqual(report["code"], code, report)
        for word in words:
            self.assertIn(word, report["message"])
        return report


class BadGoals(BadMessageCase):
    def expect_state(self, goal, code, frame="map"):
        since = len(self.stack.states.lines())
        self.stack.send_goal(goal, frame)
        state = self.stack.wait_state({"failed", "arrived"}, since, 15.0)
        self.assertIsNotNone(state, f"no answer to goal {goal}")
        self.assertEqual((state["state"], state["code"]), ("failed", code), state)
        self.assertTrue(state["message"])

    def test_1_goals(self):
        with self.subTest("wrong frame"):
            self.expect_state((3, 8, 2), "wrong_frame", frame="odom")
        with self.subTest("no frame"):
            self.expect_state((3, 8, 2), "wrong_frame", frame="")
        with self.subTest("NaN"):
            self.expect_state(("nan", 8, 2), "invalid_input")
        with self.subTest("infinite"):
            self.expect_state((3, "-inf", 2), "invalid_input")
        with self.subTest("outside"):
            self.expect_state((100, 0, 0), "goal_outside")
        with self.subTest("in an obstacle"):
            cubes = second_opinion.OccupiedCubes(self.stack.world)
            cube = sorted(cubes.cubes)[len(cubes.cubes) // 2]
            self.expect_state([(k - 32767.5) * cubes.resolution for k in cube], "goal_occupied")

    def test_2_a_good_goal_is_flown_afterwards(self):
        state = self.stack.fly_to((3.5, 6.1, 1.1))
        self.assertIsNotNone(state)
        self.assertEqual(state["state"], "arrived", state)
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track(), 0.02)
        self.assertGreater(clearance, harness.BODY_RADIUS_M)


class BadMessages(BadMessageCase):
    ros_args = fed("path_search:plan_request", "corridor_builder:path",
                   "trajectory_optimizer:corridor", "navigator:trajectory",
                   "tracker:committed_trajectory", "tracker:navigator_alive")

    def test_2_requests(self):
        kind = "goshawk_msgs/msg/PlanRequest"
        for name, changes, code in [
                ("zero speed", {"limits": {"v_max": 0.0, "a_max": 2.0}}, "invalid_limits"),
                ("negative", {"limits": {"v_max": 2.0, "a_max": -2.0}}, "invalid_limits"),
                ("NaN limit", {"limits": {"v_max": "nan", "a_max": 2.0}}, "invalid_limits"),
                ("norm", {"limits": {"v_max": 2.0, "a_max": 2.0, "norm": 7}}, "invalid_limits"),
                ("frame", {"header": {"frame_id": "world"}}, "wrong_frame"),
                ("NaN start", {"start": {"position": point("nan", 0, 1)}}, "invalid_input"),
                ("NaN speed", {"start": {"position": point(3, 0, 1),
                                         "velocity": point(0, "inf", 0)}}, "invalid_input"),
                ("outside", {"goal": {"position": point(1e12, 0, 1)}}, "goal_outside"),
                ("start outside", {"start": {"position": point(0, -50, 1)}}, "start_outside"),
                ("deadline", {"deadline": 1e-9}, "deadline_exceeded"),
                ("NaN deadline", {"deadline": "nan"}, "invalid_input")]:
            with self.subTest(name):
                report = self.expect_report("plan_request", kind, request(self.number, **changes),
                                            "path_search", code)
                self.assertEqual(report["request_id"], self.number)

    def test_3_paths(self):
        kind = "goshawk_msgs/msg/Path"
        good = {"header": {"frame_id": "map"}, "request": request(self.number),
                "map_version": 1, "waypoints": [point(*PLACES[0]), point(*PLACES[1])]}
        for name, changes, code in [
                ("one waypoint", {"waypoints": [point(3, 0, 1)]}, "invalid_input"),
                ("none", {"waypoints": []}, "invalid_input"),
                ("NaN", {"waypoints": [point(3, 0, 1), point(3, "nan", 1)]}, "invalid_input"),
                ("frame", {"header": {"frame_id": "odom"}}, "wrong_frame"),
                ("newer map", {"map_version": 10**6}, "no_map"),
                ("outside", {"waypoints": [point(3, 0, 1), point(300, 0, 1)]}, "segment_blocked"),
                ("through a wall", {}, "segment_blocked"),
                ("its request", {"request": request(self.number, limits={"v_max": 0.0})},
                 "invalid_limits")]:
            with self.subTest(name):
                self.expect_report("path", kind, {**good, **changes}, "corridor_builder", code)

    def box(self, low, high):
        normals = [1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1]
        return {"normals": [float(n) for n in normals],
                "offsets": [high[0], -low[0], high[1], -low[1], high[2], -low[2]]}

    def test_4_corridors(self):
        kind = "goshawk_msgs/msg/Corridor"
        room = self.box((0, -1, 0), (6, 9, 4))
        good = {"header": {"frame_id": "map"}, "request": request(self.number), "map_version": 1,
                "waypoints": [point(*PLACES[0]), point(*PLACES[1])], "polytopes": [room]}
        short = {**room, "normals": room["normals"][:-1]}
        for name, changes, code in [
                ("normals too short", {"polytopes": [short]}, "invalid_input"),
                ("polytopes missing", {"polytopes": []}, "invalid_input"),
                ("too many", {"polytopes": [room, room, room]}, "invalid_input"),
                ("NaN", {"polytopes": [{**room, "offsets": ["nan"] * 6}]}, "invalid_input"),
                ("no unit normals", {"polytopes": [{**room, "normals": [2.0] * 18}]},
                 "invalid_input"),
                ("frame", {"header": {"frame_id": "base_link"}}, "wrong_frame")]:
            with self.subTest(name):
                self.expect_report("corridor", kind, {**good, **changes}, "trajectory_optimizer",
                                   code)

    def test_5_trajectories(self):
        piece = {"duration": 1.0, "polytope": 0,
                 "control_points": [point(3.0, 0.0 + 1.6 * k, 1.0 + 0.2 * k) for k in range(6)]}
        good = {"header": {"frame_id": "map"}, "request": request(self.number), "map_version": 1,
                "pieces": [piece], "polytopes": [self.box((0, -1, 0), (6, 9, 4))],
                # It says that it holds: that is not believed.
                "certificate": {}}
        nan_piece = copy.deepcopy(piece)
        nan_piece["control_points"][2]["x"] = "nan"
        for name, changes, code in [
                ("much too fast", {}, "not_certified"),
                ("NaN", {"pieces": [nan_piece]}, "invalid_input"),
                ("no polytope of that number", {"pieces": [{**piece, "polytope": 9}]},
                 "invalid_input"),
                ("no time", {"pieces": [{**piece, "duration": 0.0}]}, "invalid_input"),
                ("nothing", {"pieces": []}, "invalid_input"),
                ("frame", {"header": {"frame_id": "x"}}, "wrong_frame")]:
            message = {**good, **changes}
            with self.subTest(f"{name}, to the navigator"):
                self.expect_report("trajectory", "goshawk_msgs/msg/BezierTrajectory", message,
                                   "navigator", code)
            with self.subTest(f"{name}, to the tracker"):
                self.expect_report("committed_trajectory",
                                   "goshawk_msgs/msg/CommittedTrajectory",
                                   {"header": {"frame_id": "map"}, "nominal": message},
                                   "tracker", code)


class BadOdometry(BadMessageCase):
    # The plant takes both from one writer.
    ros_args = fed("tracker:odom", "simulator:command", "simulator:fallback_stop")

    def expect_complaint(self, topic, kind, message, stage, code, word):
        """Said again until it is answered: the reader is best effort, and hears nothing before it has
        found the writer; a stage complains once a second."""
        since = len(self.stack.reports.lines())
        def told():
            self.stack.tell("fed/" + topic, kind, message)
            return until(lambda: [r for r in self.stack.reports.lines()[since:]
                                  if (node_of(r), r["code"]) == (stage, code) and word in r["message"]],
                         0.3)
        self.assertTrue(until(told, 15.0), f"{stage} did not complain: "
                                           f"{self.stack.reports.lines()[since:]}")

    def test_6_odometry_and_commands(self):
        odometry = {"header": {"frame_id": "map"}, "child_frame_id": "base_link",
                    "pose": {"pose": {"position": point("nan", 0, 1), "orientation": {"w": 1.0}}}}
        self.expect_complaint("odom", "nav_msgs/msg/Odometry", odometry, "tracker",
                              "invalid_input", "not finite")
        self.expect_complaint("odom", "nav_msgs/msg/Odometry",
                              {**odometry, "header": {"frame_id": "odom"}}, "tracker",
                              "wrong_frame", "odom")
        command = {"header": {"frame_id": "map"}, "thrust": -5.0, "orientation": {"w": 1.0}}
        self.expect_complaint("command", "goshawk_msgs/msg/AttitudeSetpoint", command, "simulator",
                              "invalid_input", "thrust")


class Tools(StackTest):
    """`goshawk topic`, `node` and `param` on live stages."""

    def ask(self, *arguments):
        outcome = self.sandbox.goshawk(*arguments, "--json", timeout_s=40)
        self.assertEqual(outcome.status, 0, str(outcome))
        return [json.loads(line) for line in outcome.out.splitlines()]

    def ask_until(self, holds, *arguments):
        """Asks again until it holds: on a busy machine discovery takes longer than a call waits."""
        answers = []
        def asked():
            answers.append(self.ask(*arguments)[0])
            return holds(answers[-1])
        until(asked, 10.0)
        return answers[-1]

    def test_node_list(self):
        wanted = {f"/{stage}" for stage in STAGES}
        answer = self.ask_until(lambda a: wanted <= {n["name"] for n in a["nodes"]},
                                "node", "list")
        self.assertEqual(answer["domain"], self.sandbox.domain.number)
        nodes = {n["name"]: n["process"] for n in answer["nodes"]}
        self.assertLessEqual(wanted, set(nodes))
        for stage, pid in self.stack.launch.pids().items():
            self.assertIn(str(pid), str(nodes[f"/{stage}"]))

    def test_topic_list_and_info(self):
        answer = self.ask_until(lambda a: len(STAGES) in [
            t["publishers"] for t in a["topics"] if t["name"] == "/stage_report"], "topic", "list")
        topics = {t["name"]: t for t in answer["topics"]}
        for name, kind in [("/odom", "nav_msgs/msg/Odometry"),
                           ("/map/voxels", "goshawk_msgs/msg/VoxelGrid"),
                           ("/stage_report", "goshawk_msgs/msg/StageReport"),
                           ("/goal_pose", "geometry_msgs/msg/PoseStamped")]:
            self.assertEqual(topics[name]["types"], [kind])
        self.assertEqual(topics["/stage_report"]["publishers"], len(STAGES))
        info = self.ask_until(lambda a: len(a["publishers"]) and len(a["subscribers"]) > 1,
                              "topic", "info", "map/voxels")
        self.assertEqual([p["nodes"] for p in info["publishers"]], [["/map_server"]])
        self.assertEqual(info["publishers"][0]["durability"], "transient_local")
        readers = {n for s in info["subscribers"] for n in s["nodes"]}
        self.assertLessEqual({"/path_search", "/corridor_builder"}, readers)

    def test_hz_of_odometry(self):
        report = self.ask("topic", "hz", "odom", "--window", "500", "-n", "500")[-1]
        note(f"odom {report['rate_hz']:.1f} Hz, period {1e3 * report['min_s']:.2f} to "
             f"{1e3 * report['max_s']:.2f} ms")
        self.assertGreater(report["rate_hz"], 100.0)
        self.assertLess(report["rate_hz"], 500.0)

    def test_delay_and_bandwidth(self):
        delay = self.ask("topic", "delay", "odom", "-n", "100")[-1]
        self.assertGreater(delay["mean_s"], 0.0)
        self.assertLess(delay["mean_s"], 5.0)
        bandwidth = self.ask("topic", "bw", "odom", "-n", "100")[-1]
        self.assertGreater(bandwidth["mean_bytes"], 600)
        self.assertGreater(bandwidth["bytes_per_s"], 100_000)

    def test_echo(self):
        odometry = self.ask("topic", "echo", "odom", "--once")[0]
        self.assertEqual(odometry["header"]["frame_id"], "map")
        for reached, wanted in zip(position_of(odometry), PLACES[0]):
            self.assertAlmostEqual(reached, wanted, delta=0.05)
        grid = self.ask("topic", "echo", "map/voxels", "--once", "--no-arr")[0]
        self.assertEqual((grid["size_x"], grid["size_y"], grid["size_z"]), (30, 44, 20))
        self.assertAlmostEqual(grid["inflation"], 0.2)

    def test_pub(self):
        unread = self.sandbox.goshawk("topic", "pub", "some/topic", "geometry_msgs/msg/Point",
                                      "x: 1.5", "--once", "--timeout", "1")
        self.assertEqual(unread.status, 1, str(unread))
        self.assertIn("nobody reads /some/topic", unread.err)
        reader = self.sandbox.start(GOSHAWK, "topic", "echo", "goal_pose", "--once", "--json",
                                    "--timeout", "60")
        def heard():
            """A reader that had not found the stages yet when it was said hears it next time."""
            told = self.stack.pub("goal_pose", "geometry_msgs/msg/PoseStamped",
                                  goal_message(PLACES[0]))
            return told if reader.wait(0.2) is not None else None
        answer = json.loads(until(heard, 15.0).out.splitlines()[-1])
        self.assertEqual(answer["published"], 1)
        self.assertGreaterEqual(answer["subscribers"], 1)
        self.assertEqual(reader.wait(10.0), 0, str(reader.outcome()))

    def test_param_describe(self):
        for stage in STAGES:
            answer = self.ask("param", "describe", stage)[0]
            self.assertEqual(answer["component"], stage)
            for parameter in answer["parameters"]:
                self.assertEqual(set(parameter),
                                 {"name", "type", "unit", "default", "range", "text",
                                  "at_run_time"})
            self.assertTrue(answer["parameters"])
            self.check_that_the_stage_can_change(stage, answer["parameters"])

    def check_that_the_stage_can_change(self, stage, parameters):
        """What is said to change at run time does: here to the defaults, all at once."""
        wanted = [word for p in parameters if p["at_run_time"]
                  for word in (p["name"], p["default"])]
        if wanted:
            answer = self.ask("param", "set", stage, *wanted, "--timeout", "60")[0]
            self.assertEqual(len(answer["parameters"]), len(wanted) // 2)

    def test_doctor_finds_nothing_wrong_with_a_flight(self):
        answer = self.ask_until(lambda a: all(stage in str(a) for stage in STAGES), "doctor")
        self.assertIs(answer["ok"], True, answer)
        domain = [f for f in answer["findings"] if f["about"].startswith("domain ")]
        for stage in STAGES:
            self.assertIn(stage, domain[0]["message"])
        self.assertEqual({f["level"] for f in answer["findings"]} & {"fault"}, set())

    def test_what_is_not_there(self):
        for arguments in (["topic", "echo", "nothing", "--once"], ["topic", "info", "nothing"],
                          ["topic", "hz", "nothing"]):
            outcome = self.sandbox.goshawk(*arguments, "--timeout", "1", timeout_s=20)
            self.assertIn(outcome.status, (1, 2), str(outcome))
            self.assertIn("nothing", outcome.err)
        outcome = self.sandbox.goshawk("topic", "pub", "goal_pose",
                                       "geometry_msgs/msg/PoseStampd", "{}", "--once",
                                       timeout_s=20)
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("PoseStamped", outcome.err)


if __name__ == "__main__":
    harness.main()
