#!/usr/bin/python3
"""Recordings of a live stack, what is left of them when things go wrong, and what is played back."""

import json
import os
import signal
import time

import harness
from harness import GOSHAWK, until
from recording_case import RecordingCase


class Recording(RecordingCase):
    """Without a stack: what is written by `goshawk topic pub` is in the file."""

    def test_topics_that_come_later_are_joined_and_all_is_there(self):
        file, process = self.record("a.mcap")
        first = self.pub("first", "std_msgs/msg/String", {"data": "one"}, "-r", "50", "-n", "60")
        self.assertEqual(first.wait(20), 0, str(first.outcome()))
        second = self.pub("uav1/second", "geometry_msgs/msg/Point", {"x": 2.5}, "-n", "3", "-r",
                          "20")
        self.assertEqual(second.wait(20), 0, str(second.outcome()))
        status, _ = process.stop()
        self.assertEqual(status, 0)
        end = json.loads(process.out())
        listed = self.contents(file)
        self.assertTrue(listed["whole"], listed)
        self.assertEqual(listed["counts"], {"/first": 60, "/uav1/second": 3})
        self.assertEqual((end["messages"], end["lost"]), (63, 0))
        self.assertEqual(end["bytes"], file.stat().st_size)
        values = [m["value"] for m in self.messages(file, "first")]
        self.assertEqual(values, [{"data": "one"}] * 60)
        self.assertEqual([t["durability"] for t in listed["topics"]], ["transient_local"] * 2)

    def test_kill_nine_costs_only_what_came_since_the_last_flush(self):
        file, process = self.record("b.mcap")
        writer = self.pub("count", "std_msgs/msg/String", {"data": "x" * 100}, "-r", "100")
        # Far from filling a chunk, the file grows by what came, once a second.
        for _ in range(4):
            size = file.stat().st_size
            self.assertTrue(until(lambda: file.stat().st_size > size, 10), str(process.outcome()))
        before = self.contents(file)["messages"]
        process.stop(signal.SIGKILL)
        killed = time.time()
        writer.stop()
        listed = self.contents(file)
        self.assertFalse(listed["whole"])
        self.assertIn("is cut off", listed["complaints"][0])
        last = self.messages(file, "count")[-1]["log_time_s"]
        harness.note(f"kill -9 cost {killed - last:.2f} s, {listed['messages']} messages are left")
        self.assertGreaterEqual(listed["messages"], before)
        self.assertGreater(before, 0)
        self.assertLess(file.stat().st_size, 1 << 20)

    def test_a_file_that_may_grow_no_more_stays_readable(self):
        self.check_record_stops("/bin/bash", "-c", 'ulimit -f 64; exec "$0" record -o c.mcap --json',
                                GOSHAWK)

    def test_a_full_disk_ends_a_recording_that_stays_readable(self):
        own_disk = ["unshare", "--map-root-user", "--mount", "/bin/sh", "-c"]
        mount = "mkdir disk && mount -t tmpfs -o size=200k none disk"
        if self.sandbox.call(*own_disk, f"{mount}; status=$?; exit $status").status != 0:
            self.skipTest("no disk of our own may be mounted here (unshare, tmpfs)")
        (self.sandbox.folder / "disk").rmdir()
        # What is left on it is looked at from outside.
        self.check_record_stops(*own_disk, f'{mount}; "$0" record -o disk/c.mcap --json; '
                                'status=$?; cp disk/c.mcap .; exit $status', GOSHAWK)

    def check_record_stops(self, *command):
        file = self.sandbox.folder / "c.mcap"
        process = self.sandbox.start(*command)
        until(lambda: "recording to" in process.err(), 10)
        # Noise does not pack: each second's chunk is 20 KB of it.
        noise = [byte - 128 for byte in os.urandom(20000)]
        writer = self.pub("noise", "octomap_msgs/msg/Octomap", {"data": noise}, "-r", "20")
        status = process.wait(60)
        writer.stop()
        self.assertEqual(status, 1, str(process.outcome()))
        end = json.loads(process.out())
        self.assertEqual(end["code"], "io_failed")
        self.assertIn("c.mcap", end["message"])
        self.assertGreater(end["lost"], 0)
        listed = self.contents(file)
        self.assertEqual(listed["messages"], end["messages"])

    def test_wrong_calls_are_sentences(self):
        cases = [(["record", "-o", "/nonexistent/a.mcap"], 1, "/nonexistent/a.mcap"),
                 (["record", "no such topic"], 2, "no such topic"),
                 (["record", "--duration", "-1"], 2, "duration"),
                 (["replay", "/nonexistent.mcap"], 1, "/nonexistent.mcap"),
                 (["replay", "/etc/passwd"], 1, "not an MCAP"),
                 (["replay", "x.mcap", "--rate", "0"], 2, "rate")]
        for words, status, word in cases:
            with self.subTest(words=words):
                outcome = self.sandbox.goshawk(*words, timeout_s=20)
                self.assert_civil(outcome)
                self.assertEqual(outcome.status, status, str(outcome))
                self.assertIn(word, outcome.err + outcome.out)
        existing = self.sandbox.folder / "mine.mcap"
        existing.write_bytes(b"precious")
        outcome = self.sandbox.goshawk("record", "-o", existing)
        self.assertEqual(outcome.status, 1)
        self.assertEqual(existing.read_bytes(), b"precious")


