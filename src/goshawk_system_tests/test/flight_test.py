#!/usr/bin/python3
"""Whole flights by `goshawk fly`: every stage over DDS, judged by several opinions."""

import csv
import json
import math
import pathlib
import struct

import harness
import second_opinion
from harness import SystemTest, note
from stack import spawned

STAGE_KEYS = {"name", "implementation", "code", "compute_us", "wire_us", "counters"}
LEG_KEYS = {"goal", "arrived", "code", "message", "flight_time_s", "request_id", "commits", "stages",
            "path", "corridor", "trajectory", "tracking"}
KEYS = {"ok", "code", "message", "verdict", "legs", "tracking", "clearance", "folder", "why"}
FILES = {"flight.json", "flown.csv", "trajectory.csv", "corridor.ply", "world.bt", "top.png",
         "side.png", "time.png"}
V_MAX_M_S = 2.0
A_MAX_M_S2 = 2.0


def png_size(path):
    """Width and height of a PNG picture; ValueError if it is none."""
    head = pathlib.Path(path).read_bytes()[:24]
    if head[:8] != b"\x89PNG\r\n\x1a\n" or head[12:16] != b"IHDR":
        raise ValueError(f"{path} is no PNG picture")
    return struct.unpack(">II", head[16:24])


def table(path):
    with open(path, encoding="utf-8", newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def length(row, prefix, unit):
    return sum(row[f"{prefix}{axis}_{unit}"] ** 2 for axis in "xyz") ** 0.5


def polyline_m(points):
    """Length of the line through points."""
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


class FlightCase(SystemTest):
    def fly(self, *arguments, timeout_s=90.0):
        folder = self.sandbox.folder / "out"
        outcome = self.sandbox.goshawk("fly", "--json", "--output", folder, *arguments,
                                       timeout_s=timeout_s)
        self.assertEqual(outcome.status, 0, str(outcome) + self.log_tails(folder))
        self.assert_civil(outcome)
        flight = self.json_object(outcome)
        note(f"{outcome.seconds:.1f} s, clearance {flight['clearance']['smallest_m']:.3f} m, "
             f"tracking max {1e3 * flight['tracking']['max_error_m']:.1f} mm")
        return flight, folder

    def log_tails(self, folder):
        logs = sorted((folder / "logs").glob("*.log"))
        return "".join(f"\n--- {p.name}\n{p.read_text(errors='replace')[-400:]}" for p in logs)

    def check_safe(self, flight, legs):
        self.assertEqual(set(flight), KEYS)
        self.assertTrue(flight["ok"])
        self.assertEqual((flight["code"], flight["verdict"]), ("ok", "safe"))
        self.assertEqual(len(flight["legs"]), legs)
        for leg in flight["legs"]:
            self.check_leg(leg)
        self.assertGreater(flight["clearance"]["smallest_m"], 0.0)
        self.assertGreater(flight["clearance"]["samples"], 100)
        self.assertLess(flight["tracking"]["max_error_m"], harness.MARGIN_M)

    def check_leg(self, leg):
        self.assertEqual(set(leg), LEG_KEYS)
        self.assertTrue(leg["arrived"], leg)
        self.assertEqual([s["name"] for s in leg["stages"]],
                         ["path_search", "corridor_builder", "trajectory_optimizer", "navigator",
                          "tracker"])
        for stage in leg["stages"]:
            self.assertEqual(set(stage), STAGE_KEYS)
            self.assertEqual(stage["code"], "ok")
            self.assertGreaterEqual(stage["compute_us"], 0.0)
            self.assertGreater(stage["wire_us"], 0.0, stage)
            self.assertLess(stage["wire_us"], 5e6, stage)
        path, trajectory = leg["path"], leg["trajectory"]
        # What the summary asserts follows from the points that it brings.
        self.assertAlmostEqual(path["raw_length_m"], polyline_m(path["raw_points"]), places=9)
        self.assertAlmostEqual(path["pruned_length_m"], polyline_m(path["points"]), places=9)
        self.assertEqual(len(path["raw_points"]), path["waypoints_raw"])
        self.assertEqual(len(path["points"]), path["waypoints"])
        self.assertLess(math.dist(path["points"][-1], leg["goal"]), 1e-9)
        self.assertAlmostEqual(trajectory["mean_speed_m_s"],
                               trajectory["length_m"] / trajectory["duration_s"], places=9)
        self.assertGreaterEqual(path["raw_length_m"], path["pruned_length_m"] - 1e-9)
        self.assertGreaterEqual(path["waypoints_raw"], path["waypoints"])
        self.assertGreaterEqual(leg["corridor"]["polytopes"], 1)
        self.assertGreater(trajectory["max_speed_m_s"], trajectory["mean_speed_m_s"])
        self.assertLessEqual(trajectory["max_speed_m_s"], V_MAX_M_S + 1e-6)
        self.assertLessEqual(trajectory["max_acceleration_m_s2"], A_MAX_M_S2 + 1e-6)
        self.assertGreaterEqual(leg["flight_time_s"], trajectory["duration_s"])

    def check_files(self, folder, flight):
        self.assertLessEqual(FILES, {p.name for p in folder.iterdir()})
        self.assertEqual(json.loads((folder / "flight.json").read_text()), flight)
        for name in ("top.png", "side.png", "time.png"):
            width, height = png_size(folder / name)
            self.assertGreater(width * height, 100_000, name)
            self.assertGreater((folder / name).stat().st_size, 5_000, name)
        ply = (folder / "corridor.ply").read_text().splitlines()
        self.assertEqual(ply[0], "ply")
        vertices = next(int(line.split()[2]) for line in ply if line.startswith("element vertex"))
        self.assertGreaterEqual(vertices, 4)
        self.assertTrue((folder / "logs" / "supervisord.log").is_file())

    def check_tables(self, folder, flight):
        planned, flown = table(folder / "trajectory.csv"), table(folder / "flown.csv")
        self.assertGreater(len(planned), 50)
        for row in planned:
            self.assertLessEqual(length(row, "v", "m_s"), V_MAX_M_S + 1e-6)
            self.assertLessEqual(length(row, "a", "m_s2"), A_MAX_M_S2 + 1e-6)
        self.assertGreater(len(flown), 500)
        times = [row["t_s"] for row in flown]
        self.assertEqual(times, sorted(times))
        goal = flight["legs"][-1]["goal"]
        end = [flown[-1][f"{axis}_m"] for axis in "xyz"]
        for wanted, reached in zip(goal, end):
            self.assertAlmostEqual(wanted, reached, delta=0.1)
        track = [tuple(row[f"{axis}_m"] for axis in "xyz") for row in flown]
        clearance = second_opinion.smallest_clearance(folder / "world.bt", track)
        note(f"third opinion: centre {clearance:.3f} m from the nearest obstacle")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)
        # The second opinion takes a cylinder of that radius, 0.1 m high.
        told = flight["clearance"]["smallest_m"]
        self.assertLessEqual(told, clearance + 0.01)
        reach_m = math.hypot(harness.BODY_RADIUS_M, 0.05)
        self.assertGreaterEqual(told, clearance - reach_m - 0.01)


