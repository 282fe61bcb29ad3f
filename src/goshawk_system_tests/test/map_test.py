#!/usr/bin/python3
"""The map server alone: a map that grows with scans, and a very large one."""

import json
import math
import pathlib
import time

import harness
from harness import note, until
from map_case import MapCase, bits_of, cloud, first_with, odometry

BRICK = (64, 8, 8)  # voxels


class LiveMap(MapCase):
    def test_a_scan_changes_bricks_and_the_next_version(self):
        server, reports = self.run_server(
            "use_box:=true", "unknown:=occupied", "resolution_m:=0.2", "radius_m:=0.0",
            "margin_m:=0.0", "box_x_max_m:=10.0", "box_y_max_m:=10.0", "box_z_max_m:=4.0",
            "sensor_timeout_s:=0.0")
        updates = self.echo("map/voxels/updates")
        first = self.wait_line(self.echo("map/voxels", "--once"))
        size = (first["size_x"], first["size_y"], first["size_z"])
        self.assertEqual(size, (50, 50, 20))
        self.assertTrue(all(int(w) == 0 for w in first["known"]), "something is known already")

        # A cloud before any odometry has no sensor: it is refused, and the map stays.
        self.send_cloud(cloud([(6.1, 5.1, 2.1)]), lambda: first_with(
            reports.lines(), lambda r: r["code"] == "tracking_lost"))
        self.assertEqual(updates.lines(), [])
        self.send_odometry((5.1, 5.1, 2.1))
        update = self.send_cloud(cloud([(8.1, 5.1, 2.1)]), lambda: first_with(updates.lines()))
        self.assertGreaterEqual(update["from_version"], first["version"])
        self.assertEqual(update["to_version"], update["from_version"] + 1)
        self.check_ray(update["bricks"], first["origin"])

        # In the body's frame, the same wall from elsewhere.
        self.send_odometry((5.1, 3.1, 2.1))
        second = self.send_cloud(
            cloud([(3.0, 0.0, 0.0)], "base_link"), lambda: first_with(
                updates.lines(), lambda u: self.state(u["bricks"], first["origin"],
                                                      (8.1, 3.1, 2.1)) == "occupied"))
        self.assertGreater(second["to_version"], update["to_version"])

        # A late joiner gets the whole map within a second or two.
        late = until(lambda: self.late_version() >= second["to_version"], 15.0, 0.5)
        self.assertTrue(late, "the latched map stays old")
        self.assertTrue(server.alive())
        self.check_bad_clouds(server, reports)

    def test_after_its_last_change_the_whole_map_is_said_again(self):
        """To whom DDS does not repeat it: who was deaf for longer than its lease."""
        self.run_server("use_box:=true", "resolution_m:=0.2", "sensor_timeout_s:=0.0")
        whole, updates = self.echo("map/voxels", "--no-arr"), self.echo("map/voxels/updates")
        self.send_odometry((5.1, 5.1, 2.1))
        self.send_cloud(cloud([(8.1, 5.1, 2.1)]), lambda: first_with(updates.lines()))

        def said():
            """How often the newest version has come."""
            newest = updates.lines()[-1]["to_version"]
            return sum(m["version"] == newest for m in whole.lines())
        self.assertTrue(until(lambda: said() >= 4, 20.0), f"{said()}: {whole.outcome()}")

    def late_version(self):
        outcome = self.sandbox.goshawk("topic", "echo", "map/voxels", "--once", "--json",
                                       "--no-arr", "--timeout", "60", timeout_s=30)
        return json.loads(outcome.out)["version"]

    def state(self, bricks, origin, point, resolution=0.2):
        voxel = [math.floor((p - origin[a]) / resolution) for p, a in zip(point, "xyz")]
        for brick in bricks:
            at = [v - n * b for v, n, b in
                  zip(voxel, BRICK, (brick["word_x"], brick["brick_y"], brick["brick_z"]))]
            if all(0 <= a < n for a, n in zip(at, BRICK)):
                row = 8 * at[2] + at[1]
                if not bits_of(brick["known"], row, at[0]):
                    return "unknown"
                return "occupied" if bits_of(brick["grown"], row, at[0]) else "free"
        return "unchanged"

    def check_ray(self, bricks, origin):
        self.assertEqual(self.state(bricks, origin, (8.1, 5.1, 2.1)), "occupied")
        for x in (5.3, 6.1, 7.7):
            self.assertEqual(self.state(bricks, origin, (x, 5.1, 2.1)), "free")
        for point in ((9.1, 5.1, 2.1), (6.1, 6.1, 2.1)):
            self.assertEqual(self.state(bricks, origin, point), "unknown")

    def check_bad_clouds(self, server, reports):
        """Each is refused with a sentence that names its own fault, and the server lives."""
        good = [(7.1, 5.1, 2.1)]
        for bad, code, word in [
                (cloud(good, frame="camera"), "wrong_frame", "'camera'"),
                (cloud(good, width=1000), "invalid_input", "1 x 1000 points"),
                (cloud(good, width=1001, row_step=0), "invalid_input", "1 x 1001 points"),
                (cloud(good, height=4_000_000_000), "invalid_input", "4000000000 x 1 points"),
                (cloud(good, point_step=2), "invalid_input", "beyond its point_step of 2 bytes"),
                (cloud(good, is_bigendian=True), "invalid_input", "big-endian"),
                (cloud(good, fields=[]), "invalid_input", "has no field 'x'"),
                (cloud(good, header={"frame_id": "map"}), "invalid_input", "stamp of a cloud is zero"),
                (cloud(good, header={"frame_id": "map", "stamp": {"sec": 99}}), "tracking_lost",
                 "before the oldest pose"),
                (cloud(good, header={"frame_id": "map", "stamp": {"sec": 500}}), "tracking_lost",
                 "after the newest pose")]:
            since = len(reports.lines())
            told = self.send_cloud(bad, lambda: first_with(
                reports.lines()[since:], lambda r: word in r["message"]))
            self.assertEqual(told["code"], code, f"{bad}")
        # What has nothing to say changes nothing, and is no fault: sensors see nothing at times.
        since = len(reports.lines())
        for nothing in (cloud([]), cloud([], fields=[]), cloud([], width=0, height=4_000_000_000, row_step=0),
                        cloud([(math.nan,) * 3])):
            self.tell("cloud_in", "sensor_msgs/msg/PointCloud2", nothing)
        before = self.late_version()
        self.send_cloud(cloud(good), lambda: self.late_version() > before)
        self.assertEqual([r for r in reports.lines()[since:] if r["code"] != "ok"], [])
        self.assertTrue(server.alive())


