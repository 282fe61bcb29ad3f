#!/usr/bin/python3
"""How long a stage is deaf that was killed and started again, or stopped for a while.

    restarts.py COUNT              without DDS Security
    restarts.py COUNT KEYS         with the folder of `goshawk secure init`
    restarts.py --stop S ...       stopped for S seconds instead

Starts four planning stages and goshawk_pulse in the domain of ROS_DOMAIN_ID, kills path_search COUNT
times, starts it again at once, and says how long it did not answer.
"""

import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

LIMIT_S = 120.0
PREFIX = pathlib.Path(os.environ.get("GOSHAWK_PREFIX") or
                      pathlib.Path(__file__).resolve().parents[3] / "install")
VICTIM = "path_search"
OTHERS = ["corridor_builder", "navigator", "tracker"]


def start(program, word, role, keys, **options):
    env = dict(os.environ)
    if keys:
        env["FASTRTPS_DEFAULT_PROFILES_FILE"] = os.path.abspath(f"{keys}/{role}/profile.xml")
    return subprocess.Popen([PREFIX / "bin" / program, word], env=env, **options)


class Pulse:
    """The silences of the victim, as goshawk_pulse tells them."""

    def __init__(self, folder, keys):
        self.path = pathlib.Path(folder) / "pulse"
        with open(self.path, "wb") as out:
            self.process = start("goshawk_pulse", "/" + VICTIM, "operator", keys, stdout=out)

    def silences(self):
        text = self.path.read_text(encoding="utf-8")
        return [json.loads(line)["silent_s"] for line in text[:text.rfind("\n") + 1].splitlines()]

    def wait(self, count):
        """@return whether so many silences have ended by now, or within LIMIT_S"""
        end = time.monotonic() + LIMIT_S
        while len(self.silences()) < count and time.monotonic() < end:
            time.sleep(0.05)
        return len(self.silences()) >= count


def measure(count, keys, stop_s, folder):
    """The silences, sorted, without the time for which it was stopped [s]."""
    def stage(name):
        return start("goshawk_container", name, name, keys, stderr=subprocess.DEVNULL)

    def upset(victim):
        if not stop_s:
            victim.kill()
            victim.wait()
            return stage(VICTIM)
        victim.send_signal(signal.SIGSTOP)
        time.sleep(stop_s)
        victim.send_signal(signal.SIGCONT)
        return victim

    others = [stage(name) for name in OTHERS]
    victim, pulse = stage(VICTIM), Pulse(folder, keys)
    try:
        if not pulse.wait(1):
            sys.exit("it was never heard")
        for number in range(count):
            time.sleep(1.0)
            victim = upset(victim)
            if not pulse.wait(number + 2):
                sys.exit(f"deaf for more than {LIMIT_S} s at time {number + 1}")
        return sorted(silent_s - stop_s for silent_s in pulse.silences()[1:])
    finally:
        for process in [victim, pulse.process, *others]:
            process.kill()
            process.wait()


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--stop", type=float, default=0.0)
    parser.add_argument("count", type=int)
    parser.add_argument("keys", nargs="?", default="")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        silent_s = measure(given.count, given.keys, given.stop, folder)
    print(json.dumps({"times": given.count, "p50_s": round(silent_s[len(silent_s) // 2], 3),
                      "longest_s": round(silent_s[-1], 3)}))


if __name__ == "__main__":
    main()
