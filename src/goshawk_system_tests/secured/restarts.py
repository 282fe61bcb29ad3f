#!/usr/bin/python3
"""How long a stage that was killed and started again is deaf, with and without DDS Security.

    restarts.py COUNT              without
    restarts.py COUNT KEYS         with the folder of `goshawk secure init`

Starts four planning stages and goshawk_pulse in the domain of ROS_DOMAIN_ID, kills path_search COUNT
times, starts it again at once, and says how long it did not answer.
"""

import json
import os
import pathlib
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


def measure(count, keys, folder):
    def stage(name):
        return start("goshawk_container", name, name, keys, stderr=subprocess.DEVNULL)
    others = [stage(name) for name in OTHERS]
    victim, pulse = stage(VICTIM), Pulse(folder, keys)
    try:
        if not pulse.wait(1):
            sys.exit("it was never heard")
        for number in range(count):
            time.sleep(1.0)
            victim.kill()
            victim.wait()
            victim = stage(VICTIM)
            if not pulse.wait(number + 2):
                sys.exit(f"deaf for more than {LIMIT_S} s after restart {number + 1}")
        return sorted(pulse.silences()[1:])
    finally:
        for process in [victim, pulse.process, *others]:
            process.kill()
            process.wait()


def main():
    count, keys = int(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else ""
    with tempfile.TemporaryDirectory() as folder:
        silent_s = measure(count, keys, folder)
    print(json.dumps({"restarts": count, "p50_s": silent_s[len(silent_s) // 2],
                      "above_10_s": sum(s > 10.0 for s in silent_s), "longest_s": silent_s[-1]}))


if __name__ == "__main__":
    main()
