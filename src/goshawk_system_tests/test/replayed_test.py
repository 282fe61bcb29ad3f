#!/usr/bin/python3
"""Stages that are fed from a recording say again what they said."""

import json
import time

import harness
from harness import GOSHAWK, Publisher, node_of, until, words
from recording_case import RecordingCase
from stack import Launch

STATES = words("NavigatorState", "state")
PLANNING = ["map_server", "path_search", "corridor_builder", "trajectory_optimizer"]
INPUTS = {
    "path_search": (["map/voxels", "map/voxels/updates", "plan_request"], "/path"),
    "corridor_builder": (["map/voxels", "map/voxels/updates", "path"], "/corridor"),
    "trajectory_optimizer": (["corridor"], "/trajectory"),
}
GOALS = [(3, 8, 2), (3.5, 6.1, 1.1), (3, 4, 1.5), (0.5, 0.5, 0.5)]


def without_times(value):
    """What a stage may not repeat: when it was published, when the request was asked (moved by
    --restamp), and how long it took."""
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if k not in ("stamp", "compute_ns")}
    if isinstance(value, list):
        return [without_times(v) for v in value]
    return value


class ReplayedStages(RecordingCase):
    """Each planning stage alone, fed from a recording, answers as it did in the recording."""

    def launch(self, stages, name, *ros_args, env=None):
        """@return the launch, once all of its stages are ready, and their reports"""
        file = self.sandbox.folder / f"{name}.yaml"
        file.write_text(json.dumps({"stages": [{"component": s} for s in stages]}))
        reports = self.sandbox.start(GOSHAWK, "topic", "echo", "stage_report", "--json",
                                     "--timeout", "60", env=env)
        launch = Launch(self.sandbox, file, *ros_args, env=env)
        self.assertTrue(until(lambda: {node_of(r) for r in reports.lines()} >= set(stages), 30),
                        launch.tails())
        return launch, reports

    def request(self, number, goal):
        def state(x, y, z):
            return {"position": {"x": x, "y": y, "z": z}}
        now = time.time_ns()
        return {"header": {"frame_id": "map", "stamp": {"sec": now // 10**9,
                                                        "nanosec": now % 10**9}},
                "id": number, "start": state(3.0, 0.0, 1.0), "goal": state(*map(float, goal)),
                "limits": {"v_max": 2.0, "a_max": 2.0}, "deadline": 10.0}

    def test_every_stage_answers_with_the_same_bytes(self):
        file = self.record_plans()
        counts = self.contents(file)["counts"]
        self.assertEqual(counts.get("/plan_request"), len(GOALS), counts)
        for topic in ("/path", "/corridor", "/trajectory"):
            self.assertGreaterEqual(counts[topic], 2, counts)
        # Each in a domain of its own, all at once.
        started = {stage: self.start_stage(file, stage) for stage in INPUTS}
        for stage, (again, process, launch, reports, played) in started.items():
            with self.subTest(stage=stage):
                self.assertEqual(played.wait(60.0), 0, str(played.outcome()))
                wanted = len(answers_of(stage, [m["value"] for m in self.messages(
                    file, "stage_report")]))
                until(lambda: len(answers_of(stage, reports.lines())) >= wanted, 20.0)
                _, output = INPUTS[stage]
                self.wait_recorded(again, {output: len(self.messages(file, output))})
                time.sleep(0.3)  # for one answer too many
                launch.process.stop()
                process.stop()
                self.compare(file, again, stage, launch)

    def wait_recorded(self, file, least):
        """A recorder may be behind, and writes what it has once a second."""
        def written():
            counts = self.counts(file)
            return all(counts.get(topic, 0) >= count for topic, count in least.items())
        until(written, 20.0, 0.5)

    def record_plans(self):
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world, "--json").status, 0)
        file, process = self.record("plans.mcap")
        launch, reports = self.launch(PLANNING, "planning", "-p", f"map_server:map_file:={world}")
        # The search, and the recorder, which begins to read a topic once somebody writes it.
        requests = Publisher(self.sandbox, "plan_request", "goshawk_msgs/msg/PlanRequest", 2)
        for number, goal in enumerate(GOALS, 1):
            requests.send(self.request(number, goal))
        def ends():
            """A request ends with a trajectory, or with the stage that cannot go on."""
            return [r for r in reports.lines() if r["request_id"] != 0 and
                    (r["code"] != "ok" or node_of(r) == "trajectory_optimizer")]
        self.assertTrue(until(lambda: len(ends()) >= len(GOALS), 20.0), launch.tails())
        solved = sum(r["code"] == "ok" for r in ends())
        self.wait_recorded(file, {"/plan_request": len(GOALS), "/trajectory": solved,
                                  "/stage_report": len(reports.lines())})
        requests.process.stop()
        reports.stop()
        launch.process.stop()
        process.stop()
        return file

    def start_stage(self, file, stage):
        """The stage, a recorder of its output, and what it is fed with."""
        inputs, output = INPUTS[stage]
        domain = harness.Domain()
        self.addCleanup(domain.close)
        env = {"ROS_DOMAIN_ID": str(domain.number)}
        again, process = self.record(f"{stage}.mcap", output, env=env)
        launch, reports = self.launch([stage], stage, env=env)
        played = self.sandbox.start(GOSHAWK, "replay", file, "--restamp", "--topics", *inputs,
                                    "--wait", "2", "--json", env=env)
        return again, process, launch, reports, played

    def compare(self, file, again, stage, launch):
        _, output = INPUTS[stage]
        then, now = self.messages(file, output), self.messages(again, output)
        self.assertEqual(len(now), len(then), launch.tails())
        for old, new in zip(then, now):
            self.assertEqual(new["bytes"], old["bytes"])
            self.assertEqual(without_times(new["value"]), without_times(old["value"]))
        harness.note(f"{stage}: {len(now)} answers the same")


