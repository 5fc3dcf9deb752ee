#!/usr/bin/env python3
"""Draws docs/images/demo.png: the two simulated scans of `make demo` before and after `igsp align`; and, given two real
scans, docs/images/method.png: one run on them, step by step.

usage: docs/make_pictures.py path/to/igsp [SOURCE.ply TARGET.ply]     (needs numpy and matplotlib: python3-matplotlib)
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


def transform(matrix, points):
    return points @ np.array(matrix)[:3, :3].T + np.array(matrix)[:3, 3]


def align(igsp, source, target, report):
    # A pair that is not registered has a report as well, so the exit code is not looked at.
    subprocess.run([igsp, "align", source, target, "--threads", "1", "--report", report, "--quiet"], capture_output=True)
    return json.loads(pathlib.Path(report).read_text())


def draw_demo(igsp, folder):
    subprocess.run([igsp, "simulate", "park", "--out", folder], check=True, capture_output=True)
    source, target = read_ply(f"{folder}/station_1.ply"), read_ply(f"{folder}/station_0.ply")
    run = align(igsp, f"{folder}/station_1.ply", f"{folder}/station_0.ply", f"{folder}/run.json")
    figure, (before, after) = plt.subplots(1, 2, figsize=(9, 4.6), sharey=True)
    draw(before, target, source, "two scans, each in its scanner's frame", (-28, 28))
    aligned = transform(run["target_from_source"], source)
    draw(after, target, aligned, f"igsp align: {run['verdict']}, overlap {run['overlap']:.2f}", (-28, 28))
    before.set_ylabel("y [m]")
    after.legend(loc="lower right", markerscale=20, framealpha=1)
    figure.tight_layout()
    figure.savefig(images / "demo.png", dpi=110)


def draw_points(axes, points, colour, size, label=None):
    axes.scatter(points[:, 0], points[:, 1], s=size, c=colour, linewidths=0, label=label)


def draw_matches(axes, run, iteration, aligned, target, shift):
    """The source at its final pose, shifted aside, and lines between the matched keypoints; far ones dashed and dark."""
    source_keypoints = transform(run["target_from_source"], np.array(run["source_keypoints"]))
    target_keypoints = np.array(run["target_keypoints"])
    pairs = np.array(iteration["correspondences"])
    ends = np.stack([source_keypoints[pairs[:, 0]], target_keypoints[pairs[:, 1]]], axis=1)
    far = np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > 2.5 * run["voxel_size"]
    draw_points(axes, target, "#9a9a9a", 0.3)
    draw_points(axes, aligned + shift, "#c0392b", 0.3)
    for line, is_far in zip(ends, far):
        axes.plot(*(line + [shift, np.zeros(3)])[:, :2].T, c="black" if is_far else "#1a9850", lw=1.0 if is_far else 0.4,
                  ls="--" if is_far else "-")
    return len(pairs), int(far.sum())


def draw_method(igsp, source_file, target_file, folder):
    """One run, seen along z. The target is turned so that z is what it was in the file."""
    source, target = read_ply(source_file), read_ply(target_file)
    run = align(igsp, source_file, target_file, f"{folder}/run.json")
    aligned = transform(run["target_from_source"], source)
    figure, axes = plt.subplots(2, 2, figsize=(10, 9.2))
    keypoints, matched, fitted, rival = axes.flat
    low, high = np.percentile(np.vstack([target, aligned]), [0.5, 99.5], axis=0)

    draw_points(keypoints, target, "#bbbbbb", 0.3)
    draw_points(keypoints, np.array(run["target_keypoints"]), "#2c3e90", 6)
    keypoints.set_title(f"keypoints of the target: {run['keypoints']['target']}")

    first = run["iterations"][0]
    aside = np.array([0, 1.1 * (high[1] - low[1]), 0])
    count, far = draw_matches(matched, run, first, aligned, target, aside)
    matched.set_title(f"iteration 1: {count} matches, T = {first['t_cd']:.0f} bits;\n"
                      f"{far} of them (dashed) far apart at the final pose")

    draw_points(fitted, target, "#9a9a9a", 0.3, "target")
    draw_points(fitted, aligned, "#c0392b", 0.3, "source")
    evidence = run["evidence"]
    fitted.set_title(f"final pose: {evidence['agreeing_matches']} of {evidence['mutual_matches']} mutual matches agree,\n"
                     f"overlap {run['overlap']:.2f}, contact {evidence['contact_share']:.3f}")

    draw_points(rival, target, "#9a9a9a", 0.3)
    if run["runner_up"]:
        draw_points(rival, transform(run["runner_up"]["target_from_source"], source), "#c0392b", 0.3)
        rival.set_title(f"the runner-up pose: explains {100 * run['runner_up']['share']:.0f} % as much")
    for one in axes.flat:
        one.set(aspect="equal", xlim=(low[0], high[0]), ylim=(low[1], high[1] + (aside[1] if one is matched else 0)))
    for one in axes[1]:
        one.set_xlabel("x [m]")
    for one in axes[:, 0]:
        one.set_ylabel("y [m]")
    fitted.legend(loc="lower right", markerscale=15, framealpha=1)
    figure.tight_layout()
    figure.savefig(images / "method.png", dpi=95)


images = pathlib.Path(__file__).parent / "images"
with tempfile.TemporaryDirectory() as scratch:
    draw_demo(sys.argv[1], scratch)
    if len(sys.argv) > 3:
        draw_method(sys.argv[1], sys.argv[2], sys.argv[3], scratch)
