#!/usr/bin/python3
"""What one looks at: pages of flights, in headless Chromium."""

import json
import math
import os
import pathlib
import re
import shutil
import socket

import harness
from harness import GOSHAWK, PREFIX, SOURCE, SystemTest, note, until
from map_case import MapCase, cloud, odometry
from stack import StackTest
from viewer_pages import page_data

SCRIPTS = SOURCE / "src/goshawk_viewer/test"


def browser_environment(test):
    """What node needs to drive a browser; if a part is absent the test is skipped."""
    modules = pathlib.Path(os.environ.get("GOSHAWK_NODE_MODULES") or
                           SOURCE / "build/node/node_modules")
    chromium = os.environ.get("GOSHAWK_CHROMIUM") or shutil.which("chromium")
    absent = [name for name, there in [("node", shutil.which("node")), ("chromium", chromium),
                                       (f"playwright-core in {modules}",
                                        (modules / "playwright-core").is_dir())] if not there]
    if absent:
        test.skipTest(f"no page is looked at without {', '.join(absent)}: run tools/setup --tests")
    return {"GOSHAWK_NODE_MODULES": str(modules.resolve()), "GOSHAWK_CHROMIUM": str(chromium)}


def studio_environment(test):
    """The same with Foxglove Studio, which npm brings."""
    environment = browser_environment(test)
    modules = pathlib.Path(environment["GOSHAWK_NODE_MODULES"])
    for name in ("@foxglove/studio-base", "react", "react-dom"):
        if not (modules / name).is_dir():
            test.skipTest(f"Foxglove Studio is not looked at without {name} in {modules}: run "
                          "tools/setup --tests")
    return environment


def look(test, script, *arguments):
    outcome = test.sandbox.call("node", SCRIPTS / script, *arguments, timeout_s=600,
                                env=browser_environment(test))
    test.assertEqual(outcome.status, 0, str(outcome))
    note(outcome.out.strip().replace("\n", "\n    "))


class FlightPage(SystemTest):
    def test_a_flight_leaves_a_page_that_works_alone(self):
        browser_environment(self)
        folder = self.sandbox.folder / "flight"
        flown = self.sandbox.goshawk("fly", "--output", folder, timeout_s=60)
        self.assertEqual(flown.status, 0, str(flown))
        self.assertIn(str(folder / "flight.html"), flown.out)
        page = (folder / "flight.html").read_text(encoding="utf-8")
        self.assertIn("MIT License", page)
        for outside in ('src="http', "src='http", '@import', 'href="http'):
            self.assertNotIn(outside, page)
        look(self, "flight_page_test.mjs", folder / "flight.html")
        self.recording_shows_the_same(folder)
        self.studio_shows_the_recording(folder)

    def recording_shows_the_same(self, folder):
        """The page that is made from the recording alone has what the flight's own page has."""
        page = self.sandbox.folder / "recording.html"
        made = self.sandbox.call(PREFIX / "lib/goshawk/recording_page", folder / "flight.mcap",
                                 PREFIX / "share/goshawk/viewer/page.html", page)
        self.assertEqual((made.status, made.err), (0, ""), str(made))
        live, later = (page_data(p) for p in (folder / "flight.html", page))
        self.assertEqual(len(live["legs"]), len(later["legs"]))
        for of_flight, of_recording in zip(live["legs"], later["legs"]):
            for part in ("waypoints", "raw", "pieces", "corridor"):
                self.assertEqual(of_flight[part], of_recording[part], part)
        for part in ("obstacles", "grown"):
            self.assertGreater(len(later[part]["runs"]), 100, part)
        self.assertGreater(len(later["flown"]["t"]), 50)
        self.assertLess(math.dist(live["flown"]["p"][-3:], later["flown"]["p"][-3:]), 0.1)

    def studio_shows_the_recording(self, folder):
        with self.subTest("Foxglove Studio"):
            environment = studio_environment(self)
            view = self.sandbox.start(GOSHAWK, "view", "--foxglove", folder, "--port", "0",
                                      "--no-open", "--json", env=environment)
            shown = until(view.lines, 60.0)
            self.assertTrue(shown and shown[0]["ok"], str(view.outcome()))
            look(self, "studio_page_test.mjs", shown[0]["url"], "recording")
            self.assertEqual(view.stop()[0], 0, str(view.outcome()))

    def test_view_of_recordings_that_are_none_or_cut_off(self):
        sample = self.sandbox.folder / "plan.mcap"
        foreign = self.sandbox.folder / "foreign.mcap"
        foreign.write_bytes(b"not a recording" * 100)
        folder = self.sandbox.folder / "plan"
        folder.mkdir()
        for what, sentence in [(foreign, "is not an MCAP recording"), (sample, "cannot be read"),
                               (folder, "is it a flight folder, or a recording?")]:
            with self.subTest(what=what.name):
                outcome = self.sandbox.goshawk("view", what, "--check")
                self.assert_civil(outcome)
                self.assertEqual(outcome.status, 2, str(outcome))
                self.assertIn(sentence, outcome.err)

    def test_without_the_studio_view_says_how_to_get_it(self):
        outcome = self.sandbox.goshawk("view", "--foxglove", "--live", "--no-open",
                                       env={"GOSHAWK_NODE_MODULES": "/nowhere"})
        self.assertEqual(outcome.status, 1, str(outcome))
        self.assertIn("tools/setup --viewer", outcome.err)

    def test_a_plan_leaves_one_too(self):
        folder = self.sandbox.folder / "plan"
        planned = self.sandbox.goshawk("plan", "--save", folder)
        self.assertEqual(planned.status, 0, str(planned))
        self.assertTrue((folder / "flight.html").is_file())

    def test_view_says_what_is_wrong(self):
        for arguments, status, sentence in [
                (["/nowhere"], 2, "is it a flight folder"), ([], 2, "no flight in ./flights"),
                (["x", "--live"], 2, "one of them"), (["--port", "70000"], 2, "65535"),
                (["--live", "--bridge", "http://x"], 2, "ws://127.0.0.1:8765")]:
            with self.subTest(arguments=arguments):
                outcome = self.sandbox.goshawk("view", "--no-open", *arguments)
                self.assert_civil(outcome)
                self.assertEqual(outcome.status, status, str(outcome))
                self.assertIn(sentence, outcome.err)

    def test_view_on_a_busy_port(self):
        folder = self.sandbox.folder / "plan"
        self.sandbox.goshawk("plan", "--save", folder)
        with socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            port = taken.getsockname()[1]
            outcome = self.sandbox.goshawk("view", folder, "--no-open", "--port", port)
        self.assertEqual(outcome.status, 1, str(outcome))
        self.assertIn(f"port {port} cannot be used", outcome.err)


