#!/usr/bin/env python3
"""Draws docs/images/demo.png: the two simulated scans of `make demo` before and after `igsp align`.

usage: docs/make_pictures.py path/to/igsp     (needs numpy and matplotlib: python3-matplotlib)
"""
import json
import pathlib
import subprocess
import sys
import tempfile

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read_ply(path):
    data = pathlib.Path(path).read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii").splitlines()
    count = next(int(line.split()[2]) for line in header if line.startswith("element vertex"))
    kinds = {"float": "<f4", "double": "<f8"}
    fields = [(line.split()[2], kinds[line.split()[1]]) for line in header if line.startswith("property")]
    points = np.frombuffer(data, np.dtype(fields), count, end)
    return np.stack([points[axis].astype(float) for axis in "xyz"], axis=1)


def draw(axes, target, source, title, window):
    for points, colour, label in ((target, "#9a9a9a", "target"), (source, "#c0392b", "source")):
        above_ground = points[points[:, 2] > -0.9]
        axes.scatter(above_ground[:, 0], above_ground[:, 1], s=0.15, c=colour, linewidths=0, label=label)
    axes.set(title=title, xlabel="x [m]", aspect="equal", xlim=window, ylim=window)


def main():
    igsp = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([igsp, "simulate", "park", "--out", folder], check=True, capture_output=True)
        source, target = read_ply(f"{folder}/station_1.ply"), read_ply(f"{folder}/station_0.ply")
        report = f"{folder}/run.json"
        subprocess.run([igsp, "align", f"{folder}/station_1.ply", f"{folder}/station_0.ply", "--report", report], check=True,
                       capture_output=True)
        run = json.loads(pathlib.Path(report).read_text())
    matrix = np.array(run["target_from_source"])
    aligned = source @ matrix[:3, :3].T + matrix[:3, 3]
    figure, (before, after) = plt.subplots(1, 2, figsize=(9, 4.6), sharey=True)
    draw(before, target, source, "two scans, each in its scanner's frame", (-28, 28))
    draw(after, target, aligned, f"igsp align: {run['verdict']}, overlap {run['overlap']:.2f}", (-28, 28))
    before.set_ylabel("y [m]")
    after.legend(loc="lower right", markerscale=20, framealpha=1)
    figure.tight_layout()
    figure.savefig(pathlib.Path(__file__).parent / "images" / "demo.png", dpi=110)


main()
