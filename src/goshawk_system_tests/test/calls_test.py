#!/usr/bin/python3
"""Wrong calls and bad files: each ends by itself, with the documented status, code and sentence."""

import harness
import second_opinion
from calls_case import DONE, NOT_DONE, WRONG_CALL, CallsCase, ascii_pcd

PLAN_KEYS = {"ok", "code", "message", "request", "stages", "path", "corridor", "trajectory",
             "certificate"}


class GoodPlan(CallsCase):
    """What the wrong calls below differ from."""

    def test_the_documented_keys(self):
        outcome = self.sandbox.goshawk("plan", "--json")
        self.assertEqual(outcome.status, DONE, str(outcome))
        plan = self.json_object(outcome)
        self.assertEqual(set(plan), PLAN_KEYS)
        self.assertTrue(plan["ok"])
        self.assertEqual([set(s) for s in plan["stages"]],
                         3 * [{"name", "implementation", "compute_us"}])
        self.assertEqual(set(plan["path"]), {"raw_length_m", "pruned_length_m", "waypoints_raw",
                                             "waypoints", "expanded", "points", "cost", "goal",
                                             "start_moved_m", "goal_moved_m", "cut_off", "note"})
        self.assertEqual(set(plan["corridor"]), {"polytopes", "min_overlap_radius_m"})
        self.assertEqual(set(plan["trajectory"]),
                         {"duration_s", "length_m", "mean_speed_m_s", "max_speed_m_s",
                          "max_acceleration_m_s2", "pieces"})
        self.assertEqual(set(plan["certificate"]),
                         {"position_m", "validity_s", "velocity_m_s", "acceleration_m_s2", "continuity_position_m",
                          "continuity_velocity_m_s", "continuity_acceleration_m_s2", "start_m", "goal_m",
                          "jerk_m_s3", "start_excess_m_s", "start_excess_m_s2",
                          "start_excess_s"})
        for family, value in plan["certificate"].items():
            self.assertLessEqual(value, 1e-6, family)

    def test_its_control_points_lie_in_their_polytopes(self):
        plan = self.json_object(self.sandbox.goshawk("plan", "--json", "--goal", "3.5,6.1,1.1"))
        polytopes = plan["corridor"]["polytopes"]
        for piece in plan["trajectory"]["pieces"]:
            p = polytopes[piece["polytope"]]
            self.assertEqual(len(piece["control_points"]), 6)
            for point in piece["control_points"]:
                for normal, offset in zip(p["A"], p["b"]):
                    self.assertAlmostEqual(sum(n * n for n in normal), 1.0, places=9)
                    self.assertLessEqual(sum(n * x for n, x in zip(normal, point)), offset + 1e-6)

    def test_the_same_call_gives_the_same_plan(self):
        plans = [self.json_object(self.sandbox.goshawk("plan", "--json")) for _ in range(2)]
        for plan in plans:
            for stage in plan["stages"]:
                del stage["compute_us"]
        self.assertEqual(plans[0], plans[1])

    def test_saved_files(self):
        folder = self.sandbox.folder / "plan"
        outcome = self.sandbox.goshawk("plan", "--save", folder)
        self.assertEqual(outcome.status, DONE, str(outcome))
        self.assertIn("certified", outcome.out)
        for name in ("top.png", "side.png", "trajectory.csv", "corridor.ply"):
            self.assertGreater((folder / name).stat().st_size, 1000, name)


