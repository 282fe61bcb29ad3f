"""What a campaign says of its rows: a summary, tables, and how it ended as a whole."""

import collections
import csv
import statistics

import fault_report
from fault_report import quantile

FAULT_COLUMNS = ["mission", "number", "kind", "what", "at_s", "duration_s", "recovery_s", "contacts",
                 "goals_lost", "too_fast", "said"]


def faults_of(rows):
    return [fault for row in rows for fault in row.get("faults", [])]


def summary(rows):
    """One object: how many goals of how many were reached, and what became of the others."""
    legs = sum(r["legs"] for r in rows)
    codes = collections.Counter(code for r in rows for code in r["leg_codes"])
    codes.update(r["code"] for r in rows if r["legs"] == 0)
    clearances = [r["clearance_m"] for r in rows if r["clearance_m"] is not None]
    errors = [r["max_error_m"] for r in rows if r["max_error_m"] is not None]
    energies = [r["energy_j"] for r in rows if r["energy_j"] is not None]
    result = {"missions": len(rows), "flights": legs, "arrived": sum(r["arrived"] for r in rows),
              "collisions": sum(r["verdict"] == "touched" for r in rows),
              "not_judged": sum(r["legs"] > 0 and r["verdict"] not in ("safe", "touched")
                                for r in rows),
              "failures_by_code": dict(codes),
              "smallest_clearance_m": min(clearances, default=None),
              "median_clearance_m": quantile(clearances, 0.5),
              "largest_error_m": max(errors, default=None),
              "flight_time_s": round(sum(r["flight_s"] for r in rows), 3),
              "median_energy_j": statistics.median(energies) if energies else None}
    if any("faults" in r for r in rows):
        result["largest_speed_ratio"] = max((r["speed_ratio"] for r in rows if "speed_ratio" in r),
                                            default=None)
        result["unseen_gaps"] = sum(r.get("unseen", 0) for r in rows)
        result["faults"] = fault_report.summary(faults_of(rows))
    return result


def text(value):
    return "-" if value is None else f"{value:.4g}" if isinstance(value, float) else str(value)


def print_row(cells):
    print("| " + " | ".join(map(text, cells)) + " |")


def print_tables(rows):
    keys = ["missions", "flights", "arrived", "collisions", "smallest_clearance_m",
            "largest_error_m", "flight_time_s", "median_energy_j", "failures_by_code"]
    print_row(["group", *keys])
    print("|" + " --- |" * (len(keys) + 1))
    for name in ("kind", "density", "wind_m_s", "noise_m"):
        for value in sorted({r[name] for r in rows}):
            group = summary([r for r in rows if r[name] == value])
            print_row([f"{name} {value}", *(group[k] for k in keys)])
    whole = summary(rows)
    print_row(["all", *(whole[k] for k in keys)])
    if "faults" in whole:
        print_faults(whole["faults"], faults_of(rows))
    for r in rows:
        if r["verdict"] == "touched" or (r["legs"] == 0 and r["code"] != "ok"):
            print(f"mission {r['mission']}: {r['verdict']}, {r['code']}: {r['message']}")


def print_faults(kinds, faults):
    print()
    keys = ["injected", "contacts", "goals_lost", "too_fast", "not_recovered", "recovery_p50_s",
            "recovery_p99_s"]
    print_row(["fault", *keys])
    print("|" + " --- |" * (len(keys) + 1))
    for kind, group in kinds.items():
        print_row([kind, *(group[k] for k in keys)])
    print()
    for fault in faults:
        if fault["contacts"] or fault["goals_lost"] or fault["too_fast"]:
            print(sentence(fault))


def sentence(fault):
    """What one fault was, and what came of it."""
    recovery = ("not recovered" if fault["recovery_s"] is None
                else f"recovered after {fault['recovery_s']:.2f} s")
    came = [word for word, count in (("a contact", fault["contacts"]),
                                     ("a goal lost", fault["goals_lost"]),
                                     ("too fast", fault["too_fast"])) if count]
    return (f"{fault['kind']}: {fault['what']}, at {fault['at_s']:.1f} s: {recovery}; "
            f"{', '.join(came) or 'no harm'}; said: {', '.join(fault['said']) or 'nothing'}")


def write_faults(rows, path):
    """A row for each fault of the campaign."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, FAULT_COLUMNS, extrasaction="ignore")
        table.writeheader()
        for row in rows:
            for number, fault in enumerate(row.get("faults", []), 1):
                table.writerow({**fault, "mission": row["mission"], "number": number,
                                "said": "; ".join(fault["said"])})


def outcome_of(rows, interrupted):
    """@return code and sentence of a whole campaign"""
    touched = [r["mission"] for r in rows if r["verdict"] == "touched"]
    if touched:
        return "collision", f"missions {touched} touched something"
    if interrupted:
        return "cancelled", "interrupted; the same call continues"
    if not any(r["legs"] for r in rows):
        return rows[0]["code"], f"nothing was flown: {rows[0]['message']}"
    fast = [r["mission"] for r in rows if any(f["too_fast"] for f in r.get("faults", []))]
    if fast:
        return "tracking_lost", f"missions {fast} flew faster than 1.1 times their limit"
    return "ok", ""
