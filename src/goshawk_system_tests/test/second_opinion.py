"""How near a track came to the obstacles of a map file, found without any code of the planner."""

import math
import pathlib
import re


class OccupiedCubes:
    """The occupied cubes of an OctoMap .bt file, read here once more: an opinion that shares no
    code with what it judges."""

    DEPTH = 16

    def __init__(self, path):
        content = pathlib.Path(path).read_bytes()
        head, self.bytes = content.split(b"\ndata\n", 1)
        self.resolution = float(re.search(rb"\nres ([0-9.eE+-]+)", head).group(1))
        self.at = 0
        self.cubes = set()
        self.read(0, (0, 0, 0))

    def read(self, depth, key):
        bits = int.from_bytes(self.bytes[self.at:self.at + 2], "little")
        self.at += 2
        size = 1 << (self.DEPTH - depth - 1)
        inner = []
        for child in range(8):
            kind = bits >> (2 * child) & 3
            corner = tuple(k + size * (child >> axis & 1) for axis, k in enumerate(key))
            if kind == 3:
                inner.append(corner)
            elif kind == 2:
                self.cubes.update((corner[0] + x, corner[1] + y, corner[2] + z)
                                  for x in range(size) for y in range(size) for z in range(size))
        for corner in inner:
            self.read(depth + 1, corner)

    def distance(self, point, most=0.6):
        """[m] from the point to the nearest occupied cube, or `most`."""
        r = self.resolution
        key = [math.floor(p / r) + 32768 for p in point]
        reach = math.ceil(most / r)
        nearest = most
        offsets = range(-reach, reach + 1)
        for x in offsets:
            for y in offsets:
                for z in offsets:
                    cube = (key[0] + x, key[1] + y, key[2] + z)
                    if cube not in self.cubes:
                        continue
                    gap = [max((c - 32768) * r - p, p - (c - 32767) * r, 0.0)
                           for c, p in zip(cube, point)]
                    nearest = min(nearest, math.hypot(*gap))
        return nearest


def smallest_clearance(world, track, step_m=0.01):
    """[m] from the track to the nearest obstacle: of the samples at least step_m apart."""
    cubes = OccupiedCubes(world)
    smallest, last = math.inf, None
    for point in track:
        if last is not None and math.dist(point, last) < step_m:
            continue
        last = point
        smallest = min(smallest, cubes.distance(point))
    return smallest
