#!/usr/bin/python3
"""Who ends with whom: stages with their supervisor, and nothing with a stage that a flight can do
without."""

import json
import os
import re
import signal
import socket
import time

import harness
from harness import GOSHAWK, SystemTest, note, until
from stack import Launch, position_of

GONE_S = 2.0  # after the supervisor's end


class SupervisionCase(SystemTest):
    def launch(self, text, name="test.yaml", **keywords):
        path = self.sandbox.folder / name
        path.write_text(text)
        return Launch(self.sandbox, path, **keywords)

    def wait_running(self, launch, count):
        running = until(lambda: len(launch.events("running")) >= count, 20.0)
        self.assertTrue(running, launch.tails())

    def supervisor_of(self, launch):
        """The process id of the launch's supervisord."""
        with open(f"/proc/{launch.process.pid}/task/{launch.process.pid}/children",
                  encoding="ascii") as file:
            children = [int(word) for word in file.read().split()]
        self.assertEqual(len(children), 1)
        return children[0]

    def check_all_gone(self):
        begin = time.monotonic()
        gone = until(lambda: not harness.processes_of(self.sandbox.token), GONE_S)
        note(f"all gone after {time.monotonic() - begin:.2f} s")
        self.assertTrue(gone, [harness.command_of(p)
                               for p in harness.processes_of(self.sandbox.token)])


# A program of another's, with a child in a session of its own, and a program that a signal to stop
# does not reach.
FOREIGN = ("stages:\n  - component: corridor_builder\n  - component: path_search\n"
           "  - command: [bash, -c, 'setsid sleep 1000 & exec sleep 1000']\n    name: foreign\n"
           "  - command: [bash, -c, \"trap '' TERM INT; while true; do sleep 1; done\"]\n"
           "    name: deaf\n")


class SupervisorKilled(SupervisionCase):
    def test_everything_ends_with_the_supervisor(self):
        launch = self.launch(FOREIGN)
        self.wait_running(launch, 4)
        os.kill(self.supervisor_of(launch), signal.SIGKILL)
        launch.process.wait(10.0)
        self.check_all_gone()
        self.assertEqual(launch.process.outcome().status, 1)
        failed = launch.events("failed")
        self.assertIn("SIGKILL", failed[-1]["message"])
        self.assertEqual((failed[-1]["ok"], failed[-1]["code"]), (False, "io_failed"))

    def test_components_end_with_it_even_if_the_launch_is_killed_too(self):
        launch = self.launch("stages: [{component: corridor_builder}, {component: tracker},"
                             " {command: [sleep, '1000']}]\n")
        self.wait_running(launch, 3)
        supervisor = self.supervisor_of(launch)
        os.kill(launch.process.pid, signal.SIGSTOP)  # it does not see the other one's end
        os.kill(supervisor, signal.SIGKILL)
        os.kill(launch.process.pid, signal.SIGKILL)
        launch.process.wait(10.0)
        self.check_all_gone()

    def test_nothing_is_left_in_the_temporary_folder(self):
        temporary = self.sandbox.folder / "tmp"
        temporary.mkdir()
        path = self.sandbox.folder / "test.yaml"
        path.write_text("stages: [{component: corridor_builder}]\n")
        for number in (signal.SIGINT, signal.SIGKILL):
            process = self.sandbox.start(GOSHAWK, "launch", path, "--json",
                                         env={"TMPDIR": str(temporary)})
            self.assertTrue(until(lambda: any(e["event"] == "running" for e in process.lines()),
                                  20.0), str(process.outcome()))
            process.process.send_signal(number)
            process.wait(10.0)
            self.check_all_gone()
            self.assertEqual(list(temporary.iterdir()), [])
        self.assertTrue(list((self.sandbox.folder / "state/goshawk/log").glob("*_test/*.log")))


