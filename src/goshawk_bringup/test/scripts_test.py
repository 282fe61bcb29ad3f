"""Tests of the launch's parts, without a stack."""

import os
import pathlib
import shlex
import socket
import subprocess
import sys
import tempfile
import time
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import launch_file  # noqa: E402
import stage_names  # noqa: E402
import supervision  # noqa: E402
from launch_file import WrongCall  # noqa: E402

ODD = ["100%", " #1; x", "a ;b", "it's \"quoted\"", "%(ENV_HOME)s", "two\nlines", "-p", "", "$HOME"]


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def plan(self, text, extra=()):
        path = self.folder / "test.yaml"
        path.write_text(text)
        return launch_file.Plan(launch_file.read(path), path, "/prefix", extra)

    def programs(self, text, extra=()):
        return {p.name: p for p in self.plan(text, extra).programs()}


class LaunchFiles(Folder):
    def test_a_component_becomes_a_process_with_its_parameters(self):
        programs = self.programs("namespace: uav1\nparams_files: [my.yaml]\nstages:\n"
                                 "  - component: path_search\n    params: {planner: astar, x: true}\n"
                                 "    remap: {path: p}\n", ["-p", "a:=1"])
        command = programs["path_search"].command
        self.assertEqual(command[:2], ["/prefix/bin/goshawk_container", "path_search:path_search"])
        self.assertEqual(command[2:], ["--ros-args", "-r", "__ns:=/uav1", "--params-file",
                                       str(self.folder / "my.yaml"), "-p",
                                       "path_search:planner:=astar", "-p", "path_search:x:=true",
                                       "-r", "path_search:path:=p", "-p", "a:=1"])
        self.assertEqual(programs["path_search"].nodes, ["/uav1/path_search"])

    def test_a_container_has_all_components_and_their_nodes(self):
        programs = self.programs("container: true\nstages:\n  - component: tracker\n"
                                 "  - component: simulator\n    node: plant\n"
                                 "  - command: [ls]\n")
        self.assertEqual(list(programs), ["container", "ls"])
        self.assertEqual(programs["container"].nodes, ["/tracker", "/plant"])

    def test_observers_are_not_essential_unless_the_file_says_so(self):
        programs = self.programs(
            "stages:\n  - component: tracker\n  - component: flight_check\n"
            "  - component: visualizer\n    essential: true\n"
            "  - component: navigator\n    essential: false\n"
            "  - command: [/bin/ls]\n  - command: [/bin/echo]\n    essential: false\n")
        self.assertEqual({n for n, p in programs.items() if p.essential},
                         {"tracker", "visualizer", "ls"})

    def test_a_recorder_is_not_essential(self):
        self.assertFalse(launch_file.is_essential({"command": ["goshawk", "record"]}))
        self.assertTrue(launch_file.is_essential({"command": ["goshawk", "run", "tracker"]}))

    def test_a_program_that_cannot_be_started_is_refused_with_its_path(self):
        text = self.folder / "text.txt"
        text.write_text("no program")
        for command, words in (("[./absent]", [str(self.folder / "absent"), "does not exist"]),
                               ("[./text.txt]", [str(text), "cannot be executed"]),
                               ("[no_such_program_xyz]", ["no_such_program_xyz", "PATH"])):
            with self.assertRaises(WrongCall) as refused:
                self.programs(f"stages:\n  - component: tracker\n  - command: {command}\n")
            for word in ["stage 2", *words]:
                self.assertIn(word, str(refused.exception))

    def test_names_that_clash_or_are_odd_are_refused(self):
        for text, word in (("- component: tracker\n- component: tracker\n", "two stages"),
                           ("- command: [ls]\n  name: 'a]b'\n", "cannot be named 'a]b'"),
                           ("- component: tracker\n  essential: 5\n", "essential")):
            with self.assertRaises(WrongCall) as refused:
                self.programs("stages:\n" + text)
            self.assertIn(word, str(refused.exception))


