"""Tests of a campaign's faults: what is drawn, what the shim does to a process, what a report says."""

import argparse
import itertools
import os
import pathlib
import random
import select
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import campaign  # noqa: E402
import campaign_report  # noqa: E402
import fault_control  # noqa: E402
import fault_report  # noqa: E402
import faults  # noqa: E402
from flown_track import Track  # noqa: E402

SHIM = os.environ["GOSHAWK_FAULT_SHIM"]


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


class Draws(unittest.TestCase):
    def take(self, kinds, seed, count=400, live=False):
        return [f.row() | {"after_s": f.after_s}
                for f in itertools.islice(faults.drawn(kinds, seed, live), count)]

    def test_a_seed_gives_the_same_faults_each_time_and_another_seed_others(self):
        self.assertEqual(self.take(faults.KINDS, 5), self.take(faults.KINDS, 5))
        self.assertNotEqual(self.take(faults.KINDS, 5), self.take(faults.KINDS, 6))

    def test_all_kinds_that_are_asked_for_come_and_no_others(self):
        self.assertEqual({f["kind"] for f in self.take(faults.KINDS, 1)}, set(faults.KINDS))
        self.assertEqual({f["kind"] for f in self.take(["clock", "kill"], 1)}, {"clock", "kill"})

    def test_every_stage_is_hit_and_the_vehicle_is_never_killed_nor_stopped_alone(self):
        drawn = self.take(["kill", "stall"], 3)
        self.assertEqual({t for f in drawn if f["kind"] == "kill" for t in f["targets"]},
                         set(faults.STAGES))
        stalls = [f for f in drawn if f["kind"] == "stall"]
        self.assertIn(faults.STAGES, [f["targets"] for f in stalls])
        for f in stalls:
            self.assertTrue(0.05 <= f["duration_s"] <= 10.0)
            if faults.PLANT in f["targets"]:
                self.assertEqual(f["targets"], [*faults.STAGES, faults.PLANT])

    def test_faults_of_the_lidar_come_in_live_flights_alone(self):
        live = self.take(faults.KINDS, 4, 1000, live=True)
        for kind in ("kill", "stall", "clock", "loss", "blind"):
            self.assertIn([faults.LIDAR], [f["targets"] for f in live if f["kind"] == kind], kind)
        text = " ".join(f["what"] for f in live)
        for words in ("lidar is silent", "lidar is covered", *faults.CLOUD_LIES.values()):
            self.assertIn(words, text)
        self.assertNotIn("empty map", text)
        known = self.take(faults.KINDS, 4, 1000)
        self.assertFalse([f for f in known if faults.LIDAR in f["targets"] or "cloud" in f["what"]])


# Says its wall clock, and how long it waits for a deadline 0.5 s ahead on it.
SAY_TIME = """
import ctypes, sys, time
class Timespec(ctypes.Structure):
    _fields_ = [("s", ctypes.c_long), ("ns", ctypes.c_long)]
libc = ctypes.CDLL(None)
semaphore = ctypes.create_string_buffer(64)
libc.sem_init(semaphore, 0, 0)
print("ready", flush=True)
for line in sys.stdin:
    begin = time.monotonic()
    deadline_ns = time.time_ns() + 500_000_000
    libc.sem_timedwait(semaphore, ctypes.byref(Timespec(*divmod(deadline_ns, 10 ** 9))))
    print(time.time(), time.monotonic() - begin, flush=True)
"""

# Prints each datagram that comes; sends one back for each.
ECHO = """
import socket
s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1], flush=True)
while True:
    data, sender = s.recvfrom(100)
    s.sendto(data, sender)
"""


