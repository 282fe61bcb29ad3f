"""The figures of tools/thesis: the flight in its world, and the planners by density."""

import csv
import itertools
import json
import re

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Patch
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

# name of the planner in the report: name here, colour, mark
PLANNERS = {
    "goshawk": ("Goshawk", "tab:blue", "o"),
    "thesis": ("thesis", "tab:orange", "s"),
    "minimum_snap": ("minimum snap (Ref. 40)", "tab:green", "^"),
    "minimum_jerk": ("minimum jerk (Ref. 42)", "tab:red", "D"),
}


def occupied_voxels(path):
    """(resolution in m, {(x, y, z) in voxels from the map's zero}) of an OctoMap .bt file."""
    head, tree = path.read_bytes().split(b"\ndata\n", 1)
    resolution = float(re.search(rb"\nres ([0-9.eE+-]+)", head).group(1))
    offset, voxels = 0, set()

    def read(size, corner):
        nonlocal offset
        bits = int.from_bytes(tree[offset:offset + 2], "little")
        offset += 2
        half = size // 2
        corners = [tuple(c + half * (child >> axis & 1) for axis, c in enumerate(corner))
                   for child in range(8)]
        kinds = [bits >> 2 * child & 3 for child in range(8)]  # 1: free, 2: occupied, 3: inner
        for kind, at in zip(kinds, corners):
            if kind == 2:
                voxels.update(itertools.product(*(range(c, c + half) for c in at)))
        for kind, at in zip(kinds, corners):
            if kind == 3:
                read(half, at)

    read(1 << 16, (-(1 << 15),) * 3)
    return resolution, voxels


def faces(voxels, resolution):
    """The squares between what is occupied and what is not, with the normal's axis."""
    squares, axes = [], []
    for voxel in voxels:
        for axis, side in itertools.product(range(3), (0, 1)):
            beside = list(voxel)
            beside[axis] += 2 * side - 1
            if tuple(beside) in voxels:
                continue
            square = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = list(voxel)
                corner[axis] += side
                corner[axis - 2] += u
                corner[axis - 1] += v
                square.append([resolution * c for c in corner])
            squares.append(square)
            axes.append(axis)
    return squares, axes


def read_columns(path, *names):
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [[float(r[n]) for r in rows] for n in names]


def draw_flight(folder, path):
    """Voxel path, pruned path, trajectory and flown track among the obstacles."""
    result = json.loads((folder / "flight.json").read_text())
    found = result["legs"][0]["path"]
    planned = read_columns(folder / "trajectory.csv", "x_m", "y_m", "z_m")
    flown = read_columns(folder / "flown.csv", "x_m", "y_m", "z_m")
    resolution, voxels = occupied_voxels(folder / "world.bt")
    squares, axes_of = faces(voxels, resolution)
    figure = plt.figure(figsize=(11, 9))
    axes = figure.add_subplot(projection="3d", computed_zorder=False)
    shades = ["#b8bcc4", "#c8ccd4", "#dde0e6"]
    axes.add_collection3d(Poly3DCollection(squares, facecolors=[shades[a] for a in axes_of],
                                           alpha=0.2, linewidths=0, zorder=1))
    axes.plot(*zip(*found["raw_points"]), "-", color="tab:red", marker=".", markersize=4,
              linewidth=1, label="voxel path (JA*)", zorder=3)
    axes.plot(*zip(*found["points"]), "o-", color="black", markersize=5, linewidth=1.3,
              label="pruned path", zorder=4)
    axes.plot(*planned, color="tab:orange", linewidth=4, label="trajectory", zorder=5)
    axes.plot(*flown, color="tab:blue", linewidth=1.6, linestyle="--", label="flown track", zorder=6)
    spans = [[resolution * f(v[a] for v in voxels) for f in (min, max)] for a in range(3)]
    for name, (low, high) in zip("xyz", spans):
        getattr(axes, f"set_{name}lim")(low, high + resolution)
        getattr(axes, f"set_{name}label")(f"{name} [m]", labelpad=6)
    axes.set_box_aspect([high - low for low, high in spans])
    axes.locator_params(axis="z", nbins=4)
    axes.view_init(elev=42, azim=-28)
    handles, _ = axes.get_legend_handles_labels()
    axes.legend(handles=[*handles, Patch(color=shades[1], label="obstacles")], loc="upper left",
                bbox_to_anchor=(0.0, 0.95))
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def draw_by_density(rows, thesis_rows, value, thesis_value, label, path, log):
    """One line a planner; hollow: what the thesis gives for it, at density 0.4.
    @param value, thesis_value functions of a row"""
    figure, axes = plt.subplots(figsize=(8, 4.6), constrained_layout=True)
    for planner, (name, colour, mark) in PLANNERS.items():
        mine = sorted((r["density"], value(r)) for r in rows if r["planner"] == planner)
        if mine:
            axes.plot(*zip(*mine), marker=mark, color=colour, label=name)
        for r in thesis_rows:
            if r["planner"] == planner:
                axes.plot([0.4], [thesis_value(r)], marker=mark, color=colour, markersize=10,
                          fillstyle="none", linestyle="none",
                          label=f"{name.split(',')[0]}, as published")
    axes.set_xlabel("obstacle density of the grown map")
    axes.set_ylabel(label)
    axes.set_xticks([0.1, 0.2, 0.3, 0.4])
    if log:
        axes.set_yscale("log")
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_planners(report, folder):
    rows = [r for r in report["rows"] if r["world"] == "boxes 6x8x4"]
    published = [r for r in report["thesis_table_3"] if "thesis" in r["by"]]
    draw_by_density(rows, published, lambda r: r["plan_ms"], lambda r: 1e3 * r["generation_s"],
                    "median time of a plan [ms]", folder / "generation_time.png", log=True)
    draw_by_density(rows, published, lambda r: r["length_m"], lambda r: r["length_m"],
                    "median length [m]", folder / "length.png", log=False)