class Names(unittest.TestCase):
    def claim(self, domain, *nodes):
        names = stage_names.StageNames(domain, nodes)
        self.addCleanup(names.close)
        return names

    def test_a_name_is_had_by_one_launch_in_a_domain(self):
        first = self.claim(4711, "/a", "/b")
        with self.assertRaises(stage_names.InUse) as refused:
            self.claim(4711, "/c", "/b")
        self.assertIn(f"/b in domain 4711 is already started by process {os.getpid()}",
                      str(refused.exception))
        self.claim(4711, "/c")  # the refused one holds nothing
        self.claim(4712, "/a", "/b")
        self.assertTrue(all(d >= stage_names.FIRST_DESCRIPTOR for d in first.descriptors()))

    def test_it_is_free_when_the_last_process_that_has_it_ends(self):
        names = self.claim(4713, "/a")
        child = subprocess.Popen(["sleep", "60"], pass_fds=names.descriptors())
        names.close()
        with self.assertRaises(stage_names.InUse):
            self.claim(4713, "/a")
        child.kill()
        child.wait()
        self.claim(4713, "/a")

    def test_long_names_have_addresses_of_their_own(self):
        long = "/" + 200 * "n"
        address = stage_names.address_of(0, long + "a")
        self.assertNotEqual(address, stage_names.address_of(0, long + "b"))
        with socket.socket(socket.AF_UNIX) as held:
            held.bind(address)


class Supervised(Folder):
    def supervisor(self, *commands):
        programs = [launch_file.Program(f"p{k}", c, True, []) for k, c in enumerate(commands)]
        supervisor = supervision.Supervisor(programs, str(self.folder), [])
        self.addCleanup(supervisor.stop)
        return supervisor

    def until(self, supervisor, wanted):
        seen = []
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            seen += [(event, match.groupdict()) for event, match in supervisor.events()]
            if any(event == wanted for event, _ in seen):
                return seen
            time.sleep(0.05)
        self.fail(f"no {wanted} in {seen}: {supervisor.how_it_ended()}")
        return seen

    def test_arguments_arrive_as_they_are(self):
        out = self.folder / "out % #1 ;2"
        script = "import sys; open(sys.argv[1], 'w').write(repr(sys.argv[2:]))"
        supervisor = self.supervisor([sys.executable, "-c", script, str(out), *ODD])
        self.until(supervisor, "exited")
        self.assertEqual(out.read_text(), repr(ODD))

    def test_a_crash_is_told_with_its_signal(self):
        supervisor = self.supervisor(["/bin/bash", "-c", "kill -SEGV $$"])
        events = dict(self.until(supervisor, "exited"))
        self.assertIn("SIGSEGV", events["exited"]["how"])
        self.assertEqual(events["exited"]["name"], "p0")

    def test_a_process_that_waits_to_be_reaped_is_not_alive(self):
        child = subprocess.Popen(["sleep", "60"])
        self.assertTrue(supervision.is_alive(child.pid))
        child.kill()
        deadline = time.monotonic() + 60.0
        while supervision.is_alive(child.pid) and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(supervision.is_alive(child.pid))
        child.wait()
        self.assertFalse(supervision.is_alive(child.pid))

    def test_stop_ends_what_left_its_process_group_too(self):
        supervisor = self.supervisor(["/bin/bash", "-c", "setsid sleep 1000 & exec sleep 1000"])
        deadline = time.monotonic() + 60.0
        while len(supervision.processes_of(supervisor.token)) < 3 and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertGreaterEqual(len(supervision.processes_of(supervisor.token)), 3)
        self.assertEqual(supervisor.stop(), [])
        self.assertEqual(supervision.processes_of(supervisor.token), [])

    def test_a_wrong_configuration_is_told(self):
        supervisor = self.supervisor(["/bin/true"])
        supervisor.process.terminate()
        supervisor.process.wait()
        self.assertIsNotNone(supervisor.how_it_ended())

    def test_configuration_holds_no_text_of_a_user(self):
        program = launch_file.Program("p", ODD, True, [])
        text = supervision.configuration([program])
        for word in ODD:
            if word.strip():
                self.assertNotIn(shlex.quote(word), text)


if __name__ == "__main__":
    unittest.main()
