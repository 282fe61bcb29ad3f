#!/usr/bin/python3
"""The map server alone: a map that grows with scans, and a very large one."""

import json
import math
import pathlib
import struct
import time

import harness
from harness import GOSHAWK, Publisher, SystemTest, node_of, note, until

BRICK = (64, 8, 8)  # voxels


STAMP = {"sec": 100, "nanosec": 0}  # of all odometry and clouds: the newest pose places them


def cloud(points, frame="map", **changes):
    """A PointCloud2 of float32 x, y, z."""
    data = b"".join(struct.pack("<fff", *p) for p in points)
    fields = [{"name": n, "offset": 4 * k, "datatype": 7, "count": 1} for k, n in enumerate("xyz")]
    return {"header": {"frame_id": frame, "stamp": STAMP}, "height": 1, "width": len(points), "fields": fields,
            "is_bigendian": False, "point_step": 12, "row_step": 12 * len(points),
            "data": list(data), "is_dense": True, **changes}


def odometry(position, frame="map", child="base_link"):
    x, y, z = position
    return {"header": {"frame_id": frame, "stamp": STAMP}, "child_frame_id": child,
            "pose": {"pose": {"position": {"x": x, "y": y, "z": z}, "orientation": {"w": 1.0}}}}


def bits_of(words, row, x):
    """Bit x of a row of words; words may be numbers or their decimal texts."""
    return int(words[row]) >> x & 1


def first_with(messages, condition=lambda _: True):
    """The first one that fulfils the condition, or None."""
    return next((m for m in messages if condition(m)), None)


class MapCase(SystemTest):
    def setUp(self):
        super().setUp()
        self.publishers = {}

    def tell(self, topic, kind, message):
        if topic not in self.publishers:
            self.publishers[topic] = Publisher(self.sandbox, topic, kind)
        self.publishers[topic].send(message)

    def send_odometry(self, position):
        self.tell("odom", "nav_msgs/msg/Odometry", odometry(position))

    def send_cloud(self, message, effect):
        """Again and again until it has an effect: the reader is best effort and may lose one, or
        take it before the odometry that was sent before. @return the effect"""
        def once_more():
            self.tell("cloud_in", "sensor_msgs/msg/PointCloud2", message)
            return until(effect, 0.1)
        found = until(once_more, 10.0)
        self.assertTrue(found, f"no effect of {str(message)[:300]}")
        return found

    def echo(self, topic, *options):
        return self.sandbox.start(GOSHAWK, "topic", "echo", topic, "--json", "--timeout", "60",
                                  *options)

    def wait_line(self, process, condition=lambda _: True, timeout_s=20.0):
        found = until(lambda: first_with(process.lines(), condition), timeout_s)
        self.assertIsNotNone(found, str(process.outcome()))
        return found

    def run_server(self, *parameters):
        options = [word for p in parameters for word in ("-p", p)]
        server = self.sandbox.start(GOSHAWK, "run", "map_server", "--ros-args", *options)
        reports = self.echo("stage_report")
        self.wait_line(reports, lambda r: r["code"] == "ok" and node_of(r) == "map_server", 60.0)
        return server, reports


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


