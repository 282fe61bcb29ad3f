#!/usr/bin/python3
"""The pages tell the truth: codes, generated pages, and every command line that they show."""

import os
import re
import shlex
import subprocess

import harness
from harness import SOURCE, SystemTest, note

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
# What runs until it is stopped: it must live this long.
ENDLESS = re.compile(r"goshawk (launch|run|topic (echo|hz|delay|bw))\b")
LIVES_S = 3.0


def command_lines(path):
    """Indented lines that begin with tools/goshawk or tools/fly, with or without a prompt, and
    the exports that stand in the same block before them."""
    exports = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        match = re.match(r"\s{4,}(?:\$ )?(.*)", line)
        if not match:
            if line.strip():
                exports = {}
            continue
        text = match.group(1)
        if text.startswith("export "):
            name, value = text.removeprefix("export ").split("=", 1)
            exports[name] = value
        elif re.match(r"tools/(goshawk|fly)\b", text):
            yield text, dict(exports)


class Pages(SystemTest):
    def test_every_error_code_has_a_row_in_troubleshooting(self):
        names = re.findall(r'Named\{ErrorCode::\w+, "(\w+)"\}',
                           (SOURCE / "src/goshawk_core/src/error.cpp").read_text())
        self.assertGreater(len(names), 20)
        rows = [line.split("|")[1] for line in
                (SOURCE / "docs/troubleshooting.md").read_text().splitlines()
                if line.startswith("|")]
        told = {code for row in rows for code in re.findall(r"`(\w+)`", row)}
        self.assertEqual(set(names) - told, set(), "codes without a row")
        self.assertEqual(told - set(names), set(), "rows of codes that do not exist")

    def test_generated_pages_are_fresh(self):
        outcome = self.sandbox.call("/usr/bin/python3", SOURCE / "tools/docs", "--check",
                                    cwd=SOURCE, timeout_s=60)
        self.assertEqual(outcome.status, 0, str(outcome))

    def test_links_lead_somewhere(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", page.read_text()):
                with self.subTest(page=page.name, link=target):
                    self.assertTrue((page.parent / target).exists())


class Commands(SystemTest):
    """Each runs as it stands, in a folder of its own, with the installed programs."""

    def setUp(self):
        super().setUp()
        tools = self.sandbox.folder / "tools"
        tools.mkdir()
        # What the scripts start, without setting up and building once more.
        for name, words in (("goshawk", ""), ("fly", "fly ")):
            script = tools / name
            script.write_text(f'#!/bin/sh\nexec {shlex.quote(harness.GOSHAWK)} {words}"$@"\n')
            script.chmod(0o755)
        self.other = harness.Domain()
        self.addCleanup(self.other.close)
        parameters = self.sandbox.folder / "my.yaml"
        parameters.write_text("path_search:\n  ros__parameters:\n    planner: astar\n")

    def environment(self, name, exports):
        """A page's domain is an example. Tools look at the live stages; what starts stages does
        so in another domain."""
        environment = {k: v for k, v in exports.items() if k != "ROS_DOMAIN_ID"}
        if re.search(r"goshawk (launch|run|fly|bench)", name):
            environment["ROS_DOMAIN_ID"] = str(self.other.number)
        return environment

    def run_line(self, line, exports):
        words = shlex.split(line.split("  #")[0])
        words[0] = str(self.sandbox.folder / words[0])
        name = " ".join(line.split()).replace("tools/fly", "goshawk fly")
        if ENDLESS.search(name):
            process = self.sandbox.start(*words, env=self.environment(name, exports))
            status = process.wait(LIVES_S)
            if status is None:
                status, _ = process.stop()
                self.assertIn(status, (0, 1), str(process.outcome()))
            elif "topic" in name:  # --once, or nobody is there: a sentence
                self.assertIn(status, (0, 1), str(process.outcome()))
            else:
                self.fail(f"ended by itself: {process.outcome()}")
            return
        outcome = self.sandbox.call(*words, env=self.environment(name, exports), timeout_s=120)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 0, str(outcome))

    def test_every_command_line_of_the_pages(self):
        harness.Stack(self.sandbox).wait_ready()
        done = set()
        for page in PAGES:
            for line, exports in command_lines(page):
                if line in done or "my_map" in line or "/path/to" in line:
                    continue
                done.add(line)
                with self.subTest(page=page.name, line=line):
                    self.run_line(line, exports)
        note(f"{len(done)} command lines")
        self.assertGreater(len(done), 8)


if __name__ == "__main__":
    harness.main()
