"""What mission k of a campaign is, and how it is flown and judged. All of it follows from the
campaign's options and k, so that any one can be flown again."""

import csv
import json
import math
import os
import pathlib
import random
import signal
import subprocess
import threading

import fault_report
import faults
import faulty_flight
from flown_track import Track

DONE, NOT_DONE = 0, 1
PREPARATION_S = 120.0  # for a mission's world, launch and end, besides its goals
TRIES = 3
SPEED_FACTOR = 1.1  # no fault makes the vehicle faster than its limit times this
V_MAX_M_S = 2.0     # the navigator's default
GRAVITY_M_S2, AIR_KG_M3 = 9.81, 1.2
MASS_KG = 1.0                                      # the simulator's default
ROTORS_M2 = 4 * math.pi * 0.0635 ** 2              # four propellers of five inches


class Mission:
    """What mission number k of a campaign is."""

    def __init__(self, options, number):
        self.number = number
        draw = random.Random(f"{options.seed}/{number}")
        self.kind = draw.choice(options.kinds)
        self.density = draw.choice(options.densities)
        self.wind_m_s = draw.choice(options.wind)
        self.noise_m = draw.choice(options.noise)
        self.heading_rad = draw.uniform(-math.pi, math.pi)
        self.world_seed = draw.randrange(1, 1 << 31)
        self.fault_seed = draw.randrange(1, 1 << 31)

    def conditions(self):
        return {"mission": self.number, "kind": self.kind, "density": self.density,
                "wind_m_s": self.wind_m_s, "noise_m": self.noise_m, "world_seed": self.world_seed}

    def world_arguments(self, size):
        return ["--kind", self.kind, "--density", self.density, "--seed", self.world_seed,
                "--size", size]

    def simulator_parameters(self):
        """Half of the wind is steady, half comes in gusts."""
        steady = 0.5 * self.wind_m_s
        values = {"wind_x_m_s": steady * math.cos(self.heading_rad),
                  "wind_y_m_s": steady * math.sin(self.heading_rad),
                  "gust_deviation_m_s": 0.5 * self.wind_m_s / math.sqrt(3.0),
                  "gust_seed": self.number, "position_noise_m": self.noise_m,
                  "velocity_noise_m_s": self.noise_m, "sensor_seed": self.number}
        return [word for name, value in values.items()
                for word in ("-p", f"simulator:{name}:={value}")]


