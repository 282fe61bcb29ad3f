#!/usr/bin/python3
"""What one looks at: pages of flights, in headless Chromium."""

import os
import pathlib
import shutil

import harness
from harness import SOURCE, SystemTest, note

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


if __name__ == "__main__":
    harness.main()
