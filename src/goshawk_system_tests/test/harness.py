"""What the system tests share: the installed programs, a domain and a folder of a test's own,
processes that are always stopped, and a report for CTest.

A test file ends with `harness.main()`; CTest calls it with the names of test classes. Exit status
77 says that all tests were skipped.
"""

import json
import os
import pathlib
import random
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
import uuid
import xml.etree.ElementTree as ElementTree

from reporting import Report

SOURCE = pathlib.Path(os.environ.get("GOSHAWK_SOURCE") or
                      pathlib.Path(__file__).resolve().parents[3])
PREFIX = pathlib.Path(os.environ.get("GOSHAWK_PREFIX") or SOURCE / "install")
GOSHAWK = str(PREFIX / "bin" / "goshawk")
STAGES = ["map_server", "path_search", "corridor_builder", "trajectory_optimizer", "navigator",
          "tracker", "simulator", "flight_check"]
MARGIN_M = 0.05          # map_server's default, for the tracking error
BODY_RADIUS_M = 0.15     # map_server's default
SKIPPED = 77
# Limits of time are there for what hangs: a slow machine has this many times longer.
PATIENCE = 4.0
TOKEN = "GOSHAWK_SYSTEM_TEST"
# Cyclone DDS on loopback, without multicast, finding what Goshawk starts.
CYCLONE = ("<CycloneDDS><Domain><General><Interfaces><NetworkInterface name='lo'/></Interfaces>"
           "<AllowMulticast>false</AllowMulticast></General><Discovery><Peers>"
           "<Peer address='127.0.0.1'/></Peers><ParticipantIndex>auto</ParticipantIndex>"
           "<MaxAutoParticipantIndex>60</MaxAutoParticipantIndex></Discovery></Domain>"
           "</CycloneDDS>")


sys.dont_write_bytecode = True
sys.path[:0] = [str(SOURCE / "idl"), str(SOURCE / "tools")]
import hold_domain  # noqa: E402
import idl_to_schema  # noqa: E402


def words(struct, field):
    """The values of a field that have constants: {0: "idle", 3: "arrived"} of NavigatorState's state."""
    structs = idl_to_schema.parse_file(str(SOURCE / "idl" / "goshawk_msgs.idl"))
    fields = next(s.fields for s in structs if s.name.endswith("/" + struct))
    constants = next(f.constants for f in fields if f.name == field)
    return {c.value: c.name[len(field) + 1:].lower() for c in constants}


def node_of(report):
    """The name of the node that sent a stage_report, without its namespace."""
    return report["node"].rsplit("/", 1)[-1]


def data_file(test, relative):
    """A file of the shared data; if it is absent the test is skipped, and says so."""
    folders = [os.environ.get("GOSHAWK_DATA"), SOURCE.parent / "shared" / "data"]
    for folder in folders:
        if folder and (pathlib.Path(folder) / relative).is_file():
            return str(pathlib.Path(folder) / relative)
    test.skipTest(f"{relative} is in none of {[str(f) for f in folders if f]}: set GOSHAWK_DATA")


def free_port():
    """For a process that is told its port: outside of the range from which the kernel hands out ports."""
    for port in random.SystemRandom().sample(range(10000, 32000), 100):
        with socket.socket() as s:
            try:
                s.bind(("127.0.0.1", port))
                return port
            except OSError:
                continue
    raise RuntimeError("no port from 10000 to 31999 is free")


class Domain:
    """A DDS domain that nobody else uses, until close()."""

    def __init__(self):
        self.number, self.lock = hold_domain.hold_private_domain()

    def close(self):
        self.lock.close()


class Outcome:
    def __init__(self, command, status, out, err, seconds):
        self.command, self.status, self.out, self.err = command, status, out, err
        self.seconds = seconds

    def __str__(self):
        return (f"{' '.join(self.command)}\n  status {self.status} after {self.seconds:.1f} s\n"
                f"  stdout: {self.out[-1500:]}\n  stderr: {self.err[-1500:]}")


