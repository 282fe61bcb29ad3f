#!/usr/bin/python3
"""goshawk launch: starts what a launch file lists under supervisord, until Ctrl-C.

Its one argument is a JSON object of options, which goshawk_cli writes (verbs/launch.cpp).
"""

import json
import os
import signal
import subprocess
import sys
import time

import launch_file
import stage_names
import supervision
from launch_file import WrongCall

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2
RETRIES = 5     # starts after the first before a launch that begins gives up
PERIOD_S = 0.05
STAYS_S = 1.0   # a process that lives for so long runs


class Failure(Exception):
    def __init__(self, code, message, status=NOT_DONE, stage=""):
        super().__init__(message)
        self.code, self.status, self.stage = code, status, stage


class Voice:
    """Events on standard output: lines for people, or objects. Who reads them may go away: the
    flight does not end because of that."""

    def __init__(self, as_json):
        self.as_json = as_json

    def say(self, event, stage="", text="", **more):
        if self.as_json:
            self.write(json.dumps({"event": event, "stage": stage, "message": text, **more}))
        else:
            self.write(f"[launch] {stage + ': ' if stage else ''}{text or event}")

    def fail(self, failure):
        if self.as_json:
            self.say("failed", failure.stage, str(failure), ok=False, code=failure.code)
        else:
            of = f"{failure.stage}: " if failure.stage else ""
            print(f"goshawk launch: {failure.code}: {of}{failure}", file=sys.stderr, flush=True)
        return failure.status

    def write(self, line):
        try:
            print(line, flush=True)
        except BrokenPipeError:
            sys.stdout = open(os.devnull, "w", encoding="utf-8")


class Stage:
    """What is known of one program's process."""

    def __init__(self, program):
        self.name, self.essential = program.name, program.essential
        self.pid = None
        self.since_s = 0.0      # monotonic time at which its start was seen
        self.lives = False      # its end was not seen
        self.runs = False       # it has lived for STAYS_S
        self.has_run = False    # it, or one before
        self.how = ""           # how it ended last
        self.fast_ends = 0      # in a row, none of which ran


class Launch:
    def __init__(self, programs, logs, voice):
        self.logs, self.voice = logs, voice
        self.stages = {p.name: Stage(p) for p in programs}
        self.stopping = False
        self.up = False  # every essential stage has run

    def run(self, programs, descriptors):
        supervisor = supervision.Supervisor(programs, self.logs, descriptors)
        self.voice.say("starting", text=f"starting {', '.join(self.stages)}; logs in {self.logs}")
        failure = None
        try:
            self.watch(supervisor)
        except Failure as caught:
            failure = caught
        left = supervisor.stop()
        if left and failure is None:
            failure = Failure("io_failed", f"these processes do not end: {left}")
        status = self.voice.fail(failure) if failure else DONE
        if not left:
            self.voice.say("stopped", text="all stages stopped")
        return status

    def watch(self, supervisor):
        while not self.stopping:
            how = supervisor.how_it_ended()
            for event, match in supervisor.events():
                getattr(self, f"on_{event}")(match.groupdict())
            self.look_who_runs()
            if how:
                raise Failure("io_failed", f"supervisord ended ({how}), and all stages with it; its "
                              f"log: {self.logs}/supervisord.log")
            time.sleep(PERIOD_S)

    def on_spawned(self, match):
        stage = self.stages[match["name"]]
        before, stage.pid = stage.pid, int(match["pid"])
        stage.since_s, stage.lives, stage.runs = time.monotonic(), True, False
        if before is not None:
            self.voice.say("restarted", stage.name, f"ended unexpectedly ({stage.how}), was started "
                           f"again as process {stage.pid}; its log: {self.log_of(stage)}")

    def look_who_runs(self):
        now_s = time.monotonic()
        for stage in self.stages.values():
            if (stage.lives and not stage.runs and now_s - stage.since_s > STAYS_S
                    and supervision.is_alive(stage.pid)):
                stage.runs = stage.has_run = True
                stage.fast_ends = 0
                self.voice.say("running", stage.name, f"running as process {stage.pid}")
        if not self.up and all(s.has_run for s in self.stages.values() if s.essential):
            self.up = True
            self.voice.say("up", text="every essential stage runs")

    def on_exited(self, match):
        stage = self.stages[match["name"]]
        stage.how, stage.lives = match["how"], False
        stage.fast_ends += 1
        self.judge(stage)

    def on_fault(self, match):
        # supervisord does not say of which program: before the launch is up, that is fatal.
        if "too quickly" not in match["how"] and not self.up:
            raise Failure("io_failed", match["how"])

    def judge(self, stage):
        """Before all is up, a stage that cannot start ends the launch. Later nothing does: the
        tracker and the vehicle do not stop because something else has."""
        tail = f"; the end of its log {self.log_of(stage)}:\n{self.tail_of(stage)}"
        if not self.up and not stage.has_run:
            # Status 2 is a wrong parameter or call: starting it again would only repeat it.
            if stage.how == "exit status 2":
                raise Failure("invalid_parameter", f"cannot start{tail}", WRONG_CALL, stage.name)
            if stage.essential and stage.fast_ends > RETRIES:
                raise Failure("stage_silent", f"gave up after {RETRIES} restarts ({stage.how}){tail}",
                              stage=stage.name)
        if stage.fast_ends == RETRIES + 1:
            self.voice.say("failing", stage.name, f"ended {stage.fast_ends} times in a row "
                           f"({stage.how}); it is started again, ever more rarely{tail}")

    def log_of(self, stage):
        return os.path.join(self.logs, f"{stage.name}.log")

    def tail_of(self, stage, lines=15):
        try:
            with open(self.log_of(stage), encoding="utf-8", errors="replace") as file:
                return "".join("    " + line for line in file.readlines()[-lines:]).rstrip()
        except OSError:
            return "    (it left no log)"


