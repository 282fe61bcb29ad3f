#!/usr/bin/python3
"""A flight that begins without a map: a simulated lidar sees the true world, the map server maps
what it sees, and the vehicle flies by that map. Judged by the true world, which no planner has."""

import json
import math

import harness
import second_opinion
from harness import SystemTest, node_of, note, until
from stack import Stack

FAR_M = 4.0  # from the start: the world is 8 m long
MOST_HOPS = 12
REACHED_M = 0.25
STEPS = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))


class LiveMap:
    """The newest map/voxels: which voxels are free for the vehicle's centre."""

    def __init__(self, message):
        self.size = [message[f"size_{axis}"] for axis in "xyz"]
        self.origin = [message["origin"][axis] for axis in "xyz"]
        self.resolution = message["resolution"]
        self.known = [int(word) for word in message["known"]]
        self.grown = [int(word) for word in message["grown"]]

    def is_free(self, voxel):
        """Rows are 64-bit words along x, y faster than z."""
        if not all(0 <= v < n for v, n in zip(voxel, self.size)):
            return False
        x, y, z = voxel
        word = (z * self.size[1] + y) * ((self.size[0] + 63) // 64) + x // 64
        return bool(self.known[word] & ~self.grown[word] & (1 << x % 64))

    def known_voxels(self):
        return sum(word.bit_count() for word in self.known)

    def voxel_of(self, point):
        return tuple(math.floor((p - o) / self.resolution) for p, o in zip(point, self.origin))

    def places_from(self, point):
        """Centres of free voxels that steps over faces lead to, if all neighbours are free too."""
        def beside(voxel):
            return [tuple(v + s for v, s in zip(voxel, step)) for step in STEPS]
        start = self.voxel_of(point)
        reached, open_ends = {start}, [start]
        while open_ends:
            for voxel in beside(open_ends.pop()):
                if voxel not in reached and self.is_free(voxel):
                    reached.add(voxel)
                    open_ends.append(voxel)
        return [tuple(o + self.resolution * (v + 0.5) for o, v in zip(self.origin, voxel))
                for voxel in reached if all(self.is_free(v) for v in beside(voxel))]


class LiveFlight(SystemTest):
    def setUp(self):
        super().setUp()
        self.stack = Stack(self.sandbox, "live", world_parameter="lidar:world_file")
        self.stack.wait_ready()
        ready = until(lambda: any(node_of(r) == "lidar" and r["code"] == "ok"
                                  for r in self.stack.reports.lines()), 60.0)
        self.assertTrue(ready, self.stack.launch.tails())

    def map(self):
        outcome = self.sandbox.goshawk("topic", "echo", "map/voxels", "--once", "--json",
                                       "--timeout", "20", timeout_s=40)
        self.assertEqual(outcome.status, 0, str(outcome))
        return LiveMap(json.loads(outcome.out))

    def hop(self, start):
        """Flies to the place farthest from the start that the map of this moment leads to.
        @return what the navigator says, and how many voxels are known"""
        live = self.map()
        places = live.places_from(self.stack.place())
        if not places:
            return "nowhere to go", live.known_voxels()
        goal = max(places, key=lambda p: math.dist(p, start))
        state = self.stack.fly_to(goal, timeout_s=60.0)
        self.assertIsNotNone(state, f"no answer to {goal}\n{self.stack.launch.tails()}")
        if state["state"] == "arrived":
            self.assertLess(math.dist(self.stack.place(), goal), REACHED_M)
            return "arrived", live.known_voxels()
        return state["message"], live.known_voxels()

    def test_a_vehicle_flies_by_the_map_that_its_lidar_makes(self):
        start = self.stack.place()
        mapped = until(lambda: self.map().places_from(start), 60.0)
        self.assertTrue(mapped, f"nothing is mapped\n{self.stack.launch.tails()}")
        hops = []
        while len(hops) < MOST_HOPS:
            hops.append(self.hop(start))
            arrived = any(told == "arrived" for told, _ in hops)
            if arrived and math.dist(self.stack.place(), start) >= FAR_M:
                break
        far = math.dist(self.stack.place(), start)
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track(), 0.02)
        note(f"{far:.2f} m from the start after {hops}; the centre came to {clearance:.3f} m of "
             "the true world")
        self.assertTrue(arrived, f"{hops}\n{self.stack.launch.tails()}")
        self.assertGreaterEqual(far, FAR_M, f"{hops}\n{self.stack.launch.tails()}")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)
        self.assertGreater(self.map().known_voxels(), hops[0][1], "the world did not unfold")
        self.check_saved()

    def check_saved(self):
        """What `goshawk map save` writes has obstacles only where the true world has them."""
        file = self.sandbox.folder / "mapped.bt"
        outcome = self.sandbox.goshawk("map", "save", file, "--json", "--timeout", "20")
        saved = self.json_object(outcome)
        self.assertEqual(outcome.status, 0, str(outcome))
        self.assertGreater(saved["free_voxels"], 1000)
        found = second_opinion.OccupiedCubes(file)
        true = second_opinion.OccupiedCubes(self.stack.world)
        size = found.resolution
        far = [cube for cube in found.cubes
               if true.distance([size * (c + 0.5 - 32768) for c in cube], size) >= size]
        self.assertGreater(len(found.cubes), 100)
        self.assertLess(len(far), 0.05 * len(found.cubes))


if __name__ == "__main__":
    harness.main()