class SavedMap(MapCase):
    """Maps that a running server gives and takes, what left its window included."""

    WINDOW = ["use_box:=true", "follow_vehicle:=true", "unknown:=free", "resolution_m:=0.2",
              "radius_m:=0.0", "margin_m:=0.0", "box_x_max_m:=12.8", "box_y_max_m:=8.0",
              "box_z_max_m:=3.2", "sensor_timeout_s:=0.0"]

    def fly(self, places):
        """A wall on the left of each place."""
        updates = self.echo("map/voxels/updates")
        self.send_odometry((places[0], 4.1, 1.5))
        for x in places:
            count = len(updates.lines())
            self.send_odometry((x, 4.1, 1.5))
            points = [(x + 0.2 * k, 6.1, 1.5) for k in range(-10, 11)]
            self.send_cloud(cloud(points), lambda: len(updates.lines()) > count)
        updates.stop()

    def map_json(self, *words):
        outcome = self.sandbox.goshawk("map", *words, "--json", timeout_s=60)
        self.assertEqual(outcome.status, 0, str(outcome))
        return self.json_object(outcome)

    def test_a_saved_map_is_taken_by_another_server_and_grows_there(self):
        saved, again = self.sandbox.folder / "saved.bt", self.sandbox.folder / "again.bt"
        server, reports = self.run_server(*self.WINDOW)
        self.fly([3.0 + 2.0 * k for k in range(25)])
        told = self.map_json("save", saved)
        self.assertLess(told["lower_m"][0], 2.0, "what left the window is not in it")
        self.assertGreater(told["upper_m"][0], 40.0)
        self.assertGreater(told["occupied_voxels"], 150)
        server.stop()
        reports.stop()

        server, reports = self.run_server(*self.WINDOW)
        self.map_json("load", saved)
        self.map_json("save", again)
        self.assertTrue(self.map_json("diff", saved, again)["same"])
        self.fly([61.0, 63.0])
        self.map_json("save", again)
        grown = self.map_json("diff", saved, again)
        self.assertGreater(grown["learnt_voxels"], 20)
        self.assertEqual(grown["forgotten_voxels"], 0)
        self.check_refusals(saved)
        server.stop()
        reports.stop()

        # The file as map_file: a flight begins in it.
        self.run_server(*self.WINDOW, f"map_file:={saved}")
        self.map_json("save", again)
        self.assertTrue(self.map_json("diff", saved, again)["same"])

    def check_refusals(self, saved):
        coarse = self.sandbox.folder / "coarse.bt"
        made = self.sandbox.goshawk("world", coarse, "--kind", "forest", "--size", "20,20,5",
                                    "--density", "0.05", "--resolution", "0.5", timeout_s=60)
        self.assertEqual(made.status, 0, str(made))
        for words, code, sentence in [
                (["load", coarse], "invalid_input", "of one size"),
                (["load", self.sandbox.folder / "no.bt"], "map_unreadable", "no.bt"),
                (["load", saved, "--namespace", "/nobody", "--timeout", "1"], "stage_silent",
                 "/nobody/octomap_in")]:
            outcome = self.sandbox.goshawk("map", *words, "--json", timeout_s=60)
            self.assertEqual(outcome.status, 1, str(outcome))
            answer = json.loads(outcome.out)
            self.assertEqual(answer["code"], code, str(outcome))
            self.assertIn(sentence, answer["message"])


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


