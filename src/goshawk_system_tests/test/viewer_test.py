#!/usr/bin/python3
"""What one looks at: pages of flights, in headless Chromium."""

import json
import math
import os
import pathlib
import shutil
import socket

import harness
from harness import GOSHAWK, SOURCE, SystemTest, note, until
from stack import StackTest

SCRIPTS = SOURCE / "src/goshawk_viewer/test"


def browser_environment(test):
    """What node needs to drive a browser; where a part is absent the test is skipped."""
    modules = pathlib.Path(os.environ.get("GOSHAWK_NODE_MODULES") or
                           SOURCE / "build/node/node_modules")
    chromium = os.environ.get("GOSHAWK_CHROMIUM") or shutil.which("chromium")
    absent = [name for name, there in [("node", shutil.which("node")), ("chromium", chromium),
                                       (f"playwright-core in {modules}",
                                        (modules / "playwright-core").is_dir())] if not there]
    if absent:
        test.skipTest(f"no page is looked at without {', '.join(absent)}: run tools/setup --tests")
    return {"GOSHAWK_NODE_MODULES": str(modules.resolve()), "GOSHAWK_CHROMIUM": str(chromium)}


def look(test, script, *arguments):
    outcome = test.sandbox.call("node", SCRIPTS / script, *arguments, timeout_s=90,
                                env=browser_environment(test))
    test.assertEqual(outcome.status, 0, str(outcome))
    note(outcome.out.strip().replace("\n", "\n    "))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


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

    def test_a_plan_leaves_one_too(self):
        folder = self.sandbox.folder / "plan"
        planned = self.sandbox.goshawk("plan", "--save", folder)
        self.assertEqual(planned.status, 0, str(planned))
        self.assertTrue((folder / "flight.html").is_file())

    def test_view_says_what_is_wrong(self):
        for arguments, status, sentence in [
                (["/nowhere"], 2, "is it a flight folder?"), ([], 2, "no flight in ./flights"),
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
        self.assertIn(f"port {port} cannot be had", outcome.err)


class LiveView(StackTest):
    """The bridge beside a flight: a page that flies it, other viewers' topics, a busy port."""

    launch_file = "flight_view"
    port = free_port()
    ros_args = ("-p", f"viewer_bridge:port:={port}")

    def test_a_click_on_the_page_flies_the_vehicle(self):
        browser_environment(self)
        bridge = f"ws://127.0.0.1:{self.port}"
        view = self.sandbox.start(GOSHAWK, "view", "--live", "--bridge", bridge, "--port", "0",
                                  "--no-open", "--json")
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

    def test_other_viewers_get_markers(self):
        self.assertEqual(self.stack.fly_to((3.0, 0.0, 1.0))["state"], "arrived")
        for topic, wanted in [("view/obstacles", {"obstacles"}),
                              ("view/plan", {"pruned path", "path as searched", "corridor",
                                             "corridor edges", "trajectory"}),
                              ("view/flown", {"flown track"})]:
            with self.subTest(topic=topic):
                outcome = self.sandbox.goshawk("topic", "echo", topic, "--once", "--json",
                                               "--timeout", "10")
                self.assertEqual(outcome.status, 0, str(outcome))
                markers = json.loads(outcome.out)["markers"]
                self.assertEqual({m["ns"] for m in markers}, wanted)
                for marker in markers:
                    self.assertGreater(len(marker["points"]), 1, marker["ns"])

    def test_a_second_bridge_on_the_port_says_so(self):
        outcome = self.sandbox.goshawk("run", "viewer_bridge:second", "--ros-args", "-p",
                                       f"port:={self.port}")
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn(f"port {self.port} of 127.0.0.1 cannot be had", outcome.err)


if __name__ == "__main__":
    harness.main()
