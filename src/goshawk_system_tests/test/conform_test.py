#!/usr/bin/python3
"""`goshawk conform`: our stages pass every item, and so do the templates as users build them."""

import json

import harness
from harness import GOSHAWK, SOURCE, SystemTest, note


class Conform(SystemTest):
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
        # That of a tracker flies, and waits most of the time: the others are examined meanwhile.
        tracker = self.start("tracker", "-n", "20")
        for stage in ("path_search", "corridor_builder", "trajectory_optimizer", "map_server",
                      "tracker"):
            with self.subTest(stage=stage):
                outcome, report = self.result(tracker if stage == "tracker" else
                                              self.start(stage, "-n", "20"))
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
        self.assertLessEqual({"answers every recorded request", "solves what was solved",
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

    def build(self, template, *options):
        """A template as its users have it: alone, with what is installed. @return its program"""
        folder = self.sandbox.folder / template
        outcome = self.sandbox.call("cmake", "-S", SOURCE / "docs" / "templates" / template, "-B",
                                    folder, "-DCMAKE_BUILD_TYPE=Debug", *options, timeout_s=60)
        self.assertEqual(outcome.status, 0, str(outcome))
        outcome = self.sandbox.call("cmake", "--build", folder, timeout_s=300)
        self.assertEqual(outcome.status, 0, str(outcome))
        return folder / "my_search"

    def test_the_template_in_c_is_built_from_idl_alone_and_passes(self):
        program = self.build("search_stage_c", f"-DIDL={SOURCE / 'idl'}",
                             f"-DSOURCES={SOURCE / 'src/goshawk_system_tests/cyclone'}")
        self.passes("path_search", program)

    def test_the_template_in_cpp_is_built_with_what_is_installed_and_passes(self):
        prefixes = f"-DCMAKE_PREFIX_PATH={harness.PREFIX}"
        program = self.build("search_stage_cpp", prefixes)
        self.passes("path_search", program)

    def test_wrong_calls_and_an_empty_domain_are_sentences(self):
        outcome, report = self.conform("path_serch")
        self.assertEqual((outcome.status, report["code"]), (2, "invalid_parameter"))
        self.assertIn("path_search", report["message"])


if __name__ == "__main__":
    harness.main()
