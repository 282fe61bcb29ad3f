"""The page of tools/league: its table, the published figures, and each world from above."""

import base64
import datetime
import html
import io
import json
import os
import pathlib
import platform
import subprocess

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.patches import Circle, Rectangle

import league_peers

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = """<!doctype html><meta charset="utf-8"><title>Goshawk: the league</title>
<style>body{font:15px/1.5 sans-serif;max-width:78em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0}th,td{padding:.25em .6em;border-bottom:1px solid #ddd;
text-align:right;white-space:nowrap}th{border-bottom:2px solid #888}
td:first-child,th:first-child{text-align:left}.bad{color:#b00;font-weight:bold}
img{max-width:100%;margin:.5em 0}.peer{color:#777}p{max-width:50em}</style>
"""
COLUMNS = [("world", "world", ""), ("tracking", "tracking", ""), ("runs", "runs", "d"),
           ("arrived", "arrived", "d"), ("contacts", "contacts", "d"),
           ("violations", "violations", "d"), ("clearance_m", "clearance, m", ".3f"),
           ("time_s", "time, s", ".2f"), ("first_time_s", "seed 0, s", ".2f"),
           ("floor_s", "floor, s", ".2f"), ("length_m", "length, m", ".1f"),
           ("mean_speed_m_s", "mean, m/s", ".2f"), ("top_speed_m_s", "top, m/s", ".2f"),
           ("of_known_speed", "of known", ".2f"),
           ("jerk_m_s2", "jerk, m/s&sup2;", ".0f"), ("max_error_m", "error, m", ".3f"),
           ("replan_p50_ms", "replan p50, ms", ".1f"), ("replan_p99_ms", "p99, ms", ".1f"),
           ("peer", "peer", ""), ("peer_time_s", "peer, s", ".2f")]
PEER_COLUMNS = ["world", "peer", "success, %", "time, s", "length, m", "jerk, m/s&sup2;",
                "replan, ms", "machine", "source"]


def cell(row, key, form):
    value = row[key]
    text = "-" if value is None else html.escape(format(value, form))
    bad = (key in ("contacts", "violations") and value) or (key == "arrived"
                                                            and value < row["runs"])
    kind = " class=bad" if bad else " class=peer" if key.startswith("peer") else ""
    return f"<td{kind}>{text}"


def results_table(rows):
    head = "".join(f"<th>{title}" for _, title, _ in COLUMNS)
    body = "".join("<tr>" + "".join(cell(row, key, form) for key, _, form in COLUMNS)
                   for row in rows)
    return f"<table><tr>{head}{body}</table>\n"


def peers_table(worlds):
    lines = ["<tr>" + "".join(f"<th>{c}" for c in PEER_COLUMNS)]
    for world in worlds:
        for peer in league_peers.PEERS.get(world, []):
            values = [world, peer["peer"], peer["success"], peer["time_s"], peer.get("length_m"),
                      peer.get("jerk_m_s2"), peer.get("replan_p50_ms"), peer["machine"],
                      peer["source"]]
            lines.append("<tr>" + "".join(
                f"<td class=peer>{'-' if v is None else html.escape(str(v))}" for v in values))
    return "<table>" + "".join(lines) + "</table>\n"


def failures(results):
    lines = [f"<li>{html.escape(r['world'])}, {r['tracking']} tracking, seed {r['seed']}: "
             f"{html.escape(r['verdict'] if r['touched'] else r['reason'])}"
             for r in results if r["touched"] or not r["arrived"]]
    return "<h2>What went wrong</h2><ul>" + "".join(lines) + "</ul>\n" if lines else ""


def draw(file):
    """A flight from above, coloured by speed. @return its PNG, as text"""
    flight = json.loads(file.read_text(encoding="utf-8"))
    x0, y0, _, x1, y1, z1 = flight["box"]
    figure, axes = plt.subplots(figsize=(13, max(2.2, 13 * (y1 - y0) / (x1 - x0) + 0.6)))
    shapes = []
    for solid in flight["solids"]:
        (x, y, z), (dx, dy, dz) = solid["center"], solid["size"]
        if z + dz / 2 <= 0.0 or z - dz / 2 >= z1:
            continue
        shapes.append(Rectangle((x - dx / 2, y - dy / 2), dx, dy) if solid["box"]
                      else Circle((x, y), dx / 2))
    axes.add_collection(PatchCollection(shapes, facecolor="#9a9", edgecolor="#676", linewidth=0.3))
    points = [(p[1], p[2]) for p in flight["track"]]
    lines = LineCollection(list(zip(points[:-1], points[1:])), cmap="turbo", linewidth=1.6)
    lines.set_array([p[4] for p in flight["track"]])
    axes.add_collection(lines)
    figure.colorbar(lines, ax=axes, label="m/s", pad=0.01)
    axes.plot(*flight["goal"][:2], "k*", markersize=9)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x, m", ylabel="y, m")
    picture = io.BytesIO()
    figure.tight_layout()
    figure.savefig(picture, format="png", dpi=90)
    plt.close(figure)
    return base64.b64encode(picture.getvalue()).decode()


def pictures(rows, flights):
    text = ""
    for row in rows:
        name = flights.name((row["world"], row["tracking"], 0, False))
        file = flights.folder / f"{name}.track.json"
        if row["tracking"] != "true" or not file.exists():
            continue
        text += (f"<h3>{row['world']}, seed 0</h3>"
                 f'<img alt="{row["world"]} from above" '
                 f'src="data:image/png;base64,{draw(file)}">\n')
    return text


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = next((line.split(":", 1)[1].strip() for line in file
                      if line.startswith("model name")), platform.machine())
    commit = subprocess.run(["git", "-C", str(ROOT), "describe", "--always", "--dirty"],
                            capture_output=True, text=True, check=False).stdout.strip()
    return (f"{model}, {os.cpu_count()} cores, load average {os.getloadavg()[1]:.1f}; commit "
            f"{commit or 'unknown'}; {datetime.date.today()}")


def write_page(page, rows, results, flights):
    worlds = list(dict.fromkeys(row["world"] for row in rows))
    noise = flights.options.noise
    text = [HEAD, "<h1>The league</h1>\n<p>", html.escape(machine()),
            f". A lidar of 64 x 512 rays at 10 Hz, 30 m, range noise {noise:g} m; the world is "
            "unknown at first. Judged by FCL against the true solids with the body as a cylinder "
            "of 0.15 m radius. Time: from the goal until the vehicle is at rest within 0.1 m of "
            "it. Means of the flights that arrived; <i>of known</i>: mean speed over that of the "
            "same flight with the whole map known; <i>floor</i>: the straight way under the "
            "limits. "
            "Replans are processor times of search, corridor, optimizer, stop part and its check. "
            "docs/league.md says what can be compared with what.</p>\n",
            results_table(rows), failures(results), "<h2>Published</h2>\n", peers_table(worlds),
            "<h2>From above</h2>\n", pictures(rows, flights)]
    page.write_text("".join(text), encoding="utf-8")
