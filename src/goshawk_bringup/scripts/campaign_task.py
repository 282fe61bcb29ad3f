#!/usr/bin/python3
"""One task of a campaign's array job: flies its missions, and leaves a row for each.

    campaign_task.py PREFIX FOLDER     with SLURM_ARRAY_TASK_ID
"""

import argparse
import json
import os
import pathlib
import signal
import sys

from mission import Flyer, Mission
from slurm_engine import row_file


def main():
    prefix, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    options = argparse.Namespace(**json.loads((folder / "campaign.json").read_text()),
                                 prefix=prefix, output=folder)
    task = int(os.environ["SLURM_ARRAY_TASK_ID"])
    missions = json.loads((folder / "slurm/tasks.json").read_text())[task]
    flyer = Flyer(options)
    signal.signal(signal.SIGTERM, lambda *_: flyer.stop())
    for number in missions:
        path = row_file(folder / "rows", number)
        if path.exists():
            continue  # by this task, before its node was lost
        row = flyer.fly(Mission(options, number))
        if flyer.stopping:
            return 1
        # Whole or not at all: the campaign reads it as soon as it is there.
        part = path.with_suffix(f".{os.getpid()}.part")
        part.write_text(json.dumps(row))
        part.rename(path)
        print(f"mission {number}: {row['verdict']}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