class BadPoints(CallsCase):
    def test_points_where_the_vehicle_cannot_be(self):
        inside = self.occupied_point()
        for option, end in (("--start", "start"), ("--goal", "goal")):
            self.expect(["plan", option, "100,0,1"], NOT_DONE, f"{end}_outside", "100")
            self.expect(["plan", option, "-1e300,0,1"], NOT_DONE, f"{end}_outside")
            self.expect(["plan", option, inside], NOT_DONE, f"{end}_occupied")

    def occupied_point(self):
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world).status, DONE)
        cubes = second_opinion.OccupiedCubes(world)
        cube = sorted(cubes.cubes)[len(cubes.cubes) // 2]
        return ",".join(f"{(k - 32768 + 0.5) * cubes.resolution:.3f}" for k in cube)

    def test_points_that_are_not_finite(self):
        for option in ("--start", "--goal"):
            for text in ("nan,0,0", "0,inf,0", "0,0,-inf"):
                self.expect(["plan", f"{option}={text}"], NOT_DONE, "invalid_input")

    def test_texts_that_are_no_points(self):
        for option in ("--start", "--goal"):
            for text in ("1,2", "1,2,3,4", "a,b,c", "1,2,3m", " ", "1, 2, 3"):
                self.expect(["plan", f"{option}={text}"], WRONG_CALL, "invalid_parameter")
                self.expect(["fly", f"{option}={text}", "--output",
                             self.sandbox.folder / "out"], WRONG_CALL, "invalid_parameter")

    def test_points_never_measured(self):
        map_file = harness.data_file(self, "octomap/geb079.bt")
        goal = "0,0,0"  # replaced below by a place that the map itself calls unknown
        plan = ["plan", "--map", map_file, "--start", goal, "--goal", goal]
        answer = self.json_object(self.sandbox.goshawk(*plan, "--json"))
        self.assertIn(answer["code"], ("start_unknown", "start_occupied", "start_outside"))

    def test_a_goal_that_is_cut_off(self):
        # A plate of voxels across the whole box parts it in two.
        points = [(0.1 + 0.2 * x, 0.1 + 0.2 * y, 2.1) for x in range(20) for y in range(20)]
        points += [(0.1, 0.1, 0.1), (3.9, 3.9, 4.1)]
        plate = self.file("plate.pcd", ascii_pcd(points))
        answer = self.expect(["plan", "--map", plate, "--start", "2,2,1", "--goal", "2,2,3.4"],
                             NOT_DONE, "no_path")
        self.assertIsNone(answer["path"])
        self.assertEqual(set(answer), PLAN_KEYS)
        self.expect(["fly", "--map", plate, "--start", "2,2,1", "--output",
                     self.sandbox.folder / "out"], WRONG_CALL, "invalid_parameter", "--goal")

    def test_fly_refuses_a_start_in_a_wall_before_anything_starts(self):
        out = self.sandbox.folder / "out"
        answer = self.expect(["fly", f"--start={self.occupied_point()}", "--output", out], NOT_DONE,
                             "start_occupied")
        self.assertNotIn("legs", answer)
        self.assertFalse(out.exists())


class BadNumbers(CallsCase):
    def test_limits(self):
        fly = ["--output", self.sandbox.folder / "out"]
        for option in ("--v-max", "--a-max"):
            for value in ("0", "-1", "nan", "inf", "-inf"):
                self.expect(["plan", f"{option}={value}"], NOT_DONE, "invalid_limits")
                self.expect(["fly", f"{option}={value}", *fly], NOT_DONE, "invalid_limits")
            for value in ("x", "1m", "1,5", "--"):
                self.expect(["plan", f"{option}={value}"], WRONG_CALL, "invalid_parameter", option,
                            value)
                self.expect(["fly", f"{option}={value}", *fly], WRONG_CALL, "invalid_parameter")

    def test_limits_of_jerk_and_of_the_vertical(self):
        options = {"--j-max": ("j_max_m_s3", 8.0), "--v-max-vertical": ("v_max_vertical_m_s", 0.5),
                   "--a-max-vertical": ("a_max_vertical_m_s2", 0.75)}
        for option in options:
            self.expect(["plan", f"{option}=-1"], NOT_DONE, "invalid_limits")
            self.expect(["plan", f"{option}=x"], WRONG_CALL, "invalid_parameter", option)
        self.expect(["plan", "--norm=manhattan"], WRONG_CALL, "invalid_parameter", "per_axis")
        call = ["plan", "--json", "--norm", "horizontal_vertical"]
        for option, (_, value) in options.items():
            call += [option, str(value)]
        plan = self.json_object(self.sandbox.goshawk(*call))
        self.assertTrue(plan["ok"], plan["message"])
        for key, value in options.values():
            self.assertEqual(plan["request"]["limits"][key], value)
        climb = max(abs(b[2] - a[2]) * 5 / piece["duration_s"]
                    for piece in plan["trajectory"]["pieces"]
                    for a, b in zip(piece["control_points"], piece["control_points"][1:]))
        self.assertLessEqual(climb, 0.5 + 1e-6)
        self.assertGreater(climb, 0.25)

    def test_limits_at_the_edge_of_numbers(self):
        """Whatever comes of it: an answer, in time."""
        for value in ("1e-300", "1e300", "1e-9", "1e9"):
            for option in ("--v-max", "--a-max"):
                outcome = self.sandbox.goshawk("plan", "--json", f"{option}={value}", timeout_s=20)
                self.assert_civil(outcome)
                answer = self.json_object(outcome)
                self.assertEqual(answer["ok"], outcome.status == DONE)

    def test_radius_margin_resolution_unknown(self):
        for option, name in (("--radius", "radius_m"), ("--margin", "margin_m")):
            for value in ("-0.1", "nan", "inf", "x", "1e9"):
                self.expect(["plan", f"{option}={value}"], WRONG_CALL, "invalid_parameter", name)
        for value in ("0", "-0.2", "nan", "x"):
            self.expect(["plan", f"--resolution={value}"], WRONG_CALL, "invalid_parameter",
                        "resolution_m")
        self.expect(["plan", "--unknown=blokced"], WRONG_CALL, "invalid_parameter", "unknown",
                    "blocked")
        self.expect(["plan", "--radius", "3"], NOT_DONE, "map_empty")

    def test_params_files(self):
        for text, words in [
                ("path_search:\n  ros__parameters:\n    planer: astar\n", ("planer", "planner")),
                ("path_search:\n  ros__parameters:\n    planner: 5\n", ("planner",)),
                ("map_server:\n  ros__parameters:\n    radius_m: wide\n", ("radius_m", "wide")),
                ("map_server:\n  ros__parameters:\n    radius_m: [1]\n", ("radius_m",)),
                ("path_search:\n  planner: astar\n", ("ros__parameters",)),
                ("path_search: [", ("YAML",)), ("- 1\n", ("map of node names",))]:
            path = self.file("params.yaml", text)
            self.expect(["plan", "--params-file", path], WRONG_CALL, "invalid_parameter", *words)
        self.expect(["plan", "--params-file", "/no/such.yaml"], WRONG_CALL, "invalid_parameter",
                    "/no/such.yaml")
        both = self.file("both.yaml", "path_search:\n  ros__parameters:\n    planer: astar\n"
                                      "corridor_builder:\n  ros__parameters:\n    genrator: box\n")
        self.expect(["plan", "--params-file", both], WRONG_CALL, "invalid_parameter", "planer",
                    "genrator")

    def test_worlds(self):
        out = self.sandbox.folder / "out.bt"
        for arguments, words in [(["--density", "2"], ["density"]),
                                 (["--density=-0.1"], ["density"]),
                                 (["--density", "nan"], ["density"]),
                                 (["--size", "0,1,1"], ["size"]),
                                 (["--size=-5,1,1"], ["size"]),
                                 (["--size", "nan,1,1"], ["size"]),
                                 (["--resolution", "0"], ["resolution"]),
                                 (["--resolution", "inf"], ["resolution"]),
                                 (["--kind", "forrest"], ["forrest", "forest"]),
                                 (["--inflation=-1"], ["inflation"])]:
            self.expect(["world", out, *arguments], WRONG_CALL, "invalid_parameter", *words)
        self.expect(["world", out, "--size", "5,5"], WRONG_CALL, "invalid_parameter", "5,5")
        self.expect(["world", out, "--keep-free", "100,0,0"], NOT_DONE, "invalid_input", "100")
        self.expect(["world", out, "--size", "5000,5000,5000"], NOT_DONE, "map_too_large")
        self.expect(["world", out, "--size", "1e300,1,1"], NOT_DONE, "map_too_large")
        self.assertFalse(out.exists())

    def test_a_density_that_is_no_number_is_refused_by_fly(self):
        for value in ("x", "0.4x", "2", "nan"):
            self.expect(["fly", f"--density={value}", "--output", self.sandbox.folder / "out"],
                        WRONG_CALL, "invalid_parameter", "density")


class Worlds(CallsCase):
    def test_the_same_call_gives_the_same_bytes(self):
        for kind in ("boxes", "forest", "office", "noise"):
            with self.subTest(kind=kind):
                files = [self.sandbox.folder / f"{kind}{n}.bt" for n in range(3)]
                for path, seed in zip(files, ("5", "5", "6")):
                    outcome = self.sandbox.goshawk("world", path, "--kind", kind, "--size",
                                                   "10,10,4", "--density", "0.2", "--seed", seed)
                    self.assertEqual(outcome.status, DONE, str(outcome))
                self.assertEqual(files[0].read_bytes(), files[1].read_bytes())
                self.assertNotEqual(files[0].read_bytes(), files[2].read_bytes())

    def test_what_it_says_is_what_the_file_holds(self):
        path = self.sandbox.folder / "world.bt"
        said = self.json_object(self.sandbox.goshawk("world", path, "--json"))
        self.assertTrue(said["ok"])
        self.assertLessEqual({"file", "kind", "seed", "resolution_m", "size_voxels", "origin_m",
                              "upper_m", "occupied_voxels", "occupied_ratio", "inflation_m",
                              "grown_ratio"}, set(said))
        cubes = second_opinion.OccupiedCubes(path)
        self.assertEqual(said["occupied_voxels"], len(cubes.cubes))
        self.assertEqual(said["resolution_m"], cubes.resolution)
        self.assertAlmostEqual(said["grown_ratio"], 0.4, delta=0.01)

    def test_conversions_keep_every_voxel(self):
        first = self.sandbox.folder / "a.bt"
        self.assertEqual(self.sandbox.goshawk("world", first).status, DONE)
        for name in ("b.ot", "c.bt"):
            second = self.sandbox.folder / name
            outcome = self.sandbox.goshawk("world", second, "--convert", first, "--json")
            self.assertEqual(outcome.status, DONE, str(outcome))
            first = second
        self.assertEqual(second_opinion.OccupiedCubes(self.sandbox.folder / "a.bt").cubes,
                         second_opinion.OccupiedCubes(self.sandbox.folder / "c.bt").cubes)


class MapFiles(CallsCase):
    def goshawk_map(self, *arguments):
        outcome = self.sandbox.goshawk("map", *arguments, "--json")
        self.assertEqual(outcome.status, DONE, str(outcome))
        return self.json_object(outcome)

    def halves(self):
        """A world, and what is left and right of x = 3 m in it."""
        world, left, right = (self.sandbox.folder / f"{name}.bt"
                              for name in ("world", "left", "right"))
        self.assertEqual(self.sandbox.goshawk("world", world).status, DONE)
        self.goshawk_map("crop", world, left, "--lower=-9,-9,-9", "--upper", "3,19,9")
        self.goshawk_map("crop", world, right, "--lower", "3,-9,-9", "--upper", "19,19,9")
        return world, left, right

    def test_halves_make_the_whole(self):
        world, left, right = self.halves()
        cubes = {path: second_opinion.OccupiedCubes(path).cubes for path in (world, left, right)}
        self.assertEqual(cubes[left] | cubes[right], cubes[world])
        self.assertFalse(cubes[left] & cubes[right])
        both = self.sandbox.folder / "both.ot"
        said = self.goshawk_map("merge", both, left, right)
        self.assertEqual(said["occupied_voxels"], len(cubes[world]))
        self.assertTrue(self.goshawk_map("diff", world, both)["same"])
        self.assertEqual(self.goshawk_map("info", world)["free_voxels"],
                         self.goshawk_map("info", both)["free_voxels"])

    def test_differences_are_counted(self):
        world, left, right = self.halves()
        said = self.goshawk_map("diff", left, world)
        info = self.goshawk_map("info", right)
        self.assertFalse(said["same"])
        self.assertEqual(said["learnt_voxels"], info["occupied_voxels"] + info["free_voxels"])
        self.assertEqual((said["appeared_voxels"], said["vanished_voxels"]), (0, 0))
        self.assertEqual(self.goshawk_map("diff", world, left)["forgotten_voxels"],
                         said["learnt_voxels"])

    def test_wrong_maps_are_refused(self):
        world, left, _ = self.halves()
        coarse = self.sandbox.folder / "coarse.bt"
        self.assertEqual(self.sandbox.goshawk("world", coarse, "--resolution", "0.4").status, DONE)
        self.expect(["map", "merge", "all.bt", world, coarse], NOT_DONE, "invalid_input", "0.4")
        self.expect(["map", "info", "/no/such/map.bt"], NOT_DONE, "map_unreadable", "/no/such")
        self.expect(["map", "crop", left, "out.bt", "--lower", "50,50,0", "--upper", "60,60,1"],
                    NOT_DONE, "map_empty")
        self.expect(["map", "crop", left, "/no/such/out.bt", "--lower", "0,0,0", "--upper",
                     "1,1,1"], NOT_DONE, "io_failed", "/no/such")
        self.expect(["map", "save", "out.bt", "--timeout", "0.2"], NOT_DONE, "stage_silent",
                    "octomap_binary")


if __name__ == "__main__":
    harness.main()