class Process:
    """A program that runs beside the test; its output goes to files. Stopped by its own id."""

    def __init__(self, command, env, folder, cwd=None, stdin=subprocess.DEVNULL):
        self.command = [str(word) for word in command]
        name = f"{os.path.basename(self.command[0])}-{uuid.uuid4().hex[:8]}"
        self.out_path, self.err_path = (folder / f"{name}.{end}" for end in ("out", "err"))
        with open(self.out_path, "wb") as out, open(self.err_path, "wb") as err:
            self.process = subprocess.Popen(self.command, stdin=stdin, stdout=out, stderr=err,
                                            env=env, cwd=cwd)
        self.begin = time.monotonic()
        self._read, self._lines = 0, []  # [byte] of the output, and the JSON in them

    @property
    def pid(self):
        return self.process.pid

    def out(self):
        return self.out_path.read_text(errors="replace")

    def err(self):
        return self.err_path.read_text(errors="replace")

    def alive(self):
        return self.process.poll() is None

    def wait(self, timeout_s):
        """@return the exit status, or None if it still runs"""
        try:
            return self.process.wait(PATIENCE * timeout_s)
        except subprocess.TimeoutExpired:
            return None

    def stop(self, number=signal.SIGINT, timeout_s=10.0):
        """Signals it, and kills it if that does not help. @return status and seconds taken"""
        begin = time.monotonic()
        if self.alive():
            self.process.send_signal(number)
            if self.wait(timeout_s) is None:
                self.process.kill()
                self.process.wait()
        if self.process.stdin:
            self.process.stdin.close()
        return self.process.returncode, time.monotonic() - begin

    def outcome(self):
        return Outcome(self.command, self.process.returncode, self.out(), self.err(),
                       time.monotonic() - self.begin)

    def lines(self):
        """Whole lines of JSON that came so far."""
        with open(self.out_path, "rb") as file:
            file.seek(self._read)
            text = file.read()
        whole = text[:text.rfind(b"\n") + 1]
        self._read += len(whole)
        self._lines += [json.loads(line) for line in
                        whole.decode(errors="replace").splitlines() if line.startswith("{")]
        return list(self._lines)


def until(condition, timeout_s, step_s=0.05):
    """The first value of condition() that is true, or its last one."""
    end = time.monotonic() + PATIENCE * timeout_s
    while True:
        value = condition()
        if value or time.monotonic() > end:
            return value
        time.sleep(step_s)


def processes_of(token):
    """Ids of the processes that inherited this test's token: whatever it started, however deep."""
    mark = f"{TOKEN}={token}\0".encode()
    found = []
    for entry in os.listdir("/proc"):
        if not entry.isdigit() or int(entry) == os.getpid():
            continue
        try:
            if mark in pathlib.Path(f"/proc/{entry}/environ").read_bytes() + b"\0":
                state = pathlib.Path(f"/proc/{entry}/stat").read_text().rsplit(")", 1)[1].split()[0]
                if state != "Z":
                    found.append(int(entry))
        except OSError:
            continue
    return found


class Publisher:
    """`goshawk topic pub`, which writes a message whenever it is told to."""

    def __init__(self, sandbox, topic, kind, readers=1):
        self.process = sandbox.start(GOSHAWK, "topic", "pub", topic, kind, "-", "--json",
                                     "--wait-matching-subscriptions", str(readers),
                                     "--timeout", "60", stdin=subprocess.PIPE)
        self.sent = 0

    def send(self, message):
        """Returns once all who read the topic reliably have it."""
        self.process.process.stdin.write(json.dumps(message).encode() + b"\n")
        self.process.process.stdin.flush()
        self.sent += 1
        until(lambda: len(self.process.lines()) == self.sent or not self.process.alive(), 20.0,
              0.01)
        lines = self.process.lines()
        if len(lines) != self.sent or lines[-1].get("ok") is False:
            raise AssertionError(f"nobody took the message: {self.process.outcome()}")