def answers_of(stage, reports):
    return [r for r in reports if node_of(r) == stage and r["request_id"] != 0]


PLANT = "simulator"
OUTPUTS = {
    "map_server": ["map/voxels", "map/voxels/updates", "octomap_binary"],
    "path_search": ["path"],
    "corridor_builder": ["corridor"],
    "trajectory_optimizer": ["trajectory"],
    "navigator": ["plan_request", "committed_trajectory", "navigator_state", "navigator_alive"],
    "tracker": ["command", "fallback_stop", "tracking_state"],
    "flight_check": [],  # reports only
    PLANT: ["odom", "odom_true", "vehicle_status", "/tf"],
}
REPORTING = [stage for stage in OUTPUTS if stage not in ("navigator", PLANT)]
MEASURED = ("path", "corridor", "trajectory")  # hold compute_ns, the time that an answer took
ALL_INPUTS = ["goal_pose", "odom", "odom_true", "command", "fallback_stop", "octomap_binary",
              "cloud_in", "map/*", "plan_request", "path", "corridor", "trajectory",
              "stage_report", "committed_trajectory", "tracking_state", "navigator_alive", "vehicle_status"]
RECORDER = "goshawk_record"
FLIGHT_S = 7.5  # of simulated time
WEATHER = {"gust_deviation_m_s": 0.5, "position_noise_m": 0.002, "odometry_delay_s": 0.008}


def again_topic(topic):
    return "again/" + topic.lstrip("/")


def without(value, name):
    if isinstance(value, dict):
        return {k: without(v, name) for k, v in value.items() if k != name}
    if isinstance(value, list):
        return [without(v, name) for v in value]
    return value


