#!/usr/bin/env python3
"""Draws docs/images/peers_*.svg and .png from the rows of bench_peers.py."""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "igsp", "svg.fonttype": "none", "font.size": 9})
import matplotlib.pyplot as plt  # noqa: E402 - after the choice of the backend

from rows import read_rows  # noqa: E402
from tallies import Tally, tallies, title_of  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
MARKERS = {"igsp": "*", "igsp_paper": "P", "open3d_ransac_100k": "o", "open3d_ransac_4m": "s", "open3d_fgr": "^",
           "kiss_matcher": "D", "pcl_geometric_consistency": "v", "pcl_kfpcs": "X", "pcl_icp": "<", "pcl_ndt": ">",
           "pcl_prerejective": "h"}
PARTS = [("right, said so", "0.25", ""), ("right, but refused", "0.8", "...."),
         ("wrong or no overlap, refused", "white", ""), ("wrong, yet called registered", "white", "xxxx")]


def save(figure: plt.Figure, path: Path) -> None:
    figure.tight_layout()
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None})
    figure.savefig(path.with_suffix(".png"), dpi=110)
    plt.close(figure)


def recall(tally: Tally) -> float:
    """Percent of the pairs that are right, on average over the runs."""
    return 100 * tally.in_a_pass(tally.right) / tally.known_pairs


def draw_recall(found: dict[str, Tally], path: Path) -> None:
    """Filled: with ICP after, or igsp's own refinement; hollow: the method alone. A line joins the two. Grey: measured
    on a smaller sample, whose pairs may be easier or harder."""
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    largest = max(len(tally.pairs) for tally in found.values())
    for preset, tally in found.items():
        method, _, label = preset.partition("+")
        if not tally.known or method not in MARKERS:
            continue
        place = tally.median("cpu_seconds"), recall(tally)
        final = preset + "+icp" not in found
        colour = "black" if len(tally.pairs) > 0.7 * largest else "0.6"
        axes.plot(*place, MARKERS[method], color=colour, markerfacecolor=colour if final else "white",
                  markersize=12 if method == "igsp" else 7, label=title_of(method) if final else None, linestyle="none")
        if label:
            alone = found[method]
            axes.plot([alone.median("cpu_seconds"), place[0]], [recall(alone), place[1]], color="0.6", linewidth=0.8,
                      zorder=0)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set_xlabel("CPU seconds of a registration, median, one thread")
    axes.set_ylabel("pairs that are right [%]")
    axes.set_ylim(-4, 104)
    axes.grid(alpha=0.3, which="both")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False,
                title="filled: with refinement\nhollow: without\ngrey: a smaller sample")
    save(figure, path)


def draw_verdicts(found: dict[str, Tally], path: Path) -> None:
    """All pairs, those without overlap among them: there, refusing is what is right."""
    shown = [tally for preset, tally in found.items() if preset.split("+")[0] in MARKERS]
    figure, axes = plt.subplots(figsize=(7.2, 0.32 * len(shown) + 1.4))
    largest = max(len(tally.pairs) for tally in shown)
    titles = [title_of(tally.preset) + (f", {len(tally.pairs)} pairs" if len(tally.pairs) < 0.7 * largest else "")
              for tally in reversed(shown)]
    for place, tally in enumerate(reversed(shown)):
        said, right, false = (tally.in_a_pass(rows) for rows in (tally.said, tally.right, tally.false_accepts))
        counts = [said, right - said, len(tally.pairs) - right - false, false]
        left = 0.0
        for count, (label, colour, hatch) in zip(counts, PARTS, strict=True):
            share = 100 * count / len(tally.pairs)
            axes.barh(place, share, left=left, color=colour, hatch=hatch, edgecolor="black", linewidth=0.6, height=0.7,
                      label=label if place == 0 else None)
            left += share
    axes.set_yticks(range(len(shown)), titles)
    axes.set_xlabel(f"share of the pairs, {largest} unless said [%]")
    axes.set_xlim(0, 100)
    axes.legend(loc="lower center", bbox_to_anchor=(0.4, 1.0), ncols=2, frameon=False)
    save(figure, path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=Path, default=ROOT / "docs/data/peers.csv")
    parser.add_argument("--images", type=Path, default=ROOT / "docs/images")
    args = parser.parse_args()
    found = tallies(read_rows(args.rows))
    args.images.mkdir(parents=True, exist_ok=True)
    draw_recall(found, args.images / "peers_recall")
    draw_verdicts(found, args.images / "peers_verdicts")


if __name__ == "__main__":
    main()