class Flyer:
    """Runs goshawk; stops what runs when the campaign is interrupted."""

    def __init__(self, options):
        self.options = options
        self.goshawk = str(pathlib.Path(options.prefix) / "bin/goshawk")
        self.timeout_s = PREPARATION_S + options.goals * options.timeout_s
        # Each flight picks a domain of its own; in a given one they would meet.
        self.env = {k: v for k, v in os.environ.items() if k != "ROS_DOMAIN_ID"}
        self.lock, self.running, self.stopping = threading.Lock(), set(), False

    def call(self, *words, env=None, beside=None):
        """(status, the one JSON object that was printed), or a failure in the same form.

        @param beside called with the process while it runs"""
        with self.lock:
            if self.stopping:
                return NOT_DONE, {"ok": False, "code": "cancelled", "message": "interrupted"}
            process = subprocess.Popen([self.goshawk, *map(str, words), "--json"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       env=env or self.env)
            self.running.add(process)
        thread = threading.Thread(target=beside, args=(process,)) if beside else None
        try:
            if thread:
                thread.start()
            out, err = process.communicate(timeout=self.timeout_s)
            return process.returncode, json.loads(out)
        except subprocess.TimeoutExpired:
            self.interrupt(process)
            process.communicate()
            return NOT_DONE, {"ok": False, "code": "stage_silent", "message":
                              f"no result within {self.timeout_s:g} s"}
        except json.JSONDecodeError:
            return NOT_DONE, {"ok": False, "code": "io_failed", "message": f"no JSON: {err[-300:]}"}
        finally:
            if thread:
                thread.join()
            with self.lock:
                self.running.discard(process)

    def stop(self):
        with self.lock:
            self.stopping = True
            for process in self.running:
                self.interrupt(process)

    @staticmethod
    def interrupt(process):
        process.send_signal(signal.SIGINT)

    def fly(self, mission):
        """A flight whose track has gaps is not judged: the machine was too busy, so once more."""
        for _ in range(TRIES):
            row = self.fly_once(mission)
            if row["verdict"] != "not judged" or self.stopping:
                break
        return row

    def fly_once(self, mission):
        folder = self.options.output / f"mission_{mission.number:05d}"
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("events.jsonl", "flown.csv"):  # of an earlier try
            (folder / name).unlink(missing_ok=True)
        world = folder / "made.bt"
        status, result = self.call("world", world, *mission.world_arguments(self.options.size))
        if status != DONE:
            return {**mission.conditions(), **outcome(status, result, folder)}
        words = ["fly", "--map", world, "--random", self.options.goals, "--seed",
                 mission.world_seed, "--launch", self.options.launch, "--output", folder,
                 "--no-record", *mission.simulator_parameters(),
                 "--timeout", self.options.timeout_s,
                 *(word for p in self.options.parameters for word in ("-p", p))]
        if self.options.launch.startswith("live"):
            words.append("--live")
        if self.options.faults:
            return FaultyMission(self, mission, folder, world).fly(words)
        return {**mission.conditions(), **outcome(*self.call(*words), folder)}


class FaultyMission:
    """A mission with faults: flown in real time, judged without trust in any clock of it."""

    def __init__(self, flyer, mission, folder, world):
        self.flyer, self.mission, self.folder, self.world = flyer, mission, folder, world
        self.rows, self.fault = [], None

    def fly(self, words):
        options = self.flyer.options
        flight = faulty_flight.FaultyFlight(
            options.prefix, self.folder, self.world, [float(x) for x in options.size.split(",")],
            self.flyer.env, self.mission.fault_seed)
        injector = faulty_flight.Injector(
            flight, faults.drawn(options.faults, self.mission.fault_seed,
                                 options.launch.startswith("live")))

        def beside(process):
            try:
                self.rows = injector.run(lambda: process.poll() is not None)
            except Exception as error:
                self.fault = error
                self.flyer.interrupt(process)

        loads = ([] if options.launch.startswith("live") else
                 ["-p", f"map_server:map_file:={flight.world}"])
        status, result = self.flyer.call(*words, *self.truth(), "--keep-going", *loads,
                                         env=flight.flight_env, beside=beside)
        if self.fault:
            raise self.fault
        fault_report.assess(injector.events.read(), self.rows)
        injector.events.close()
        row = {**self.mission.conditions(), **outcome(status, result, self.folder)}
        return {**row, **self.judge(injector.events.all), "faults": self.rows}

    def truth(self):
        """With sensors that are not perfect the plant tells the truth on a topic of its own, which
        lies about odometry do not reach."""
        return [] if self.mission.noise_m else ["-p", "simulator:position_noise_m:=0.001"]

    def judge(self, events):
        """The second opinion on the flown track against the world that was made."""
        path = self.folder / "flown.csv"
        begin = [e for e in events if e["event"] == "track"]
        if not path.exists() or not begin:
            return {"verdict": "not flown"}
        stalls = sum(r["kind"] == "stall" and faults.PLANT in r["targets"] for r in self.rows)
        track = Track(path, stalls)
        at_ns = begin[-1]["at_ns"]
        parts = track.parts()
        if not parts:
            return {"verdict": "not flown"}
        speed, fast_s = track.fastest()
        limit = self.limit_m_s()
        if speed > SPEED_FACTOR * limit:
            fault_report.blame(self.rows, at_ns + fast_s * 1e9, "too_fast")
        row = {"max_speed_m_s": round(speed, 3), "speed_ratio": round(speed / limit, 3),
               "unseen": len(parts) - 1, "verdict": "safe", "clearance_m": None}
        for part in parts:
            table = self.folder / "judged.csv"
            track.write(table, part)
            _, judged = self.flyer.call("check", table, "--map", self.world)
            if "flown" not in judged:
                return {**row, "verdict": "not judged", "clearance_m": None,
                        "code": judged["code"], "message": judged["message"]}
            flown = judged["flown"]
            row["clearance_m"] = smaller(row["clearance_m"], flown["smallest_m"])
            if flown["touched"]:
                row["verdict"] = "touched"
                touched_ns = at_ns + track.stamp_at(track.times[part.start] + flown["at_s"]) * 1e9
                fault_report.blame(self.rows, touched_ns, "contacts")
        return row

    def limit_m_s(self):
        given = [p.split(":=")[1] for p in self.flyer.options.parameters
                 if p.startswith("navigator:v_max_m_s:=")]
        return float(given[-1]) if given else V_MAX_M_S


def smaller(a, b):
    """Of two clearances; None is that of a world without obstacles."""
    return min((x for x in (a, b) if x is not None), default=None)


def outcome(status, result, folder):
    legs = result.get("legs", [])
    clearance = (result.get("clearance") or {}).get("smallest_m")
    durations = [leg["trajectory"]["duration_s"] for leg in legs if leg.get("trajectory")]
    return {"status": status, "code": result["code"], "message": result["message"],
            "verdict": result.get("verdict", "not flown"), "legs": len(legs),
            "arrived": sum(leg["arrived"] for leg in legs),
            "leg_codes": [leg["code"] for leg in legs if not leg["arrived"]],
            "clearance_m": clearance, "flight_s": sum(durations),
            "max_error_m": (result.get("tracking") or {}).get("max_error_m"),
            "energy_j": energy_j(folder / "flown.csv")}


def energy_j(path):
    """Work of the rotors on the air, by momentum theory: thrust^1.5 / sqrt(2 rho area)."""
    try:
        with open(path, encoding="utf-8") as file:
            rows = [[float(r[k]) for k in ("t_s", "vx_m_s", "vy_m_s", "vz_m_s")]
                    for r in csv.DictReader(file)]
    except (OSError, KeyError, ValueError):
        return None
    sum_j = 0.0
    for before, after in zip(rows[::10], rows[10::10]):
        dt = after[0] - before[0]
        if dt <= 0.0:
            continue
        a = [(after[i] - before[i]) / dt for i in (1, 2, 3)]
        thrust = MASS_KG * math.hypot(a[0], a[1], a[2] + GRAVITY_M_S2)
        sum_j += dt * thrust ** 1.5 / math.sqrt(2.0 * AIR_KG_M3 * ROTORS_M2)
    return sum_j
