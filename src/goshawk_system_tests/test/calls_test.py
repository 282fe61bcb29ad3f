#!/usr/bin/python3
"""Wrong calls and bad files: each ends by itself, with the documented status, code and sentence."""

import gzip
import os

import harness
from harness import SystemTest

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2
PLAN_KEYS = {"ok", "code", "message", "stages", "path", "corridor", "trajectory", "certificate"}


def ascii_pcd(points, claimed=None):
    head = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
            f"WIDTH {claimed or len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
            f"POINTS {claimed or len(points)}\nDATA ascii\n")
    return (head + "".join(f"{x} {y} {z}\n" for x, y, z in points)).encode()


def ascii_ply(points, claimed=None):
    head = (f"ply\nformat ascii 1.0\nelement vertex {claimed or len(points)}\nproperty float x\n"
            "property float y\nproperty float z\nend_header\n")
    return (head + "".join(f"{x} {y} {z}\n" for x, y, z in points)).encode()


class CallsCase(SystemTest):
    def expect(self, arguments, status, code, *words, timeout_s=30.0, cwd=None):
        """One wrong call with --json and the same without it."""
        arguments = [str(a) for a in arguments]
        with self.subTest(call=" ".join(arguments)[:120]):
            outcome = self.sandbox.goshawk(*arguments, "--json", timeout_s=timeout_s, cwd=cwd)
            self.assert_civil(outcome)
            self.assertEqual(outcome.status, status, str(outcome))
            answer = self.json_object(outcome)
            self.assertIs(answer["ok"], False)
            self.assertEqual(answer["code"], code, str(outcome))
            for word in words:
                self.assertIn(str(word), answer["message"])
            return answer
        return None

    def file(self, name, content):
        path = self.sandbox.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


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
                                             "waypoints", "expanded", "points"})
        self.assertEqual(set(plan["corridor"]), {"polytopes", "min_overlap_radius_m"})
        self.assertEqual(set(plan["trajectory"]),
                         {"duration_s", "length_m", "mean_speed_m_s", "max_speed_m_s",
                          "max_acceleration_m_s2", "pieces"})
        self.assertEqual(set(plan["certificate"]),
                         {"position_m", "velocity_m_s", "acceleration_m_s2", "joint_position_m",
                          "joint_velocity_m_s", "joint_acceleration_m_s2", "start_m", "goal_m"})
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


