#!/usr/bin/python3
"""Files that are no maps, or no whole ones: each is refused with the documented code and sentence."""

import gzip
import os

import harness
from calls_case import DONE, NOT_DONE, CallsCase, ascii_pcd, ascii_ply


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
        for name in ("map.las", "map", "map.bt.zip", "map.BTX"):
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


if __name__ == "__main__":
    harness.main()