def place(plan, options):
    """Adds the map, and where the vehicle begins in it, to the parameters: what the caller asked
    for, or a made world if nothing names a map."""
    server, plant = plan.node_of({"map_server"}), plan.node_of(launch_file.PLANTS)
    for option, node, kind in (("map", server, "map_server"), ("start", plant, "simulated vehicle")):
        if options[option] and node is None:
            raise WrongCall(f"--{option}: {plan.path} starts no {kind}")
    if server is None:
        if options["start"]:
            for axis, value in zip("xyz", options["start"].split(",")):
                plan.extra += ["-p", f"{plant}:start_{axis}_m:={value}"]
        return None
    arguments = plan.ros_args(plan.stages_with_nodes())
    named = any(a.startswith(f"{server}:map_file:=") for a in arguments)
    if named and not options["map"] and not options["start"]:
        return None
    command = [os.path.join(options["prefix"], "bin/goshawk"), "place", "--json",
               "--map-server", server, "--world", os.path.join(options["log_dir"], "world.bt")]
    for option, value in (("--plant", plant), ("--map", options["map"]),
                          ("--start", options["start"])):
        if value:
            command.append(f"{option}={value}")
    asked = subprocess.run([*command, "--ros-args", *arguments], text=True,
                           stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
    try:
        answer = json.loads(asked.stdout)
    except ValueError:
        raise Failure("io_failed", f"the map could not be prepared: {asked.stdout}") from None
    if not answer["ok"]:
        raise Failure(answer["code"], answer["message"], asked.returncode)
    for name, value in answer["parameters"].items():
        plan.extra += ["-p", f"{name}:={value}"]
    return answer["message"]


# component, its parameter, and the file in the folder of logs
MEMORIES = (("map_server", "journal_file", "map.journal"),
            ("navigator", "memory_file", "navigator.memory"),
            ("mission", "memory_file", "mission.memory"))


def keep_memories(plan, log_dir):
    """Gives stages files, so that one that is started again goes on where it ended: the map server
    with its map, the navigator with its goal, the mission where it was. What another launch has
    left there is removed."""
    arguments = plan.ros_args(plan.stages_with_nodes())
    for component, parameter, name in MEMORIES:
        node = plan.node_of({component})
        if node is None or any(a.startswith(f"{node}:{parameter}:=") for a in arguments):
            continue
        path = os.path.abspath(os.path.join(log_dir, name))
        if os.path.exists(path):
            os.remove(path)
        plan.extra += ["-p", f"{node}:{parameter}:={path}"]


def domain_of(content):
    domain = content.get("domain", os.environ.get("ROS_DOMAIN_ID") or 0)
    try:
        number = -1 if isinstance(domain, bool) else int(domain)
    except (TypeError, ValueError):
        number = -1
    if not 0 <= number <= 232:
        raise WrongCall(f"domain {domain!r} is not a number from 0 to 232")
    os.environ["ROS_DOMAIN_ID"] = str(number)
    return number


def launch(options, voice):
    content = launch_file.read(options["file"])
    domain = domain_of(content)
    interfaces = launch_file.choose_host(content, options["file"], options["host"])
    if interfaces:
        os.environ.setdefault("GOSHAWK_INTERFACES", interfaces)
    plan = launch_file.Plan(content, options["file"], options["prefix"], options["ros_args"],
                            options["host"])
    if options["secure"]:
        plan.secure = os.path.abspath(options["secure"])
    nodes = [node for program in plan.programs() for node in program.nodes]
    if options["check"]:
        names = [program.name for program in plan.programs()]
        voice.say("checked", text=f"{options['file']} starts {', '.join(names)}", ok=True, code="ok",
                  stages=names)
        return DONE
    names = stage_names.StageNames(domain, nodes)
    os.makedirs(options["log_dir"], exist_ok=True)
    said = place(plan, options)
    if said:
        voice.say("placed", text=said)
    keep_memories(plan, options["log_dir"])
    programs = plan.programs()
    running = Launch(programs, os.path.abspath(options["log_dir"]), voice)

    def stop(*_):
        running.stopping = True

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    if options["stop_with_parent"]:
        supervision.stop_with_parent(options["parent"])
    return running.run(programs, names.descriptors())


def main():
    options = json.loads(sys.argv[1])
    voice = Voice(options["json"])
    try:
        return launch(options, voice)
    except WrongCall as fault:
        return voice.fail(Failure("invalid_parameter", str(fault), WRONG_CALL))
    except stage_names.InUse as taken:
        return voice.fail(Failure("io_failed", str(taken)))
    except OSError as error:
        return voice.fail(Failure("io_failed", str(error)))
    except Failure as failure:
        return voice.fail(failure)


if __name__ == "__main__":
    sys.exit(main())