class DefaultFlight(FlightCase):
    def test_the_default_flight_is_safe_and_leaves_a_whole_folder(self):
        flight, folder = self.fly()
        self.check_safe(flight, legs=1)
        self.assertEqual(flight["legs"][0]["goal"], [3, 8, 2])
        self.check_files(folder, flight)
        self.check_tables(folder, flight)


class RenamedStages(FlightCase):
    def test_a_flight_does_not_care_what_nodes_are_called(self):
        # The plant and the map server get parameters by the names of their nodes.
        names = {"map_server": "map_server", "simulator": "simulator"}
        launch = self.sandbox.folder / "renamed.yaml"
        launch.write_text("stages:\n" + "".join(
            f"  - {{component: {stage}, node: {names.get(stage, 'my_' + stage)}}}\n"
            for stage in harness.STAGES), encoding="utf-8")
        flight, _ = self.fly("--launch", launch)
        self.check_safe(flight, 1)


class ContainerFlight(FlightCase):
    def test_one_process_flies_a_tour_of_two_goals(self):
        flight, folder = self.fly("--launch", "flight_container", "--goal", "3.5,6.1,1.1",
                                  "--goal", "3,8,2")
        self.check_safe(flight, legs=2)
        self.assertEqual([leg["goal"] for leg in flight["legs"]], [[3.5, 6.1, 1.1], [3, 8, 2]])
        self.check_files(folder, flight)
        self.check_tables(folder, flight)
        self.assertEqual(set(spawned(folder / "logs")), {"container"})


class RealMapFlight(FlightCase):
    def test_random_goals_on_a_scanned_building(self):
        map_file = harness.data_file(self, "octomap/geb079.bt")
        flight, folder = self.fly("--map", map_file, "--random", "2", "--seed", "3",
                                  timeout_s=150.0)
        self.check_safe(flight, legs=2)
        self.check_files(folder, flight)


class FlightThatFails(FlightCase):
    def test_a_goal_that_cannot_be_reached_ends_with_its_reason(self):
        folder = self.sandbox.folder / "out"
        # The second goal lies outside of what this launch's search may use; fly itself sees it
        # free in the map, and starts.
        launch = self.sandbox.folder / "boxed.yaml"
        stages = ["map_server", "corridor_builder", "trajectory_optimizer", "navigator", "tracker",
                  "simulator", "flight_check"]
        launch.write_text("stages:\n  - {component: path_search, params: {search_box: "
                          "'0,-1,0,6,7,4'}}\n" +
                          "".join(f"  - component: {stage}\n" for stage in stages))
        outcome = self.sandbox.goshawk("fly", "--json", "--launch", launch, "--output", folder,
                                       "--goal", "3.5,6.1,1.1", "--goal", "3,8,2", timeout_s=60)
        self.assertEqual(outcome.status, 1, str(outcome))
        flight = self.json_object(outcome)
        self.assertEqual((flight["ok"], flight["code"], flight["verdict"]),
                         (False, "goal_outside", "failed"))
        self.assertIn("cut by search_box", flight["message"])
        self.assertEqual([leg["arrived"] for leg in flight["legs"]], [True, False])
        self.assertEqual(flight["why"]["binds"], "refused", flight["why"])
        self.assertEqual(flight["why"]["stage"], "path_search")
        self.assertIn("search_box", flight["why"]["because"])

    def test_ends_that_no_plan_can_have_are_refused_before_anything_starts(self):
        folder = self.sandbox.folder / "out"
        for arguments, status, code in [
                (["--goal", "3,8,2", "--goal", "100,100,100"], 1, "goal_outside"),
                (["--start", "100,0,1"], 1, "start_outside"),
                (["--goal", "3,8,2", "-p", "path_search:move_within_m:=-1"], 2,
                 "invalid_parameter")]:
            outcome = self.sandbox.goshawk("fly", "--json", "--output", folder, *arguments,
                                           timeout_s=20)
            self.assertEqual(outcome.status, status, str(outcome))
            self.assertEqual(self.json_object(outcome)["code"], code)
            self.assertFalse(folder.exists())


if __name__ == "__main__":
    harness.main()
