#!/usr/bin/python3
"""kill -9 of each stage during a flight, and the ways a launch ends."""

import math
import os
import signal
import time

import harness
from harness import GOSHAWK, SystemTest, note, until
from legs_case import LegsCase
from stack import PLACES, Launch


class KillNine(LegsCase):
    """One launched flight; each test kills one stage while the vehicle moves, then flies on."""

    def kill(self, stage):
        before = self.stack.launch.pids()
        restarts = len(self.stack.launch.events("restarted", stage))
        os.kill(before[stage], signal.SIGKILL)
        if stage == "navigator":
            self.stack.forget_publisher("goal_pose")
        begin = time.monotonic()
        told = until(lambda: len(self.stack.launch.events("restarted", stage)) > restarts, 15.0)
        self.assertTrue(told, f"launch says nothing of {stage}\n{self.stack.launch.tails()}")
        note(f"{stage}: launch reported the restart after {time.monotonic() - begin:.2f} s")
        event = self.stack.launch.events("restarted", stage)[-1]
        self.assertIn("SIGKILL", event["message"])
        after = self.stack.launch.pids()
        self.assertNotEqual(after[stage], before[stage])
        self.assertEqual({s: p for s, p in after.items() if s != stage},
                         {s: p for s, p in before.items() if s != stage})

    def check_planning_stage(self, stage):
        """What plans is not needed to finish a flight that is committed; what was restarted plans
        the next leg, which the next test begins with."""
        _, since = self.start_leg()
        self.kill(stage)
        state = self.stack.wait_state({"arrived", "failed"}, since, 40.0)
        self.assertIsNotNone(state, "the leg neither ends nor fails")
        self.assertEqual(state["state"], "arrived", state)
        self.check_untouched()

    def test_1_path_search(self):
        self.check_planning_stage("path_search")

    def test_2_corridor_builder(self):
        self.check_planning_stage("corridor_builder")

    def test_3_trajectory_optimizer(self):
        self.check_planning_stage("trajectory_optimizer")

    def test_4_map_server(self):
        self.check_planning_stage("map_server")

    def test_5_navigator(self):
        """The tracker flies on meanwhile; the new navigator knows the goal and what is flown, and
        says when the vehicle has arrived."""
        goal, _ = self.start_leg()
        since = len(self.stack.states.lines())
        self.kill("navigator")
        state = self.stack.wait_state({"arrived", "failed"}, since, 40.0)
        note(f"navigator killed: the new one said {self.said(since)}")
        self.assertIsNotNone(state, "the new navigator has forgotten its goal")
        self.assertEqual(state["state"], "arrived", state)
        self.assertLess(math.dist(self.stack.place(), goal), 0.1)
        self.assertNotIn("idle/ok", self.said(since))
        self.fly_on()
        self.check_untouched()

    def test_6_navigator_and_a_goal_at_once(self):
        """The vehicle still moves when the new navigator gets another goal: it plans from the
        motion, and arrives."""
        self.start_leg()
        self.kill("navigator")
        goal = min(PLACES, key=lambda p: math.dist(p, self.stack.place()))
        state = self.stack.fly_to(goal)
        self.assertIsNotNone(state)
        self.assertEqual(state["state"], "arrived", state)
        self.check_untouched()

    def test_7_tracker(self):
        """The vehicle flies the fallback stop that it was given. The new tracker finds it
        elsewhere than the trajectory is and refuses that, so the navigator plans anew: the goal is
        reached."""
        goal, since = self.start_leg()
        self.kill("tracker")
        state = self.stack.wait_state({"arrived", "failed"}, since, 40.0)
        note(f"tracker killed: navigator said {self.said(since)}")
        self.check_untouched()
        braked = [r["message"] for r in self.stack.reports.lines()
                  if r["message"].startswith("commands stopped coming")]
        self.assertTrue(any("fallback stop" in message for message in braked), braked)
        self.assertIsNotNone(state, "the leg neither ends nor fails")
        self.assertEqual(state["state"], "arrived", state)
        self.assertLess(math.dist(self.stack.place(), goal), 0.1)
        self.fly_on()
        self.check_untouched()

    def test_8_simulator(self):
        """The vehicle itself is gone and comes back where it began: what was flown is over, and
        the next goal is flown from there."""
        self.start_leg(PLACES[0])
        since = len(self.stack.states.lines())
        self.kill("simulator")
        back = until(lambda: math.dist(self.stack.place(), PLACES[1]) < 0.3, 10.0)
        self.assertTrue(back, "no odometry from the new simulator")
        self.stack.wait_state({"arrived", "failed"}, since, 20.0)
        note(f"simulator killed: navigator said {self.said(since)}")
        self.fly_on()


