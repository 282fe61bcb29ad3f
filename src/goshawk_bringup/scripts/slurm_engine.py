"""Flies a campaign's missions on a cluster: one array job of Slurm, whose tasks write a row for each
mission into the campaign's folder, which all nodes share. What a lost node did not finish is queued
again, first by Slurm (--requeue), then by another job."""

import json
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

ROUNDS = 3
PERIOD_S = 1.0
SILENT_S = 600.0    # a controller that does not answer for so long is given up
MOST_TASKS = 1000   # Slurm's default for MaxArraySize
TASK = pathlib.Path(__file__).with_name("campaign_task.py")


class Unavailable(Exception):
    """Slurm cannot be used: a sentence."""


def call(*words):
    program = shutil.which(words[0])
    if program is None:
        raise Unavailable(f"there is no {words[0]} on the PATH: install Slurm's client "
                          "(Debian: slurm-client), or use --engine local")
    return subprocess.run([program, *words[1:]], text=True, capture_output=True)


class Job:
    """An array job, known by its number in the campaign's folder: a campaign that was interrupted
    without ending its job finds it again."""

    def __init__(self, folder):
        self.folder = folder / "slurm"
        self.folder.mkdir(exist_ok=True)
        self.path = self.folder / "job"
        self.heard_s = time.monotonic()

    def submit(self, missions, options):
        """Each task flies some missions of the list, one after the other."""
        per_task = -(-len(missions) // MOST_TASKS)
        tasks = [missions[k:k + per_task] for k in range(0, len(missions), per_task)]
        (self.folder / "tasks.json").write_text(json.dumps(tasks))
        array = f"0-{len(tasks) - 1}" + (f"%{options.jobs}" if options.jobs else "")
        command = shlex.join(["/usr/bin/python3", str(TASK), options.prefix,
                              str(options.output.resolve())])
        done = call("sbatch", "--parsable", "--requeue", "--job-name=goshawk_campaign",
                    f"--array={array}", f"--output={self.folder.resolve()}/%A_%a.log",
                    *options.sbatch, f"--wrap=exec {command}")
        if done.returncode != 0:
            raise Unavailable(f"sbatch refused the campaign's job: {done.stderr.strip()}")
        number = done.stdout.strip().split(";")[0]
        self.path.write_text(number)
        return number

    def tasks_left(self):
        """How many tasks wait or run; None if the controller does not answer."""
        if not self.path.exists():
            return 0
        done = call("squeue", "--noheader", "--array", f"--jobs={self.path.read_text()}",
                    "--format=%T")
        if done.returncode == 0:
            self.heard_s = time.monotonic()
            return len(done.stdout.split())
        if "Invalid job id" in done.stderr:  # ended so long ago that Slurm has forgotten it
            return 0
        if time.monotonic() - self.heard_s > SILENT_S:
            raise Unavailable(f"Slurm does not answer: {done.stderr.strip()}; the job "
                              f"{self.path.read_text()} may go on, and the same call finds it")
        return None

    def cancel(self):
        call("scancel", self.path.read_text())


class Engine:
    """Missions by their numbers in, rows out, as they come."""

    def __init__(self, options):
        self.options, self.interrupted = options, False
        self.rows_folder = options.output / "rows"
        self.rows_folder.mkdir(exist_ok=True)
        self.job = Job(options.output)

    def interrupt(self):
        self.interrupted = True

    def fly(self, missions):
        """@param missions numbers of those to fly @return their rows, one after the other"""
        left = set(missions)
        for turn in range(ROUNDS):
            yield from self.new_rows(left)
            if not left:
                return
            if self.job.tasks_left() == 0:
                number = self.job.submit(sorted(left), self.options)
                print(f"job {number} of Slurm: {len(left)} missions"
                      + (" that an earlier job lost" if turn else ""), file=sys.stderr, flush=True)
            while self.job.tasks_left() != 0:
                if self.interrupted:
                    self.job.cancel()
                    return
                yield from self.new_rows(left)
                time.sleep(PERIOD_S)
        yield from self.new_rows(left)
        if left:
            raise Unavailable(f"missions {sorted(left)} left no result in {ROUNDS} jobs: see "
                              f"{self.job.folder}; all nodes must see the folder {self.options.output}")

    def new_rows(self, left):
        for number in sorted(left):
            path = row_file(self.rows_folder, number)
            if path.exists():
                left.discard(number)
                yield json.loads(path.read_text())


def row_file(folder, number):
    return folder / f"mission_{number:05d}.json"
