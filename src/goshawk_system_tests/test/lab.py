"""Two hosts on one machine: network namespaces with a link between them that delays, loses, doubles
and cuts (lab/link.cpp), and a wall clock for each (the shim of goshawk_bringup).

    vehicle 10.77.0.2 --- veth --- goshawk_lab_link --- veth --- 10.77.0.1 ground

Namespaces end with the processes that hold them. A machine that does not permit them raises
NotPermitted, which says what is missing.
"""

import os
import subprocess
import sys

from harness import GOSHAWK, PREFIX, until

sys.path.insert(0, str(PREFIX / "lib" / "goshawk"))
import fault_control  # noqa: E402

DOMAIN = 7  # nobody else is in these namespaces
ADDRESSES = {"ground": "10.77.0.1", "vehicle": "10.77.0.2"}
LINK = PREFIX / "bin" / "goshawk_lab_link"


class NotPermitted(Exception):
    """What this machine lacks, in a sentence."""


def run(*command):
    done = subprocess.run([str(word) for word in command], text=True, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.stdout.strip()}")


def attempt(*command):
    """What a machine may not permit."""
    try:
        run(*command)
    except AssertionError as fault:
        raise NotPermitted(f"no network namespaces here: {fault} (needs root, or CAP_SYS_ADMIN, "
                           "CAP_NET_ADMIN and CAP_NET_RAW, and the packages iproute2 and "
                           "util-linux)") from fault


class Namespace:
    """A network namespace, which lives as long as the process that holds it."""

    def __init__(self, sandbox):
        self.holder = sandbox.start("setpriv", "--pdeathsig", "KILL", "unshare", "--net", "sleep",
                                    "infinity")
        own = os.readlink("/proc/self/ns/net")
        until(lambda: self.now() not in (None, own) or not self.holder.alive(), 10.0)
        if not self.holder.alive():
            raise NotPermitted(f"no network namespaces here: unshare --net: "
                               f"{self.holder.err().strip()} (needs root or CAP_SYS_ADMIN)")
        attempt(*self.enter("ip", "link", "set", "lo", "up"))

    def now(self):
        try:
            return os.readlink(f"/proc/{self.holder.pid}/ns/net")
        except OSError:
            return None

    def enter(self, *command):
        return ["nsenter", "--target", str(self.holder.pid), "--net", *map(str, command)]

    def ip(self, *words):
        run(*self.enter("ip", *words))


class Host:
    """A sandbox whose programs run on one of the two hosts."""

    def __init__(self, sandbox, namespace, name, clock_s=0.0):
        self.sandbox, self.namespace, self.name = sandbox, namespace, name
        self.folder, self.address = sandbox.folder, ADDRESSES[name]
        self.env = {"ROS_DOMAIN_ID": str(DOMAIN), "GOSHAWK_INTERFACES": self.address}
        self.set_clock(clock_s)

    def set_clock(self, ahead_s):
        """The wall clock of all that is started from now on."""
        if ahead_s:
            shim = fault_control.environment(fault_control.shim_of(PREFIX), self.folder / "no_faults")
            self.env.update(shim, GOSHAWK_LAB_CLOCK_S=str(ahead_s))
        else:
            self.env.pop("GOSHAWK_LAB_CLOCK_S", None)

    def start(self, *command, env=None, **options):
        return self.sandbox.start(*self.namespace.enter(*command), env={**self.env, **(env or {})},
                                  **options)

    def call(self, *command, env=None, **options):
        return self.sandbox.call(*self.namespace.enter(*command), env={**self.env, **(env or {})},
                                 **options)

    def goshawk(self, *arguments, **options):
        return self.call(GOSHAWK, *arguments, **options)


class Lab:
    """The hosts `vehicle` and `ground`, and the link between them, whose faults set() changes."""

    def __init__(self, sandbox, seed=1):
        self.sandbox = sandbox
        between = Namespace(sandbox)
        self.namespaces, self.hosts = [between], {}
        for name, address in ADDRESSES.items():
            namespace = Namespace(sandbox)
            self.namespaces.append(namespace)
            # The first link is what a machine may not permit; what fails after it is a fault.
            add = run if self.hosts else attempt
            add(*between.enter("ip", "link", "add", f"to_{name}", "type", "veth", "peer", "name",
                               "eth0", "netns", namespace.holder.pid))
            between.ip("link", "set", f"to_{name}", "up")
            namespace.ip("address", "add", f"{address}/24", "dev", "eth0")
            namespace.ip("link", "set", "eth0", "up")
            # Multicast finds other hosts unless a discovery server does.
            namespace.ip("route", "add", "224.0.0.0/4", "dev", "eth0")
            self.hosts[name] = Host(sandbox, namespace, name)
        self.link = sandbox.start(*between.enter(LINK, "to_vehicle", "to_ground", seed),
                                  stdin=subprocess.PIPE)
        self.said = 0
        self.answer("ready")

    def close(self):
        """Ends the link, and the namespaces once nothing runs in them."""
        self.link.process.stdin.close()
        self.link.process.stdin = None
        for namespace in self.namespaces:
            namespace.holder.process.kill()

    def answer(self, wanted=None):
        """The link's next line."""
        until(lambda: self.link.out().count("\n") > self.said or not self.link.alive(), 10.0, 0.01)
        lines = self.link.out().splitlines()
        if len(lines) <= self.said:
            fault = f"the link does not start: {self.link.err().strip()}"
            raise (NotPermitted if "CAP_NET_RAW" in fault else AssertionError)(fault)
        line = lines[self.said]
        self.said += 1
        if wanted is not None and line != wanted:
            raise AssertionError(f"the link said '{line}', not '{wanted}'")
        return line

    def tell(self, line):
        self.link.process.stdin.write(line.encode() + b"\n")
        self.link.process.stdin.flush()

    def set(self, **faults):
        """delay, jitter [s], loss, duplicate, reorder [probability], cut [s from now on]"""
        for name, value in faults.items():
            self.tell(f"{name} {value}")
            self.answer(f"{name} {value}")

    def count(self):
        """@return frames that the link has passed, and lost"""
        self.tell("count")
        return tuple(int(word) for word in self.answer().split())
