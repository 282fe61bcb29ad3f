#!/usr/bin/python3
"""Mutated datagrams to every stage in flight. By hand, with more of them:

    STORM_DATAGRAMS=100000 STORM_RATE=1500 /usr/bin/python3 test/storm_test.py
"""

import json
import os
import re

import harness
from harness import PREFIX, note
from stack import PLACES, StackTest

DATAGRAMS = int(os.environ.get("STORM_DATAGRAMS", "3000"))
RATE = float(os.environ.get("STORM_RATE", "1000"))


class DatagramStorm(StackTest):
    def test_no_process_ends_and_nothing_is_touched(self):
        pids = self.stack.launch.pids()
        storm = self.sandbox.start(PREFIX / "bin" / "goshawk_datagram_storm", "--count", DATAGRAMS,
                                   "--rate", RATE, "--seed", 1)
        legs = []
        while storm.alive() or not legs:
            state = self.stack.fly_to(PLACES[len(legs) % 2])
            legs.append(f"{state['state']}/{state['code']}" if state else "no answer")
        storm.wait(10.0)
        self.assertEqual(storm.process.returncode, 0, str(storm.outcome()))
        sent = json.loads(storm.out())
        self.assertEqual(sent["as_joined"] + sent["as_others"], DATAGRAMS)
        note(f"{sent}; legs {legs}; refused {self.refused()}")
        self.assertEqual(self.stack.launch.pids(), pids, self.stack.launch.tails())
        self.check_doctor()
        self.check_untouched()
        # Forged datagrams are as if they had not been: goals are reached meanwhile.
        self.assertEqual({leg for leg in legs if not leg.startswith("arrived")}, set(), legs)

    def check_doctor(self):
        findings = json.loads(self.sandbox.goshawk("doctor", "--json", timeout_s=90).out)["findings"]
        told = {f["about"] for f in findings if "datagrams were refused" in f["message"]}
        self.assertIn("node /tracker", told, findings)

    def refused(self):
        """The newest count that each stage has logged."""
        counts = {}
        for log in self.stack.launch.logs.glob("*.log"):
            found = re.findall(r"a datagram was refused \((\d+) so far\)",
                               log.read_text(errors="replace"))
            if found:
                counts[log.stem] = int(found[-1])
        return counts


if __name__ == "__main__":
    harness.main()
