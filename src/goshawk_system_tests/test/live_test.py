#!/usr/bin/python3
"""A flight that begins without a map: a simulated lidar sees the true world, the map server maps
what it sees, and the vehicle flies by that map. Judged by the true world, which no planner has."""

import json
import math

import harness
import second_opinion
from harness import SystemTest, node_of, note, until
from stack import Stack

FAR_M = 1.5  # from the start: this is a flight
MOST_HOPS = 8


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

    def reachable_from(self, point):
        """The centres of the free voxels that steps over faces lead to."""
        start = tuple(math.floor((p - o) / self.resolution) for p, o in zip(point, self.origin))
        reached, open_ends = {start}, [start]
        while open_ends:
            x, y, z = open_ends.pop()
            for step in ((x - 1, y, z), (x + 1, y, z), (x, y - 1, z), (x, y + 1, z), (x, y, z - 1),
                         (x, y, z + 1)):
                if step not in reached and self.is_free(step):
                    reached.add(step)
                    open_ends.append(step)
        return [tuple(o + self.resolution * (v + 0.5) for o, v in zip(self.origin, voxel))
                for voxel in reached]


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
        @return the distance from the start, and how many voxels could be reached"""
        places = self.map().reachable_from(self.stack.place())
        goal = max(places, key=lambda p: math.dist(p, start))
        if math.dist(goal, self.stack.place()) > 0.1:
            state = self.stack.fly_to(goal, timeout_s=120.0)
            self.assertEqual(state and state["state"], "arrived",
                             f"{goal}: {state}\n{self.stack.launch.tails()}")
            self.assertLess(math.dist(self.stack.place(), goal), 0.2)
        return math.dist(goal, start), len(places)

    def test_a_vehicle_flies_by_the_map_that_its_lidar_makes(self):
        start = self.stack.place()
        known = until(lambda: len(self.map().reachable_from(start)) > 1, 60.0)
        self.assertTrue(known, f"nothing is mapped\n{self.stack.launch.tails()}")
        hops = [self.hop(start)]
        while hops[-1][0] < FAR_M and len(hops) < MOST_HOPS:
            hops.append(self.hop(start))
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track())
        note("hops: " + ", ".join(f"{far:.2f} m of {n} voxels" for far, n in hops) +
             f"; the centre came to {clearance:.3f} m of the true world")
        self.assertGreaterEqual(hops[-1][0], FAR_M, self.stack.launch.tails())
        self.assertGreater(clearance, harness.BODY_RADIUS_M)


if __name__ == "__main__":
    harness.main()