class Sandbox:
    """A domain, a folder, an environment; close() ends what is still there and tells of it."""

    def __init__(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="goshawk-system-")
        self.folder = pathlib.Path(self.temporary.name)
        self.domain = Domain()
        self.token = uuid.uuid4().hex
        self.env = {**os.environ, "ROS_DOMAIN_ID": str(self.domain.number), TOKEN: self.token,
                    "CYCLONEDDS_URI": CYCLONE, "PYTHONDONTWRITEBYTECODE": "1",
                    "XDG_STATE_HOME": str(self.folder / "state")}
        for name in ("GOSHAWK_INTERFACES", "GOSHAWK_ROS_GRAPH", "FASTRTPS_DEFAULT_PROFILES_FILE"):
            self.env.pop(name, None)
        self.processes = []

    def close(self):
        for process in reversed(self.processes):
            process.stop()
        gone = until(lambda: not processes_of(self.token), 3.0)
        survivors = [] if gone else processes_of(self.token)
        told = [(pid, command_of(pid)) for pid in survivors]
        for pid in survivors:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.domain.close()
        self.temporary.cleanup()
        return told

    def start(self, *command, env=None, cwd=None, **options):
        process = Process(command, {**self.env, **(env or {})}, self.folder, cwd or self.folder,
                          **options)
        self.processes.append(process)
        return process

    def call(self, *command, timeout_s=60.0, env=None, cwd=None):
        """Runs a program to its end. A time-out is a failure of the test."""
        process = self.start(*command, env=env, cwd=cwd)
        if process.wait(timeout_s) is None:
            process.stop(signal.SIGTERM, 3.0)
            raise AssertionError(f"still running after {PATIENCE * timeout_s} s:\n{process.outcome()}")
        self.processes.remove(process)
        return process.outcome()

    def goshawk(self, *arguments, **keywords):
        return self.call(GOSHAWK, *arguments, **keywords)


def command_of(pid):
    try:
        text = pathlib.Path(f"/proc/{pid}/cmdline").read_bytes()
        return text.replace(b"\0", b" ").decode(errors="replace")
    except OSError:
        return "?"


class SystemTest(unittest.TestCase):
    """A test with a sandbox of its own; nothing that it started may outlive it."""

    maxDiff = None

    def setUp(self):
        self.sandbox = Sandbox()
        self.addCleanup(self.close_sandbox)

    def close_sandbox(self):
        left = self.sandbox.close()
        self.assertEqual(left, [], "processes outlived the test")

    def json_object(self, outcome):
        try:
            value = json.loads(outcome.out)
        except ValueError:
            self.fail(f"no JSON object: {outcome}")
        self.assertIsInstance(value, dict)
        return value

    def assert_civil(self, outcome):
        """Ended by itself, with a sentence: no signal, no abort, no traceback."""
        self.assertIn(outcome.status, (0, 1, 2), str(outcome))
        for word in ("Traceback", "terminate called", "Segmentation", "Assertion", "what():",
                     "internal fault", "AddressSanitizer"):
            self.assertNotIn(word, outcome.out + outcome.err, str(outcome))


def note(text):
    """A figure for the log; never asserted."""
    print(f"    {text}", file=sys.stderr, flush=True)


def main():
    if not os.access(GOSHAWK, os.X_OK):
        sys.exit(f"{GOSHAWK} is not there: build first, or set GOSHAWK_PREFIX")
    loader, module = unittest.defaultTestLoader, sys.modules["__main__"]
    names = sys.argv[1:]
    tests = (loader.loadTestsFromNames(names, module) if names else
             loader.loadTestsFromModule(module))
    begin = time.monotonic()
    result = unittest.TextTestRunner(resultclass=Report, verbosity=2).run(tests)
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    note(f"{sum(u.ru_utime + u.ru_stime for u in used):.0f} s of processor time in "
         f"{time.monotonic() - begin:.0f} s")
    report = os.environ.get("GOSHAWK_REPORT")
    if report:
        pathlib.Path(report).parent.mkdir(parents=True, exist_ok=True)
        ElementTree.ElementTree(result.suite).write(report, encoding="unicode")
    if not result.wasSuccessful() or result.testsRun + len(result.skipped) == 0:
        sys.exit(1)
    sys.exit(0 if result.good else SKIPPED)
