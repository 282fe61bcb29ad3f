#!/usr/bin/python3
"""Wrong calls of each verb: status, code and sentence; help; what may follow on a command line."""

import re

import harness
from calls_case import DONE, NOT_DONE, WRONG_CALL, CallsCase

ALL_VERBS = ["plan", "fly", "check", "world", "campaign", "launch", "goto", "hold", "resume",
             "land", "takeoff", "mission", "why", "view", "run",
             "bench plan", "bench search", "bench scenario", "bench stage", "bench dds", "bench corridor",
             "bench trajectory", "bench guard", "bench replan", "bench updates", "bench tracking",
             "bench map", "bench sensors", "bench senses", "bench obstacles", "conform", "record", "replay",
             "bag record", "bag play", "bag info",
             "map info", "map save", "map load", "map crop", "map merge", "map diff", "map picture",
             "sense check",
             "interface list", "interface show", "topic list", "topic info", "topic type",
             "topic find", "topic echo", "topic hz", "topic delay", "topic bw", "topic pub",
             "node list", "node info", "param list", "param get", "param set", "param describe",
             "param dump", "doctor", "secure init"]


class BadCalls(CallsCase):
    def wrong(self, arguments, *words):
        outcome = self.sandbox.goshawk(*arguments, timeout_s=20)
        with self.subTest(call=" ".join(arguments)):
            self.assert_civil(outcome)
            self.assertEqual(outcome.status, WRONG_CALL, str(outcome))
            for word in words:
                self.assertIn(word, outcome.err)

    def test_verbs(self):
        self.wrong(["paln"], "paln", "plan")
        self.wrong(["xyzzy"], "xyzzy", "--help")
        self.wrong(["topic", "lst"], "lst", "list")
        self.wrong(["node", "kill"], "kill")
        self.wrong(["param", "describe", "traker"], "traker", "tracker")
        self.wrong(["run"], "COMPONENT")
        self.wrong(["run", "traker"], "traker", "tracker")
        self.wrong(["launch"], "file")
        self.assertEqual(self.sandbox.goshawk().status, WRONG_CALL)

    def test_options(self):
        for verb in ("plan", "fly", "topic", "node", "launch", "run"):
            self.wrong([verb, "--gaol", "1,2,3"], "gaol")
        self.wrong(["plan", "--goal"], "--goal")
        self.wrong(["fly", "--random", "many"], "random")
        self.wrong(["world", "out.bt", "--seed=-1"], "seed")
        self.wrong(["world"], "output")
        self.wrong(["map", "crop", "a.bt", "b.bt", "--lower", "0,0,0"], "--upper")
        self.wrong(["map", "merge", "all.bt", "a.bt", "--rule", "newer"], "newer", "later")
        self.wrong(["map", "diff", "a.bt"], "files")
        self.wrong(["sense", "chekc", "a.mcap"], "chekc", "check")
        self.wrong(["sense", "check", "a.mcap", "--a-max", "0"], "--a-max")

    def test_wrong_options_answer_in_json_where_that_is_asked_for(self):
        for verb in ALL_VERBS:
            self.expect([*verb.split(), "--gaol", "1,2,3"], WRONG_CALL, "invalid_input", "gaol")

    def test_failures_of_every_verb_have_one_shape(self):
        for arguments, status, code in [
                (["check", "/no/such/flight"], WRONG_CALL, "invalid_parameter"),
                (["world", "out.bt", "--kind", "forrest"], WRONG_CALL, "invalid_parameter"),
                (["campaign", "--missions", "0"], WRONG_CALL, "invalid_parameter"),
                (["campaign", "--kinds", "forrest"], WRONG_CALL, "invalid_parameter"),
                (["campaign", "--output", "/proc/campaign"], NOT_DONE, "io_failed"),
                (["launch", "flihgt"], WRONG_CALL, "invalid_parameter"),
                (["launch"], WRONG_CALL, "invalid_input"),
                (["view", "/no/such/flight"], WRONG_CALL, "io_failed"),
                (["run", "traker"], WRONG_CALL, "invalid_parameter"),
                (["bench", "stage", "tracker", "--input", "/no.mcap"], NOT_DONE, "io_failed"),
                (["bench", "stage", "traker", "--input", "/no.mcap"], WRONG_CALL,
                 "invalid_parameter"),
                (["conform", "traker"], WRONG_CALL, "invalid_parameter"),
                (["record", "a b"], WRONG_CALL, "invalid_parameter"),
                (["replay", "/no.mcap"], NOT_DONE, "io_failed"),
                (["topic", "echo", "/a b"], WRONG_CALL, "invalid_parameter"),
                (["goto", "1,2"], WRONG_CALL, "invalid_parameter"),
                (["goto", "1,2,3", "--ready", "0.2"], NOT_DONE, "stage_silent"),
                (["hold", "--namespace", "a b"], WRONG_CALL, "invalid_parameter"),
                (["resume", "--ready", "0.2"], NOT_DONE, "stage_silent"),
                (["land", "--ready", "0.2"], NOT_DONE, "stage_silent"),
                (["takeoff", "--height", "0"], WRONG_CALL, "invalid_parameter"),
                (["mission", "/no.yaml"], NOT_DONE, "io_failed"),
                (["why", "/no.mcap"], NOT_DONE, "io_failed"),
                (["mission", "--ready", "0.2"], NOT_DONE, "stage_silent"),
                (["bag", "play", "/no.mcap"], NOT_DONE, "io_failed"),
                (["bag", "info", "/no.mcap"], NOT_DONE, "io_failed"),
                (["interface", "show", "goshawk_msgs/msg/Pth"], WRONG_CALL, "invalid_parameter"),
                (["node", "list", "--timeout", "0.2"], NOT_DONE, "stage_silent"),
                (["node", "info", "/a", "--timeout", "0.2"], NOT_DONE, "stage_silent"),
                (["node", "info", "a b"], WRONG_CALL, "invalid_parameter"),
                (["param", "describe", "traker"], WRONG_CALL, "invalid_parameter"),
                (["fly", "--launch", "flihgt", "--output", self.sandbox.folder / "out"],
                 WRONG_CALL, "invalid_parameter"),
                (["fly", "-p", "tracker:mas_kg:=1", "--output", self.sandbox.folder / "out"],
                 WRONG_CALL, "invalid_parameter")]:
            self.expect(arguments, status, code)
        self.assertFalse((self.sandbox.folder / "out").exists(), "a refused fly leaves no folder")

    def test_help(self):
        for verb in ("topic", "node", "param", "bench"):
            with self.subTest(verb=verb):
                self.assertIn(verb, self.help_of(verb))
        for verb in ("fly", "topic echo", "topic"):
            helped = self.sandbox.goshawk("help", *verb.split(), timeout_s=20)
            self.assertEqual((helped.status, helped.out), (DONE, self.help_of(verb)))
        self.wrong(["help", "flu"], "flu", "fly")
        self.assertEqual(self.sandbox.goshawk("--help").status, DONE)
        self.assertIn("goshawk ", self.sandbox.goshawk("--version").out)

    def help_of(self, verb):
        outcome = self.sandbox.goshawk(*verb.split(), "--help", timeout_s=20)
        self.assertEqual(outcome.status, DONE, str(outcome))
        return outcome.out

    def test_help_shows_examples_of_its_own_options(self):
        for verb in ALL_VERBS:
            if verb in ("topic list", "node list", "interface list", "doctor"):
                continue  # nothing to show
            with self.subTest(verb=verb):
                text = self.help_of(verb)
                head, _, examples = text.partition("xample")
                shown = re.findall(rf"^  goshawk {verb}\b.*", examples, re.MULTILINE)
                self.assertTrue(shown, text)
                for option in re.findall(r" (--?[a-z][a-z-]*)\b", " ".join(shown)):
                    # What stands behind --ros-args is ROS 2's.
                    if option not in ("--ros-args", "-p", "-r", "--params-file", "--log-level"):
                        self.assertIn(option, head)

    def complete(self, *words):
        return self.sandbox.goshawk("complete", *words, timeout_s=20).out.split()

    def test_every_verb_is_among_those_that_are_tested(self):
        for group in ("bag", "bench", "interface", "topic", "node", "param", "secure"):
            words = {w for w in self.complete(group, "") if not w.startswith("-")}
            self.assertTrue(words)
            self.assertLessEqual({f"{group} {w}" for w in words}, set(ALL_VERBS))

    def test_what_may_follow(self):
        self.assertLessEqual({verb.split()[0] for verb in ALL_VERBS}, set(self.complete("")))
        self.assertNotIn("place", self.complete(""))
        self.assertLessEqual({"flight", "flight_container"}, set(self.complete("launch", "")))
        self.assertIn("tracker", self.complete("run", ""))
        self.assertIn("--goal", self.complete("fly", "--map", "x.bt", "-"))
        self.assertEqual(set(self.complete("world", "--kind", "")),
                         {"boxes", "forest", "office", "noise"})
        self.assertIn("v_max_m_s", self.complete("param", "set", "/navigator", ""))
        self.assertNotIn("mass_kg", self.complete("param", "set", "/tracker", ""))
        self.assertIn("astar", self.complete("param", "set", "/path_search", "planner", ""))

    def test_numbers_of_fly(self):
        fly = ["--output", self.sandbox.folder / "out"]
        self.expect(["fly", "--random=-1", *fly], WRONG_CALL, "invalid_parameter", "random")
        self.expect(["fly", "--timeout=0", *fly], WRONG_CALL, "invalid_parameter", "timeout")
        self.expect(["fly", "--timeout=nan", *fly], WRONG_CALL, "invalid_parameter", "timeout")

    def test_folders_that_cannot_be_written(self):
        self.expect(["fly", "--output", "/proc/flight"], NOT_DONE, "io_failed", "/proc/flight")
        blocked = self.file("file", b"")
        self.expect(["fly", "--output", blocked / "flight"], NOT_DONE, "io_failed", str(blocked))
        (blocked.parent / "taken" / "events.jsonl").mkdir(parents=True)
        self.expect(["fly", "--output", blocked.parent / "taken"], NOT_DONE, "io_failed",
                    "events.jsonl", timeout_s=60)
        self.expect(["world", "/no/such/folder/world.bt"], NOT_DONE, "io_failed",
                    "/no/such/folder/world.bt")
        self.expect(["world", blocked / "world.bt"], NOT_DONE, "io_failed", str(blocked))
        outcome = self.sandbox.goshawk("plan", "--save", "/proc/plan", timeout_s=20)
        self.assertEqual(outcome.status, NOT_DONE, str(outcome))
        self.assertIn("/proc/plan", outcome.err)

    def test_a_plan_that_cannot_be_saved_is_one_object(self):
        self.expect(["plan", "--save", "/proc/plan"], NOT_DONE, "io_failed", "/proc/plan")

    def test_domains_and_interfaces(self):
        for name, value in (("ROS_DOMAIN_ID", "x"), ("ROS_DOMAIN_ID", "233"),
                            ("ROS_DOMAIN_ID", "-1"), ("GOSHAWK_INTERFACES", "1.2.3.4"),
                            ("GOSHAWK_INTERFACES", "nonsense")):
            for command in (["run", "tracker"], ["topic", "list"], ["node", "list"],
                            ["fly", "--output", self.sandbox.folder / "out"]):
                with self.subTest(name=name, value=value, command=command[0]):
                    outcome = self.sandbox.goshawk(*command, env={name: value}, timeout_s=20)
                    self.assert_civil(outcome)
                    self.assertNotEqual(outcome.status, DONE, str(outcome))
                    self.assertIn(value, outcome.err)

    def test_parameters_of_a_component(self):
        outcome = self.sandbox.goshawk("run", "tracker", "--ros-args", "-p", "mas_kg:=1", "-p",
                                       "max_tilt_rad:=steep", "-p", "min_thrust_n:=-1",
                                       timeout_s=20)
        self.assert_civil(outcome)
        self.assertEqual(outcome.status, WRONG_CALL, str(outcome))
        for word in ("mas_kg", "mass_kg", "max_tilt_rad", "steep", "min_thrust_n"):
            self.assertIn(word, outcome.err)

    def test_components_that_cannot_start(self):
        for arguments, word in [(["map_server"], "map_file"),
                                (["map_server", "--ros-args", "-p", "map_file:=/no/such.bt"],
                                 "/no/such.bt"),
                                (["tracker", "tracker"], "tracker"),
                                (["tracker", "--ros-args", "-r", "x"], "x"),
                                (["tracker", "--ros-args", "-r", "__node:=a b"], "a b"),
                                (["tracker", "--ros-args", "--params-file"], "--params-file"),
                                (["tracker", "--ros-args", "--log-level", "loud"], "loud")]:
            self.wrong(["run", *arguments], word)


if __name__ == "__main__":
    harness.main()