class Replay(RecordingCase):
    """Of one recording, which the first test makes."""

    recorded = None

    def setUp(self):
        super().setUp()
        if Replay.recorded is None:
            Replay.recorded = self.make().read_bytes()
        self.file = self.sandbox.folder / "played.mcap"
        self.file.write_bytes(Replay.recorded)

    def make(self):
        file, process = self.record("r.mcap")
        points = [self.pub(f"point{k}", "geometry_msgs/msg/Point", {"x": float(k)}, "-r", "20",
                           "-n", "40") for k in range(2)]
        for point in points:
            self.assertEqual(point.wait(30), 0, str(point.outcome()))
        process.stop()
        return file

    def test_rate_prefix_choice_and_quality_of_service(self):
        again, process = self.record("again.mcap")
        outcome = self.sandbox.goshawk("replay", self.file, "--rate", "4", "--prefix", "/old",
                                       "--topics", "point1", "--clock", "--json")
        self.assertEqual(outcome.status, 0, str(outcome))
        process.stop()
        listed = self.contents(again)
        self.assertEqual(listed["counts"]["/old/point1"], 40)
        self.assertEqual({t["durability"] for t in listed["topics"] if t["name"] != "/clock"},
                         {"transient_local"})
        self.assertNotIn("/old/point0", listed["counts"])
        self.assertGreater(listed["counts"]["/clock"], 5)
        played = self.json_object(outcome)
        was = self.contents(self.file)["duration_s"]
        self.assertEqual(played["published"], 40)
        self.assertLess(played["duration_s"], was)
        self.assertGreater(played["duration_s"], 0.2 * was)

    def test_a_truncated_file_plays_what_is_readable(self):
        whole = self.file.read_bytes()
        cut = self.sandbox.folder / "cut.mcap"
        cut.write_bytes(whole[:len(whole) // 2])
        outcome = self.sandbox.goshawk("replay", cut, "--rate", "10", "--json", "--wait", "0")
        self.assertEqual(outcome.status, 0, str(outcome))
        self.assertIn("is cut off", outcome.err)
        self.assertGreater(self.json_object(outcome)["published"], 0)
        self.assertLess(self.json_object(outcome)["published"], 80)

    def test_no_turns_are_given_that_were_not_recorded(self):
        outcome = self.sandbox.goshawk("replay", self.file, "--lock-step", "tracker")
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("/tracker", outcome.err)
        self.assertIn("not recorded in lock step", outcome.err)

    def test_loop_goes_on_until_it_is_stopped(self):
        heard = self.sandbox.start(GOSHAWK, "topic", "echo", "point1", "--json", "--timeout", "60")
        process = self.sandbox.start(GOSHAWK, "replay", self.file, "--loop", "--rate", "50",
                                     "--json", "--wait", "0")
        until(lambda: len(heard.lines()) > 80 or not process.alive(), 20.0)
        self.assertTrue(process.alive(), str(process.outcome()))
        status, _ = process.stop()
        self.assertEqual(status, 0)
        self.assertGreater(json.loads(process.out())["published"], 160)


if __name__ == "__main__":
    harness.main()
