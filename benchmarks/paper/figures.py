#!/usr/bin/env python3
"""Draws the paper's Fig. 3 and 8 and the cost of an iteration over the number of keypoints from the CSV files."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from rows import Row, in_order, read_rows
from style import LINES, plt, save

PARAMETERS = {"p1": "$p_1$", "p2": "$p_2$", "p3": "$p_3$", "s_ed": "$s_{ed}\\,r_k$ [bits]"}
PAPER_VALUE = {"m": 8, "p1": 2.5, "p2": 1.5, "p3": 1.25, "s_ed": 30}  # the paper's Table 1


def mean_over_pairs(rows: list[Row], by: str, of: str) -> tuple[np.ndarray, np.ndarray]:
    """(V,) values of `by` and (V,) means of `of` over all rows that share them."""
    values = np.array(sorted({row[by] for row in rows}))
    return values, np.array([np.mean([row[of] for row in rows if row[by] == value]) for value in values])


def legend_on_top(figure: plt.Figure, axis: plt.Axes) -> None:
    figure.legend(*axis.get_legend_handles_labels(), loc="upper center", ncols=4)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - 0.3 / figure.get_figheight()))


def draw_weights(rows: list[Row], path: Path) -> None:
    """Fig. 3 (a-b): Eq. 7 over the iterations for m = 2..16, and how many iterations a run takes."""
    figure, (weights, counts) = plt.subplots(1, 2, figsize=(9.2, 3.4), layout="constrained")
    k = np.arange(0, 26)
    for m, marker in ((2, "o"), (4, "s"), (8, "^"), (16, "D")):
        shade = str(0.68 - 0.17 * np.log2(m))
        weights.plot(k, np.exp(-k / m), color=shade, marker=marker, markevery=(1, 4), label=f"m = {m}")
        weights.plot(k, 1 - np.exp(-k / m), color=shade, marker=marker, markevery=(1, 4), linestyle="--")
    weights.plot([], [], "k-", label="$W_{fd}$")
    weights.plot([], [], "k--", label="$W_{ed}$")
    weights.set(xlabel="iteration k", ylabel="weight")
    weights.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    of_m = [row for row in rows if row["parameter"] == "m"]
    for dataset in in_order(of_m, "dataset"):
        values, means = mean_over_pairs([row for row in of_m if row["dataset"] == dataset], "value", "iterations")
        counts.plot(values, means, label=dataset, **LINES[dataset])
    counts.axvline(PAPER_VALUE["m"], color="black", linewidth=0.6, linestyle=":")
    counts.set(xlabel="weight changing rate m", ylabel="iterations until convergence, mean", ylim=(0, None))
    counts.legend()
    save(figure, path)


def draw_parameters(rows: list[Row], path: Path) -> None:
    """Fig. 3 (c-n): precision and recall at the last iteration, and for p1 after the first, which it decides."""
    datasets = in_order(rows, "dataset")
    figure, axes = plt.subplots(len(datasets), len(PARAMETERS), figsize=(8.6, 1.9 * len(datasets) + 0.5), sharex="col",
                                sharey=True, layout="constrained", squeeze=False)
    for line, dataset in zip(axes, datasets):
        for axis, parameter in zip(line, PARAMETERS):
            chosen = [row for row in rows if row["dataset"] == dataset and row["parameter"] == parameter]
            axis.plot(*mean_over_pairs(chosen, "value", "precision"), "k-o", label="precision")
            axis.plot(*mean_over_pairs(chosen, "value", "recall"), "--^", color="tab:blue", markerfacecolor="white",
                      label="recall")
            axis.plot(*mean_over_pairs(chosen, "value", "right"), ":", color="0.4", label="pairs registered right")
            if parameter == "p1":
                axis.plot(*mean_over_pairs(chosen, "value", "first_precision"), "-.", color="0.4",
                          label="precision, first iteration")
            axis.axvline(PAPER_VALUE[parameter], color="black", linewidth=0.6, linestyle=":")
            axis.set(ylim=(-0.04, 1.04))
        line[0].set_ylabel(f"{dataset}\nshare of 1")
    for axis, label in zip(axes[-1], PARAMETERS.values()):
        axis.set_xlabel(label)
    legend_on_top(figure, axes[0][0])
    save(figure, path)


def draw_precision_recall(rows: list[Row], path: Path) -> None:
    """Fig. 8: a point per iteration, a line per pair; the paper's preset and the default one."""
    datasets = in_order(rows, "dataset")
    columns = (len(datasets) + 1) // 2
    figure, axes = plt.subplots(2, columns, figsize=(3 * columns, 5.8), sharex=True, sharey=True, layout="constrained",
                                squeeze=False)
    for axis, dataset in zip(axes.flat, datasets):
        for preset, look in (("default", {"color": "tab:blue", "linestyle": "--", "marker": "^"}),
                             ("paper", {"color": "black", "linestyle": "-", "marker": "o"})):
            for pair in in_order([row for row in rows if row["dataset"] == dataset], "pair"):
                run = [row for row in rows if row["pair"] == pair and row["preset"] == preset]
                recall, precision = [row["recall"] for row in run], [row["precision"] for row in run]
                axis.plot(recall, precision, markersize=2.5, linewidth=0.8, alpha=0.8, **look)
                axis.plot(recall[:1], precision[:1], color=look["color"], marker=look["marker"], markersize=7,
                          markerfacecolor="white", linestyle="")
                axis.plot(recall[-1:], precision[-1:], color=look["color"], marker=look["marker"], markersize=7,
                          linestyle="")
        axis.set(title=dataset, xlim=(-0.03, 1.03), ylim=(-0.03, 1.03))
    for axis in axes[-1]:
        axis.set_xlabel("recall")
    for line in axes:
        line[0].set_ylabel("precision")
    for axis in axes.flat[len(datasets):]:
        axis.set_axis_off()
    look_up = [plt.Line2D([], [], color="black", marker="o", markersize=3, label="paper preset"),
               plt.Line2D([], [], color="tab:blue", linestyle="--", marker="^", markersize=3, label="default preset"),
               plt.Line2D([], [], color="black", marker="o", markersize=7, markerfacecolor="white", linestyle="",
                          label="first iteration"),
               plt.Line2D([], [], color="black", marker="o", markersize=7, linestyle="", label="last iteration")]
    if len(datasets) % 2:
        axes[-1][-1].legend(handles=look_up, loc="center")
    else:
        axes[0][0].legend(handles=look_up, loc="best")
    save(figure, path)