class LockStepReplay(RecordingCase):
    """Every stage, fed from the recording of a flight in lock step, says the same bytes again: time
    is what the recorded turns say, and messages come in the turn in which they came."""

    def launch(self, name, stages):
        file = self.sandbox.folder / f"{name}.yaml"
        file.write_text(json.dumps({"container": True, "stages": stages}))
        return Launch(self.sandbox, file)

    def fly(self):
        """@return the recording of a flight of all stages"""
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world, "--json").status, 0)
        file, recorder = self.record("flight.mcap", "--lock-step")
        pilot = self.sandbox.start(harness.PREFIX / "bin" / "goshawk_lock_step_pilot", FLIGHT_S)
        followers = [s for s in OUTPUTS if s != PLANT]
        stages = [{"component": s, "params": {"lock_step": True}} for s in followers]
        stages[0]["params"]["map_file"] = str(world)
        turns = ",".join(["pilot", *followers, RECORDER])
        stages.append({"component": PLANT,
                       "params": {**WEATHER, "lock_step_nodes": turns, "speed": 0.0}})
        launch = self.launch("flight", stages)
        self.assertEqual(pilot.wait(60), 0, launch.tails())
        launch.process.stop()
        self.assertEqual(recorder.stop()[0], 0, str(recorder.outcome()))
        return file

    def replay(self, file):
        """@return the recording of what all stages answer to it, under /again"""
        again, recorder = self.record("again.mcap", "again/*", "--lock-step")
        stages = [{"component": stage, "params": {"lock_step": True},
                   "remap": {topic: again_topic(topic) for topic in outputs}}
                  for stage, outputs in OUTPUTS.items()]
        stages[0]["params"]["map_file"] = str(self.sandbox.folder / "world.bt")
        stages[-1]["params"].update(WEATHER)
        for stage in stages:
            if stage["component"] != "navigator":  # which reads what the others report
                stage["remap"]["stage_report"] = "again/stage_report"
        launch = self.launch("again", stages)
        played = self.sandbox.goshawk("replay", file, "--topics", *ALL_INPUTS, "--json",
                                      "--lock-step", *(s for s in OUTPUTS if s != PLANT),
                                      RECORDER, "--plant", PLANT)
        self.assertEqual(played.status, 0, f"{played}\n{launch.tails()}")
        launch.process.stop()
        self.assertEqual(recorder.stop()[0], 0, str(recorder.outcome()))
        return again

    def test_every_stage_says_the_same_bytes(self):
        file = self.fly()
        again = self.replay(file)
        counts = self.contents(file)["counts"]
        states = [STATES[m["value"]["state"]] for m in self.messages(file, "navigator_state")]
        self.assertIn("flying", states)
        self.assertGreater(counts["/odom"], 1500)
        for stage, topics in OUTPUTS.items():
            for topic in topics:
                with self.subTest(stage=stage, topic=topic):
                    self.compare(file, again, topic)
        self.compare_reports(file, again)

    def compare_reports(self, file, again):
        then, now = ([m["value"] for m in self.messages(f, t)]
                     for f, t in ((file, "stage_report"), (again, "again/stage_report")))
        for stage in REPORTING:
            with self.subTest(stage=stage, topic="stage_report"):
                old, new = ([(r["header"]["stamp"], r["request_id"], r["code"], r["message"])
                             for r in reports if node_of(r) == stage] for reports in (then, now))
                harness.note(f"{stage}: {len(old)} reports, again {len(new)}")
                self.assertGreater(len(new), 0)
                self.assertLessEqual(abs(len(new) - len(old)), 1)
                for pair in zip(new, old):
                    self.assertEqual(*pair)

    def compare(self, file, again, topic):
        then, now = self.messages(file, topic), self.messages(again, again_topic(topic))
        harness.note(f"{topic}: {len(then)} messages, again {len(now)}")
        # The world stands still wherever in a step the pilot left it.
        self.assertLessEqual(abs(len(now) - len(then)), 2)
        self.assertGreater(len(now), 0)
        then = then[first_of(now, then):]
        for k, (old, new) in enumerate(zip(then, now)):
            if topic in MEASURED:
                old, new = (without(m, "compute_ns")["value"] for m in (old, new))
                self.assertEqual(new, old, f"message {k}")
            else:
                self.assertEqual((new["bytes"], new["crc32"]), (old["bytes"], old["crc32"]),
                                 f"message {k}: {first_difference(old['value'], new['value'])}")


def first_of(now, then):
    """Where in `then` what is recorded again begins: a recorder may be found a message too late."""
    values = [without(m["value"], "compute_ns") for m in then[:3]]
    first = without(now[0]["value"], "compute_ns")
    return values.index(first) if first in values else 0


def first_difference(old, new, path=""):
    if isinstance(old, dict) and isinstance(new, dict):
        pairs = [(f"{path}.{k}", old[k], new.get(k)) for k in old]
    elif isinstance(old, list) and isinstance(new, list) and len(old) == len(new):
        pairs = [(f"{path}[{i}]", *both) for i, both in enumerate(zip(old, new))]
    else:
        return None if old == new else f"{path} was {str(old)[:200]}, is {str(new)[:200]}"
    return next(filter(None, (first_difference(a, b, p) for p, a, b in pairs)), None)


if __name__ == "__main__":
    harness.main()
