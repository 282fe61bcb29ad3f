#!/usr/bin/env python3
"""Draws the plots that a bench report asks for, as PNG beside it: draw_plots.py REPORT.json"""

import json
import os
import sys
import textwrap

try:
    import matplotlib
except ImportError:
    sys.exit("pictures need matplotlib: run tools/setup, or install python3-matplotlib")
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

MARKERS = "os^Dv<>ph*"
# Okabe and Ito's colours, which every kind of colour vision tells apart, the palest one last.
COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#f0e442"]
matplotlib.rcParams["axes.prop_cycle"] = matplotlib.cycler(color=COLORS)
MOST_MARKED = 60  # points of a line; more are a curve


def rows_of(report, plot):
    return [r for r in report[plot.get("from", "rows")]
            if all(r.get(k) == v for k, v in plot["where"].items())
            and r.get(plot["x"]) is not None and r.get(plot["y"]) is not None]


def printed(label):
    """Units as they are printed: reports write them in ASCII."""
    return label.replace("^2", "²").replace("^3", "³").replace("[us]", "[µs]")


def draw(report, plot, folder):
    rows = rows_of(report, plot)
    if not rows:
        return None
    figure, axes = plt.subplots(figsize=(7, 4.5), constrained_layout=True)
    series = list(dict.fromkeys(str(r.get(plot["series"], "")) for r in rows))
    for index, name in enumerate(series):
        mine = [r for r in rows if str(r.get(plot["series"], "")) == name]
        xs, ys = [r[plot["x"]] for r in mine], [r[plot["y"]] for r in mine]
        curve = len(mine) > MOST_MARKED and not plot["points_only"]
        style = {"marker": None if curve else MARKERS[index % len(MARKERS)], "label": name or None}
        if name == "limit":
            style.update(color="black", dashes=(5, 3))
        axes.plot(xs, ys, linestyle="none" if plot["points_only"] else "-", **style)
    named = any(isinstance(r[plot["x"]], str) for r in rows)
    if named:
        names = list(dict.fromkeys(r[plot["x"]] for r in rows))
        axes.set_xticks(range(len(names)), [textwrap.fill(n, 14) for n in names], fontsize="small")
        axes.margins(x=0.6 / len(names))
    if plot["log_x"]:
        axes.set_xscale("log")
    if plot["log_y"]:
        axes.set_yscale("log")
    elif plot["points_only"] and not named:
        axes.margins(y=0.15)  # a cloud of points: its spread matters, not its distance from zero
    else:
        low, high = axes.get_ylim()
        axes.set_ylim(min(0, low), high + 0.03 * (high - min(0, low)))
    axes.set(title=plot["title"], xlabel=printed(plot["x_label"]),
             ylabel=printed(plot["y_label"]))
    axes.grid(True, which="both", alpha=0.3)
    if len(series) > 1:
        # Beside the picture where points may lie anywhere.
        beside = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)} if named else {}
        axes.legend(fontsize="small", **beside)
    path = os.path.join(folder, plot["file"] + ".png")
    figure.savefig(path, dpi=130)
    plt.close(figure)
    return path


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as file:
        report = json.load(file)
    folder = os.path.dirname(os.path.abspath(sys.argv[1]))
    for plot in report["plots"]:
        path = draw(report, plot, folder)
        print(f"drew {path}" if path else f"no rows for {plot['file']}", file=sys.stderr)


main()