class SecondLaunch(SupervisionCase):
    STAGES = "stages: [{component: corridor_builder}, {component: tracker}]\n"

    def test_a_second_stack_is_refused_with_the_first_ones_name_and_process(self):
        first = self.launch(self.STAGES, "first.yaml")
        self.wait_running(first, 2)
        second = self.launch("stages: [{component: tracker}]\n", "second.yaml")
        self.assertEqual(second.process.wait(20.0), 1, second.tails())
        refused = second.events("failed")[-1]
        for word in ("/tracker", str(first.process.pid), "first.yaml"):
            self.assertIn(word, refused["message"])
        self.assertEqual(refused["ok"], False)
        self.assertTrue(first.process.alive())

        other = self.launch("namespace: /uav2\n" + self.STAGES, "other.yaml")
        self.wait_running(other, 2)
        number = self.sandbox.domain.number
        with_domain = harness.Domain()
        self.addCleanup(with_domain.close)
        self.assertNotEqual(number, with_domain.number)
        elsewhere = self.launch(self.STAGES, "elsewhere.yaml",
                                env={"ROS_DOMAIN_ID": str(with_domain.number)})
        self.wait_running(elsewhere, 2)

        first.process.stop()
        again = self.launch(self.STAGES, "first.yaml")
        self.wait_running(again, 2)

    def test_names_are_taken_until_the_last_stage_of_a_killed_launch_is_gone(self):
        first = self.launch("stages: [{command: [sleep, '1000']}]\n", "first.yaml")
        self.wait_running(first, 1)
        name = b"\0goshawk/stage/%d/sleep" % self.sandbox.domain.number
        os.kill(self.supervisor_of(first), signal.SIGSTOP)
        first.process.process.kill()
        first.process.wait(10.0)
        with socket.socket(socket.AF_UNIX) as claim:
            self.assertRaises(OSError, claim.bind, name)
        # SIGTERM of the launch's end waits for it.
        for pid in harness.processes_of(self.sandbox.token):
            if "supervisord" in harness.command_of(pid):
                os.kill(pid, signal.SIGCONT)
        self.check_all_gone()
        with socket.socket(socket.AF_UNIX) as claim:
            claim.bind(name)


class NotEssential(SupervisionCase):
    def test_seven_kills_of_the_checker_do_not_end_a_flight(self):
        launch = self.launch("stages: [{component: corridor_builder}, {component: flight_check}]\n")
        self.wait_running(launch, 2)
        for number in range(1, 8):
            os.kill(launch.pids()["flight_check"], signal.SIGKILL)
            told = until(lambda: len(launch.events("restarted", "flight_check")) == number, 40.0)
            self.assertTrue(told, launch.tails())
        self.assertTrue(launch.process.alive())
        self.assertEqual(launch.events("restarted", "corridor_builder"), [])
        self.assertTrue(launch.events("failing", "flight_check"))

    def test_what_dies_for_ever_after_the_start_ends_nothing_else(self):
        """Not even if it is essential: the tracker and the vehicle go on."""
        flag = self.sandbox.folder / "runs"
        flag.touch()
        launch = self.launch("stages:\n  - component: tracker\n"
                             f"  - command: [bash, -c, 'test -e {flag} && exec sleep 1000; exit 2']"
                             "\n    name: brittle\n")
        self.wait_running(launch, 2)
        tracker = launch.pids()["tracker"]
        flag.unlink()
        os.kill(launch.pids()["brittle"], signal.SIGSEGV)
        told = until(lambda: launch.events("failing", "brittle"), 60.0)
        self.assertTrue(told, launch.tails())
        self.assertIn("exit status 2", told[0]["message"])
        self.assertTrue(launch.process.alive())
        self.assertEqual(launch.pids()["tracker"], tracker)
        crash = launch.events("restarted", "brittle")[0]
        for word in ("SIGSEGV", str(launch.logs / "brittle.log")):
            self.assertIn(word, crash["message"])

    def test_a_stage_that_is_not_essential_may_never_start(self):
        launch = self.launch("stages:\n  - component: tracker\n"
                             "  - command: [/bin/false]\n    name: useless\n    essential: false\n")
        told = until(lambda: launch.events("failing", "useless"), 60.0)
        self.assertTrue(told, launch.tails())
        self.assertTrue(launch.process.alive())
        self.assertTrue(launch.events("up"))

    def test_a_reader_of_its_events_that_goes_away_ends_nothing(self):
        path = self.sandbox.folder / "test.yaml"
        path.write_text("stages: [{component: tracker}]\n")
        logs = self.sandbox.folder / "logs"
        self.sandbox.start("/bin/bash", "-c",
                           f"'{GOSHAWK}' launch '{path}' --json --log-dir '{logs}' | head -1; "
                           "sleep 1000")
        log = logs / "supervisord.log"
        runs = until(lambda: log.exists() and "spawned: 'tracker'" in log.read_text(), 20.0)
        self.assertTrue(runs)
        pid = int(re.findall(r"spawned: 'tracker' with pid (\d+)", log.read_text())[-1])
        os.kill(pid, signal.SIGKILL)  # there is something to tell
        again = until(lambda: log.read_text().count("spawned: 'tracker'") == 2, 20.0)
        self.assertTrue(again)
        self.assertNotIn("waiting for", log.read_text())
        for pid in harness.processes_of(self.sandbox.token):
            if "launch.py" in harness.command_of(pid):
                os.kill(pid, signal.SIGINT)
        gone = until(lambda: not any("tracker" in harness.command_of(p)
                                     for p in harness.processes_of(self.sandbox.token)), 10.0)
        self.assertTrue(gone)


