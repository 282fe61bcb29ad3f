#!/usr/bin/python3
"""goshawk launch FILE.yaml: starts what a launch file lists under supervisord, until Ctrl-C.

A launch file (docs/launch.md):

    namespace: /uav1            # optional
    domain: 5                   # optional; else ROS_DOMAIN_ID
    container: false            # true: all components in one process
    params_files: [my.yaml]     # optional, beside the launch file or absolute
    stages:
      - component: path_search  # one of the installed components ...
        node: path_search       # optional, its node's name
        params: {planner: astar}
        remap: {path: my_path}
        realtime: 10            # optional: priority 1 to 99, where the system permits it
      - command: [./my_search]  # ... or a program of your own
        name: my_search
"""

import argparse
import ctypes
import difflib
import http.client
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import xmlrpc.client

import yaml
from supervisor.xmlrpc import SupervisorTransport

DONE, NOT_DONE, WRONG_CALL = 0, 1, 2
FILE_KEYS = {"namespace", "domain", "container", "params_files", "stages"}
STAGE_KEYS = {"component", "node", "params", "remap", "command", "name", "realtime"}
RETRIES = 5


class WrongCall(Exception):
    pass


def nearest(word, known):
    match = difflib.get_close_matches(str(word), sorted(known), 1)
    return f"; did you mean {match[0]}?" if match else ""


def check_keys(mapping, known, where):
    if not isinstance(mapping, dict):
        raise WrongCall(f"{where} is not a map of names to values")
    faults = [f"{where} has no key '{k}'{nearest(k, known)}" for k in mapping if k not in known]
    if faults:
        raise WrongCall("\n  ".join(faults))