def draw_growth(rows: list[Row], path: Path) -> None:
    """Seconds of one iteration's matching over the number of keypoints; dense only as far as it was run."""
    figure, axis = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    for k, look in ((0, "-"), (4, "--")):
        run = [row for row in rows if row["k"] == k]
        dense = [row for row in run if row["dense_s"] != ""]
        axis.loglog([row["keypoints"] for row in run], [row["edges_s"] + row["sparse_s"] for row in run], "o" + look,
                    color="black", label=f"exact and sparse, k = {k}")
        axis.loglog([row["keypoints"] for row in dense], [row["matrix_s"] + row["dense_s"] for row in dense],
                    "s" + look, color="0.5", markerfacecolor="white", label=f"padded dense Kuhn-Munkres, k = {k}")
    sizes = np.array([500, 20000])
    for exponent, anchor in ((3, 0.03), (2, 0.0003)):
        axis.loglog(sizes, anchor * (sizes / sizes[0]) ** exponent, ":", color="0.6", linewidth=0.8)
        axis.annotate(f"$\\propto n^{exponent}$", (sizes[1], anchor * (sizes[1] / sizes[0]) ** exponent), fontsize=8,
                      ha="right", va="bottom")
    axis.set(xlabel="keypoints of each cloud", ylabel="matching of one iteration, CPU time [s]")
    axis.set_xticks([row["keypoints"] for row in rows if row["k"] == 0])
    axis.xaxis.set_major_formatter(lambda value, _: f"{value:,.0f}")
    axis.xaxis.set_minor_formatter(lambda value, _: "")
    axis.legend(loc="upper left")
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="folder of the CSV files")
    parser.add_argument("--out", type=Path, required=True, help="folder for the figures")
    arguments = parser.parse_args()
    parameters = read_rows(arguments.data / "parameters.csv")
    draw_weights(parameters, arguments.out / "fig3_weights")
    draw_parameters(parameters, arguments.out / "fig3_parameters")
    draw_precision_recall(read_rows(arguments.data / "iterations.csv"), arguments.out / "fig8_precision_recall")
    draw_growth(read_rows(arguments.data / "growth.csv"), arguments.out / "growth")


if __name__ == "__main__":
    main()
