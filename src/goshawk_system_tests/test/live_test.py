#!/usr/bin/python3
"""A flight that begins without a map: a simulated lidar sees the true world, the map server maps
what it sees, and the vehicle flies by that map. Judged by the true world, which no planner has."""

import json
import math

import harness
import second_opinion
from harness import SystemTest, node_of, note, until
from stack import Stack

FAR_M = 1.5  # a flight of this length is one


class LiveMap:
    """The newest map/voxels: which voxels are free for the vehicle's centre."""

    def __init__(self, message):
        self.size = [message[f"size_{axis}"] for axis in "xyz"]
        self.origin = [message["origin"][axis] for axis in "xyz"]
        self.resolution = message["resolution"]
        self.known = [int(word) for word in message["known"]]
        self.grown = [int(word) for word in message["grown"]]

    def free_places(self):
        """The centres of the free voxels. Rows are 64-bit words along x, y faster than z."""
        words = (self.size[0] + 63) // 64
        for z in range(self.size[2]):
            for y in range(self.size[1]):
                for x in range(self.size[0]):
                    word = (z * self.size[1] + y) * words + x // 64
                    if self.known[word] & ~self.grown[word] & (1 << x % 64):
                        yield tuple(o + self.resolution * (i + 0.5)
                                    for o, i in zip(self.origin, (x, y, z)))


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

    def far_places(self):
        """Free places on the map of this moment, the farthest from the vehicle first, no two of
        them near each other."""
        here = self.stack.place()
        places = []
        for p in sorted(self.map().free_places(), key=lambda p: -math.dist(p, here)):
            if math.dist(p, here) >= FAR_M and all(math.dist(p, q) > 0.5 for q in places):
                places.append(p)
        return places

    def fly_far(self):
        """Flies to the farthest place that can be reached. @return it, or None"""
        for place in self.far_places()[:8]:
            state = self.stack.fly_to(place, timeout_s=120.0)
            self.assertIsNotNone(state, f"no end of the flight to {place}\n"
                                 f"{self.stack.launch.tails()}")
            if state["state"] == "arrived":
                self.assertLess(math.dist(self.stack.place(), place), 0.2)
                return place
            note(f"{place}: {state['code']}")
        return None

    def test_a_vehicle_flies_by_the_map_that_its_lidar_makes(self):
        known = until(lambda: sum(1 for _ in self.map().free_places()) > 100, 60.0)
        self.assertTrue(known, f"nothing is mapped\n{self.stack.launch.tails()}")
        reached = self.fly_far()
        self.assertIsNotNone(reached, f"no place is reached\n{self.stack.launch.tails()}")
        clearance = second_opinion.smallest_clearance(self.stack.world, self.stack.track())
        note(f"reached {reached}; the centre came to {clearance:.3f} m of the true world")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)


if __name__ == "__main__":
    harness.main()