def read_launch_file(path):
    try:
        with open(path, encoding="utf-8") as file:
            content = yaml.safe_load(file)
    except OSError as error:
        raise WrongCall(f"{path} cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise WrongCall(f"{path} is not valid YAML: {error}") from error
    check_keys(content, FILE_KEYS, path)
    if not isinstance(content.get("params_files", []), list):
        raise WrongCall(f"{path}: params_files is not a list of files but"
                        f" {content['params_files']!r}: write params_files: [my.yaml]")
    stages = content.get("stages")
    if not isinstance(stages, list) or not stages:
        raise WrongCall(f"{path} lists no stages: write stages: [{{component: map_server}}, ...]")
    for index, stage in enumerate(stages):
        where = f"{path}, stage {index + 1}"
        check_keys(stage, STAGE_KEYS, where)
        if ("component" in stage) == ("command" in stage):
            raise WrongCall(f"{where} needs either a component or a command")
        if "command" in stage and not (isinstance(stage["command"], list) and stage["command"]):
            raise WrongCall(f"{where}: command is not a list, as in [./my_search, --fast]")
        for key in ("params", "remap"):
            if not isinstance(stage.get(key, {}), dict):
                raise WrongCall(f"{where}: {key} is not a map of names to values")
        priority = stage.get("realtime", 1)
        if not isinstance(priority, int) or not 1 <= priority <= 99:
            raise WrongCall(f"{where}: realtime is {priority!r}: a priority from 1 to 99 is meant")
    return content


def realtime_is_permitted():
    """Whether this user may give processes real-time priority: tried on this one, and undone."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except OSError:
        return False
    os.sched_setscheduler(0, *before)
    return True


def scalar(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def with_priority(stage, command):
    if "realtime" not in stage or not realtime_is_permitted():
        return command
    return ["/usr/bin/chrt", "--fifo", str(stage["realtime"]), *command]


class Plan:
    """What to start: names, command lines, environment."""

    def __init__(self, content, path, prefix, extra):
        self.folder = os.path.dirname(os.path.abspath(path))
        self.container = os.path.join(prefix, "bin", "goshawk_container")
        self.namespace = content.get("namespace", "/")
        self.extra = extra
        self.params_files = [self.beside(f) for f in content.get("params_files", [])]
        components = [s for s in content["stages"] if "component" in s]
        commands = [s for s in content["stages"] if "command" in s]
        self.programs = {}
        if content.get("container") and components:
            self.add("container", self.component_command(components))
        else:
            for stage in components:
                self.add(stage.get("node", stage["component"]),
                         with_priority(stage, self.component_command([stage])))
        for stage in commands:
            name = stage.get("name", os.path.basename(stage["command"][0]))
            first = stage["command"][0]
            if "/" in first:
                first = self.beside(first)
            self.add(name, with_priority(stage, [first, *map(scalar, stage["command"][1:])]))

    def beside(self, path):
        return os.path.normpath(os.path.join(self.folder, path))

    def add(self, name, command):
        if name in self.programs:
            raise WrongCall(f"two stages are named {name}: give one of them another node or name")
        self.programs[name] = command

    def component_command(self, stages):
        nodes = [s.get("node", s["component"]) for s in stages]
        command = [self.container] + [f"{s['component']}:{n}" for s, n in zip(stages, nodes)]
        command += ["--ros-args", "-r", f"__ns:={self.namespace}"]
        for file in self.params_files:
            command += ["--params-file", file]
        for stage, node in zip(stages, nodes):
            for key, value in stage.get("params", {}).items():
                command += ["-p", f"{node}:{key}:={scalar(value)}"]
            for source, target in stage.get("remap", {}).items():
                command += ["-r", f"{node}:{source}:={target}"]
        # What the caller adds goes to every component; parameters name their node themselves.
        return command + self.extra


def quoted(argument):
    """supervisord splits like a shell and expands %(x)s."""
    return "'" + argument.replace("'", "'\\''").replace("%", "%%") + "'"


def supervisor_configuration(plan, logs, socket):
    lines = ["[unix_http_server]", f"file={socket}", "[supervisord]", "nodaemon=true",
             f"logfile={logs}/supervisord.log", f"pidfile={logs}/supervisord.pid",
             f"childlogdir={logs}", "loglevel=info",
             "[rpcinterface:supervisor]",
             "supervisor.rpcinterface_factory="
             "supervisor.rpcinterface:make_main_rpcinterface"]
    if os.geteuid() == 0:
        lines.insert(4, "user=root")
    # One group: supervisord stops groups one after the other, a second or two for each.
    lines += ["[group:stages]", "programs=" + ",".join(plan.programs)]
    for name, command in plan.programs.items():
        lines += [f"[program:{name}]", "command=" + " ".join(quoted(a) for a in command),
                  "autostart=true", "autorestart=true", "startsecs=1", f"startretries={RETRIES}",
                  "stopsignal=INT", "stopwaitsecs=5", "redirect_stderr=true",
                  f"stdout_logfile={logs}/{name}.log", "stdout_logfile_maxbytes=20MB",
                  "stdout_logfile_backups=1"]
    return "\n".join(lines) + "\n"


def stop_with_parent(parent=0):
    """SIGTERM for this process when its parent ends, however it ends.

    @param parent its process id: it may have ended before this process could ask for that"""
    pr_set_pdeathsig = 1
    ctypes.CDLL(None).prctl(pr_set_pdeathsig, signal.SIGTERM)
    if parent and os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGTERM)


class Launch:
    def __init__(self, plan, logs, as_json):
        self.plan = plan
        self.logs = logs
        self.as_json = as_json
        self.stopping = False
        # A socket's path may have 108 bytes at the most, so it has a short folder of its own.
        self.folder = tempfile.mkdtemp(prefix="goshawk-")
        self.socket = os.path.join(self.folder, "s")
        self.states = {}
        self.starts = {}

    def say(self, event, stage="", text=""):
        if self.as_json:
            line = json.dumps({"event": event, "stage": stage, "message": text})
        else:
            line = f"[launch] {stage + ': ' if stage else ''}{text or event}"
        try:
            print(line, flush=True)
        except BrokenPipeError:
            self.stopping = True

    def run(self):
        configuration = os.path.join(self.folder, "supervisord.conf")
        with open(configuration, "w", encoding="utf-8") as file:
            file.write(supervisor_configuration(self.plan, self.logs, self.socket))
        own_pid = os.getpid()
        supervisor = subprocess.Popen(
            ["/usr/bin/python3", "/usr/bin/supervisord", "-n", "-c", configuration],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            start_new_session=True, preexec_fn=lambda: stop_with_parent(own_pid))
        self.say("starting", text=f"starting {', '.join(self.plan.programs)}; logs in {self.logs}")
        status = DONE
        try:
            status = self.watch(supervisor)
        finally:
            supervisor.terminate()
            supervisor.wait()
            for name in ("supervisord.conf", "s"):
                try:
                    os.unlink(os.path.join(self.folder, name))
                except OSError:
                    pass
            os.rmdir(self.folder)
            self.say("stopped", text="all stages stopped")
        return status

    def watch(self, supervisor):
        while not self.stopping:
            # A new one each time: after a failed call (the socket is not there yet) a transport
            # never recovers.
            server = xmlrpc.client.ServerProxy("http://127.0.0.1", transport=SupervisorTransport(
                None, None, f"unix://{self.socket}"))
            if supervisor.poll() is not None:
                self.say("failed", text="supervisord ended: see supervisord.log")
                return NOT_DONE
            try:
                processes = server.supervisor.getAllProcessInfo()
            except (OSError, http.client.HTTPException, xmlrpc.client.Error):
                processes = []
            for info in processes:
                status = self.judge(info)
                if status != DONE:
                    return status
            time.sleep(0.1)
        return DONE

    def judge(self, info):
        name, state, start = info["name"], info["statename"], info["start"]
        before = self.states.get(name)
        self.states[name] = state
        restarted = name in self.starts and self.starts[name] != start
        self.starts[name] = start
        if restarted and state in ("STARTING", "RUNNING", "BACKOFF"):
            # How it ended is gone once it runs again; supervisord's log keeps it.
            self.say("restarted", name, f"ended unexpectedly ({self.how_it_ended(name)}), "
                                        "was started again")
        if state == before:
            return DONE
        if state == "RUNNING":
            self.say("running", name, "running")
        # Status 2 is a wrong parameter or call: starting it again would only repeat it.
        if state in ("BACKOFF", "EXITED") and self.how_it_ended(name) == "exit status 2":
            self.say("failed", name, "cannot start:\n" + self.log_tail(name))
            return WRONG_CALL
        if state == "FATAL":
            self.say("failed", name, f"gave up after {RETRIES} restarts:\n" + self.log_tail(name))
            return NOT_DONE
        return DONE

    def how_it_ended(self, name):
        how = "unknown"
        try:
            with open(os.path.join(self.logs, "supervisord.log"), encoding="utf-8") as file:
                for line in file:
                    if f"exited: {name} (" in line:
                        how = line.split("(", 1)[1].split(";")[0].rstrip(")\n")
        except OSError:
            pass
        return how

    def log_tail(self, name, lines=15):
        try:
            with open(os.path.join(self.logs, f"{name}.log"), encoding="utf-8") as file:
                return "".join("    " + line for line in file.readlines()[-lines:]).rstrip()
        except OSError:
            return "    (it left no log)"


class ListFiles(argparse.Action):
    """--list: the installed launch files, one a line, and nothing else."""

    def __call__(self, parser, options, *_):
        folder = os.path.join(options.prefix, "share/goshawk/launch")
        for name in sorted(os.listdir(folder)):
            print(name.removesuffix(".yaml"))
        parser.exit()


def main():
    arguments, extra = sys.argv[1:], []
    if "--ros-args" in arguments:
        at = arguments.index("--ros-args")
        arguments, extra = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(
        prog="goshawk launch", description="Start what a launch file lists, supervised, until "
        "Ctrl-C. Options behind --ros-args go to every\ncomponent, as in "
        "--ros-args -p path_search:planner:=astar --params-file my.yaml",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="examples:\n  goshawk launch flight\n"
        "  goshawk launch flight_container --log-dir logs --ros-args -p navigator:v_max_m_s:=1\n"
        "  goshawk launch --list")
    parser.add_argument("file", help="launch file, or the name of an installed one (flight)")
    parser.add_argument("--log-dir", help="folder for the logs (default: a new one in /tmp)")
    parser.add_argument("--json", action="store_true", help="one JSON object a line")
    parser.add_argument("--prefix", required=True, help=argparse.SUPPRESS)
    parser.add_argument("--list", action=ListFiles, nargs=0,
                        help="print the names of the installed launch files, and end")
    parser.add_argument("--stop-with-parent", action="store_true",
                        help="stop as on Ctrl-C when the process that started this one ends")
    parser.add_argument("--parent", type=int, default=0, help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    path = options.file
    if not os.path.isfile(path) and "/" not in path:
        path = os.path.join(options.prefix, "share/goshawk/launch",
                            path if path.endswith(".yaml") else path + ".yaml")
    try:
        content = read_launch_file(path)
        plan = Plan(content, path, options.prefix, extra)
    except WrongCall as fault:
        print(f"goshawk launch: invalid_parameter: {fault}", file=sys.stderr)
        return WRONG_CALL
    if "domain" in content:
        os.environ["ROS_DOMAIN_ID"] = str(content["domain"])
    logs = os.path.abspath(options.log_dir or tempfile.mkdtemp(prefix="goshawk-logs-"))
    os.makedirs(logs, exist_ok=True)
    launch = Launch(plan, logs, options.json)

    def stop(*_):
        launch.stopping = True

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    if options.stop_with_parent:
        stop_with_parent(options.parent)
    return launch.run()


if __name__ == "__main__":
    sys.exit(main())
