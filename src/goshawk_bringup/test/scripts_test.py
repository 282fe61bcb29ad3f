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
from random import Random

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import launch  # noqa: E402
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


TWO_HOSTS = ("hosts: {vehicle: 10.0.0.2, ground: }\nstages:\n"
             "  - {component: map_server, host: ground}\n"
             "  - {component: tracker, host: vehicle}\n"
             "  - {command: [ls], host: ground}\n")


class Hosts(Folder):
    def content(self, text):
        path = self.folder / "test.yaml"
        path.write_text(text)
        return launch_file.read(path), path

    def names(self, text, host):
        content, path = self.content(text)
        return [p.name for p in launch_file.Plan(content, path, "/p", [], host).programs()]

    def test_each_host_starts_its_own(self):
        self.assertEqual(self.names(TWO_HOSTS, "vehicle"), ["tracker"])
        self.assertEqual(self.names(TWO_HOSTS, "ground"), ["map_server", "ls"])
        self.assertEqual(self.names("container: true\n" + TWO_HOSTS, "ground"), ["container", "ls"])

    def test_a_host_has_the_interfaces_of_the_file(self):
        content, path = self.content(TWO_HOSTS)
        self.assertEqual(launch_file.choose_host(content, path, "vehicle"), "10.0.0.2")
        self.assertEqual(launch_file.choose_host(content, path, "ground"), "")

    def test_the_map_and_the_plant_are_known_on_every_host(self):
        content, path = self.content(TWO_HOSTS)
        plan = launch_file.Plan(content, path, "/p", [], "vehicle")
        self.assertEqual(plan.node_of({"map_server"}), "map_server")

    def test_a_stage_on_a_wrong_host_is_refused(self):
        for text, words in (
                ("hosts: {a: }\nstages:\n  - component: tracker\n", "needs a host: one of a"),
                ("stages:\n  - {component: tracker, host: a}\n", "the file has no hosts"),
                ("hosts: {vehicle: }\nstages:\n  - {component: tracker, host: vehicel}\n",
                 "there is no host 'vehicel'; did you mean vehicle?"),
                ("hosts: [a]\nstages:\n  - {component: tracker, host: a}\n", "hosts is not a map"),
                ("hosts: {a: 5}\nstages:\n  - {component: tracker, host: a}\n", "interfaces 5")):
            with self.assertRaises(WrongCall) as refused:
                self.content(text)
            self.assertIn(words, str(refused.exception))

    def test_a_launch_for_a_wrong_host_is_refused(self):
        content, path = self.content(TWO_HOSTS)
        spare, _ = self.content(TWO_HOSTS.replace("{vehicle", "{spare: , vehicle"))
        for of, host, words in ((content, "", "say with --host which of them"),
                                (content, "grond", "did you mean ground?"),
                                (spare, "spare", "starts no stage on it"),
                                (self.content("stages:\n  - component: tracker\n")[0], "ground",
                                 "has no hosts")):
            with self.assertRaises(WrongCall) as refused:
                launch_file.choose_host(of, path, host)
            self.assertIn(words, str(refused.exception))


class FuzzedFiles(Folder):
    """Any text as a launch file: a plan, or a sentence. GOSHAWK_FUZZ_S: for so many seconds."""

    SEEDS = [TWO_HOSTS, "namespace: /u\ndomain: 5\ncontainer: true\nparams_files: [my.yaml]\n"
             "stages:\n  - component: tracker\n    node: t\n    params: {a: [1, 2.5], b: {c: x}}\n"
             "    remap: {path: p}\n    realtime: 10\n    essential: true\n"
             "  - command: [ls, --fast]\n    name: mine\n"]
    PIECES = ["null", "[]", "{}", "-1", "1e999", "true", "&a", "*a", "!!python/object:os.system x",
              "'", '"', "\t", "\0", "\ud7ff", ": ", "- ", "<<: *a", "stages:", "host:", "99999999999",
              "2001-01-01", "!!binary aGk=", "? ", "|", "%", "{a: {a: {a: }}}", ".nan"]

    def mutated(self, random):
        text = random.choice(self.SEEDS)
        for _ in range(random.randint(1, 6)):
            at, upto = sorted((random.randint(0, len(text)), random.randint(0, len(text))))
            piece = random.choice([*self.PIECES, text[at:upto], chr(random.randint(0, 300))])
            text = text[:at] + piece + text[min(upto, at + random.randint(0, 20)):]
        return text

    def test_a_file_is_understood_or_refused_with_a_sentence(self):
        random = Random(1)
        path = self.folder / "fuzzed.yaml"
        end = time.monotonic() + float(os.environ.get("GOSHAWK_FUZZ_S", "0"))
        tries = 0
        while tries < 1000 or time.monotonic() < end:
            tries += 1
            text = self.mutated(random)
            path.write_text(text)
            try:
                content = launch_file.read(path)
                host = random.choice(["", *launch_file.hosts_of(content, path)])
                launch_file.choose_host(content, path, host)
                launch.domain_of(content)
                plan = launch_file.Plan(content, path, "/prefix", [], host)
                programs = plan.programs()
                supervision.configuration(programs)
                for program in programs:
                    shlex.join(program.command)
            except WrongCall as refused:
                self.assertTrue(str(refused))
            except Exception as bug:  # noqa: BLE001: whatever else is a traceback for a user
                self.fail(f"{bug!r} for the launch file:\n{text}")


class Memories(Folder):
    def arguments(self, text, extra=()):
        plan = self.plan(text, extra)
        launch.keep_memories(plan, str(self.folder))
        return plan.extra

    def test_a_map_server_gets_a_journal_of_this_flight(self):
        old = self.folder / "map.journal"
        old.write_text("of another flight")
        self.assertEqual(self.arguments("stages:\n  - {component: map_server, node: maps}\n"),
                         ["-p", f"maps:journal_file:={old}"])
        self.assertFalse(old.exists())

    def test_a_navigator_gets_a_file_for_its_goal(self):
        old = self.folder / "navigator.memory"
        old.write_text("of another flight")
        self.assertEqual(self.arguments("stages:\n  - {component: navigator, node: pilot}\n"),
                         ["-p", f"pilot:memory_file:={old}"])
        self.assertFalse(old.exists())

    def test_one_that_the_file_or_the_call_names_is_left_alone(self):
        own = self.folder / "map.journal"
        own.write_text("mine")
        self.assertEqual(self.arguments("stages:\n  - component: map_server\n"
                                        f"    params: {{journal_file: {own}}}\n"), [])
        words = ["-p", f"map_server:journal_file:={own}"]
        self.assertEqual(self.arguments("stages:\n  - component: map_server\n", words), words)
        self.assertEqual(self.arguments("stages:\n  - component: tracker\n"), [])
        self.assertEqual(own.read_text(), "mine")


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
