#!/usr/bin/python3
"""goshawk campaign: many random missions, several at once, each judged by the second opinion.

A mission is a made world and a tour of random reachable goals in it, flown in a DDS domain of its
own. Everything about mission k follows from --seed and k, so that any one can be flown again.
"""

import argparse
import collections
import concurrent.futures
import csv
import json
import math
import os
import pathlib
import random
import signal
import statistics
import subprocess
import sys
import threading

DONE, NOT_DONE = 0, 1
MISSION_TIMEOUT_S = 600.0
TRIES = 3
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
        # Each flight picks a domain of its own; in a given one they would meet.
        self.env = {k: v for k, v in os.environ.items() if k != "ROS_DOMAIN_ID"}
        self.lock, self.running, self.stopping = threading.Lock(), set(), False

    def call(self, *words):
        """(status, the one JSON object that was printed), or a failure in the same form."""
        with self.lock:
            if self.stopping:
                return NOT_DONE, {"ok": False, "code": "cancelled", "message": "interrupted"}
            process = subprocess.Popen([self.goshawk, *map(str, words), "--json"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                       env=self.env)
            self.running.add(process)
        try:
            out, err = process.communicate(timeout=MISSION_TIMEOUT_S)
            return process.returncode, json.loads(out)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
            process.communicate()
            return NOT_DONE, {"ok": False, "code": "stage_silent", "message":
                              f"no result within {MISSION_TIMEOUT_S:g} s"}
        except json.JSONDecodeError:
            return NOT_DONE, {"ok": False, "code": "io_failed", "message": f"no JSON: {err[-300:]}"}
        finally:
            with self.lock:
                self.running.discard(process)

    def stop(self):
        with self.lock:
            self.stopping = True
            for process in self.running:
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
        world = folder / "made.bt"
        status, result = self.call("world", world, *mission.world_arguments(self.options.size))
        if status == DONE:
            status, result = self.call(
                "fly", "--map", world, "--random", self.options.goals, "--seed",
                mission.world_seed, "--launch", self.options.launch, "--output", folder,
                "--no-record", *mission.simulator_parameters(),
                *(word for p in self.options.parameters for word in ("-p", p)))
        return {**mission.conditions(), **outcome(status, result, folder)}


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


def quantile(values, q):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(q * len(ordered)))] if ordered else None


def summary(rows):
    """One object: how many goals of how many were reached, and what became of the others."""
    legs = sum(r["legs"] for r in rows)
    codes = collections.Counter(code for r in rows for code in r["leg_codes"])
    codes.update(r["code"] for r in rows if r["legs"] == 0)
    clearances = [r["clearance_m"] for r in rows if r["clearance_m"] is not None]
    errors = [r["max_error_m"] for r in rows if r["max_error_m"] is not None]
    energies = [r["energy_j"] for r in rows if r["energy_j"] is not None]
    return {"missions": len(rows), "flights": legs, "arrived": sum(r["arrived"] for r in rows),
            "collisions": sum(r["verdict"] == "touched" for r in rows),
            "not_judged": sum(r["legs"] > 0 and r["verdict"] == "not judged" for r in rows),
            "failures_by_code": dict(codes),
            "smallest_clearance_m": min(clearances, default=None),
            "median_clearance_m": quantile(clearances, 0.5),
            "largest_error_m": max(errors, default=None),
            "flight_time_s": round(sum(r["flight_s"] for r in rows), 3),
            "median_energy_j": statistics.median(energies) if energies else None}


def text(value):
    return "-" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def print_table(rows):
    keys = ["missions", "flights", "arrived", "collisions", "smallest_clearance_m",
            "largest_error_m", "flight_time_s", "median_energy_j", "failures_by_code"]
    print("| group | " + " | ".join(keys) + " |")
    print("|" + " --- |" * (len(keys) + 1))
    for name in ("kind", "density", "wind_m_s", "noise_m"):
        for value in sorted({r[name] for r in rows}):
            group = summary([r for r in rows if r[name] == value])
            print(f"| {name} {value} | " + " | ".join(text(group[k]) for k in keys) + " |")
    print("| all | " + " | ".join(text(summary(rows)[k]) for k in keys) + " |")
    for r in rows:
        if r["verdict"] == "touched" or (r["legs"] == 0 and r["code"] != "ok"):
            print(f"mission {r['mission']}: {r['verdict']}, {r['code']}: {r['message']}")


def run(options):
    """Flies what is not flown yet. @return all rows"""
    log = options.output / "missions.jsonl"
    rows = []
    if log.exists():
        rows = [json.loads(line) for line in log.read_text().splitlines() if line.endswith("}")]
    flown = {r["mission"] for r in rows}
    missions = [Mission(options, k) for k in range(1, options.missions + 1) if k not in flown]
    flyer = Flyer(options)
    signal.signal(signal.SIGINT, lambda *_: flyer.stop())
    signal.signal(signal.SIGTERM, lambda *_: flyer.stop())
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, log.open("a") as file:
        for number, future in enumerate(concurrent.futures.as_completed(
                [pool.submit(flyer.fly, m) for m in missions]), 1):
            row = future.result()
            if row["code"] == "cancelled" or flyer.stopping:
                continue  # not flown: the next campaign into this folder does
            rows.append(row)
            file.write(json.dumps(row) + "\n")
            file.flush()
            print(f"{number}/{len(missions)} mission {row['mission']} {row['kind']} "
                  f"{row['density']}: {row['arrived']} of {row['legs']} goals, {row['verdict']}",
                  file=sys.stderr, flush=True)
    return sorted(rows, key=lambda r: r["mission"]), flyer.stopping


def read_options():
    """One JSON object, which goshawk_cli writes (verbs/campaign.cpp)."""
    options = argparse.Namespace(**json.loads(sys.argv[1]))
    options.output = pathlib.Path(options.output)
    return options


def fail(options, code, message):
    if options.json:
        print(json.dumps({"ok": False, "code": code, "message": message}))
    else:
        print(f"goshawk campaign: {code}: {message}", file=sys.stderr)
    return NOT_DONE


def outcome_of(rows, interrupted):
    """@return code and sentence of a whole campaign"""
    touched = [r["mission"] for r in rows if r["verdict"] == "touched"]
    if touched:
        return "collision", f"missions {touched} touched something"
    if interrupted:
        return "cancelled", "interrupted; the same call continues"
    if not any(r["legs"] for r in rows):
        return rows[0]["code"], f"nothing was flown: {rows[0]['message']}"
    return "ok", ""


def main():
    options = read_options()
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        rows, interrupted = run(options)
    except OSError as error:
        return fail(options, "io_failed", f"{error.filename}: {error.strerror}")
    code, message = outcome_of(rows, interrupted)
    if options.json:
        print(json.dumps({"ok": code == "ok", "code": code, "message": message, **summary(rows),
                          "folder": str(options.output)}))
    else:
        print_table(rows)
    if code == "ok":
        return DONE
    return NOT_DONE if options.json else fail(options, code, message)


if __name__ == "__main__":
    sys.exit(main())
