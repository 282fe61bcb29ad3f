#!/usr/bin/python3
"""Checks a trajectory's certificate from its control points alone, trusting nothing else.

    goshawk plan --json | tools/check_certificate.py
    goshawk topic echo /trajectory --once --json | tools/check_certificate.py
    tools/check_certificate.py FILE

The same as goshawk/certificate_checker.hpp. Exit status: 0 it holds, 1 it does not, 2 nothing to check.
"""

import json
import math
import sys

TOLERANCE = 1e-6  # in each family's own unit


def minus(a, b, factor=1.0):
    return [factor * (x - y) for x, y in zip(a, b)]


def length(v):
    return math.sqrt(sum(x * x for x in v))


def derivative(points, duration):
    """Control points of the derivative of a Bezier curve."""
    factor = (len(points) - 1) / duration
    return [minus(b, a, factor) for a, b in zip(points, points[1:])]


def use(v, norm, limit, vertical):
    """How much of a limit is used: 1 at the limit."""
    if norm == 0:
        return length(v) / limit
    if norm == 1:
        return max(abs(x) for x in v) / limit
    return max(math.hypot(v[0], v[1]) / limit, abs(v[2]) / (vertical or limit))


def outside(polytope, p):
    if not polytope["b"] or any(abs(length(n) - 1) > 1e-6 for n in polytope["A"]):
        return math.inf
    return max(sum(x * y for x, y in zip(n, p)) - b
               for n, b in zip(polytope["A"], polytope["b"], strict=True))


def always(polytope):
    return polytope["from"] == 0 and polytope["until"] == 0


def apart(a, b):
    return max(length(minus(x, y)) for x, y in zip(a, b))


def allowance(start, limits):
    """Factors of the limits, and until when, for a start that is above them."""
    v = use(start[1], limits["norm"], limits["v_max"], limits["v_max_vertical"])
    a = use(start[2], limits["norm"], limits["a_max"], limits["a_max_vertical"])
    if v <= 1 + 1e-6 and a <= 1 + 1e-6:
        return 1.0, 1.0, 0.0
    v_to_a = limits["v_max"] / limits["a_max"]
    return max(1, v) + max(1, a) * 0.1 / v_to_a, max(1, a), 2 * max(0, v - 1) * v_to_a + 0.5


def check(plan):
    """The largest violation of each family, as a dict: what is above 1e-6, or not a number, is broken."""
    limits, pieces = plan["limits"], plan["pieces"]
    if not pieces or not limits["v_max"] > 0 or not limits["a_max"] > 0:
        return {"position": math.inf}
    v_factor, a_factor, until = allowance(plan["start"], limits)
    worst = dict.fromkeys(["position", "velocity", "acceleration"], -math.inf)
    worst["jerk"] = -math.inf if limits["j_max"] > 0 else 0.0
    used = [plan["polytopes"][p["polytope"]] for p in pieces]
    worst["validity"] = 0.0 if all(always(p) for p in used) else -math.inf
    worst.update(dict.fromkeys(["continuity_position", "continuity_velocity", "continuity_acceleration"], 0.0))

    def note(family, value):
        worst[family] = math.inf if math.isnan(value) else max(worst[family], value)

    begin, before = 0.0, None
    for piece in pieces:
        points, duration = piece["control_points"], piece["duration"]
        if not (math.isfinite(duration) and duration > 0) or len(points) != 6:
            return {"position": math.inf}
        velocity = derivative(points, duration)
        acceleration = derivative(velocity, duration)
        early = begin < until
        home = plan["polytopes"][piece["polytope"]]
        for p in points:
            note("position", outside(home, p))
        if not always(home):
            note("validity", home["from"] - begin)
            note("validity", begin + duration - home["until"])
        for v in velocity:
            u = use(v, limits["norm"], limits["v_max"], limits["v_max_vertical"])
            note("velocity", limits["v_max"] * (u - (v_factor if early else 1)))
        for a in acceleration:
            u = use(a, limits["norm"], limits["a_max"], limits["a_max_vertical"])
            note("acceleration", limits["a_max"] * (u - (a_factor if early else 1)))
        if limits["j_max"] > 0:
            for j in derivative(acceleration, duration):
                note("jerk", length(j) - limits["j_max"])
        first = [points[0], velocity[0], acceleration[0]]
        if before is None:
            worst["start"] = apart(first, plan["start"])
        else:
            for family, x, y in zip(["continuity_position", "continuity_velocity", "continuity_acceleration"], first, before):
                note(family, length(minus(x, y)))
        before = [points[-1], velocity[-1], acceleration[-1]]
        begin += duration
    worst["goal"] = apart(before, plan["goal"])
    return worst


def point(p):
    return [float(p[k]) for k in "xyz"] if isinstance(p, dict) else [float(x) for x in p]


def state(s):
    return [point(s[k]) for k in ("position", "velocity", "acceleration")]


def number(values, name, unit):
    return float(values.get(name, values.get(f"{name}_{unit}", 0.0)))


def polytope(p):
    interval = {"from": number(p, "valid_from", "s"), "until": number(p, "valid_until", "s")}
    if "A" in p:
        return {"A": [point(n) for n in p["A"]], "b": [float(b) for b in p["b"]], **interval}
    n = [float(x) for x in p["normals"]]
    return {"A": [n[i:i + 3] for i in range(0, len(n), 3)], "b": [float(b) for b in p["offsets"]],
            **interval}


def read(message):
    """From `goshawk plan --json`, or a goshawk_msgs/BezierTrajectory (topic echo --json)."""
    while "request" not in message:
        message = next((v for v in message.values() if isinstance(v, dict) and "request" in v), None)
        if message is None:
            raise KeyError("request")
    trajectory = message.get("trajectory", message)
    polytopes = message.get("corridor", message)
    if trajectory is None or polytopes is None:
        raise KeyError("trajectory")
    request = message["request"]
    limits = request["limits"]
    return {
        "start": state(request["start"]),
        "goal": state(request["goal"]),
        "limits": {"norm": int(limits["norm"]), "v_max": number(limits, "v_max", "m_s"),
                   "a_max": number(limits, "a_max", "m_s2"), "j_max": number(limits, "j_max", "m_s3"),
                   "v_max_vertical": number(limits, "v_max_vertical", "m_s"),
                   "a_max_vertical": number(limits, "a_max_vertical", "m_s2")},
        "polytopes": [polytope(p) for p in polytopes["polytopes"]],
        "pieces": [{"duration": float(p.get("duration_s", p.get("duration"))),
                    "polytope": int(p["polytope"]),
                    "control_points": [point(c) for c in p["control_points"]]}
                   for p in trajectory["pieces"]],
    }


def main(arguments):
    if len(arguments) > 1 or arguments[:1] in (["--help"], ["-h"]):
        print(__doc__, file=sys.stderr)
        return 0 if arguments[:1] in (["--help"], ["-h"]) else 2
    try:
        text = open(arguments[0], encoding="utf-8").read() if arguments else sys.stdin.read()
        plan = read(json.loads(text))
        worst = check(plan)
    except (OSError, ValueError, KeyError, TypeError, IndexError) as error:
        print(f"check_certificate: no trajectory to check: {type(error).__name__} {error}", file=sys.stderr)
        return 2
    broken = [family for family, value in worst.items() if not value <= TOLERANCE]
    for family, value in worst.items():
        print(f"{family:20} {value:12.3g} {'BROKEN' if family in broken else ''}".rstrip())
    print("the certificate does not hold" if broken else "the certificate holds")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