class JournalOfTheMap(MapCase):
    """A map server that is killed while scans come in goes on with the map that it had."""

    BOX = ["use_box:=true", "unknown:=free", "resolution_m:=0.2", "radius_m:=0.15", "margin_m:=0.05",
           "box_x_max_m:=12.0", "box_y_max_m:=10.0", "box_z_max_m:=4.0", "publish_raw:=true"]

    def setUp(self):
        super().setUp()
        self.journal = self.sandbox.folder / "map.journal"
        self.parameters = [*self.BOX, f"journal_file:={self.journal}"]
        self.updates = self.echo("map/voxels/updates")

    def whole(self):
        return json.loads(self.sandbox.goshawk("topic", "echo", "map/voxels", "--once", "--json",
                                               "--timeout", "30", timeout_s=60).out)

    def scan(self, number):
        """A scan of 40 points from a place that moves, as in flight."""
        angles = [0.31 * k + 0.7 * number for k in range(40)]
        here = (2.0 + 0.2 * (number % 40), 5.0 + 2.0 * math.sin(0.3 * number), 2.0)
        points = [(here[0] + 3.0 * math.cos(a), here[1] + 3.0 * math.sin(a), 1.0 + 0.05 * k)
                  for k, a in enumerate(angles)]
        self.tell("odom", "nav_msgs/msg/Odometry", odometry(here))
        self.tell("cloud_in", "sensor_msgs/msg/PointCloud2", cloud(points))

    def version_of_journal(self):
        """Of the last batch that is whole: entries of 1064 bytes follow a head of 32 bytes."""
        content = self.journal.read_bytes()
        for at in range(32 + 1064 * ((len(content) - 32) // 1064 - 1), 0, -1064):
            version, _, _, _, number, count = struct.unpack_from("<QiiiII", content, at)
            if number + 1 == count:
                return version
        return self.fail("the journal holds no whole batch")

    def map_while_flying(self, scans):
        for number in range(scans):
            self.scan(number)
        self.wait_line(self.updates, lambda u: u["bricks"])

    @staticmethod
    def apply(grid, update):
        """The grid after an update, by this test's own reading of the messages."""
        words_x = (grid["size_x"] + 63) // 64
        for brick in update["bricks"]:
            for row in range(64):
                y, z = 8 * brick["brick_y"] + row % 8, 8 * brick["brick_z"] + row // 8
                if y < grid["size_y"] and z < grid["size_z"]:
                    at = (z * grid["size_y"] + y) * words_x + brick["word_x"]
                    for field in ("grown", "known", "raw"):
                        grid[field][at] = brick[field][row]
        grid["version"] = update["to_version"]

    def voxels(self, grid):
        """{field: bits of every voxel}, without what pads the rows."""
        words_x = (grid["size_x"] + 63) // 64
        keep = [(1 << min(64, grid["size_x"] - 64 * w)) - 1 for w in range(words_x)]
        return {field: [int(word) & keep[k % words_x] for k, word in enumerate(grid[field])]
                for field in ("grown", "known", "raw")}

    def test_after_kill_9_every_voxel_is_as_it_was(self):
        server, reports = self.run_server(*self.parameters)
        grid = self.whole()
        self.map_while_flying(30)
        server.process.kill()
        server.process.wait()
        reports.stop()
        version = self.version_of_journal()
        _, again = self.run_server(*self.parameters)
        restored = self.whole()
        seen = self.updates.lines()
        self.assertGreater(restored["version"], seen[-1]["to_version"], "a version is used twice")
        note(f"killed at version {seen[-1]['to_version']}, restored from version {version}")
        for update in seen:
            if update["from_version"] >= grid["version"] and update["to_version"] <= version:
                self.apply(grid, update)
        self.assertEqual(grid["version"], version, "the journal has a version that nobody saw")
        self.assertGreater(sum(bin(w).count("1") for w in self.voxels(grid)["known"]), 500)
        self.assertEqual(self.voxels(restored), self.voxels(grid))
        ready = first_with(again.lines(), lambda r: "bricks are from its journal" in r["message"])
        self.assertIsNotNone(ready, again.out())

    def test_a_damaged_journal_is_told_and_what_is_whole_is_used(self):
        server, reports = self.run_server(*self.parameters)
        self.map_while_flying(10)
        server.process.kill()
        server.process.wait()
        reports.stop()
        content = bytearray(self.journal.read_bytes())
        self.assertGreater(len(content), 5000)
        content[-1500] ^= 1
        self.journal.write_bytes(content)
        _, again = self.run_server(*self.parameters)
        told = self.wait_line(again, lambda r: r["code"] == "map_malformed")
        self.assertIn("damaged or cut off", told["message"])
        self.assertGreater(sum(bin(int(w)).count("1") for w in self.whole()["known"]), 0)

    def test_a_file_that_is_no_journal_is_put_aside(self):
        self.journal.write_text("a letter, which must not be lost" * 9)
        _, reports = self.run_server(*self.parameters)
        told = self.wait_line(reports, lambda r: r["code"] == "map_malformed")
        aside = pathlib.Path(f"{self.journal}.refused")
        self.assertIn(str(aside), told["message"])
        self.assertIn("a letter", aside.read_text())

    def test_a_disk_that_is_full_is_told_and_the_map_goes_on(self):
        """A limit of the process stands for the disk: writes beyond it fail."""
        script = ("import os, resource, signal, sys\n"
                  "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
                  "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
                  "os.execv(sys.argv[1], sys.argv[1:])\n")
        options = [word for p in self.parameters for word in ("-p", p)]
        server = self.sandbox.start("/usr/bin/python3", "-c", script, GOSHAWK, "run", "map_server",
                                    "--ros-args", *options)
        reports = self.echo("stage_report")
        self.wait_line(reports, lambda r: r["code"] == "ok" and node_of(r) == "map_server", 60.0)
        self.map_while_flying(10)
        told = self.wait_line(reports, lambda r: r["code"] == "io_failed")
        self.assertIn("is lost if the map server dies", told["message"])
        before = len(self.updates.lines())
        self.map_while_flying(20)
        self.assertTrue(until(lambda: len(self.updates.lines()) > before, 20.0))
        self.assertTrue(server.alive())


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
