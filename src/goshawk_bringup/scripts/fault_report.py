"""What became of a flight's faults: what the stages said, how long the flight took to recover, and
which of them a contact, a lost goal or too high a speed followed."""

import collections
import math

STEADY_S = 0.5  # a flight that goes well for so long has recovered


class Life:
    """How a flight went, from its events: good are the times at which the navigator has arrived or
    the tracker follows a trajectory, and every stage that was killed is back."""

    def __init__(self, events, kills):
        """@param kills [(node, ns)]"""
        changes = [(e["at_ns"], e["event"], e) for e in events]
        changes += [(at_ns, "killed", {"node": node}) for node, at_ns in kills]
        self.spans, self.away = [], set()  # [(from ns, good)]
        navigator, mode = "", ""
        for at_ns, event, e in sorted(changes, key=lambda c: c[0]):
            if event == "navigator":
                navigator = e["state"]
            elif event == "tracker":
                mode = e["mode"]
            elif event == "killed":
                self.away.add(e["node"])
            elif event == "report" and e["code"] == "ok":
                self.away.discard(e["node"].rsplit("/", 1)[-1])
            flies = navigator == "arrived" or (navigator == "flying" and mode == "follow")
            self.spans.append((at_ns, flies and not self.away))
        self.end_ns = max((c[0] for c in changes), default=0)

    def recovered_ns(self, since_ns):
        """The first moment from since_ns on from which on the flight goes well for STEADY_S, or to
        its end; None if there is none."""
        steady_ns = STEADY_S * 1e9
        begin_ns = None
        for k, (from_ns, good) in enumerate(self.spans):
            to_ns = self.spans[k + 1][0] if k + 1 < len(self.spans) else self.end_ns
            if to_ns < since_ns and k + 1 < len(self.spans):
                continue
            if not good:
                begin_ns = None
                continue
            if begin_ns is None:
                begin_ns = max(from_ns, since_ns)
            if to_ns - begin_ns >= steady_ns or k + 1 == len(self.spans):
                return begin_ns
        return None


def said(events, begin_ns, end_ns):
    """Codes with which stages answered between two moments: ["tracker: process_stalled", ...]."""
    found = []
    for e in events:
        if not begin_ns <= e["at_ns"] < end_ns or e.get("code", "ok") == "ok":
            continue
        if e["event"] not in ("report", "navigator"):
            continue
        node = e["node"].rsplit("/", 1)[-1] if e["event"] == "report" else "navigator"
        text = f"{node}: {e['code']}"
        if text not in found:
            found.append(text)
    return found


def assess(events, rows):
    """Completes the rows of a flight's faults: at_s, said, recovery_s (None: it did not recover),
    goals_lost."""
    goals = [e["at_ns"] for e in events if e["event"] == "goal"]
    kills = [(row["what"].rsplit(" ", 1)[-1], row["begin_ns"]) for row in rows
             if row["kind"] == "kill"]
    life = Life(events, kills)
    for row, following in zip(rows, [*rows[1:], None]):
        until_ns = following["begin_ns"] if following else math.inf
        recovered = life.recovered_ns(row["end_ns"])
        row["at_s"] = round((row["begin_ns"] - goals[0]) * 1e-9, 3) if goals else None
        row["said"] = said(events, row["begin_ns"], until_ns)
        row["recovery_s"] = (None if recovered is None
                             else round((recovered - row["end_ns"]) * 1e-9, 3))
        row["goals_lost"] = row["contacts"] = row["too_fast"] = 0
    for e in events:
        if e["event"] == "goal":
            goal_ns = e["at_ns"]
        elif e["event"] == "leg" and not e["arrived"]:
            blame_goal(rows, goal_ns, e["at_ns"])
    return rows


def blame_goal(rows, goal_ns, lost_ns):
    """A lost goal is put down to the first fault since the goal from which the flight had not
    recovered when the goal was lost, or else to the newest one."""
    for row in rows:
        if goal_ns <= row["begin_ns"] <= lost_ns and (
                row["recovery_s"] is None or row["end_ns"] + row["recovery_s"] * 1e9 > lost_ns):
            row["goals_lost"] += 1
            return
    blame(rows, lost_ns, "goals_lost")


def blame(rows, at_ns, what):
    """The newest fault before a moment is what it is put down to. @return that fault, or None"""
    before = [row for row in rows if row["begin_ns"] <= at_ns]
    if before:
        before[-1][what] += 1
    return before[-1] if before else None


def quantile(values, q):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(q * len(ordered)))] if ordered else None


def summary(rows):
    """{kind: {"injected", "contacts", "goals_lost", ...}} of all faults of a campaign."""
    kinds = collections.defaultdict(list)
    for row in rows:
        kinds[row["kind"]].append(row)
    result = {}
    for kind, group in sorted(kinds.items()):
        times = [r["recovery_s"] for r in group if r["recovery_s"] is not None]
        result[kind] = {"injected": len(group), "contacts": sum(r["contacts"] for r in group),
                        "goals_lost": sum(r["goals_lost"] for r in group),
                        "too_fast": sum(r["too_fast"] for r in group),
                        "not_recovered": sum(r["recovery_s"] is None for r in group),
                        "recovery_p50_s": quantile(times, 0.5),
                        "recovery_p99_s": quantile(times, 0.99)}
    return result
