#!/usr/bin/python3
"""A flight that begins without a map, to a goal that nobody has seen: a simulated lidar sees the
true world, the map server maps what it sees, and the vehicle flies by that map. Judged by the true
world, which no planner has."""

import csv

import harness
import second_opinion
import viewer_pages
from harness import GOSHAWK, SystemTest, note

WALL_M = 8.0  # the world is so long, from the start to the goal


class LiveFlight(SystemTest):
    def fly(self, folder):
        outcome = self.sandbox.goshawk("fly", "--live", "--json", "--output", folder,
                                       timeout_s=240.0)
        logs = "".join(f"\n--- {p.name}\n{p.read_text(errors='replace')[-600:]}"
                       for p in sorted((folder / "logs").glob("*.log")))
        self.assertEqual(outcome.status, 0, str(outcome) + logs)
        return self.json_object(outcome)

    def track(self, folder):
        with open(folder / "flown.csv", encoding="utf-8", newline="") as file:
            return [tuple(float(row[f"{axis}_m"]) for axis in "xyz")
                    for row in csv.DictReader(file)]

    def test_a_goal_that_was_never_seen_is_reached_by_the_map_that_the_lidar_makes(self):
        commits = self.sandbox.start(GOSHAWK, "topic", "echo", "committed_trajectory", "--json",
                                     "--timeout", "240")
        folder = self.sandbox.folder / "out"
        flight = self.fly(folder)
        self.assertEqual((flight["code"], flight["verdict"]), ("ok", "safe"))
        leg = flight["legs"][0]
        self.assertTrue(leg["arrived"], leg)
        self.assertGreater(leg["commits"], 1)
        self.assertEqual(leg["tracking"], flight["tracking"], "of all that was flown to the one goal")
        track = self.track(folder)
        clearance = second_opinion.smallest_clearance(folder / "world.bt", track, 0.02)
        with_stop = [c for c in commits.lines() if c["stop_pieces"]]
        note(f"{leg['flight_time_s']:.1f} s, {len(commits.lines())} commits, {len(with_stop)} with "
             f"a stop part; the centre came to {clearance:.3f} m of the true world")
        self.assertGreater(clearance, harness.BODY_RADIUS_M)
        self.assertGreater(abs(track[-1][1] - track[0][1]), 0.9 * WALL_M)
        self.assertGreater(len(with_stop), 1, "the world did not unfold")
        for name in ("top.png", "side.png", "growth.png", "flight.html", "flight.mcap"):
            self.assertTrue((folder / name).is_file(), name)
        self.assertIsNone(flight["why"], "of a flight that arrived")
        self.page_plays_the_growth(folder)

    def page_plays_the_growth(self, folder):
        """The page's map begins with nothing; it ends with walls where the world has some."""
        page = viewer_pages.page_data(folder / "flight.html")
        growth = page["growth"]
        seen = [len(viewer_pages.voxels_after(growth, k)[0]) for k in (1, len(growth["moments"]))]
        note(f"{len(growth['moments'])} moments, {seen[0]} to {seen[1]} known voxels")
        self.assertLess(seen[0], 0.5 * seen[1])
        times = [m["t"] for m in growth["moments"]]
        self.assertEqual(times, sorted(times))
        self.assertEqual(page["stops"][1:], [[3.0, 8.0, 2.0]], "goals are goals, not commits' ends")
        self.assertTrue(any(leg["stop_after"] > 0 and leg["nominal"] for leg in page["legs"]))

    def test_a_launch_file_without_a_lidar_is_refused(self):
        outcome = self.sandbox.goshawk("fly", "--live", "--launch", "flight", timeout_s=120.0)
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("a sensor named lidar", outcome.err)


if __name__ == "__main__":
    harness.main()
