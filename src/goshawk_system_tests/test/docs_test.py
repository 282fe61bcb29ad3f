#!/usr/bin/python3
"""The pages tell the truth: codes, generated pages, and every command line that they show."""

import concurrent.futures
import re
import shlex
import time

import harness
from harness import SOURCE, SystemTest, note, until
from stack import Stack

PAGES = [SOURCE / "README.md", *sorted((SOURCE / "docs").glob("*.md"))]
# What runs until it is stopped, and how it says that it does its work.
ENDLESS = [(re.compile(r"goshawk launch\b"), lambda text: starts_all(text)),
           (re.compile(r"goshawk run\b"), lambda text: "ready: " in text),
           (re.compile(r"goshawk view\b(?!.*--check)"), lambda text: "open http://" in text),
           (re.compile(r"goshawk topic (echo|hz|delay|bw)\b(?!.*--once)"),
            lambda text: text.count("\n") > 0)]


def starts_all(text):
    """Each of the stages that a launch names runs."""
    named = re.search(r"\[launch\] starting (.*?);", text)
    return named is not None and all(f"[launch] {stage}: running " in text
                                     for stage in named.group(1).split(", "))


def reading_order():
    """The pages as the README names them, which is the order in which a reader meets them."""
    named = re.findall(r"\]\((docs/\w+\.md)\)", (SOURCE / "README.md").read_text(encoding="utf-8"))
    return [SOURCE / "README.md", *dict.fromkeys(SOURCE / name for name in named)]


def made_by(line):
    """The files and folders that a command line leaves behind."""
    return set(re.findall(r"(?:-o|--output|--save|--log-dir|goshawk world|secure init|map crop \S+|"
                          r"map merge|map save) (\S+)", line))


def used_by(line):
    """The files and folders that a command line names: what looks like a path or a file."""
    words = [word.rpartition(":=")[2] for word in line.split()[1:]]
    return {word for word in words if re.fullmatch(r"/tmp/\S+|[\w./]+\.(bt|pcd|ply|mcap|yaml)", word)}


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
        names = re.findall(r'CodeName\{ErrorCode::\w+, "(\w+)"\}',
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
        for page in [*PAGES, *SOURCE.glob("*.md"), *SOURCE.glob("docs/adr/*.md"),
                     *SOURCE.glob("src/*/README.md")]:
            text = re.sub(r"(?m)^    .*$", "", page.read_text())  # code has no links
            for target in re.findall(r"\]\(([^)#:\s]+)(?:#[^)]*)?\)", text):
                with self.subTest(page=page.name, link=target):
                    self.assertTrue((page.parent / target).exists())


class Order(SystemTest):
    def test_every_page_is_named_by_the_readme(self):
        self.assertEqual({page.name for page in PAGES} - {page.name for page in reading_order()},
                         set())

    def test_what_a_page_uses_was_made_before(self):
        """By a line above, or by a page that comes before, in an empty folder."""
        made = set()
        for page in reading_order():
            for line, _ in command_lines(page):
                made |= made_by(line)
                for name in used_by(line):
                    with self.subTest(page=page.name, line=line):
                        self.assertTrue(any(name == there or name.startswith(f"{there}/")
                                            for there in made | {"/path/to"}),
                                        f"nothing made {name}")


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

    def environment(self, name, exports):
        """A page's domain is an example. Tools look at the live stages; what starts stages does
        so in a domain of its own."""
        environment = {k: v for k, v in exports.items() if k != "ROS_DOMAIN_ID"}
        if re.search(r"goshawk (launch|run|fly|bench|replay|conform)", name):
            domain = harness.Domain()
            self.addCleanup(domain.close)
            environment["ROS_DOMAIN_ID"] = str(domain.number)
        return environment

    def here(self, line):
        """The pages' examples write to /tmp and listen on ports that others may have: two runs of
        this test must not meet there."""
        line = line.split("  #")[0].replace("/tmp/", f"{self.sandbox.folder}/")
        if re.search(r"goshawk view\b(?!.*--check)", line):
            line += " --port 0 --no-open"
            line += f" --bridge ws://127.0.0.1:{harness.free_port()}" if "--live" in line else ""
        if "launch flight_view" in line:
            line += " --ros-args -p viewer_bridge:port:=0"
        return line

    def start_line(self, line, exports):
        words = shlex.split(self.here(line))
        words[0] = str(self.sandbox.folder / words[0])
        name = " ".join(line.split()).replace("tools/fly", "goshawk fly")
        return name, self.sandbox.start(*words, env=self.environment(name, exports))

    def check_endless(self, process, works):
        """It says that it does its work, and ends well when it is stopped."""
        until(lambda: works(process.out() + process.err()) or not process.alive(), 60.0)
        self.assertTrue(process.alive(), f"ended by itself: {process.outcome()}")
        self.assertTrue(works(process.out() + process.err()), str(process.outcome()))
        status, _ = process.stop()
        self.assertEqual(status, 0, str(process.outcome()))

    def check_line(self, name, process):
        for pattern, works in ENDLESS:
            if pattern.search(name):
                return self.check_endless(process, works)
        if process.wait(120.0) is None:
            self.fail(f"does not end: {process.outcome()}")
        outcome = process.outcome()
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 0, str(outcome))
        return None

    def faults_of(self, lines):
        """Runs one line after the other. @return what is wrong, by page and line"""
        faults = {}
        for line, (page, exports) in lines.items():
            begin = time.monotonic()
            try:
                self.check_line(*self.start_line(line, exports))
            except AssertionError as fault:
                faults[page, line] = str(fault)
            note(f"{time.monotonic() - begin:6.1f} s  {line}")
        return faults

    def test_every_command_line_of_the_pages(self):
        Stack(self.sandbox).wait_ready()
        lines = {line: (page.name, exports) for page in PAGES
                 for line, exports in command_lines(page)
                 if "/path/to" not in line}
        note(f"{len(lines)} command lines")
        self.assertGreater(len(lines), 8)
        # Worlds come first: flights are made in them.
        worlds = {line: lines.pop(line) for line in list(lines) if "goshawk world" in line}
        faults = self.faults_of(worlds)
        # Flights take their time, and need little of the machine's: the others run meanwhile, and
        # those that look at what a flight left afterwards.
        flights = {line: lines[line] for line in lines
                   if re.match(r"tools/(fly|goshawk campaign)\b", line)}
        folders = [folder for line in flights for folder in re.findall(r"--output (\S+)", line)]
        after = {line: lines[line] for line in lines if line not in flights and any(
            re.search(re.escape(folder) + r"(/|\s|$)", line) for folder in folders)}
        self.assertGreater(len(after), 0)
        others = {line: lines[line] for line in lines if line not in flights | after}
        with concurrent.futures.ThreadPoolExecutor() as pool:
            flown = pool.submit(self.faults_of, flights)
            faults |= {**self.faults_of(others), **flown.result()}
        faults.update(self.faults_of(after))
        for (page, line), fault in faults.items():
            with self.subTest(page=page, line=line):
                self.fail(fault)


if __name__ == "__main__":
    harness.main()
