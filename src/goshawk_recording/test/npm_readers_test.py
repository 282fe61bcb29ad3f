#!/usr/bin/python3
"""Recordings as others read them: npm's @mcap and @foxglove packages read every message of a
recording with random content of every type.

npm_readers_test.py SAMPLE_PROGRAM DUMP_PROGRAM [RECORDING ...]

Exit status 77, with a sentence, where node, npm or the package registry is not there.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent / "npm"
SKIPPED = 77


def skip(why):
    print(f"SKIPPED: {why}", file=sys.stderr)
    sys.exit(SKIPPED)


def install(folder):
    for name in ("package.json", "package-lock.json", "read_recording.mjs"):
        shutil.copy(HERE / name, folder)
    command = ["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--fetch-retries=1"]
    try:
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=90)
    except subprocess.TimeoutExpired:
        skip("npm did not get the packages within 90 s: is there a network?")
    if done.returncode != 0:
        words = ("ENOTFOUND", "EAI_AGAIN", "ECONNREFUSED", "ECONNRESET", "ETIMEDOUT", "network",
                 "ENOTCACHED", "E401", "E403", "E404", "E503")
        if any(word in done.stderr for word in words):
            skip(f"npm gets no packages here: {done.stderr.strip()[-300:]}")
        sys.exit(f"npm ci failed: {done.stderr}")


def main():
    sample, dump, *recordings = sys.argv[1:]
    if not shutil.which("node") or not shutil.which("npm"):
        skip("node and npm are not installed")
    with tempfile.TemporaryDirectory(prefix="goshawk-npm-") as name:
        folder = pathlib.Path(name)
        install(folder)
        made = folder / "sample.mcap"
        subprocess.run([sample, made], check=True)
        for recording in [made, *recordings]:
            lines = folder / "dump.jsonl"
            with open(lines, "wb") as out:
                subprocess.run([dump, recording], check=True, stdout=out)
            done = subprocess.run(["node", folder / "read_recording.mjs", recording, lines],
                                  timeout=600)
            if done.returncode != 0:
                sys.exit(f"{recording}: read otherwise than by Goshawk")


if __name__ == "__main__":
    main()