class LaunchEnds(SystemTest):
    """Nothing is left behind, whatever ends a launch: the sandbox looks for survivors."""

    def launch_running(self):
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world).status, 0)
        launch = Launch(self.sandbox, "flight", "-p", f"map_server:map_file:={world}")
        self.assertTrue(until(lambda: len(launch.events("running")) == len(harness.STAGES),
                              20.0), launch.tails())
        return launch

    def check_stop(self, number):
        launch = self.launch_running()
        pids = launch.pids()
        status, seconds = launch.process.stop(number)
        note(f"stopped by {number.name} in {seconds:.2f} s")
        self.assertEqual(status, 0, launch.tails())
        self.assertNotIn("SIGKILL", launch.supervisor_log())
        self.assertEqual(launch.events()[-1]["event"], "stopped")
        for pid in pids.values():
            self.assertFalse(os.path.exists(f"/proc/{pid}"))

    def test_sigint(self):
        self.check_stop(signal.SIGINT)

    def test_sigterm(self):
        self.check_stop(signal.SIGTERM)

    def test_a_killed_launch_takes_its_stages_with_it(self):
        launch = self.launch_running()
        launch.process.process.kill()
        launch.process.wait(5.0)
        gone = until(lambda: not harness.processes_of(self.sandbox.token), 10.0)
        self.assertTrue(gone, [harness.command_of(p)
                               for p in harness.processes_of(self.sandbox.token)])

    def test_what_begins_after_its_parent_has_gone_ends(self):
        """A parent can end before its child could ask to be told of that."""
        other = str(os.getppid())
        for arguments in (["launch", "flight"], ["record", "-o", "gone.mcap"]):
            with self.subTest(verb=arguments[0]):
                outcome = self.sandbox.goshawk(*arguments, "--stop-with-parent", "--parent", other)
                self.assert_civil(outcome)

    def test_an_interrupted_fly_stops_everything(self):
        fly = self.sandbox.start(GOSHAWK, "fly", "--json", "--output",
                                 self.sandbox.folder / "out")
        flying = until(lambda: "flying" in fly.err() or not fly.alive(), 30.0)
        self.assertTrue(flying and fly.alive(), str(fly.outcome()))
        status, seconds = fly.stop(signal.SIGINT)
        note(f"fly stopped by SIGINT in {seconds:.2f} s")
        self.assertEqual(status, 1, str(fly.outcome()))
        self.assertFalse(self.json_object(fly.outcome())["ok"])
        self.assertEqual(harness.processes_of(self.sandbox.token), [])


    def test_a_killed_fly_takes_everything_with_it(self):
        fly = self.sandbox.start(GOSHAWK, "fly", "--output", self.sandbox.folder / "out")
        self.assertTrue(until(lambda: "flying" in fly.err() or not fly.alive(), 30.0))
        self.assertTrue(fly.alive(), str(fly.outcome()))
        fly.process.kill()
        fly.wait(5.0)
        gone = until(lambda: not harness.processes_of(self.sandbox.token), 10.0)
        self.assertTrue(gone, [harness.command_of(p)
                               for p in harness.processes_of(self.sandbox.token)])


