"""Launch files (docs/launch.md): read, checked as a whole, and turned into command lines."""

import difflib
import os
import re
import shutil
import xml.etree.ElementTree as ElementTree

import yaml

import topic_rights

FILE_KEYS = {"namespace", "domain", "container", "params_files", "hosts", "stages"}
STAGE_KEYS = {"component", "node", "params", "remap", "command", "name", "realtime", "essential",
              "host"}
NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.-]*")
# A flight goes on without these.
OBSERVERS = {"flight_check", "mission", "viewer_bridge", "visualizer"}
PLANTS = {"simulator", "mujoco", "px4_stand_in"}


class WrongCall(Exception):
    """What is wrong with a launch file or with the options, in a sentence."""


def nearest(word, known):
    match = difflib.get_close_matches(str(word), sorted(known), 1)
    return f"; did you mean {match[0]}?" if match else ""


def check_keys(mapping, known, place):
    if not isinstance(mapping, dict):
        raise WrongCall(f"{place} is not a map of names to values")
    faults = [f"{place} has no key '{k}'{nearest(k, known)}" for k in mapping if k not in known]
    if faults:
        raise WrongCall("\n  ".join(faults))


def read(path):
    """@return the content of a launch file, with every key checked"""
    try:
        with open(path, encoding="utf-8") as file:
            content = yaml.safe_load(file)
    except OSError as error:
        raise WrongCall(f"{path} cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise WrongCall(f"{path} is not valid YAML: {error}") from error
    check_keys(content, FILE_KEYS, path)
    check_texts(content, ("namespace",), path)
    if not isinstance(content.get("params_files", []), list):
        raise WrongCall(f"{path}: params_files is not a list of files but"
                        f" {content['params_files']!r}: write params_files: [my.yaml]")
    if not isinstance(content.get("container", False), bool):
        raise WrongCall(f"{path}: container is neither true nor false")
    stages = content.get("stages")
    if not isinstance(stages, list) or not stages:
        raise WrongCall(f"{path} lists no stages: write stages: [{{component: map_server}}, ...]")
    hosts = hosts_of(content, path)
    for number, stage in enumerate(stages, 1):
        check_stage(stage, f"{path}, stage {number}")
        check_host(stage, hosts, f"{path}, stage {number}")
    return content


def hosts_of(content, path):
    """@return {name: interfaces, or "" if the environment says them}"""
    hosts = content.get("hosts", {})
    if not isinstance(hosts, dict) or not all(isinstance(name, str) for name in hosts):
        raise WrongCall(f"{path}: hosts is not a map of names to interfaces: write hosts: "
                        "{vehicle: 192.168.1.10, ground: 192.168.1.20}")
    for name, interfaces in hosts.items():
        if interfaces is not None and not isinstance(interfaces, str):
            raise WrongCall(f"{path}: host {name} has interfaces {interfaces!r}: write IPv4 "
                            "addresses of it with commas between, all, or nothing")
    return {name: interfaces or "" for name, interfaces in hosts.items()}


def check_host(stage, hosts, place):
    if not hosts and "host" in stage:
        raise WrongCall(f"{place} has a host, but the file has no hosts: write hosts: "
                        f"{{{stage['host']}: 192.168.1.10}}")
    if hosts and "host" not in stage:
        raise WrongCall(f"{place} needs a host: one of {', '.join(hosts)}")
    if hosts and stage["host"] not in hosts:
        raise WrongCall(f"{place}: there is no host '{stage['host']}'"
                        f"{nearest(stage['host'], hosts)} (hosts has {', '.join(hosts)})")


def choose_host(content, path, host):
    """@return the interfaces of the host that this launch is for; "" if the file does not say"""
    hosts = hosts_of(content, path)
    if not hosts and host:
        raise WrongCall(f"--host {host}: {path} has no hosts, so all of it runs on one")
    if hosts and not host:
        raise WrongCall(f"{path} is for the hosts {', '.join(hosts)}: say with --host which of them "
                        "this one is")
    if host and host not in hosts:
        raise WrongCall(f"--host {host}: {path} has no such host{nearest(host, hosts)} (it has "
                        f"{', '.join(hosts)})")
    if host and not any(stage["host"] == host for stage in content["stages"]):
        raise WrongCall(f"--host {host}: {path} starts no stage on it")
    return hosts.get(host, "")


def check_texts(mapping, keys, place):
    """These are names: no lists, maps, dates or nothing at all."""
    for key in keys:
        if key in mapping and (isinstance(mapping[key], bool)
                               or not isinstance(mapping[key], (str, int))):
            raise WrongCall(f"{place}: {key} is {mapping[key]!r}, not a name")


def check_stage(stage, place):
    check_keys(stage, STAGE_KEYS, place)
    check_texts(stage, ("component", "node", "name", "host"), place)
    if ("component" in stage) == ("command" in stage):
        raise WrongCall(f"{place} needs either a component or a command")
    if "command" in stage and not (isinstance(stage["command"], list) and stage["command"]):
        raise WrongCall(f"{place}: command is not a list, as in [./my_search, --fast]")
    for key in ("params", "remap"):
        if not isinstance(stage.get(key, {}), dict):
            raise WrongCall(f"{place}: {key} is not a map of names to values")
    priority = stage.get("realtime", 1)
    if isinstance(priority, bool) or not isinstance(priority, int) or not 1 <= priority <= 99:
        raise WrongCall(f"{place}: realtime is {priority!r}, not a priority from 1 to 99")
    if not isinstance(stage.get("essential", True), bool):
        raise WrongCall(f"{place}: essential is neither true nor false")


def scalar(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def is_essential(stage):
    """Whether a flight needs this stage: by what it is, unless the file says so."""
    if "essential" in stage:
        return stage["essential"]
    if "component" in stage:
        return stage["component"] not in OBSERVERS
    words = [str(word) for word in stage["command"]]
    return not (os.path.basename(words[0]) == "goshawk" and words[1:2] == ["record"])


class Program:
    """One process to start."""

    def __init__(self, name, command, essential, nodes, role=""):
        self.name, self.command, self.essential, self.nodes = name, command, essential, nodes
        self.role = role  # under which it is certified (goshawk secure init)


class Plan:
    """What to start: names, command lines, the nodes that each process has.

    @param host only programs of this host are started; "": all"""

    def __init__(self, content, path, prefix, extra, host=""):
        self.host = host
        self.folder = os.path.dirname(os.path.abspath(path))
        self.path = path
        self.container = os.path.join(prefix, "bin", "goshawk_container")
        self.namespace = "/" + str(content.get("namespace", "/")).strip("/")
        self.params_files = [self.beside(str(f)) for f in content.get("params_files", [])]
        self.stages = content["stages"]
        self.in_container = content.get("container", False)
        self.secure = ""  # folder of goshawk secure init; empty: without DDS Security
        self.extra = list(extra)

    def beside(self, path):
        return os.path.normpath(os.path.join(self.folder, path))

    def full_name(self, node):
        return f"{self.namespace.rstrip('/')}/{node}"

    def node_of(self, components):
        """@return the node's name of the first stage that is one of these components, or None"""
        return next((s.get("node", s["component"]) for s in self.stages
                     if s.get("component") in components), None)

    def stages_with_nodes(self):
        return [s for s in self.stages if "component" in s]

    def ros_args(self, stages):
        """What stands behind --ros-args for these components in one process."""
        arguments = ["-r", f"__ns:={self.namespace}"]
        for file in self.params_files:
            arguments += ["--params-file", file]
        for stage in stages:
            node = stage.get("node", stage["component"])
            for key, value in stage.get("params", {}).items():
                arguments += ["-p", f"{node}:{key}:={scalar(value)}"]
            for source, target in stage.get("remap", {}).items():
                arguments += ["-r", f"{node}:{source}:={target}"]
        # What the caller adds goes to every component; parameters name their node themselves.
        return arguments + self.extra

    def programs(self):
        """@return the host's programs, in their order; raises WrongCall for names that clash"""
        here = [(number, s) for number, s in enumerate(self.stages, 1)
                if s.get("host", "") == self.host]
        components = [s for _, s in here if "component" in s]
        groups = [components] if self.in_container and components else [[s] for s in components]
        programs = [self.component_program(group) for group in groups]
        programs += [self.command_program(number, s) for number, s in here if "command" in s]
        names = [p.name for p in programs]
        for name in names:
            if not NAME.fullmatch(name):
                raise WrongCall(f"{self.path}: a stage cannot be named '{name}': give it a name of "
                                "letters, digits, '_', '.' and '-'")
            if names.count(name) > 1:
                raise WrongCall(f"two stages are named {name}: give one of them another node or "
                                "name")
        return [self.secured(p) for p in programs] if self.secure else programs

    def secured(self, program):
        """The program with the certificate of its role; raises WrongCall if there is none."""
        if program.role == "":
            raise WrongCall(f"{self.path}: with --secure each stage is a process of its own, with "
                            "its own rights: set container: false")
        profile = os.path.join(self.secure, program.role, "profile.xml")
        if not os.path.isfile(profile):
            raise WrongCall(f"{self.secure} has no certificate for {program.role}: make the folder "
                            f"with goshawk secure init, and --like {program.role}=ROLE for a "
                            "program of your own")
        if self.host and is_loopback_only(profile):
            raise WrongCall(
                f"{profile} is for loopback, so that {self.host} and the other hosts would never meet: "
                "put this host's address in place of 127.0.0.1, and add the other hosts' to its "
                "initialPeersList, in each profile.xml")
        program.command = ["/usr/bin/env", f"FASTRTPS_DEFAULT_PROFILES_FILE={profile}",
                           *program.command]
        return program

    def component_program(self, stages):
        nodes = [str(s.get("node", s["component"])) for s in stages]
        command = [self.container] + [f"{s['component']}:{n}" for s, n in zip(stages, nodes)]
        command += ["--ros-args", *self.ros_args(stages)]
        full_names = [self.full_name(n) for n in nodes]
        if self.in_container:
            return Program("container", command, True, full_names)
        stage = stages[0]
        return Program(nodes[0], with_priority(stage, command), is_essential(stage), full_names,
                       topic_rights.role_of(stage["component"]))

    def command_program(self, number, stage):
        words = [scalar(word) for word in stage["command"]]
        words[0] = self.executable(words[0], f"{self.path}, stage {number}")
        name = str(stage.get("name", os.path.basename(words[0])))
        recorder = [os.path.basename(words[0]), *words[1:2]] == ["goshawk", "record"]
        return Program(name, with_priority(stage, words), is_essential(stage),
                       [self.full_name(name)], "recorder" if recorder else name)

    def executable(self, program, place):
        """The program's path; raises WrongCall unless it can be started."""
        if "/" not in program:
            found = shutil.which(program)
            if found is None:
                raise WrongCall(f"{place}: there is no program {program} on the PATH (beside the "
                                f"launch file: write ./{program})")
            return found
        path = self.beside(program)
        if not os.path.exists(path):
            raise WrongCall(f"{place}: {path} does not exist")
        if os.path.isdir(path) or not os.access(path, os.X_OK):
            raise WrongCall(f"{place}: {path} cannot be executed")
        return path


def is_loopback_only(profile):
    """Whether a participant with this profile of Fast DDS speaks with this host alone."""
    try:
        root = ElementTree.parse(profile).getroot()
    except (OSError, ElementTree.ParseError) as error:
        raise WrongCall(f"{profile} is not a profile of Fast DDS: {error}") from error
    addresses = [a.text.strip() for a in root.iterfind(".//{*}interfaceWhiteList/{*}address") if a.text]
    return bool(addresses) and all(a.startswith("127.") for a in addresses)


def realtime_is_permitted():
    """Whether this user may give processes real-time priority: tried on this one, and undone."""
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    except OSError:
        return False
    os.sched_setscheduler(0, *before)
    return True


def with_priority(stage, command):
    if "realtime" not in stage or not realtime_is_permitted():
        return command
    return ["/usr/bin/chrt", "--fifo", str(stage["realtime"]), *command]