class BadMaps(CallsCase):
    """Files of each ending that are no maps."""

    ENDINGS = ("bt", "ot", "pcd", "ply", "3dmap")

    def plan_on(self, path, code, *words):
        self.expect(["plan", "--map", path, "--start", "1,1,1", "--goal", "2,2,1"], NOT_DONE, code,
                    *words)

    def test_missing_files(self):
        for ending in self.ENDINGS:
            self.plan_on(f"/no/such/map.{ending}", "map_unreadable", f"/no/such/map.{ending}")

    def test_what_is_no_file(self):
        folder = self.sandbox.folder / "folder.bt"
        folder.mkdir()
        self.plan_on(folder, "map_unreadable", "folder.bt")
        pipe = self.sandbox.folder / "pipe.pcd"
        os.mkfifo(pipe)
        self.plan_on(pipe, "map_unreadable", "pipe.pcd")
        self.plan_on("/dev/zero", "map_unreadable", "/dev/zero")

    def test_empty_files(self):
        for ending in self.ENDINGS:
            self.plan_on(self.file(f"empty.{ending}", b""), "map_malformed", f"empty.{ending}")

    def test_garbage(self):
        noise = bytes((i * 7919 + i // 3) % 256 for i in range(5000))
        for ending in self.ENDINGS:
            self.plan_on(self.file(f"noise.{ending}", noise), "map_malformed", f"noise.{ending}")

    def test_files_of_another_kind(self):
        picture = b"\x89PNG\r\n\x1a\n" + bytes(200)
        packed = gzip.compress(b"# Octomap OcTree binary file\n" * 50)
        for ending in self.ENDINGS:
            for name, content in (("picture", picture), ("packed", packed),
                                  ("text", b"Dear reader,\nthis is no map.\n")):
                self.plan_on(self.file(f"{name}.{ending}", content), "map_malformed",
                             f"{name}.{ending}")

    def test_unknown_endings(self):
        for name in ("map.stl", "map", "map.bt.zip", "map.BTX"):
            self.plan_on(self.file(name, b"x"), "map_unreadable", name)

    def test_a_map_that_was_cut_off(self):
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world).status, DONE)
        whole = world.read_bytes()
        for share in (0.02, 0.3, 0.7, 0.999):
            cut = self.file(f"cut{share}.bt", whole[:int(share * len(whole))])
            self.plan_on(cut, "map_malformed", cut.name)
        full = self.sandbox.folder / "world.ot"
        self.assertEqual(self.sandbox.goshawk("world", full, "--convert", world).status, DONE)
        cut = self.file("cut.ot", full.read_bytes()[:-3])
        self.plan_on(cut, "map_malformed", cut.name)

    def test_clouds_that_claim_more_than_they_bring(self):
        points = [(0, 0, 0), (1, 1, 1)]
        for claimed in (3, 10**9, 10**18):
            self.plan_on(self.file("claim.pcd", ascii_pcd(points, claimed)), "map_malformed")
            self.plan_on(self.file("claim.ply", ascii_ply(points, claimed)), "map_malformed")

    def test_clouds_without_a_usable_point(self):
        points = [("nan", 0, 0), (0, "inf", 0)]
        self.plan_on(self.file("nan.pcd", ascii_pcd(points)), "map_empty", "not finite")
        self.plan_on(self.file("nan.ply", ascii_ply(points)), "map_empty", "not finite")

    def test_a_cloud_that_spans_too_much(self):
        points = [(0, 0, 0), (1e6, 1e6, 1e6)]
        self.plan_on(self.file("far.pcd", ascii_pcd(points)), "map_too_large", "resolution")
        points = [(0, 0, 0), (1e30, 0, 0)]
        self.plan_on(self.file("farther.ply", ascii_ply(points)), "map_too_large")

    def test_a_3dmap_with_wrong_numbers(self):
        for text in ("voxel 10 10\n", "voxel -1 5 5\n", "voxel 5 5 5\n9 9 9\n", "voxel x y z\n",
                     "voxel 0 5 5\n"):
            self.plan_on(self.file("wrong.3dmap", text), "map_malformed")
        self.plan_on(self.file("huge.3dmap", "voxel 100000 100000 100000\n0 0 0\n"),
                     "map_too_large")

    def test_a_world_without_free_space(self):
        points = [(0.1 + 0.2 * x, 0.1 + 0.2 * y, 0.1 + 0.2 * z)
                  for x in range(10) for y in range(10) for z in range(10)]
        full = self.file("full.pcd", ascii_pcd(points))
        self.plan_on(full, "map_empty")
        self.expect(["fly", "--map", full, "--random", "1", "--output",
                     self.sandbox.folder / "out"], NOT_DONE, "map_empty")

    def test_truth_the_same_cloud_in_two_formats_is_a_map(self):
        points = [(0, 0, 0), (5, 5, 3)]
        for name, content in (("good.pcd", ascii_pcd(points)), ("good.ply", ascii_ply(points))):
            outcome = self.sandbox.goshawk("plan", "--map", self.file(name, content), "--start",
                                           "1,1,1", "--goal", "4,4,2", "--json")
            self.assertEqual(outcome.status, DONE, str(outcome))

    def test_the_other_verbs_say_the_same(self):
        noise = self.file("noise.bt", b"noise")
        self.expect(["fly", "--map", noise, "--random", "1", "--output",
                     self.sandbox.folder / "out"], NOT_DONE, "map_malformed", "noise.bt")
        self.expect(["world", self.sandbox.folder / "out.bt", "--convert", noise], NOT_DONE,
                    "map_malformed", "noise.bt")
        self.expect(["world", self.sandbox.folder / "out.bt", "--convert", "/no/such.pcd"],
                    NOT_DONE, "map_unreadable", "/no/such.pcd")


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
        cubes = harness.OccupiedCubes(world)
        cube = sorted(cubes.cubes)[len(cubes.cubes) // 2]
        return ",".join(f"{(k - 32768 + 0.5) * cubes.resolution:.3f}" for k in cube)

    def test_points_that_are_not_finite(self):
        for option in ("--start", "--goal"):
            for text in ("nan,0,0", "0,inf,0", "0,0,-inf"):
                self.expect(["plan", f"{option}={text}"], NOT_DONE, "invalid_input")

    def test_texts_that_are_no_points(self):
        for option in ("--start", "--goal"):
            for text in ("1,2", "1,2,3,4", "a,b,c", "1,2,3m", " ", "1, 2, 3"):
                self.expect(["plan", f"{option}={text}"], WRONG_CALL, "invalid_input")
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
        answer = self.expect(["fly", f"--start={self.occupied_point()}", "--output",
                              self.sandbox.folder / "out"], NOT_DONE, "start_occupied")
        self.assertNotIn("legs", answer)


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
        self.expect(["world", out, "--size", "5,5"], WRONG_CALL, "invalid_input", "5,5")
        self.expect(["world", out, "--keep-free", "100,0,0"], NOT_DONE, "invalid_input", "100")
        self.expect(["world", out, "--size", "5000,5000,5000"], NOT_DONE, "map_too_large")
        self.expect(["world", out, "--size", "1e300,1,1"], NOT_DONE, "map_too_large")
        self.assertFalse(out.exists())

    def test_a_density_that_is_no_number_is_refused_by_fly(self):
        for value in ("x", "0.4x", "2", "nan"):
            self.expect(["fly", f"--density={value}", "--output", self.sandbox.folder / "out"],
                        WRONG_CALL, "invalid_parameter", "density")


class BadCalls(CallsCase):
    def wrong(self, arguments, *words):
        outcome = self.sandbox.goshawk(*arguments, timeout_s=20)
        with self.subTest(call=" ".join(arguments)):
            self.assert_civil(outcome)
            self.assertEqual(outcome.status, WRONG_CALL, str(outcome))
            for word in words:
                self.assertIn(word, outcome.err)

    def test_verbs(self):
        self.wrong(["paln"], "paln", "plan")
        self.wrong(["xyzzy"], "xyzzy", "--help")
        self.wrong(["topic", "lst"], "lst", "list")
        self.wrong(["node", "kill"], "kill")
        self.wrong(["param", "describe", "traker"], "traker", "tracker")
        self.wrong(["run"], "COMPONENT")
        self.wrong(["run", "traker"], "traker", "tracker")
        self.wrong(["launch"], "file")
        self.assertEqual(self.sandbox.goshawk().status, WRONG_CALL)

    def test_options(self):
        for verb in ("plan", "fly", "topic", "node", "launch", "run"):
            self.wrong([verb, "--gaol", "1,2,3"], "gaol")
        self.wrong(["plan", "--goal"], "--goal")
        self.wrong(["fly", "--random", "many"], "random")
        self.wrong(["world", "out.bt", "--seed=-1"], "seed")
        self.wrong(["world"], "output")

    def test_wrong_options_answer_in_json_where_that_is_asked_for(self):
        for verb in ("plan", "fly", "world"):
            self.expect([verb, "--gaol", "1,2,3"], WRONG_CALL, "invalid_input", "gaol")

    def test_help(self):
        for verb in ("plan", "fly", "world", "launch", "run", "topic", "node", "param", "bench"):
            with self.subTest(verb=verb):
                outcome = self.sandbox.goshawk(verb, "--help", timeout_s=20)
                self.assertEqual(outcome.status, DONE, str(outcome))
                self.assertIn(verb, outcome.out)
        self.assertEqual(self.sandbox.goshawk("--help").status, DONE)

    def test_numbers_of_fly(self):
        fly = ["--output", self.sandbox.folder / "out"]
        self.expect(["fly", "--random=-1", *fly], WRONG_CALL, "invalid_parameter", "random")
        self.expect(["fly", "--timeout=0", *fly], WRONG_CALL, "invalid_parameter", "timeout")
        self.expect(["fly", "--timeout=nan", *fly], WRONG_CALL, "invalid_parameter", "timeout")

    def test_folders_that_cannot_be_written(self):
        self.expect(["fly", "--output", "/proc/flight"], NOT_DONE, "io_failed", "/proc/flight")
        blocked = self.file("file", b"")
        self.expect(["fly", "--output", blocked / "flight"], NOT_DONE, "io_failed", str(blocked))
        self.expect(["world", "/no/such/folder/world.bt"], NOT_DONE, "io_failed",
                    "/no/such/folder/world.bt")
        self.expect(["world", blocked / "world.bt"], NOT_DONE, "io_failed", str(blocked))
        outcome = self.sandbox.goshawk("plan", "--save", "/proc/plan", timeout_s=20)
        self.assertEqual(outcome.status, NOT_DONE, str(outcome))
        self.assertIn("/proc/plan", outcome.err)

    def test_a_plan_that_cannot_be_saved_is_one_object(self):
        self.expect(["plan", "--save", "/proc/plan"], NOT_DONE, "io_failed", "/proc/plan")

    def test_domains_and_interfaces(self):
        for name, value in (("ROS_DOMAIN_ID", "x"), ("ROS_DOMAIN_ID", "233"),
                            ("ROS_DOMAIN_ID", "-1"), ("GOSHAWK_INTERFACES", "1.2.3.4"),
                            ("GOSHAWK_INTERFACES", "nonsense")):
            for command in (["run", "tracker"], ["topic", "list"], ["node", "list"],
                            ["fly", "--output", self.sandbox.folder / "out"]):
                with self.subTest(name=name, value=value, command=command[0]):
                    outcome = self.sandbox.goshawk(*command, env={name: value}, timeout_s=20)
                    self.assert_civil(outcome)
                    self.assertNotEqual(outcome.status, DONE, str(outcome))
                    self.assertIn(value, outcome.err)

    def test_parameters_of_a_component(self):
        outcome = self.sandbox.goshawk("run", "tracker", "--ros-args", "-p", "mas_kg:=1", "-p",
                                       "max_tilt_rad:=steep", "-p", "min_thrust_n:=-1",
                                       timeout_s=20)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, WRONG_CALL, str(outcome))
        for word in ("mas_kg", "mass_kg", "max_tilt_rad", "steep", "min_thrust_n"):
            self.assertIn(word, outcome.err)

    def test_components_that_cannot_start(self):
        for arguments, word in [(["map_server"], "map_file"),
                                (["map_server", "--ros-args", "-p", "map_file:=/no/such.bt"],
                                 "/no/such.bt"),
                                (["tracker", "tracker"], "tracker"),
                                (["tracker", "--ros-args", "-r", "x"], "x"),
                                (["tracker", "--ros-args", "-r", "__node:=a b"], "a b"),
                                (["tracker", "--ros-args", "--params-file"], "--params-file"),
                                (["tracker", "--ros-args", "--log-level", "loud"], "loud")]:
            self.wrong(["run", *arguments], word)


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
        cubes = harness.OccupiedCubes(path)
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
        self.assertEqual(harness.OccupiedCubes(self.sandbox.folder / "a.bt").cubes,
                         harness.OccupiedCubes(self.sandbox.folder / "c.bt").cubes)


if __name__ == "__main__":
    harness.main()
