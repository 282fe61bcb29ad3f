"""Runs Debian's supervisord as the parent of all stages: configuration, events, shutdown."""

import ctypes
import os
import re
import shlex
import shutil
import signal
import subprocess
import time
import uuid

TOKEN = "GOSHAWK_LAUNCH"
POLITE_S = 1.0  # between SIGTERM and SIGKILL, if supervisord itself is gone
MINFDS = 64     # descriptors below this are supervisord's
PR_SET_PDEATHSIG = 1

SPAWNED = re.compile(r" INFO spawned: '(?P<name>[^']+)' with pid (?P<pid>\d+)$")
EXITED = re.compile(r" (?:INFO|WARN) exited: (?P<name>\S+) \((?P<how>.+?)(?:; (?:not )?expected)?\)$")
FAULT = re.compile(r" INFO spawnerr: (?P<how>.*)$")


def spawned(log):
    """{program: its newest process}, from the text of supervisord's log."""
    found = (SPAWNED.search(line) for line in log.splitlines())
    return {match["name"]: int(match["pid"]) for match in found if match}


def configuration(programs):
    """No text of a user's stands in it: commands come by the environment, as supervisord replaces
    %(ENV_X)s only after it has read the file, and logs are beside it."""
    lines = ["[supervisord]", "nodaemon=true", "silent=true", "nocleanup=true",
             "logfile=supervisord.log", "logfile_maxbytes=0", "pidfile=supervisord.pid",
             "loglevel=info", f"minfds={MINFDS}"]
    if os.geteuid() == 0:
        lines.append("user=root")
    # One group: supervisord stops groups one after the other, a second or two for each.
    lines += ["[group:stages]", "programs=" + ",".join(p.name for p in programs)]
    for number, program in enumerate(programs):
        # It is tried again for ever: when to give up is for the launch to decide.
        lines += [f"[program:{program.name}]", f"command=%(ENV_GOSHAWK_COMMAND_{number})s",
                  "directory=%(ENV_GOSHAWK_FOLDER)s", "autostart=true", "autorestart=true",
                  "startsecs=1", "startretries=1000000", "stopsignal=INT", "stopwaitsecs=5",
                  "redirect_stderr=true", f"stdout_logfile={program.name}.log",
                  "stdout_logfile_maxbytes=20MB", "stdout_logfile_backups=1"]
    return "\n".join(lines) + "\n"


def ends_with_its_parent(command):
    """A command that gets SIGTERM when supervisord ends, whatever ends that."""
    setpriv = shutil.which("setpriv")
    return [setpriv, "--pdeathsig", "TERM", "--", *command] if setpriv else command


def stop_with_parent(parent=0):
    """SIGTERM for this process when its parent ends, however it ends.

    @param parent its process id: it may have ended before this process could ask for that"""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if parent and os.getppid() != parent:
        os.kill(os.getpid(), signal.SIGTERM)


def is_alive(pid):
    """Whether a process is there and has not ended."""
    try:
        with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
            return file.read().rsplit(")", 1)[1].split()[0] not in "ZX"
    except (OSError, IndexError):
        return False


def processes_of(token):
    """Ids of the processes that inherited this token: all that a launch started, however deep."""
    mark = f"{TOKEN}={token}".encode()
    found = []
    for entry in os.listdir("/proc"):
        if not entry.isdigit() or int(entry) == os.getpid():
            continue
        try:
            with open(f"/proc/{entry}/environ", "rb") as file:
                if mark in file.read().split(b"\0") and is_alive(entry):
                    found.append(int(entry))
        except OSError:
            continue  # it has ended, or belongs to another user
    return found


class Supervisor:
    """supervisord with these programs. Its log tells what becomes of them."""

    def __init__(self, programs, logs, descriptors):
        self.logs = logs
        self.token = uuid.uuid4().hex
        with open(os.path.join(logs, "supervisord.conf"), "w", encoding="utf-8") as file:
            file.write(configuration(programs))
        log = os.path.join(logs, "supervisord.log")
        if os.path.exists(log):
            os.unlink(log)
        environment = {**os.environ, TOKEN: self.token, "GOSHAWK_FOLDER": os.getcwd()}
        for number, program in enumerate(programs):
            command = ends_with_its_parent(program.command)
            environment[f"GOSHAWK_COMMAND_{number}"] = shlex.join(command)
        own_pid = os.getpid()
        self.process = subprocess.Popen(
            ["/usr/bin/python3", "/usr/bin/supervisord", "-n", "-c", "supervisord.conf"],
            cwd=logs, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, text=True, start_new_session=True, pass_fds=descriptors,
            preexec_fn=lambda: stop_with_parent(own_pid))
        self.log, self.rest = None, ""

    def events(self):
        """What happened since the last call: ("spawned" | "exited" | "fault", match). What
        supervisord calls RUNNING is left out: it says so of processes that have ended meanwhile."""
        if self.log is None:
            try:
                self.log = open(os.path.join(self.logs, "supervisord.log"), encoding="utf-8",
                                errors="replace")
            except OSError:
                return []
        lines = (self.rest + self.log.read()).split("\n")
        self.rest = lines.pop()  # not whole yet
        found = []
        for line in lines:
            for event, pattern in (("spawned", SPAWNED), ("exited", EXITED), ("fault", FAULT)):
                match = pattern.search(line)
                if match:
                    found.append((event, match))
        return found

    def how_it_ended(self):
        """@return None as long as it lives, or how it ended in words"""
        status = self.process.poll()
        if status is None:
            return None
        if status < 0:
            return f"terminated by {signal.Signals(-status).name}"
        said = self.process.stderr.read().strip()
        return f"exit status {status}" + (f": {said}" if said else "")

    def stop(self):
        """Stops all. @return ids of the processes that are still there after SIGKILL"""
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait()
        # It kills what does not stop. What is left now is there because it was killed itself, or
        # left its process group.
        deadline = time.monotonic() + POLITE_S
        send(signal.SIGTERM, processes_of(self.token))
        while processes_of(self.token) and time.monotonic() < deadline:
            time.sleep(0.02)
        send(signal.SIGKILL, processes_of(self.token))
        deadline = time.monotonic() + POLITE_S
        while processes_of(self.token) and time.monotonic() < deadline:
            time.sleep(0.02)
        self.process.stderr.close()
        if self.log is not None:
            self.log.close()
            self.log = None
        return processes_of(self.token)


def send(number, pids):
    for pid in pids:
        try:
            os.kill(pid, number)
        except OSError:
            pass
