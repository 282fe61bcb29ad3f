"""A flight with faults: injects them while `goshawk fly` runs, and notes when."""

import json
import os
import pathlib
import signal
import subprocess
import time

import fault_control
import faults
import supervision

STEP_S = 0.01
MOST_FOR_A_GOAL = 3  # then the flight may show that it recovers
ENDING_S = 30.0      # for a flight whose stages have ended to end as well


class NoStage(Exception):
    """No stage of the flight runs."""


def now_ns():
    """On the clock of the flight's events, which no fault touches."""
    return time.clock_gettime_ns(time.CLOCK_BOOTTIME)


class Events:
    """A flight's events.jsonl, read as it grows."""

    def __init__(self, path):
        self.path, self.file, self.rest, self.all = path, None, "", []

    def read(self):
        """@return all events so far"""
        if self.file is None:
            try:
                self.file = open(self.path, encoding="utf-8")
            except OSError:
                return self.all
        *whole, self.rest = (self.rest + self.file.read()).split("\n")
        self.all += [json.loads(line) for line in whole]
        return self.all

    def count(self, name):
        return sum(e["event"] == name for e in self.read())

    def have(self, name):
        return self.count(name) > 0

    def close(self):
        if self.file is not None:
            self.file.close()


class FaultyFlight:
    """What a fault acts on: the stages' processes, their shims, the map that they load."""

    def __init__(self, prefix, folder, true_world, size_m, env, seed):
        self.prefix, self.folder = pathlib.Path(prefix), pathlib.Path(folder)
        self.true_world, self.size_m = true_world, size_m
        self.world = self.folder / "loaded.bt"
        self.world.write_bytes(pathlib.Path(true_world).read_bytes())
        self.env, self.domain = env, None
        switches = self.folder / "faults"
        switches.mkdir(exist_ok=True)
        self.controls = {s: fault_control.FaultControl(switches, s, seed)
                         for s in [*faults.STAGES, faults.LIDAR, faults.PLANT]}
        self.flight_env = {**env, **fault_control.environment(
            fault_control.shim_of(prefix), switches, env)}

    def program(self, name):
        return str(self.prefix / "bin" / name)

    def pids(self):
        """The newest process of every stage, from supervisord's log."""
        try:
            text = (self.folder / "logs/supervisord.log").read_text(errors="replace")
        except OSError:
            return {}
        return supervision.spawned(text)

    def signal(self, targets, number):
        pids = self.pids()
        for target in targets:
            # A process that has just ended is one that its supervisor starts again by itself.
            try:
                os.kill(pids[target], number)
            except (KeyError, ProcessLookupError):
                pass

    def for_each(self, targets, act):
        for target in targets:
            act(self.controls[target])

    def start(self, command):
        """A program in the flight's domain."""
        if self.domain is None:
            self.domain = domain_of(self.pids().values())
        return subprocess.Popen(command, env={**self.env, "ROS_DOMAIN_ID": self.domain},
                                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.DEVNULL, start_new_session=True)

    def stop(self, process):
        """Ends a program that start() has started, with all that it has started."""
        for number in (signal.SIGINT, signal.SIGKILL):
            try:
                os.killpg(process.pid, number)
                process.wait(3.0)
            except (ProcessLookupError, subprocess.TimeoutExpired):
                pass


def domain_of(pids):
    """The DDS domain of the processes that live of these."""
    for pid in pids:
        try:
            variables = pathlib.Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
        except OSError:
            continue
        for variable in variables:
            if variable.startswith(b"ROS_DOMAIN_ID="):
                return variable.split(b"=")[1].decode()
    raise NoStage("no stage of the flight runs")


class Injector:
    """Does one fault after the other from the flight's first goal to its end, a few for each goal."""

    def __init__(self, flight, faults_to_come):
        self.flight, self.to_come = flight, faults_to_come
        self.events = Events(flight.folder / "events.jsonl")
        self.rows = []
        self.goals = []  # for each fault the number of the goal that it met

    def run(self, is_over):
        """@param is_over tells whether the flight's process has ended. @return a row a fault"""
        while not self.events.have("goal"):
            if is_over():
                return self.rows
            time.sleep(STEP_S)
        for fault in self.to_come:
            if not (self.wait(fault.after_s, is_over) and self.wait_turn(is_over)):
                break
            self.goals.append(self.events.count("goal"))
            row = {**fault.row(), "begin_ns": now_ns()}
            try:
                fault.begin(self.flight)
            except NoStage:
                if self.wait(ENDING_S, is_over):
                    raise
                break  # it came as the flight ended
            try:
                self.wait(fault.duration_s, is_over)
            finally:
                fault.end(self.flight)
            row["end_ns"] = row["begin_ns"] if fault.instant else now_ns()
            self.rows.append(row)
        return self.rows

    def wait_turn(self, is_over):
        """Until the flight's goal has not met all its faults. @return whether it still goes on"""
        while self.goals.count(self.events.count("goal")) >= MOST_FOR_A_GOAL:
            if not self.wait(STEP_S, is_over):
                return False
        return True

    def wait(self, seconds, is_over):
        """@return whether the flight still goes on"""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if is_over() or self.events.have("end"):
                return False
            time.sleep(min(0.05, max(STEP_S, end - time.monotonic())))
        return True
