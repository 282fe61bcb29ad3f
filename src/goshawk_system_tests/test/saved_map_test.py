#!/usr/bin/python3
"""Maps that outlive their server: saved and loaded, and kept in its journal."""

import json
import math
import pathlib
import struct

import harness
from harness import GOSHAWK, node_of, note, until
from map_case import MapCase, cloud, first_with, odometry


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
        # Each scan shows 21, and half of them again; some scans may be lost.
        self.assertGreater(told["occupied_voxels"], 100)
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


if __name__ == "__main__":
    harness.main()
