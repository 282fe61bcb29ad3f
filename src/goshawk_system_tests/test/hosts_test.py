#!/usr/bin/python3
"""Flights on two hosts over a link with faults. By hand, with more goals for each kind of fault:

    LAB_GOALS=20 /usr/bin/python3 test/hosts_test.py FaultyLink SkewedClocks
"""

import json
import math
import os
import re
import shlex
import shutil
import unittest

import harness
import lab
import second_opinion
from harness import GOSHAWK, SystemTest, note, until
from stack import PLACES, Launch, Stack, States

GOALS = int(os.environ.get("LAB_GOALS", "2"))
COMMANDED = 1  # CONTROL_GOSHAWK of vehicle_status
# As flight_hosts, but the control loop goes over the network.
SPLIT = """hosts: {vehicle: , ground: }
stages:
  - {component: simulator, host: vehicle}
  - {component: tracker, host: ground}
  - {component: map_server, host: ground}
  - {component: path_search, host: ground}
  - {component: corridor_builder, host: ground}
  - {component: trajectory_optimizer, host: ground}
  - {component: navigator, host: ground}
  - {component: flight_check, host: ground}
"""


class TwoHostStack(Stack):
    """A stack on the lab's hosts: launched on each, commanded from the ground."""

    def __init__(self, lab_, file):
        self.sandbox, self.vehicle = lab_.hosts["ground"], lab_.hosts["vehicle"]
        self.world = self.sandbox.folder / "world.bt"
        made = self.sandbox.goshawk("world", self.world, "--json")
        if made.status != 0:
            raise AssertionError(f"the world could not be made: {made}")
        self.launches = {name: Launch(host, file, "-p", f"map_server:map_file:={self.world}",
                                      options=("--host", name))
                         for name, host in lab_.hosts.items()}
        self.launch = self.launches["ground"]
        self.reports = self.echo("stage_report")
        self.states = States(self.echo("navigator_state"))
        self.odom = self.vehicle.start(GOSHAWK, "topic", "echo", "odom", "--json", "--timeout", "60",
                                       "--no-arr")
        self.publishers = {}

    def tails(self):
        return "\n".join(launch.tails() for launch in self.launches.values())


class LabTest(SystemTest):
    """A lab of its own for each test; without namespaces it is skipped, and says what is missing."""

    def setUp(self):
        super().setUp()
        try:
            self.lab = lab.Lab(self.sandbox)
        except lab.NotPermitted as lacking:
            self.skipTest(str(lacking))
        self.addCleanup(self.lab.close)


class Link(LabTest):
    """The lab itself: what is asked of the link happens to the packets between the hosts."""

    def setUp(self):
        super().setUp()
        script = ("import socket, sys, time\n"
                  "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
                  "s.bind(('10.77.0.1', 9))\n"
                  "while True:\n"
                  "    data, who = s.recvfrom(65536)\n"
                  "    s.sendto(data, who)\n")
        self.lab.hosts["ground"].start("/usr/bin/python3", "-c", script)

    def ping(self, count):
        """@return the times of answers [ms]"""
        script = ("import json, socket, time\n"
                  "s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)\n"
                  "s.settimeout(0.3)\n"
                  "got = []\n"
                  f"for k in range({count}):\n"
                  "    begin = time.monotonic()\n"
                  "    s.sendto(bytes([k]) * 3000, ('10.77.0.1', 9))\n"
                  "    try:\n"
                  "        if s.recv(65536) == bytes([k]) * 3000:\n"
                  "            got.append(1000 * (time.monotonic() - begin))\n"
                  "    except TimeoutError:\n"
                  "        pass\n"
                  "print(json.dumps(got))\n")
        return json.loads(self.lab.hosts["vehicle"].call("/usr/bin/python3", "-c", script).out)

    def test_packets_pass_are_delayed_lost_and_cut(self):
        # Datagrams of three frames each, with checksums that the kernel leaves to its hardware.
        answered = until(lambda: self.ping(1), 10.0)
        self.assertTrue(answered, "nothing passes the link")
        self.lab.set(delay=0.05)
        times_ms = until(lambda: self.ping(5), 10.0)
        self.assertTrue(times_ms, "nothing passes the link with a delay")
        self.assertGreaterEqual(min(times_ms), 100.0)
        self.lab.set(delay=0.0, loss=0.2)
        # Six frames there and back: 0.8 to the sixth is a quarter.
        self.assertLess(len(self.ping(30)), 25)
        self.lab.set(loss=0.0, cut=1000.0)
        self.assertEqual(self.ping(3), [])
        self.lab.set(cut=0.0)
        self.assertTrue(until(lambda: self.ping(5), 10.0))
        passed, lost = self.lab.count()
        self.assertGreater(passed, 0)
        self.assertGreater(lost, 0)