class SilentSensors(MapCase):
    """A sensor that stops, or sees nothing, is told; so is its return."""

    def scans_until(self, points, condition, frame="map"):
        """Sends the cloud ten times a second."""
        def once_more():
            self.tell("cloud_in", "sensor_msgs/msg/PointCloud2", cloud(points, frame))
            return until(condition, 0.1)
        self.assertTrue(until(once_more, 30.0))

    def test_each_is_told_once_with_its_frame(self):
        _, reports = self.run_server(
            "use_box:=true", "unknown:=free", "sensor_timeout_s:=1.0", "body_radius_m:=0.0")
        self.send_odometry((5.0, 5.0, 2.0))
        here = [(5.0 + 0.1 * k, 5.0, 2.0) for k in range(3)]

        def told(words):
            return [r for r in reports.lines() if words in r["message"]]
        updates = self.echo("map/voxels/updates")
        self.scans_until([(7.1, 5.1, 2.1)], lambda: len(updates.lines()) > 3)
        self.scans_until(here, lambda: told("is its lens covered"))
        self.assertIn("nearer than 0.3 m", told("is its lens covered")[0]["message"])
        self.scans_until([(7.1, 5.1, 2.1)], lambda: told("sees again"))
        # Nothing comes any more. A second sensor, in the body's frame, goes on.
        self.scans_until([(2.0, 0.0, 0.0)], lambda: told("no scan of sensor 'map'"), "base_link")
        self.assertEqual(told("no scan of sensor 'map'")[0]["code"], "stage_silent")


class BigMap(MapCase):
    def memory(self, pid):
        """[MB] resident now, and at most so far."""
        text = pathlib.Path(f"/proc/{pid}/status").read_text()
        values = dict(line.split(":", 1) for line in text.splitlines())
        return tuple(int(values[k].split()[0]) / 1024 for k in ("VmRSS", "VmHWM"))

    def test_a_hundred_million_voxels_reach_a_late_joiner(self):
        world = self.sandbox.folder / "big.bt"
        made = self.sandbox.goshawk("world", world, "--kind", "forest", "--size", "100,100,10",
                                    "--resolution", "0.1", "--density", "0.02", "--json",
                                    timeout_s=120)
        self.assertEqual(made.status, 0, str(made))
        size = self.json_object(made)["size_voxels"]
        self.assertEqual(size, [1000, 1000, 100])
        # What OctoMap's tree and the process itself take: the same server on the same file, but
        # with the grid cut to a small box.
        small, reports = self.run_server(f"map_file:={world}", "use_box:=true", "box_x_max_m:=1.0",
                                         "box_y_max_m:=1.0", "box_z_max_m:=1.0")
        tree_mb, _ = self.memory(small.pid)
        small.stop()
        reports.stop()

        begin = time.monotonic()
        server, _ = self.run_server(f"map_file:={world}")
        ready_s = time.monotonic() - begin
        begin = time.monotonic()
        outcome = self.sandbox.goshawk("topic", "echo", "map/voxels", "--once", "--no-arr",
                                       "--json", "--timeout", "30", timeout_s=60)
        self.assertEqual(outcome.status, 0, str(outcome))
        late_s = time.monotonic() - begin
        grid = json.loads(outcome.out)
        self.assertEqual([grid["size_x"], grid["size_y"], grid["size_z"]], size)
        resident_mb, peak_mb = self.memory(server.pid)
        words = 16 * 1000 * 100
        packed_mb = 2 * words * 8 / 2**20  # grown and known
        note(f"world made in {made.seconds:.1f} s; ready after {ready_s:.1f} s; late joiner after "
             f"{late_s:.2f} s; resident {resident_mb:.0f} MB (at most {peak_mb:.0f}), of that "
             f"tree and process {tree_mb:.0f} MB; bit-packed {packed_mb:.1f} MB: "
             f"{(resident_mb - tree_mb) / packed_mb:.2f} times")
        self.assertLess(resident_mb - tree_mb, 3 * packed_mb)
        self.assertTrue(server.alive())


if __name__ == "__main__":
    harness.main()
