#!/usr/bin/python3
"""Each topic that steers a flight is heard from one process: a second one is refused and named."""

import os
import signal

import harness
from harness import Publisher, node_of, until
from stack import StackTest

# topic: type, what its writer is called, who must refuse a second one
GUARDED = {
    "map/voxels": ("goshawk_msgs/msg/VoxelGrid", "map_server",
                   {"path_search", "corridor_builder", "navigator", "tracker"}),
    "map/voxels/updates": ("goshawk_msgs/msg/VoxelGridUpdate", "map_server",
                           {"path_search", "corridor_builder", "navigator", "tracker"}),
    "octomap_binary": ("octomap_msgs/msg/Octomap", "map_server", {"flight_check"}),
    "plan_request": ("goshawk_msgs/msg/PlanRequest", "navigator",
                     {"path_search", "corridor_builder", "trajectory_optimizer"}),
    "path": ("goshawk_msgs/msg/Path", "path_search", {"corridor_builder"}),
    "corridor": ("goshawk_msgs/msg/Corridor", "corridor_builder", {"trajectory_optimizer"}),
    "trajectory": ("goshawk_msgs/msg/BezierTrajectory", "trajectory_optimizer", {"navigator"}),
    "committed_trajectory": ("goshawk_msgs/msg/CommittedTrajectory", "navigator",
                             {"tracker", "flight_check"}),
    "navigator_alive": ("goshawk_msgs/msg/NavigatorState", "navigator", {"tracker"}),
    "odom": ("nav_msgs/msg/Odometry", "simulator",
             {"tracker", "navigator", "map_server", "flight_check"}),
    "command": ("goshawk_msgs/msg/AttitudeSetpoint", "tracker", {"simulator"}),
    "fallback_stop": ("goshawk_msgs/msg/FallbackStop", "tracker", {"simulator"}),
    "tracking_state": ("goshawk_msgs/msg/TrackingState", "tracker", {"navigator"}),
    "vehicle_status": ("goshawk_msgs/msg/VehicleStatus", "simulator", {"flight_check", "tracker"}),
    "stage_report": ("goshawk_msgs/msg/StageReport", "path_search", {"navigator"}),
}
# What a report says of itself decides whose it should be.
CONTENT = {"stage_report": {"stage": "STAGE_PATH_SEARCH", "node": "/path_search"}}


class SecondWriters(StackTest):
    strangers = {}  # by topic: they live on through all tests

    def refusals(self, topic, stranger):
        """Who has refused it, with the newest sentence of each."""
        return {node_of(r): r["message"] for r in self.stack.reports.lines()
                if r["code"] == "second_writer" and r["message"].startswith(f"/{topic} ")
                and f"what process {stranger.process.pid} " in r["message"]}

    def test_1_a_second_writer_of_each_topic_is_refused_and_named(self):
        pids = self.stack.launch.pids()
        for topic, (kind, writer, readers) in GUARDED.items():
            with self.subTest(topic):
                # It waits for all readers of its kind before it speaks.
                stranger = Publisher(self.sandbox, topic, kind, len(readers))
                self.strangers[topic] = stranger
                def refused(topic=topic, stranger=stranger, readers=readers):
                    stranger.send(CONTENT.get(topic, {}))
                    return readers <= set(self.refusals(topic, stranger))
                until(refused, 10.0, 0.2)
                told = self.refusals(topic, stranger)
                self.assertEqual(readers - set(told), set(), f"{told}\n{self.stack.launch.tails()}")
                for sentence in told.values():
                    self.assertIn(f"is written by /{writer} (process {pids[writer]}", sentence)

    def test_2_a_flight_beside_them_reaches_its_goals(self):
        self.fly()

    def test_3_a_stage_that_is_started_again_is_heard(self):
        """The first goal that it is sent is flown."""
        for stage in ("tracker", "navigator", "map_server"):
            with self.subTest(stage):
                before = self.stack.launch.pids()[stage]
                os.kill(before, signal.SIGKILL)
                again = until(lambda s=stage, b=before: self.stack.launch.pids()[s] != b and
                              self.stack.launch.pids()[s], 30.0)
                self.assertTrue(again, self.stack.launch.tails())
                log = self.stack.launch.logs / f"{stage}.log"
                ready = until(lambda f=log: f.read_text(errors="replace").count("ready: ") > 1, 30.0)
                self.assertTrue(ready, self.stack.launch.tails())
                self.stack.forget_publisher("goal_pose")
                self.fly()
                heard = [r["message"] for r in self.stack.reports.lines()
                         if r["code"] == "second_writer" and f"what /{stage} (process {again}"
                         in r["message"]]
                self.assertEqual(heard, [])

    def test_4_nothing_was_touched(self):
        self.check_untouched()


if __name__ == "__main__":
    harness.main()