def place(x, y, z):
    return {"x": x, "y": y, "z": z}


WHOLE = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
MOVERS = {"header": {"frame_id": "map"}, "boxes": [
    {"id": 7, "kind": "person", "pose": {"position": place(4.0, 4.0, 0.9), "orientation": WHOLE},
     "half_extents": place(0.3, 0.3, 0.9)}]}
PREDICTIONS = {"header": {"frame_id": "map"}, "version": 1, "obstacles": [
    {"id": 7, "kind": "person", "half_extents": place(0.3, 0.3, 0.9), "orientation": WHOLE,
     "track": [{"duration": 2.0, "control_points": [place(4.0, 4.0, 0.9), place(6.0, 4.0, 0.9)]}],
     "error": 0.1, "error_rate": 0.2, "valid_until": 2.0, "top_speed": 2.0}]}


class LiveMapView(MapCase):
    def test_a_map_that_scans_change_is_drawn_anew(self):
        environment = browser_environment(self)
        self.run_server("use_box:=true", "unknown:=occupied", "resolution_m:=0.2", "radius_m:=0.0",
                        "margin_m:=0.0", "box_x_max_m:=10.0", "box_y_max_m:=10.0",
                        "box_z_max_m:=4.0", "publish_raw:=true")
        for topic, kind, message in [
                ("odom", "nav_msgs/msg/Odometry", odometry((5.1, 5.1, 2.1))),
                ("cloud_in", "sensor_msgs/msg/PointCloud2", cloud([(8.1, 5.1, 2.1)])),
                ("points", "sensor_msgs/msg/PointCloud2", cloud([(8.1, 5.1, 2.1)])),
                ("movers", "goshawk_msgs/msg/MovingBoxes", MOVERS),
                ("obstacles", "goshawk_msgs/msg/PredictedObstacles", PREDICTIONS)]:
            self.sandbox.start(GOSHAWK, "topic", "pub", topic, kind, json.dumps(message), "-r", "5",
                               "-n", "100000", "--timeout", "600")  # until the page reads it
        view = self.sandbox.start(GOSHAWK, "view", "--live", "--bridge",
                                  f"ws://127.0.0.1:{harness.free_port()}", "--port", "0", "--no-open",
                                  "--json", env=environment)
        shown = until(view.lines, 15.0)
        self.assertTrue(shown and shown[0]["ok"], str(view.outcome()))
        look(self, "live_map_test.mjs", shown[0]["url"])
        self.assertEqual(view.stop()[0], 0, str(view.outcome()))


