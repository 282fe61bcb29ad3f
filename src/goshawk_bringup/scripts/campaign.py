#!/usr/bin/python3
"""goshawk campaign: many random missions, several at once, each judged by the second opinion.

A mission is a made world and a tour of random reachable goals in it, flown in a DDS domain of its
own, with faults if --faults asks for them. Its one argument is a JSON object of options, which
goshawk_cli writes (verbs/campaign.cpp).
"""

import argparse
import concurrent.futures
import json
import pathlib
import signal
import sys

import campaign_report
import faults
import slurm_engine
from mission import DONE, NOT_DONE, Flyer, Mission

# Of these a campaign that is continued may have others than it began with.
CHANGEABLE = {"missions", "jobs", "json", "prefix", "output", "engine", "sbatch"}
LOCAL_JOBS = 2


class OtherCampaign(Exception):
    """The folder holds the missions of a campaign with other options."""


def read_rows(folder):
    """The rows of missions.jsonl, from which a row that was cut off is removed."""
    log = folder / "missions.jsonl"
    if not log.exists():
        return []
    rows, text = [], log.read_text()
    for line in text.splitlines():
        try:
            rows.append(json.loads(line))
        except json.JSONDecodeError:
            print(f"{log}: a row that was cut off is removed, and its mission is flown again",
                  file=sys.stderr, flush=True)
    whole = "".join(json.dumps(row) + "\n" for row in rows)
    if whole != text:
        part = log.with_suffix(".part")
        part.write_text(whole)
        part.rename(log)
    return rows


def keep_options(options):
    """Writes what a campaign is into its folder; one that continues must be the same."""
    path = options.output / "campaign.json"
    ours = {k: v for k, v in sorted(vars(options).items()) if k not in CHANGEABLE}
    if path.exists():
        before = json.loads(path.read_text())
        others = [k for k in ours if k in before and before[k] != ours[k]]
        if others:
            raise OtherCampaign(
                f"{options.output} holds a campaign with other options: "
                + ", ".join(f"{k} {before[k]}" for k in others)
                + "; use another folder, or the same options")
    path.write_text(json.dumps(ours, indent=1) + "\n")


def tell(number, count, row):
    found = row.get("faults")
    print(f"{number}/{count} mission {row['mission']} {row['kind']} {row['density']}: "
          f"{row['arrived']} of {row['legs']} goals, {row['verdict']}"
          + (f", {len(found)} faults" if found is not None else ""), file=sys.stderr, flush=True)
    for fault in found or []:
        if fault["contacts"] or fault["goals_lost"] or fault["too_fast"]:
            print("    " + campaign_report.sentence(fault), file=sys.stderr, flush=True)


class Missing(Exception):
    """Something that the campaign needs is not installed."""


def check_programs(options):
    """Strangers are programs of the system tests."""
    for name in faults.HOSTILE_PROGRAMS if "hostile" in options.faults else []:
        path = pathlib.Path(options.prefix) / "bin" / name
        if not path.exists():
            raise Missing(f"{path} is not installed, which --faults hostile needs: build the package "
                          "goshawk_system_tests")


class LocalEngine:
    """Several missions at once on this machine."""

    def __init__(self, options):
        self.options, self.flyer = options, Flyer(options)

    def interrupt(self):
        self.flyer.stop()

    def fly(self, missions):
        """@param missions numbers of those to fly @return their rows, as they come"""
        with concurrent.futures.ThreadPoolExecutor(self.options.jobs or LOCAL_JOBS) as pool:
            flights = [pool.submit(self.flyer.fly, Mission(self.options, k)) for k in missions]
            try:
                for flight in concurrent.futures.as_completed(flights):
                    row = flight.result()
                    # What was interrupted is not flown: the next campaign into this folder does.
                    if row["code"] != "cancelled" and not self.flyer.stopping:
                        yield row
            except BaseException:
                # The others' rows would be lost: they are not flown to their end.
                self.flyer.stop()
                pool.shutdown(cancel_futures=True)
                raise


ENGINES = {"local": LocalEngine, "slurm": slurm_engine.Engine}


def run(options):
    """Flies what is not flown yet. @return all rows, and whether it was interrupted"""
    rows = read_rows(options.output)
    flown = {r["mission"] for r in rows}
    missions = [k for k in range(1, options.missions + 1) if k not in flown]
    engine, interrupted = ENGINES[options.engine](options), []

    def interrupt(*_):
        interrupted.append(True)
        engine.interrupt()

    signal.signal(signal.SIGINT, interrupt)
    signal.signal(signal.SIGTERM, interrupt)
    with (options.output / "missions.jsonl").open("a") as file:
        for number, row in enumerate(engine.fly(missions), 1):
            rows.append(row)
            file.write(json.dumps(row) + "\n")
            file.flush()
            tell(number, len(missions), row)
    return sorted(rows, key=lambda r: r["mission"]), bool(interrupted)


def read_options():
    options = argparse.Namespace(**json.loads(sys.argv[1]))
    options.output = pathlib.Path(options.output)
    return options


def fail(options, code, message, status=NOT_DONE):
    if options.json:
        print(json.dumps({"ok": False, "code": code, "message": message}))
    else:
        print(f"goshawk campaign: {code}: {message}", file=sys.stderr)
    return status


def main():
    options = read_options()
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        check_programs(options)
        keep_options(options)
        rows, interrupted = run(options)
        if options.faults:
            campaign_report.write_faults(rows, options.output / "faults.csv")
    except OtherCampaign as other:
        return fail(options, "invalid_parameter", str(other), 2)
    except (Missing, slurm_engine.Unavailable) as fault:
        return fail(options, "io_failed", str(fault))
    except OSError as error:
        return fail(options, "io_failed", f"{error.filename}: {error.strerror}")
    code, message = campaign_report.outcome_of(rows, interrupted)
    if options.json:
        print(json.dumps({"ok": code == "ok", "code": code, "message": message,
                          **campaign_report.summary(rows), "folder": str(options.output)}))
    else:
        campaign_report.print_tables(rows)
    if code == "ok":
        return DONE
    return NOT_DONE if options.json else fail(options, code, message)


if __name__ == "__main__":
    sys.exit(main())