class FlightCase(LabTest):
    """What flights of the lab share."""

    def launch(self, file="flight_hosts", clock_s=0.0, **faults):
        self.lab.hosts["ground"].set_clock(clock_s)
        self.lab.set(**faults)
        self.stack = TwoHostStack(self.lab, file)
        self.stack.wait_ready(60.0)
        # Over a link that loses packets the plant finds the tracker late, and does not move before.
        status = self.lab.hosts["vehicle"].start(GOSHAWK, "topic", "echo", "vehicle_status", "--json",
                                                 "--timeout", "60")
        heard = until(lambda: any(m["control"] == COMMANDED for m in status.lines()), 60.0)
        self.assertTrue(heard, f"the plant hears no command: {status.outcome()}")
        status.stop()

    def fly(self, goals=GOALS, in_flight=None):
        """Sends goals one after the other; each is answered. @return the answers"""
        answers = []
        for k in range(goals):
            goal = PLACES[k % 2]
            for _ in range(20):
                state = self.answer_to(goal, in_flight)
                # Over a link that loses packets the hosts may still be finding each other.
                if answers or "no odometry comes" not in state["message"]:
                    break
            answers.append(f"{state['state']}/{state['code']}: {state['message']}")
            if state["state"] == "arrived":
                arrived = until(lambda: math.dist(self.stack.place(), goal) < 0.15, 10.0)
                self.assertTrue(arrived, f"said to have arrived at {goal}: {self.stack.place()}")
        return answers

    def answer_to(self, goal, in_flight):
        here, since = self.stack.place(), len(self.stack.states.lines())
        self.stack.send_goal(goal)
        if in_flight:
            until(lambda: math.dist(self.stack.place(), here) > 0.5, 30.0)
            in_flight()
        state = self.stack.wait_state({"arrived", "failed"}, since, 90.0)
        self.assertIsNotNone(state, f"no answer to a goal\n{self.stack.tails()}")
        return state

    def judge(self, answers):
        track = self.stack.track()
        clearance = second_opinion.smallest_clearance(self.stack.world, track, 0.02)
        passed, lost = self.lab.count()
        note(f"{answers}; clearance of the centre {clearance:.3f} m; frames passed {passed}, "
             f"lost {lost}")
        self.assertGreater(clearance, harness.BODY_RADIUS_M, f"touched: {answers}")

    def assert_all_arrive(self, answers):
        self.judge(answers)
        self.assertEqual([a for a in answers if not a.startswith("arrived")], [],
                         self.stack.tails())


class FaultyLink(FlightCase):
    def test_loss_and_delay(self):
        self.launch(loss=0.2, delay=0.05, jitter=0.01, duplicate=0.02, reorder=0.02)
        self.assert_all_arrive(self.fly())

    def test_cuts(self):
        """While the link is cut the vehicle goes on with what is committed, or holds; a goal that
        is given up is given up with the reason, and the next one is flown to."""
        self.launch()
        answers = self.fly(in_flight=lambda: self.lab.set(cut=2.0))
        answers += self.fly(in_flight=lambda: self.lab.set(cut=10.0))
        self.judge(answers)
        self.assertEqual(self.fly(1)[0].split("/")[0], "arrived", self.stack.tails())
        for answer in answers:
            self.assertRegex(answer, "^arrived|^failed/(stage_silent|tracking_lost): .*")

    def test_the_tracker_and_the_plant_on_different_hosts(self):
        file = self.sandbox.folder / "split.yaml"
        file.write_text(SPLIT)
        self.launch(file, loss=0.2, delay=0.01)
        self.assert_all_arrive(self.fly())