NEAR = (3.5, 6.1, 1.1)  # two metres from where the layout's goal is


class LiveView(StackTest):
    """The bridge beside a flight: a page that flies it, other viewers' topics, a busy port."""

    launch_file = "flight_view"
    page_port = harness.free_port()
    ros_args = ("-p", "viewer_bridge:port:=0",
                "-p", f"viewer_bridge:origins:=http://127.0.0.1:{page_port}")

    @property
    def port(self):
        """Any that was free, as the bridge says."""
        log = self.stack.launch.logs / "viewer_bridge.log"
        said = until(lambda: re.search(r"listens on ws://127\.0\.0\.1:(\d+)", log.read_text()), 20.0)
        self.assertTrue(said, self.stack.launch.tails())
        return int(said.group(1))

    def test_a_click_on_the_page_flies_the_vehicle(self):
        browser_environment(self)
        bridge = f"ws://127.0.0.1:{self.port}"
        view = self.sandbox.start(GOSHAWK, "view", "--live", "--bridge", bridge, "--port",
                                  str(self.page_port), "--no-open", "--json")
        shown = until(view.lines, 15.0)
        self.assertTrue(shown and shown[0]["ok"], str(view.outcome()))
        since = len(self.stack.states.lines())
        goal = (3.0, 8.0, 2.0)
        look(self, "live_page_test.mjs", shown[0]["url"], bridge, *goal)
        state = self.stack.wait_state({"arrived", "failed"}, since, 10.0)
        self.assertEqual(state and state["state"], "arrived", str(state))
        self.assertLess(math.dist(self.stack.place(), goal), 0.2)
        status, _ = view.stop()
        self.assertEqual(status, 0, str(view.outcome()))

    def test_foxglove_studio_flies_it_too(self):
        environment = studio_environment(self)
        # The goal of its layout is (3, 8, 2).
        self.assertEqual(self.stack.fly_to(NEAR)["state"], "arrived")
        view = self.sandbox.start(GOSHAWK, "view", "--foxglove", "--live", "--bridge",
                                  f"ws://127.0.0.1:{self.port}", "--port", str(self.page_port),
                                  "--no-open", "--json", env=environment)
        shown = until(view.lines, 60.0)
        self.assertTrue(shown and shown[0]["ok"], str(view.outcome()))
        since = len(self.stack.states.lines())
        look(self, "studio_page_test.mjs", shown[0]["url"], "live")
        state = self.stack.wait_state({"arrived", "failed"}, since, 20.0)
        self.assertEqual(state and state["state"], "arrived", str(state))
        self.assertLess(math.dist(self.stack.place(), (3.0, 8.0, 2.0)), 0.2)
        self.assertEqual(view.stop()[0], 0, str(view.outcome()))

    def test_other_viewers_get_markers(self):
        self.assertEqual(self.stack.fly_to(NEAR)["state"], "arrived")
        for topic, wanted in [("view/obstacles", {"obstacles"}), ("markers", {"corridor"}),
                              ("view/plan", {"pruned path", "path as searched", "corridor",
                                             "corridor edges", "trajectory"}),
                              ("view/flown", {"flown track"})]:
            with self.subTest(topic=topic):
                outcome = self.sandbox.goshawk("topic", "echo", topic, "--once", "--json",
                                               "--timeout", "60")
                self.assertEqual(outcome.status, 0, str(outcome))
                markers = json.loads(outcome.out)["markers"]
                self.assertEqual({m["ns"] for m in markers}, wanted)
                for marker in markers:
                    self.assertGreater(len(marker["points"]), 1, marker["ns"])
        line = json.loads(self.sandbox.goshawk("topic", "echo", "path_line", "--once", "--json",
                                               "--timeout", "60").out)["poses"]
        end = line[-1]["pose"]["position"]
        self.assertLess(math.dist((end["x"], end["y"], end["z"]), NEAR), 1e-6)

    def test_a_page_that_the_bridge_does_not_know_is_refused(self):
        outcome = self.sandbox.goshawk("view", "--live", "--bridge", f"ws://127.0.0.1:{self.port}",
                                       "--port", "0", "--no-open")
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 1, str(outcome))
        self.assertIn("-p origins:=http://127.0.0.1:", outcome.err)

    def test_a_second_bridge_on_the_port_says_so(self):
        outcome = self.sandbox.goshawk("run", "viewer_bridge:second", "--ros-args", "-p",
                                       f"port:={self.port}")
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn(f"port {self.port} of 127.0.0.1 cannot be used", outcome.err)


if __name__ == "__main__":
    harness.main()
