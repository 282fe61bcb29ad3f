"""Tests of `goshawk secure init`, without a stack: what it makes holds for openssl."""

import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import launch_file  # noqa: E402
import secure  # noqa: E402
import topic_rights  # noqa: E402
from launch_file import WrongCall  # noqa: E402


def options(folder, **changes):
    return {"folder": str(folder), "namespace": "/", "days": 30, "like": [], **changes}


def openssl(*arguments):
    return subprocess.run(["openssl", *map(str, arguments)], text=True, capture_output=True)


class Made(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name) / "keys"
        secure.init(options(cls.folder, namespace="/uav1", like=["my_search=path_search"]))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def document(self, path):
        """The signed XML, once openssl has verified who signed it."""
        done = openssl("smime", "-verify", "-in", path, "-CAfile",
                       self.folder / "authority" / "ca.pem", "-text")
        self.assertEqual(done.returncode, 0, done.stderr)
        return ElementTree.fromstring(done.stdout[done.stdout.index("<dds"):])

    def rights(self, name):
        grant = self.document(self.folder / name / "permissions.smime").find("permissions/grant")
        self.assertEqual(grant.findtext("subject_name"), f"CN={name},O=Goshawk")
        self.assertEqual(grant.findtext("default"), "DENY")
        rule = grant.find("allow_rule")
        return tuple({t.text for t in rule.iterfind(f"{kind}/topics/topic")}
                     for kind in ("subscribe", "publish"))

    def test_every_certificate_is_signed_by_the_authority_and_has_its_own_key(self):
        keys = set()
        for name in [*topic_rights.roles(), "my_search"]:
            own = self.folder / name
            done = openssl("verify", "-CAfile", self.folder / "authority" / "ca.pem",
                           own / "certificate.pem")
            self.assertEqual(done.returncode, 0, done.stderr)
            subject = openssl("x509", "-in", own / "certificate.pem", "-noout", "-subject",
                              "-nameopt", "RFC2253").stdout
            self.assertIn(f"CN={name},O=Goshawk", subject)
            keys.add((own / "key.pem").read_text())
            self.assertEqual((own / "key.pem").stat().st_mode & 0o077, 0)
        self.assertEqual(len(keys), len(topic_rights.roles()) + 1)

    def test_a_host_whose_clock_is_behind_accepts_the_certificates(self):
        hour_ago = int(time.time()) - 3600
        for name in ("tracker", "operator"):
            done = openssl("verify", "-attime", hour_ago, "-CAfile",
                           self.folder / "authority" / "ca.pem", self.folder / name / "certificate.pem")
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_rights_are_the_least(self):
        reads, writes = self.rights("tracker")
        self.assertIn("rt/uav1/committed_trajectory", reads)
        self.assertEqual(writes, {"rt/uav1/command", "rt/uav1/fallback_stop",
                                  "rt/uav1/tracking_state", "rt/uav1/stage_report",
                                  "rt/parameter_answer"})
        self.assertEqual(self.rights("recorder"), ({"rt/*"}, set()))
        self.assertNotIn("rt/uav1/committed_trajectory", self.rights("viewer")[1])
        self.assertEqual(self.rights("my_search"), self.rights("path_search"))
        writers = {}
        for name in topic_rights.STAGES:
            for topic in self.rights(name)[1]:
                writers.setdefault(topic, []).append(name)
        several = {t for t, names in writers.items() if len(names) > 1}
        # The guard stands in the navigator's place: a launch has one of them.
        of_either = {t for t in several if set(writers[t]) == {"navigator", "guard"}}
        self.assertEqual(of_either, {f"rt/uav1/{topic}" for topic in (
            "committed_trajectory", "navigator_state", "navigator_alive")})
        self.assertEqual(several - of_either, {"rt/uav1/stage_report", "rt/uav1/operator_answer",
                                               "rt/parameter_answer"})

    def test_a_remapped_topic_is_one_that_the_stage_has_a_right_to(self):
        table, remapped = topic_rights.roles(), 0
        for path in sorted((SCRIPTS.parent / "launch").glob("*.yaml")):
            for stage in launch_file.read(path)["stages"]:
                role = topic_rights.role_of(stage.get("component", ""))
                for source, target in stage.get("remap", {}).items():
                    for right in table[role]:
                        self.assertEqual(source in right, target in right,
                                         f"{path.name}: {role} {source} -> {target}")
                    remapped += 1
        self.assertGreater(remapped, 0)

    def test_sensors_write_what_their_component_advertises_and_no_more(self):
        source = (SCRIPTS.parents[1] / "goshawk_sensors/component/sensors_component.cpp").read_text()
        advertised = set(re.findall(r'advertise<[^"]*>\("([^"]+)"', source))
        self.assertIn("points", advertised)
        self.assertEqual(set(topic_rights.STAGES["sensors"]["writes"]), advertised)

    def test_the_guard_opens_what_its_component_names_and_no_more(self):
        source = (SCRIPTS.parents[1] / "goshawk_guard/component/guard_component.cpp").read_text()
        advertised = set(re.findall(r'advertise<[^"]*>\("([^"]+)"', source))
        heard = set(re.findall(r'(?:subscribe|listen)<[^"]*>\(\s*"([^"]+)"', source))
        self.assertIn("plan/path", heard)
        self.assertIn("LifeSign", source)  # it advertises this one
        advertised.add("navigator_alive")
        self.assertEqual(set(topic_rights.STAGES["guard"]["writes"]), advertised)
        self.assertEqual(set(topic_rights.STAGES["guard"]["reads"]),
                         heard | set(topic_rights.MAP))

    def test_governance_admits_nobody_without_a_certificate(self):
        rule = self.document(self.folder / "authority" / "governance.smime").find(
            "domain_access_rules/domain_rule")
        self.assertEqual(rule.findtext("allow_unauthenticated_participants"), "false")
        for kind in ("discovery", "liveliness", "rtps"):
            self.assertEqual(rule.findtext(f"{kind}_protection_kind"), "ENCRYPT")

    def test_what_is_wrong_is_refused_with_a_sentence(self):
        for words, changes in [("is not empty", {}),
                               ("--like x=nothing", {"folder": self.folder / "a", "like": ["x=nothing"]}),
                               ("--like tracker=tracker",
                                {"folder": self.folder / "a", "like": ["tracker=tracker"]}),
                               ("namespace '/a<b'", {"folder": self.folder / "a",
                                                     "namespace": "/a<b"})]:
            with self.subTest(words):
                with self.assertRaises(secure.Failure) as refused:
                    secure.init(options(**{"folder": self.folder, **changes}))
                self.assertIn(words, str(refused.exception))
        self.assertFalse((self.folder / "a").exists())

    def programs(self, text, host=""):
        path = pathlib.Path(self.temporary.name) / "test.yaml"
        path.write_text(text)
        plan = launch_file.Plan(launch_file.read(path), path, "/prefix", (), host)
        plan.secure = str(self.folder)
        return {p.name: p.command for p in plan.programs()}

    def test_a_launch_gives_each_process_its_own_certificate(self):
        commands = self.programs("stages:\n  - component: simulator\n    node: plant\n"
                                 "  - component: tracker\n  - command: [ls]\n    name: my_search\n")
        for name, role in (("plant", "vehicle"), ("tracker", "tracker"), ("my_search", "my_search")):
            self.assertEqual(commands[name][:2], [
                "/usr/bin/env", f"FASTRTPS_DEFAULT_PROFILES_FILE={self.folder}/{role}/profile.xml"])
        with self.assertRaisesRegex(WrongCall, "no certificate for ls"):
            self.programs("stages: [{command: [ls]}]")
        with self.assertRaisesRegex(WrongCall, "container: false"):
            self.programs("container: true\nstages: [{component: tracker}]")

    def test_a_host_among_several_needs_profiles_that_are_not_for_loopback_alone(self):
        text = ("hosts: {vehicle: 10.0.0.2, ground: }\nstages:\n"
                "  - {component: tracker, host: vehicle}\n  - {component: map_server, host: ground}\n")
        with self.assertRaisesRegex(WrongCall, "tracker/profile.xml is for loopback"):
            self.programs(text, "vehicle")
        profile = self.folder / "map_server" / "profile.xml"
        before = profile.read_text()
        self.addCleanup(profile.write_text, before)
        profile.write_text(before.replace("127.0.0.1", "10.0.0.3"))
        self.assertEqual(list(self.programs(text, "ground")), ["map_server"])
        profile.write_text("no profile")
        with self.assertRaisesRegex(WrongCall, "not a profile"):
            self.programs(text, "ground")


if __name__ == "__main__":
    unittest.main()
