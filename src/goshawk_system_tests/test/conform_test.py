#!/usr/bin/python3
"""`goshawk conform`: our stages pass every item, and so do the templates as users build them."""

import json

import harness
from harness import GOSHAWK, SOURCE, SystemTest, note


# Templates, and how they are configured as their users would.
TEMPLATES = {
    "search_stage_c": [f"-DIDL={SOURCE / 'idl'}",
                       f"-DSOURCES={SOURCE / 'src/goshawk_system_tests/cyclone'}"],
    "search_stage_cpp": [f"-DCMAKE_PREFIX_PATH={harness.PREFIX}"],
}


class Conform(SystemTest):
    @classmethod
    def setUpClass(cls):
        """The templates are compiled while others are examined: alone, with what is installed."""
        cls.builder = harness.Sandbox()
        cls.builds = {}
        for template, options in TEMPLATES.items():
            folder = cls.builder.folder / template
            cls.builds[template] = cls.builder.start(
                "/bin/sh", "-c", 'cmake -S "$1" -B "$2" -DCMAKE_BUILD_TYPE=Debug "$3" '
                '${4:+"$4"} && cmake --build "$2"', "-", SOURCE / "docs" / "templates" / template,
                folder, *options)

    @classmethod
    def tearDownClass(cls):
        left = cls.builder.close()
        if left:
            raise AssertionError(f"processes outlived the test: {left}")

    def start(self, *arguments):
        """In a domain of its own: several may run at once."""
        domain = harness.Domain()
        self.addCleanup(domain.close)
        return self.sandbox.start(GOSHAWK, "conform", *arguments, "--json",
                                  env={"ROS_DOMAIN_ID": str(domain.number)})

    def result(self, process):
        self.assertIsNotNone(process.wait(60.0), f"does not end: {process.outcome()}")
        outcome = process.outcome()
        self.assert_civil(outcome)
        return outcome, self.json_object(outcome)

    def conform(self, *arguments):
        return self.result(self.start(*arguments))

    def failed(self, report):
        return {item["name"]: item["detail"] for item in report["items"] if not item["passed"]}

    def test_every_stage_of_ours_passes(self):
        # At once: the kits wait most of the time, that of a tracker flies.
        started = {stage: self.start(stage, "-n", "20") for stage in (
            "path_search", "corridor_builder", "trajectory_optimizer", "tracker", "map_server")}
        for stage, process in started.items():
            with self.subTest(stage=stage):
                outcome, report = self.result(process)
                self.assertEqual(self.failed(report), {})
                self.assertEqual(outcome.status, 0)
                self.assertGreaterEqual(len(report["items"]), 15)
                note(f"{stage}: {len(report['items'])} items, {report['latency']['p50_ms']:.2f} ms")

    def test_the_search_in_c_passes_and_answers_what_was_recorded(self):
        recording = self.sandbox.folder / "out" / "flight.mcap"
        # Near the place where the kit's vehicle is, which flies there in its own time.
        outcome = self.sandbox.goshawk("fly", "--start", "1.5,2,1.5", "--goal", "3,0,1", "--output",
                                       recording.parent, timeout_s=90)
        self.assertEqual(outcome.status, 0, str(outcome))
        tracker = self.start("tracker", "--input", recording)
        program = harness.PREFIX / "bin" / "goshawk_cyclone_search"
        report = self.passes("path_search", program, "--input", recording)
        self.assertEqual(report["implementation"], "cyclone_bfs")
        names = {item["name"] for item in report["items"]}
        self.assertLessEqual({"answers every recorded request", "solves what was solved before",
                              "results of recorded requests are valid"}, names)
        outcome, report = self.result(tracker)
        self.assertEqual(self.failed(report), {})
        self.assertIn("flies recorded trajectory", str(report["items"]))

    def passes(self, stage, program, *arguments):
        """The program alone, as the stage: every item."""
        file = self.sandbox.folder / f"{program.name}.yaml"
        file.write_text(json.dumps({"stages": [{"command": [str(program)], "name": program.name}]}))
        outcome, report = self.conform(stage, "--launch", file, "-n", "10", *arguments)
        self.assertEqual(self.failed(report), {}, str(outcome))
        self.assertEqual(outcome.status, 0)
        return report

    def built(self, template):
        """@return the program that a template became"""
        process = self.builds[template]
        self.assertIsNotNone(process.wait(300.0), str(process.outcome()))
        self.assertEqual(process.outcome().status, 0, str(process.outcome()))
        return self.builder.folder / template / "my_search"

    def test_the_template_in_c_is_built_from_idl_alone_and_passes(self):
        self.passes("path_search", self.built("search_stage_c"))

    def test_the_template_in_cpp_is_built_with_what_is_installed_and_passes(self):
        self.passes("path_search", self.built("search_stage_cpp"))

    def test_wrong_calls_and_an_empty_domain_are_sentences(self):
        outcome, report = self.conform("path_serch")
        self.assertEqual((outcome.status, report["code"]), (2, "invalid_parameter"))
        self.assertIn("path_search", report["message"])


if __name__ == "__main__":
    harness.main()