class SkewedClocks(FlightCase):
    def test_the_ground_is_three_seconds_ahead(self):
        self.launch(clock_s=3.0, delay=0.01)
        self.assert_all_arrive(self.fly())

    def test_the_ground_is_three_seconds_behind(self):
        self.launch(clock_s=-3.0, delay=0.01)
        self.assert_all_arrive(self.fly())

    def test_clocks_that_nobody_has_set_are_named(self):
        self.launch(clock_s=3600.0)
        answers = self.fly(1)
        self.judge(answers)
        self.assertIn("clock skew", answers[0])
        self.assertIn("3.6e+03 s ahead", answers[0])


class Discovery(LabTest):
    """Without multicast, by a discovery server on the ground."""

    def test_all_find_each_other_on_the_servers_host_too(self):
        # What `fastdds discovery` starts, which it leaves alive when it is stopped itself.
        server = shutil.which("fast-discovery-server")
        if server is None:
            self.skipTest("there is no fast-discovery-server: install fastdds-tools")
        for host in self.lab.hosts.values():
            host.namespace.ip("route", "del", "224.0.0.0/4")
            host.namespace.ip("link", "set", "eth0", "multicast", "off")
            host.env["ROS_DISCOVERY_SERVER"] = f"{lab.ADDRESSES['ground']}:11811"
        ground = self.lab.hosts["ground"]
        ground.start(server, "--server-id", "0", "--ip-address", ground.address, "--port", "11811",
                     env={"ROS_DISCOVERY_SERVER": ""})
        stack = self.stack = TwoHostStack(self.lab, "flight_hosts")
        stack.wait_ready(60.0)
        for host in self.lab.hosts.values():
            listed = host.goshawk("node", "list", "--json")
            for stage in harness.STAGES:
                self.assertIn(f"/{stage}", listed.out, f"on {host.name}: {listed}")
        state = stack.fly_to(PLACES[0])
        self.assertIsNotNone(state, stack.tails())
        self.assertEqual(state["state"], "arrived", state)


class Page(LabTest):
    """The commands of docs/hosts.md, in their order, each on the host of its prompt."""

    def commands(self):
        for line in (harness.SOURCE / "docs/hosts.md").read_text(encoding="utf-8").splitlines():
            match = re.match(r"    (vehicle|ground)\$ (.*)", line)
            if match:
                yield self.lab.hosts[match.group(1)], match.group(2)

    def run_on(self, host, line):
        words = shlex.split(line)
        if words[0] == "export":
            host.env.update([words[1].split("=", 1)])
            return None
        # `fastdds discovery` starts this, and leaves it alive when it is stopped itself.
        if words[:2] == ["fastdds", "discovery"]:
            return host.start("fast-discovery-server", *words[2:])
        self.assertEqual(words[0], "tools/goshawk", line)
        if words[1] == "launch":
            process = host.start(GOSHAWK, *words[1:])
            up = until(lambda: "every essential stage runs" in process.out(), 60.0)
            self.assertTrue(up, str(process.outcome()))
            return process
        outcome = host.goshawk(*words[1:])
        self.assertEqual(outcome.status, 0, str(outcome))
        return None

    def test_each_works(self):
        commands = list(self.commands())
        self.assertGreater(len(commands), 7)
        endless = [self.run_on(host, line) for host, line in commands]
        for process in filter(None, endless):
            self.assertTrue(process.alive(), str(process.outcome()))


class WithoutNamespaces(unittest.TestCase):
    def test_what_is_missing_is_said(self):
        with self.assertRaises(lab.NotPermitted) as refused:
            lab.attempt("unshare", "--no-such-option")
        self.assertIn("CAP_SYS_ADMIN", str(refused.exception))

    def test_any_other_failure_of_the_lab_is_no_reason_to_skip(self):
        with self.assertRaisesRegex(AssertionError, "no-such-option"):
            lab.run("unshare", "--no-such-option")


if __name__ == "__main__":
    harness.main()
