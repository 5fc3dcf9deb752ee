#!/usr/bin/env python3
"""Draws the paper's Fig. 4: the source on the target at the start and after the first, middle and last iteration.

Colour: distance from a source point to the nearest target point, for points that overlap at the true relation; other
source points are grey, the target is pale.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from clouds import read_points, transformed
from rows import Row, in_order, read_rows
from style import plt, save

SHOWN_POINTS = 12000
OVERLAP_RADIUS, FARTHEST = 2.0, 6.0  # [voxels]: who overlaps; end of the colour scale


@dataclass
class View:
    """How a data set is shown: along the target's z axis."""

    unit: str
    per_metre: float
    ceiling_m: float = np.inf  # what lies above it hides the rest


VIEWS = {"Stanford": View("mm", 1000.0), "Stanford 80 %": View("mm", 1000.0), "Facade": View("m", 1.0),
         "Park": View("m", 1.0), "Indoor": View("m", 1.0, 0.8)}


def pose_of(row: Row) -> np.ndarray:
    """4x4 target_from_source after an iteration."""
    matrix = np.eye(4)
    for i in range(3):
        matrix[i] = [row[f"r{i}0"], row[f"r{i}1"], row[f"r{i}2"], row[f"t{i}"]]
    return matrix


def centroids_aligned(source: np.ndarray, target: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = target.mean(axis=0) - source.mean(axis=0)
    return matrix


def thinned(points: np.ndarray) -> np.ndarray:
    return points[:: max(1, len(points) // SHOWN_POINTS)]


def draw_row(line: np.ndarray, pair: Row, folder: Path, run: list[Row], voxel_size: float):
    """Four pictures; returns the coloured points of the last for the colour bar."""
    source, whole_target = read_points(folder / pair["source"]), read_points(folder / pair["target"])
    tree, view = cKDTree(whole_target), VIEWS[pair["group"]]
    truth = np.loadtxt(folder / pair["truth"]).reshape(4, 4)
    start = centroids_aligned(source, whole_target)
    source = thinned(source[transformed(truth, source)[:, 2] < view.ceiling_m])
    target = thinned(whole_target[whole_target[:, 2] < view.ceiling_m])
    overlaps = tree.query(transformed(truth, source))[0] < OVERLAP_RADIUS * voxel_size
    shown = [("centroids aligned", start)] + [(f"after iteration {row['k']}", pose_of(row))
                                              for row in (run[0], run[len(run) // 2], run[-1])]
    for axis, (title, pose) in zip(line, shown):
        moved = transformed(pose, source)
        order = np.argsort(moved[:, 2])
        order = order[overlaps[order]]
        distances = tree.query(moved[order])[0]
        for points, colour in ((target, "0.85"), (moved[~overlaps], "0.6")):
            axis.scatter(*(view.per_metre * points[:, a] for a in (0, 1)), s=0.3, c=colour, linewidths=0,
                         rasterized=True)
        points = axis.scatter(*(view.per_metre * moved[order, a] for a in (0, 1)), s=0.7, linewidths=0,
                              c=view.per_metre * distances, cmap="viridis_r", vmin=0, rasterized=True,
                              vmax=view.per_metre * FARTHEST * voxel_size)
        axis.set_title(title, fontsize=8)
        low, high = (np.percentile(view.per_metre * whole_target, share, axis=0) for share in (2, 98))
        room = 0.25 * (high - low).max()
        axis.set(aspect="equal", xlim=(low[0] - room, high[0] + room),
                 ylim=(low[1] - room, high[1] + room),
                 xlabel=f"x [{view.unit}]")
        axis.tick_params(labelsize=7)
        axis.xaxis.label.set_size(8)
        axis.grid(False)
    line[0].set_ylabel(f"{pair['group']}, {run[0]['preset']} preset\ny [{view.unit}]", fontsize=8)
    return points


def rows_to_show(pairs: list[Row], registrations: list[Row]) -> list[tuple[Row, str]]:
    """The first pair of every data set with the paper's preset, and with the default one where that is wrong."""
    shown = []
    for dataset in in_order(pairs, "group"):
        pair = next(pair for pair in pairs if pair["group"] == dataset)
        shown.append((pair, "paper"))
        if not any(row["right"] for row in registrations if row["pair"] == pair["name"] and row["preset"] == "paper"):
            shown.append((pair, "default"))
    return shown


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pairs", type=Path, required=True, help="folder that igsp_paper pairs wrote")
    parser.add_argument("--data", type=Path, required=True, help="folder of the CSV files")
    parser.add_argument("--out", type=Path, required=True, help="folder for the figure")
    arguments = parser.parse_args()
    pairs = read_rows(arguments.pairs / "cases.csv")
    iterations = read_rows(arguments.data / "iterations.csv")
    registrations = read_rows(arguments.data / "registrations.csv")
    shown = rows_to_show(pairs, registrations)
    figure, axes = plt.subplots(len(shown), 4, figsize=(9.6, 2.35 * len(shown)), squeeze=False, layout="constrained")
    for line, (pair, preset) in zip(axes, shown):
        run = [row for row in iterations if row["pair"] == pair["name"] and row["preset"] == preset]
        voxel_size = next(row["voxel_size"] for row in registrations if row["pair"] == pair["name"])
        points = draw_row(line, pair, arguments.pairs, run, voxel_size)
        label = f"distance [{VIEWS[pair['group']].unit}]"
        figure.colorbar(points, ax=line.tolist(), label=label, fraction=0.02, extend="max")
    save(figure, arguments.out / "fig4_iterations")


if __name__ == "__main__":
    main()
