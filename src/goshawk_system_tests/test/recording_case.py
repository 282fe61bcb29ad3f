"""What tests of recordings share."""

import json

from harness import GOSHAWK, SystemTest, until


class RecordingCase(SystemTest):
    def record(self, name, *options, env=None):
        file = self.sandbox.folder / name
        process = self.sandbox.start(GOSHAWK, "record", "-o", file, "--json", *options, env=env)
        self.assertTrue(until(lambda: "recording to" in process.err(), 10), str(process.outcome()))
        return file, process

    def contents(self, file):
        outcome = self.sandbox.goshawk("replay", file, "--list", "--json")
        self.assertEqual(outcome.status, 0, str(outcome))
        listed = self.json_object(outcome)
        listed["counts"] = {t["name"]: t["messages"] for t in listed["topics"]}
        return listed

    def counts(self, file):
        """Of the messages by topic; none before the first was written."""
        outcome = self.sandbox.goshawk("replay", file, "--list", "--json")
        return self.contents(file)["counts"] if outcome.status == 0 else {}

    def messages(self, file, *topics):
        outcome = self.sandbox.goshawk("replay", file, "--print", "--topics", *topics)
        self.assertEqual(outcome.status, 0, str(outcome))
        return [json.loads(line) for line in outcome.out.splitlines()]

    def pub(self, topic, kind, message, *options):
        return self.sandbox.start(GOSHAWK, "topic", "pub", topic, kind, json.dumps(message),
                                  *options)