class Shim(Folder):
    def start(self, program, stage="tracker", controlled=True, **more):
        control = fault_control.FaultControl(self.folder, "tracker", seed=7) if controlled else None
        process = subprocess.Popen(
            [sys.executable, "-c", program], text=True, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env={**os.environ, **fault_control.environment(SHIM, self.folder),
                 "SUPERVISOR_PROCESS_NAME": stage, **more})
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stdin.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return control, process, process.stdout.readline().strip()

    def ask(self, process):
        """How far its wall clock is ahead, roughly, and how long it waited."""
        process.stdin.write("\n")
        process.stdin.flush()
        wall, waited = process.stdout.readline().split()
        return float(wall) - time.time(), float(waited)

    def test_a_stage_s_wall_clock_is_stepped_and_its_waits_are_not(self):
        control, process, _ = self.start(SAY_TIME)
        self.assertAlmostEqual(self.ask(process)[0], 0.0, delta=20.0)
        for step_s, offset_s in ((-100.0, -100.0), (200.0, 100.0)):
            control.step_clock(step_s)
            ahead_s, waited_s = self.ask(process)
            self.assertAlmostEqual(ahead_s, offset_s, delta=20.0)
            # By the kernel's clock the deadline would be over, or 100 s ahead.
            self.assertGreater(waited_s, 0.49)
            self.assertLess(waited_s, 60.0)

    def test_a_wall_clock_may_be_wrong_from_the_start_and_be_stepped_as_well(self):
        for controlled, step_s in ((False, 0.0), (True, 200.0)):
            control, process, _ = self.start(SAY_TIME, controlled=controlled,
                                             GOSHAWK_LAB_CLOCK_S="-1000")
            if controlled:
                control.step_clock(step_s)
            ahead_s, waited_s = self.ask(process)
            self.assertAlmostEqual(ahead_s, -1000.0 + step_s, delta=20.0)
            self.assertTrue(0.49 < waited_s < 60.0, waited_s)

    def test_who_is_not_a_stage_keeps_its_clock(self):
        control, process, _ = self.start(SAY_TIME, stage="supervisord")
        control.step_clock(100.0)
        self.assertAlmostEqual(self.ask(process)[0], 0.0, delta=20.0)

    def returned(self, control, port, count=200):
        """How many of so many datagrams come back, when they are sent one by one."""
        got = 0
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            s.connect(("127.0.0.1", int(port)))
            for number in range(count):
                lost = control.lost()
                s.send(number.to_bytes(4, "little"))
                while control.lost() == lost and not select.select([s], [], [], 0.001)[0]:
                    pass
                if control.lost() == lost:
                    self.assertEqual(s.recv(100), number.to_bytes(4, "little"))
                    got += 1
        return got

    def test_of_the_datagrams_the_part_that_is_asked_for_is_lost(self):
        control, _, port = self.start(ECHO)
        self.assertEqual(self.returned(control, port), 200)
        for received, sent, least, most in ((0.3, 0.0, 110, 170), (0.0, 0.3, 110, 170),
                                            (1.0, 0.0, 0, 0), (0.0, 1.0, 0, 0)):
            control.lose(received, sent)
            got = self.returned(control, port)
            self.assertTrue(least <= got <= most, (received, sent, got))
        control.lose()
        self.assertEqual(self.returned(control, port), 200)


def event(at_s, name, **more):
    return {"at_ns": round(at_s * 1e9), "event": name, **more}


def fault(kind, begin_s, end_s, what="x"):
    return {"kind": kind, "what": what, "begin_ns": round(begin_s * 1e9),
            "end_ns": round(end_s * 1e9)}


class Reports(unittest.TestCase):
    FLIGHT = [event(0.0, "goal", number=1),
              event(0.1, "navigator", state="flying", code="ok", request_id=1),
              event(0.2, "tracker", mode="follow", request_id=1)]

    def test_a_flight_that_goes_on_has_recovered_at_once(self):
        events = [*self.FLIGHT, event(5.0, "navigator", state="arrived", code="ok", request_id=1)]
        rows = fault_report.assess(events, [fault("stall", 1.0, 2.0)])
        self.assertEqual((rows[0]["at_s"], rows[0]["recovery_s"], rows[0]["said"]), (1.0, 0.0, []))

    def test_it_has_recovered_when_it_flies_again_and_keeps_doing_so(self):
        events = [*self.FLIGHT,
                  event(2.05, "report", node="/uav/tracker", code="process_stalled", request_id=1),
                  event(2.1, "tracker", mode="brake", request_id=1),
                  event(2.3, "tracker", mode="follow", request_id=2),   # for too short a time
                  event(2.5, "tracker", mode="brake", request_id=2),
                  event(3.5, "tracker", mode="follow", request_id=3),
                  event(9.0, "navigator", state="arrived", code="ok", request_id=3)]
        rows = fault_report.assess(events, [fault("stall", 1.0, 2.0)])
        self.assertAlmostEqual(rows[0]["recovery_s"], 1.5)
        self.assertEqual(rows[0]["said"], ["tracker: process_stalled"])

    def test_a_killed_stage_must_be_back(self):
        events = [*self.FLIGHT, event(4.0, "report", node="/path_search", code="ok", request_id=0),
                  event(9.0, "navigator", state="arrived", code="ok", request_id=1)]
        rows = fault_report.assess(events, [fault("kill", 1.0, 1.0, "SIGKILL of path_search")])
        self.assertAlmostEqual(rows[0]["recovery_s"], 3.0)

    def test_a_goal_is_put_down_to_the_fault_that_the_flight_did_not_recover_from(self):
        events = [*self.FLIGHT, event(2.1, "tracker", mode="brake", request_id=1),
                  event(9.0, "leg", number=1, arrived=False, code="deadline_exceeded")]
        rows = fault_report.assess(events, [fault("clock", 0.5, 0.6), fault("kill", 2.0, 2.0),
                                            fault("loss", 4.0, 5.0)])
        self.assertEqual([r["goals_lost"] for r in rows], [0, 1, 0])
        kinds = fault_report.summary(rows)
        self.assertEqual({k: v["goals_lost"] for k, v in kinds.items()},
                         {"clock": 0, "kill": 1, "loss": 0})
        self.assertEqual(kinds["kill"]["not_recovered"], 1)
        self.assertIsNone(kinds["kill"]["recovery_p99_s"])

    def test_a_summary_counts_by_kind(self):
        rows = [dict(kind="stall", recovery_s=float(k), contacts=0, goals_lost=0, too_fast=0)
                for k in range(100)]
        random.Random(1).shuffle(rows)
        kinds = fault_report.summary([*rows, dict(kind="kill", recovery_s=None, contacts=1,
                                                  goals_lost=0, too_fast=0)])
        self.assertEqual((kinds["stall"]["injected"], kinds["stall"]["recovery_p99_s"]), (100, 99.0))
        self.assertEqual(kinds["kill"]["contacts"], 1)


