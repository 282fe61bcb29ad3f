#!/usr/bin/python3
"""Campaigns of real flights, with faults, and on a cluster."""

import csv
import json
import signal

import harness
import slurm_cluster
from harness import GOSHAWK, SystemTest, note, until

KINDS = {"kill", "stall", "clock", "loss", "blind", "hostile"}


class FaultCampaign(SystemTest):
    WORDS = ("campaign", "--faults", ",".join(sorted(KINDS)), "--goals", "2", "--wind", "0",
             "--output", "flown")

    def test_faults_are_injected_named_and_judged_and_a_campaign_continues(self):
        folder = self.sandbox.folder / "flown"
        call = (*self.WORDS, "--seed", "3", "--json")
        first = self.sandbox.goshawk(*call, "--missions", "1", timeout_s=200)
        self.check(first, 1)
        rows = (folder / "missions.jsonl").read_text()
        second = self.sandbox.goshawk(*call, "--missions", "2", timeout_s=200)
        summary = self.check(second, 2)
        self.assertTrue((folder / "missions.jsonl").read_text().startswith(rows))
        self.check_table(folder, summary["faults"])
        other = self.sandbox.goshawk(*self.WORDS, "--seed", "4", "--json")
        self.assertEqual(other.status, 2, str(other))
        self.assertIn("seed 3", self.json_object(other)["message"])

    def check(self, outcome, missions):
        """A campaign in which nothing is touched, whatever else became of its faults. On a machine
        that does not keep up a mission may not be judged."""
        summary = self.json_object(outcome)
        note(f"{summary['arrived']} of {summary['flights']} goals, {summary['not_judged']} missions "
             f"not judged, fastest {summary['largest_speed_ratio']} of the limit; {summary['faults']}")
        self.assertIn(f"mission {missions} ", outcome.err)
        self.assertEqual((summary["missions"], summary["flights"]), (missions, 2 * missions))
        self.assertEqual(summary["collisions"], 0, str(outcome))
        self.assertLess(summary["not_judged"], missions, "nothing shows that nothing was touched")
        self.assertLessEqual(set(summary["faults"]), KINDS)
        for counts in summary["faults"].values():
            self.assertGreater(counts["injected"], 0)
            self.assertEqual((counts["contacts"], counts["too_fast"]), (0, 0))
        return summary

    def check_table(self, folder, kinds):
        with open(folder / "faults.csv", encoding="utf-8", newline="") as file:
            table = list(csv.DictReader(file))
        self.assertEqual({k: v["injected"] for k, v in kinds.items()},
                         {k: sum(r["kind"] == k for r in table) for k in kinds})
        for row in table:
            self.assertTrue(row["what"])
            self.assertGreaterEqual(float(row["at_s"]), 0.0)

    def test_lock_step_and_faults_exclude_each_other(self):
        outcome = self.sandbox.goshawk(*self.WORDS, "--launch", "flight_lock_step")
        self.assertEqual(outcome.status, 2, str(outcome))
        self.assertIn("--launch flight", outcome.err)


class SlurmTest(SystemTest):
    """With a Slurm of this test's own: slurmctld, two slurmd and munged on loopback."""

    WORDS = ("campaign", "--missions", "4", "--goals", "1", "--seed", "2", "--wind", "0", "--json")

    def setUp(self):
        missing = slurm_cluster.missing()
        if missing:
            self.skipTest(f"Slurm is not installed (no {', '.join(missing)}): tools/setup --slurm")
        super().setUp()
        self.cluster = slurm_cluster.Cluster(self.sandbox.folder / "slurm", self.sandbox.env, 2)
        self.addCleanup(self.cluster.close)


class SlurmCampaign(SlurmTest):
    def test_it_says_the_same_as_a_local_run_although_a_node_is_lost(self):
        self.assertTrue(until(lambda: len(self.cluster.nodes("idle")) == 2, 30.0),
                        self.cluster.tails())
        campaign = self.sandbox.start(GOSHAWK, *self.WORDS, "--engine", "slurm", "--output", "far",
                                      env=self.cluster.env)
        lost = until(lambda: self.cluster.running(), 60.0)
        self.assertTrue(lost, f"{campaign.outcome()}\n{self.cluster.tails()}")
        self.cluster.lose_node(lost[0])
        near = self.sandbox.goshawk(*self.WORDS, "--output", "near", timeout_s=200)
        self.assertEqual(near.status, 0, str(near))
        status = campaign.wait(200.0)
        self.assertEqual(status, 0, f"{campaign.outcome()}\n{self.cluster.tails()}")
        local, gathered = json.loads(near.out), json.loads(campaign.out())
        self.assertEqual(gathered["missions"], 4)
        # How long it hovers before its first goal differs, and with it the energy.
        same = {"folder": "", "median_energy_j": 0.0}
        self.assertEqual({**local, **same}, {**gathered, **same})


class SlurmInterrupted(SlurmTest):
    def test_an_interrupted_campaign_cancels_its_job_and_continues(self):
        campaign = self.sandbox.start(GOSHAWK, *self.WORDS, "--engine", "slurm", "--output", "far",
                                      env=self.cluster.env)
        self.assertTrue(until(lambda: self.cluster.jobs(), 60.0), self.cluster.tails())
        status, _ = campaign.stop(signal.SIGINT, timeout_s=60.0)
        self.assertEqual(status, 1, str(campaign.outcome()))
        self.assertEqual(json.loads(campaign.out())["code"], "cancelled")
        self.assertTrue(until(lambda: not self.cluster.jobs(), 60.0), self.cluster.tails())
        outcome = self.sandbox.goshawk(*self.WORDS, "--engine", "slurm", "--output", "far",
                                       env=self.cluster.env, timeout_s=200)
        self.assertEqual(outcome.status, 0, f"{outcome}\n{self.cluster.tails()}")
        self.assertEqual(json.loads(outcome.out)["missions"], 4)


class NoSlurm(SystemTest):
    def test_without_slurm_the_campaign_says_what_to_install(self):
        outcome = self.sandbox.goshawk("campaign", "--engine", "slurm", "--missions", "1", "--json",
                                       env={"PATH": str(self.sandbox.folder)})
        self.assertEqual(outcome.status, 1, str(outcome))
        said = self.json_object(outcome)
        self.assertEqual(said["code"], "io_failed")
        self.assertIn("slurm-client", said["message"])


if __name__ == "__main__":
    harness.main()