class OddNames(SupervisionCase):
    """Folders, maps and parameters are a user's text: no character of it means anything."""

    NAME = "100% #1 ;x 'y' \"z\" %(here)s $HOME"

    def test_a_flight_in_a_folder_of_any_name(self):
        folder = self.sandbox.folder / self.NAME
        folder.mkdir()
        world = folder / f"map {self.NAME}.bt"
        self.assertEqual(self.sandbox.goshawk("world", world).status, 0)
        path = folder / f"{self.NAME}.yaml"
        path.write_text("stages:\n  - component: map_server\n  - component: simulator\n"
                        f"    params: {{start_x_m: 3.5}}\n"
                        "  - command: ['./my stage #2']\n    name: mine\n")
        program = folder / "my stage #2"
        program.write_text("#!/bin/sh\necho \"$0\"; exec sleep 1000\n")
        program.chmod(0o755)
        logs = folder / "logs % ;"
        process = self.sandbox.start(GOSHAWK, "launch", path, "--json", "--log-dir", logs, "--map",
                                     world, cwd=folder)
        running = until(lambda: len([e for e in process.lines() if e["event"] == "running"]) == 3
                        or not process.alive(), 20.0)
        self.assertTrue(running and process.alive(), str(process.outcome()))
        self.assertEqual((logs / "mine.log").read_text().strip(), str(program))
        loaded = self.sandbox.goshawk("topic", "echo", "/map/voxels", "--once", "--json",
                                      "--no-arr", "--timeout", "20")
        self.assertEqual(loaded.status, 0, str(loaded))
        self.assertEqual(process.stop()[0], 0)


class MapAndStart(SupervisionCase):
    def start(self, *arguments):
        process = self.sandbox.start(GOSHAWK, "launch", *arguments, "--json", "--log-dir",
                                     self.sandbox.folder / "logs")
        placed = until(lambda: [e for e in process.lines() if e["event"] == "placed"]
                       or not process.alive(), 20.0)
        self.assertTrue(process.alive() and placed, str(process.outcome()))
        return process, placed[0]["message"]

    def place(self):
        said = self.sandbox.goshawk("topic", "echo", "/odom", "--once", "--json", "--timeout", "30")
        self.assertEqual(said.status, 0, str(said))
        return position_of(json.loads(said.out))

    def check_place(self, wanted):
        for reached, coordinate in zip(self.place(), wanted):
            self.assertAlmostEqual(reached, coordinate, delta=0.05)

    PLANT = "stages: [{component: map_server}, {component: simulator}]\n"

    def plant(self):
        path = self.sandbox.folder / "plant.yaml"
        path.write_text(self.PLANT)
        return path

    def test_without_a_map_a_world_is_made(self):
        process, message = self.start(self.plant())
        self.assertIn("made world", message)
        self.assertTrue((self.sandbox.folder / "logs/world.bt").is_file())
        self.check_place((3.0, 0.0, 1.0))
        process.stop()

    def test_a_map_of_ones_own_and_a_start(self):
        world = self.sandbox.folder / "forest.bt"
        made = self.sandbox.goshawk("world", world, "--kind", "forest", "--size", "8,8,4",
                                    "--density", "0.1", "--keep-free", "4,4,1")
        self.assertEqual(made.status, 0, str(made))
        process, message = self.start(self.plant(), "--map", world, "--start", "4,4,1")
        self.assertIn(str(world), message)
        self.check_place((4.0, 4.0, 1.0))
        process.stop()
        process, message = self.start(self.plant(), "--map", world)
        chosen = re.search(r"begins at (\S+)", message)
        self.check_place([float(x) for x in chosen.group(1).split(",")])

    def test_what_cannot_be_is_refused_before_anything_starts(self):
        for arguments, status, code in (
                (["--start", "100,0,1"], 1, "start_outside"),
                (["--start", "1,2"], 2, "invalid_parameter"),
                (["--map", "/no/such.bt"], 1, "map_unreadable")):
            outcome = self.sandbox.goshawk("launch", self.plant(), "--json", *arguments)
            self.assertEqual(outcome.status, status, str(outcome))
            self.assertEqual(json.loads(outcome.out.splitlines()[-1])["code"], code)
        lonely = self.sandbox.folder / "lonely.yaml"
        lonely.write_text("stages: [{component: tracker}]\n")
        outcome = self.sandbox.goshawk("launch", lonely, "--map", "a.bt", timeout_s=20)
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("map_server", outcome.err)


if __name__ == "__main__":
    harness.main()