class Tracks(Folder):
    def table(self, rows):
        path = self.folder / "flown.csv"
        path.write_text("t_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,qw,qx,qy,qz\n" + "".join(
            f"{t},{x},0,0,{v},0,0,1,0,0,0\n" for t, x, v in rows))
        return path

    def test_a_vehicle_whose_process_was_stopped_stood_still(self):
        path = self.table([(0.0, 0.0, 1.0), (0.01, 0.01, 1.0), (3.01, 0.02, 1.0), (3.02, 0.03, 1.0)])
        track = Track(path, stalls=1)
        self.assertLess(max(b - a for a, b in zip(track.times, track.times[1:])), 0.011)
        self.assertEqual(track.stamp_at(track.times[2]), 3.01)
        self.assertEqual(Track(path).times, [0.0, 0.01, 3.01, 3.02])

    def test_what_a_vehicle_flew_unseen_after_a_stop_parts_its_track(self):
        path = self.table([(0.0, 0.0, 1.0), (0.01, 0.01, 1.0), (3.01, 2.0, 1.0), (3.02, 2.01, 1.0)])
        track = Track(path, stalls=1)
        self.assertEqual(track.parts(), [range(0, 2), range(2, 4)])
        track.write(self.folder / "part.csv", track.parts()[1])
        part = Track(self.folder / "part.csv")
        self.assertEqual((part.points[0], len(part.rows)), ((2.0, 0.0, 0.0), 2))
        self.assertAlmostEqual(part.times[0], 0.0)

    def test_a_gap_that_no_stop_explains_stays(self):
        path = self.table([(0.0, 0.0, 1.0), (0.01, 0.01, 1.0), (3.01, 2.0, 1.0)])
        track = Track(path)
        self.assertEqual((track.times, track.parts()), ([0.0, 0.01, 3.01], [range(0, 3)]))

    def test_the_fastest_moment(self):
        path = self.table([(0.0, 0.0, 1.0), (0.01, 0.01, -3.0), (0.02, 0.0, 0.0)])
        self.assertEqual(Track(path).fastest(), (3.0, 0.01))


class Campaigns(Folder):
    def test_a_folder_of_another_campaign_is_refused(self):
        options = argparse.Namespace(output=self.folder, seed=1, missions=3, faults=["kill"])
        campaign.keep_options(options)
        options.missions = 9
        campaign.keep_options(options)
        options.seed = 2
        with self.assertRaisesRegex(campaign.OtherCampaign, "seed 1"):
            campaign.keep_options(options)

    def test_an_outcome_names_the_missions_that_touched_or_were_too_fast(self):
        good = {"mission": 1, "verdict": "safe", "legs": 2}
        bad = {"mission": 2, "verdict": "touched", "legs": 2}
        fast = {"mission": 3, "verdict": "safe", "legs": 2, "faults": [{"too_fast": 1}]}
        self.assertEqual(campaign_report.outcome_of([good], False)[0], "ok")
        self.assertEqual(campaign_report.outcome_of([good], True)[0], "cancelled")
        code, message = campaign_report.outcome_of([good, bad, fast], True)
        self.assertEqual((code, "[2]" in message), ("collision", True))
        self.assertEqual(campaign_report.outcome_of([good, fast], False)[0], "tracking_lost")


if __name__ == "__main__":
    unittest.main(verbosity=2)
