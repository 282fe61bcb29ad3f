"""Tests of tools/check_certificate.py: what it accepts, what it finds, both forms of input."""

import copy
import importlib.util
import json
import pathlib
import subprocess
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / "check_certificate.py"
SPEC = importlib.util.spec_from_file_location("check_certificate", SCRIPT)
CHECKER = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(CHECKER)

BOX = {"A": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]], "b": [2, 1, 1, 1, 1, 1]}


def rest(x):
    return {"position": [x, 0, 0], "velocity": [0, 0, 0], "acceleration": [0, 0, 0]}


def plan():
    """1 m from rest to rest in 4 s, as `goshawk plan --json` has it: 1.25 m/s and 1.25 m/s^2 by the hull."""
    points = [[x, 0, 0] for x in (0, 0, 0, 1, 1, 1)]
    return {
        "ok": True,
        "request": {"start": rest(0), "goal": rest(1),
                    "limits": {"v_max_m_s": 2.0, "a_max_m_s2": 2.0, "norm": 0, "j_max_m_s3": 0.0,
                               "v_max_vertical_m_s": 0.0, "a_max_vertical_m_s2": 0.0}},
        "corridor": {"polytopes": [BOX]},
        "trajectory": {"pieces": [{"duration_s": 4.0, "polytope": 0, "control_points": points}]},
    }


def as_message(p):
    """The same as a goshawk_msgs/BezierTrajectory."""
    def xyz(v):
        return dict(zip("xyz", v))

    def flat(s):
        return {k: xyz(v) for k, v in s.items()}
    piece = p["trajectory"]["pieces"][0]
    return {
        "request": {"start": flat(p["request"]["start"]), "goal": flat(p["request"]["goal"]),
                    "limits": {"v_max": 2.0, "a_max": 2.0, "norm": 0, "j_max": 0.0}},
        "polytopes": [{"normals": sum(BOX["A"], []), "offsets": BOX["b"]}],
        "pieces": [{"duration": 4.0, "polytope": 0, "control_points": [xyz(c) for c in piece["control_points"]]}],
    }


def broken(p):
    worst = CHECKER.check(CHECKER.read(p))
    return [family for family, value in worst.items() if not value <= CHECKER.TOLERANCE]


class CertificateTest(unittest.TestCase):
    def test_a_good_plan_holds_in_both_forms(self):
        self.assertEqual(broken(plan()), [])
        self.assertEqual(broken(as_message(plan())), [])
        self.assertEqual(broken({"message": as_message(plan())}), [])

    def test_the_numbers_are_those_of_the_hull(self):
        worst = CHECKER.check(CHECKER.read(plan()))
        self.assertAlmostEqual(worst["velocity"], 1.25 - 2)
        self.assertAlmostEqual(worst["acceleration"], 1.25 - 2)
        self.assertAlmostEqual(worst["position"], -1)

    def test_each_family_is_found(self):
        def spoil(change):
            p = copy.deepcopy(plan())
            change(p, p["trajectory"]["pieces"][0], p["request"])
            return broken(p)

        def leave(p, piece, _):
            p["corridor"]["polytopes"][0]["b"][1] = 0.001
            piece["control_points"][2][1] = 0.002
        self.assertEqual(spoil(leave), ["position", "start"])
        self.assertEqual(spoil(lambda p, piece, r: r["limits"].update(v_max_m_s=1.2)), ["velocity"])
        self.assertEqual(spoil(lambda p, piece, r: r["limits"].update(a_max_m_s2=1.2)), ["acceleration"])
        self.assertEqual(spoil(lambda p, piece, r: r["limits"].update(j_max_m_s3=1.0)), ["jerk"])
        self.assertEqual(spoil(lambda p, piece, r: r["limits"].update(norm=2, v_max_vertical_m_s=0.1)), [])
        self.assertEqual(spoil(lambda p, piece, r: r["goal"]["position"].__setitem__(0, 1.1)), ["goal"])
        self.assertEqual(spoil(lambda p, piece, r: piece.update(duration_s=0.0)), ["position"])
        self.assertEqual(spoil(lambda p, piece, r: p["corridor"]["polytopes"][0].update(valid_until_s=3.5)),
                         ["validity"])
        self.assertEqual(spoil(lambda p, piece, r: p["corridor"]["polytopes"][0].update(valid_until_s=4.5)), [])
        self.assertIn("position", spoil(lambda p, piece, r: p["corridor"]["polytopes"][0]["A"][0].__setitem__(0, 2)))

    def test_a_jump_between_pieces_is_found(self):
        p = plan()
        second = copy.deepcopy(p["trajectory"]["pieces"][0])
        for c in second["control_points"]:
            c[0] += 1 - 1e-3
        p["corridor"]["polytopes"][0] = {**BOX, "b": [9, 1, 1, 1, 1, 1]}
        p["trajectory"]["pieces"].append(second)
        p["request"]["goal"] = rest(2 - 1e-3)
        self.assertEqual(broken(p), ["continuity_position"])

    def test_exit_status_and_sentence(self):
        for text, status, said in [(json.dumps(plan()), 0, "holds"),
                                   (json.dumps(plan()).replace("4.0", "1.0"), 1, "BROKEN"),
                                   ('{"ok": false, "request": {}, "trajectory": null}', 2, "no trajectory"),
                                   ("not json", 2, "no trajectory")]:
            result = subprocess.run([SCRIPT], input=text, capture_output=True, text=True, check=False)
            self.assertEqual(result.returncode, status, result.stderr)
            self.assertIn(said, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()
