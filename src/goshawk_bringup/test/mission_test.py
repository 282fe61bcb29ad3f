"""Tests of a campaign's missions, with a goshawk that only answers."""

import argparse
import csv
import json
import pathlib
import sys
import tempfile
import time
import unittest
from unittest import mock

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import campaign  # noqa: E402
import campaign_report  # noqa: E402
import fault_control  # noqa: E402
import faulty_flight  # noqa: E402
import mission  # noqa: E402

# Answers each verb with what ANSWERS/VERB holds; without an answer it flies until it is interrupted.
GOSHAWK = """#!/bin/sh
answers=$(dirname "$0")/../answers
[ "$1" = world ] && echo world > "$2"
[ -e "$answers/$1" ] || exec sleep 1000
cat "$answers/$1"
"""
COLUMNS = ["t_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "qw", "qx", "qy", "qz"]
OK = {"ok": True, "code": "ok", "message": ""}


class MissionCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in ("bin", "answers", "out"):
            (self.folder / name).mkdir()
        program = self.folder / "bin/goshawk"
        program.write_text(GOSHAWK)
        program.chmod(0o755)
        self.answer("world", OK)
        self.options = argparse.Namespace(
            prefix=str(self.folder), output=self.folder / "out", seed=1, kinds=["boxes"],
            densities=[0.1], wind=[0.0], noise=[0.0], size="4,4,4", goals=2, timeout_s=60.0, jobs=1,
            launch="flight", parameters=[], faults=["kill"])
        self.flyer = mission.Flyer(self.options)
        self.mission = mission.Mission(self.options, 1)
        self.own = self.options.output / "mission_00001"
        self.own.mkdir()

    def answer(self, verb, content):
        (self.folder / "answers" / verb).write_text(json.dumps(content))

    def write_track(self, rows):
        with open(self.own / "flown.csv", "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file)
            table.writerows([COLUMNS, *rows])

    def write_events(self, *events):
        (self.own / "events.jsonl").write_text("".join(json.dumps(e) + "\n" for e in events))


class Tries(MissionCase):
    def test_a_fault_that_cannot_be_injected_ends_the_flight_and_fails_the_mission(self):
        with mock.patch.object(faulty_flight.Injector, "run", side_effect=KeyError("tracker")):
            with self.assertRaises(KeyError):
                self.flyer.fly(self.mission)

    def test_what_an_earlier_try_flew_is_not_judged_again(self):
        self.write_track([[0.01 * k, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0] for k in range(30)])
        self.write_events({"at_ns": 1, "event": "track"})
        self.answer("fly", {"ok": False, "code": "stage_silent", "message": "none came up"})
        for faults in (["kill"], []):
            self.options.faults = faults
            row = self.flyer.fly(self.mission)
            self.assertEqual((row["verdict"], row["clearance_m"], row["energy_j"]),
                             ("not flown", None, None))

    def test_a_mission_may_take_as_long_as_its_goals_may(self):
        self.options.goals, self.options.timeout_s = 30, 60.0
        self.assertGreater(mission.Flyer(self.options).timeout_s, 30 * 60.0)


class Judging(MissionCase):
    def judge(self):
        faulty = mission.FaultyMission(self.flyer, self.mission, self.own, self.own / "made.bt")
        return faulty.judge([{"at_ns": 1, "event": "track"}])

    def test_a_track_without_a_sample_is_no_flight(self):
        self.write_track([])
        self.assertEqual(self.judge(), {"verdict": "not flown"})

    def test_a_world_without_obstacles_has_no_clearance(self):
        self.write_track([[0.01 * k, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0] for k in range(3)])
        self.answer("check", {**OK, "flown": {"touched": False, "smallest_m": None, "at_s": 0.0}})
        row = self.judge()
        self.assertEqual((row["verdict"], row["clearance_m"]), ("safe", None))

    def test_the_smallest_clearance_of_all_parts_counts(self):
        self.assertEqual(mission.smaller(None, 0.3), 0.3)
        self.assertEqual(mission.smaller(0.2, 0.3), 0.2)
        self.assertEqual(mission.smaller(0.2, None), 0.2)

    def test_goals_that_were_flown_to_without_a_track_are_not_judged(self):
        row = {**self.mission.conditions(), **mission.outcome(0, {**OK, "legs": []}, self.own)}
        counts = [campaign_report.summary([{**row, "legs": 2, "verdict": v}])["not_judged"]
                  for v in ("safe", "touched", "not judged", "not flown")]
        self.assertEqual(counts, [0, 0, 1, 1])


class Fault:
    """One that a flight cannot take any more."""

    after_s, duration_s, instant = 0.0, 0.0, False

    def __init__(self, then):
        self.then = then

    def row(self):
        return {"kind": "hostile", "what": "x", "targets": []}

    def begin(self, _):
        self.then()
        faulty_flight.domain_of([])


class Injection(MissionCase):
    def inject(self, then=lambda: None):
        self.write_events({"at_ns": 1, "event": "goal", "number": 1})
        injector = faulty_flight.Injector(argparse.Namespace(folder=self.own), [Fault(then)])
        self.addCleanup(injector.events.close)
        return injector

    def test_a_fault_whose_flight_has_just_ended_is_left_out(self):
        over = []
        injector = self.inject(lambda: over.append(True))
        self.assertEqual(injector.run(lambda: bool(over)), [])

    def test_a_flight_that_goes_on_without_stages_is_a_failure(self):
        with mock.patch.object(faulty_flight, "ENDING_S", 0.05):
            with self.assertRaises(faulty_flight.NoStage):
                self.inject().run(lambda: False)

    def test_the_caller_s_own_options_of_the_environment_stay(self):
        env = fault_control.environment("/shim.so", "/f", {"ASAN_OPTIONS": "detect_leaks=0",
                                                           "LD_PRELOAD": "/asan.so"})
        self.assertEqual(env, {"GOSHAWK_FAULTS": "/f", "LD_PRELOAD": "/asan.so:/shim.so",
                               "ASAN_OPTIONS": "detect_leaks=0:verify_asan_link_order=0"})


class Campaigns(MissionCase):
    def test_a_mission_that_fails_ends_the_campaign_without_the_others(self):
        flown = []

        def fly(which):
            if which.number == 1:
                raise KeyError("a bug")
            flown.append(which.number)
            time.sleep(0.05)
            return {"code": "ok"}

        engine = campaign.LocalEngine(self.options)
        with mock.patch.object(engine.flyer, "fly", fly):
            with self.assertRaises(KeyError):
                list(engine.fly(range(1, 201)))
        self.assertLess(len(flown), 199)
        self.assertTrue(engine.flyer.stopping)

    def test_a_row_that_was_cut_off_is_removed_before_others_follow(self):
        log = self.options.output / "missions.jsonl"
        whole = '{"mission": 1, "faults": []}\n'
        for cut in ('{"mission": 2, "faults": [{"kind": "kill"}', '{"mission": 2', ""):
            log.write_text(whole + cut)
            self.assertEqual([r["mission"] for r in campaign.read_rows(log.parent)], [1])
            self.assertEqual(log.read_text(), whole)
        log.write_text(whole.rstrip("\n"))
        self.assertEqual([r["mission"] for r in campaign.read_rows(log.parent)], [1])
        self.assertEqual(log.read_text(), whole)


if __name__ == "__main__":
    unittest.main(verbosity=2)