class LaunchFails(SystemTest):
    @classmethod
    def setUpClass(cls):
        """What the last test looks at: it takes its time."""
        cls.early = harness.Sandbox()
        path = cls.early.folder / "ends.yaml"
        path.write_text("stages:\n  - component: corridor_builder\n"
                        "  - command: [/bin/false]\n    name: ends\n")
        cls.hopeless = Launch(cls.early, path)

    @classmethod
    def tearDownClass(cls):
        left = cls.early.close()
        if left:
            raise AssertionError(f"processes outlived the test: {left}")

    def launch_file(self, text):
        path = self.sandbox.folder / "test.yaml"
        path.write_text(text)
        return path

    def launch(self, text, *arguments):
        outcome = self.sandbox.goshawk("launch", self.launch_file(text), "--json", "--log-dir",
                                       self.sandbox.folder / "logs", *arguments, timeout_s=60)
        self.assert_civil(outcome)
        return outcome

    def test_wrong_parameters_stop_it_with_all_faults(self):
        outcome = self.launch("stages:\n  - component: corridor_builder\n  - component: tracker\n"
                              "    params: {mas_kg: 1.0, max_tilt_rad: -2, max_thrust_n: heavy}\n")
        self.assertEqual(outcome.status, 2, str(outcome))
        for word in ("tracker", "mas_kg", "mass_kg", "max_tilt_rad", "max_thrust_n"):
            self.assertIn(word, outcome.out)

    def test_wrong_programs_that_always_end_are_given_up(self):
        launch = self.hopeless
        status = launch.process.wait(60.0)
        self.assertEqual(status, 1, launch.tails())
        self.assert_civil(launch.process.outcome())
        failed = launch.events("failed")
        self.assertEqual([e["stage"] for e in failed], ["ends"])
        self.assertIn("gave up", failed[0]["message"])
        self.assertIn("exit status 1", failed[0]["message"])
        self.assertEqual((failed[0]["ok"], failed[0]["code"]), (False, "stage_silent"))

    def test_a_program_that_cannot_be_started_is_refused_at_once_with_its_path(self):
        for command, path in (("[/no/such/program]", "/no/such/program"),
                              ("[./absent]", self.sandbox.folder / "absent"),
                              ("[no_such_program_xyz]", "no_such_program_xyz")):
            outcome = self.launch(f"stages:\n  - component: tracker\n  - command: {command}\n")
            self.assertEqual(outcome.status, 2, str(outcome))
            self.assertIn(str(path), outcome.out)
            self.assertFalse((self.sandbox.folder / "logs").exists(), "nothing was started")

    def test_wrong_launch_files(self):
        component = "stages: [{component: tracker}]\n"
        for text, word in [("", "map of names"), ("[]", "map of names"),
                           ("stages: []", "no stages"),
                           ("stages: 5", "no stages"), ("stage: []", "did you mean stages"),
                           ("stages: [{}]", "component or a command"),
                           ("stages: [{component: tracker, command: [a]}]",
                            "component or a command"),
                           ("stages: [{component: tracker, parms: {}}]",
                            "did you mean params"),
                           ("stages: [{component: tracker, params: 3}]", "params"),
                           ("stages: [{command: ls}]", "not a list"),
                           ("stages: [{command: []}]", "command"),
                           ("stages: [{component: tracker}, {component: tracker}]", "two stages"),
                           ("stages: [{component: traker}]", "tracker"),
                           ("stages: [5]", "stage 1"),
                           ("stages: {", "not valid YAML"),
                           ("a: !!python/object:os.system {}\n" + component, "not valid YAML"),
                           (component + "domain: 999\n", "999"),
                           (component + "domain: five\n", "five"),
                           (component + "params_files: none.yaml\n", "none.yaml"),
                           (component + "params_files: [none.yaml]\n", "none.yaml"),
                           (component + "namespace: 'a b'\n", "a b"),
                           ("\x00", "YAML")]:
            with self.subTest(file=text):
                outcome = self.launch(text)
                self.assertEqual(outcome.status, 2, str(outcome))
                self.assertIn(word, outcome.out + outcome.err)

    def test_missing_launch_files(self):
        for name in ("flihgt", "/no/such/file.yaml", "/", "/dev/null"):
            with self.subTest(file=name):
                outcome = self.sandbox.goshawk("launch", name, timeout_s=20)
                self.assert_civil(outcome)
                self.assertEqual(outcome.status, 2, str(outcome))
                self.assertIn(name, outcome.err)
        near = self.sandbox.goshawk("launch", "flihgt", timeout_s=20)
        self.assertIn("did you mean flight?", near.err)

    def test_a_folder_of_its_name_does_not_hide_an_installed_file(self):
        (self.sandbox.folder / "flight").mkdir()
        world = self.sandbox.folder / "world.bt"
        self.assertEqual(self.sandbox.goshawk("world", world).status, 0)
        launch = Launch(self.sandbox, "flight", "-p", f"map_server:map_file:={world}")
        self.assertTrue(until(lambda: launch.events("running"), 15.0), launch.tails())

    def test_bytes_that_are_no_text(self):
        path = self.sandbox.folder / "bad.yaml"
        path.write_bytes(b"stages: \xff\xfe\x80")
        outcome = self.sandbox.goshawk("launch", path, timeout_s=20)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("bad.yaml", outcome.err)


if __name__ == "__main__":
    harness.main()
