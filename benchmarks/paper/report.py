#!/usr/bin/env python3
"""Writes docs/paper/README.md: the sentences of README.template.md with the tables made from the CSV files."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import numpy as np

from rows import Row, in_order, read_rows

# The paper's Table 3: T1 [s], T2 [s], iterations, T [s].
PAPER_TIMES = {"Stanford": (3.31, 0.53, 15, 11.26), "Park": (8.12, 5.65, 13, 81.57), "Indoor": (6.25, 3.92, 14, 61.13)}
# The paper's Table 4: e_r [mdeg], e_t [mm], T [s], as printed; "/" is a failure.
PAPER_ERRORS = {
    "Stanford": {"ICP": ("/", "/", "5.6"), "3D-NDT": ("/", "/", "5.3"), "4PCS": ("74.21", "0.17", "10.5"),
                 "FM+GC": ("758.23", "2.59", "8.9"), "IGSP": ("9.89", "0.02", "11.3")},
    "Park": {"ICP": ("/", "/", "9.4"), "3D-NDT": ("/", "/", "8.1"), "4PCS": ("205.14", "187.65", "38.0"),
             "FM+GC": ("184.56", "414.61", "35.2"), "IGSP": ("93.74", "85.12", "81.6")},
    "Indoor": {"ICP": ("/", "/", "6.2"), "3D-NDT": ("/", "/", "6.0"), "4PCS": ("209.85", "/", "47.1"),
               "FM+GC": ("486.15", "431.90", "29.8"), "IGSP": ("100.42", "25.53", "61.1")},
}
# Row of Table 4: its name, the row of the paper it stands beside, method and label in peers.csv or preset.
METHODS = [("ICP, as the clouds lie", "ICP", "icp", ""), ("ICP, centroids aligned", None, "icp_centred", ""),
           ("3D-NDT, as the clouds lie", "3D-NDT", "ndt", ""), ("3D-NDT, centroids aligned", None, "ndt_centred", ""),
           ("K-4PCS (the paper: Super4PCS)", "4PCS", "kfpcs", ""), ("K-4PCS, then ICP", None, "kfpcs", "icp"),
           ("FM+GC", "FM+GC", "geometric_consistency", ""), ("FM+GC, then ICP", None, "geometric_consistency", "icp"),
           ("**igsp, paper preset**", "IGSP", "paper", None),
           ("igsp, paper preset, refined", None, "paper_refined", None),
           ("**igsp, default preset**", None, "default", None)]


def figure(value: float) -> str:
    """Three significant digits without an exponent."""
    if value == 0 or not np.isfinite(value):
        return "-"
    return f"{value:,.{max(0, 2 - int(np.floor(np.log10(abs(value)))))}f}"


def markdown(header: list[str], lines: list[list[str]]) -> str:
    """A table of text; every line as long as the header."""
    for line in lines:
        if len(line) != len(header):
            raise ValueError(f"a line of {len(line)} fields under a header of {len(header)}: {line}")
    rule = ["---"] * len(header)
    return "\n".join("| " + " | ".join(line) + " |" for line in [header, rule, *lines])


def mean(rows: list[Row], name: str) -> float:
    return float(np.mean([row[name] for row in rows]))


def pairs_table(pairs: list[Row]) -> str:
    lines = []
    for row in pairs:
        origin = f"`{row['origin']}`" if row["origin"].startswith("igsp") else "real scans"
        lines.append([row["group"], row["name"], f"{row['source_points']:,} / {row['target_points']:,}",
                      f"{row['overlap']:.2f}", origin])
    return markdown(["data set", "pair (source--target)", "points", "overlap", "from"], lines)


def settled_after(run: list[Row], voxel_size: float) -> int:
    """Iterations until a step is below 0.05 degrees and a twentieth of a voxel; all of them if none is."""
    for count, row in enumerate(run, 1):
        if row["rotation_step_deg"] < 0.05 and row["translation_step_m"] < 0.05 * voxel_size:
            return count
    return len(run)


def times_table(registrations: list[Row], iterations: list[Row]) -> str:
    """Table 3. The dense T is T1 + k T2 with the matching alone as T2."""
    runs = {}
    for row in iterations:
        if row["preset"] == "paper":
            runs.setdefault(row["pair"], []).append(row)
    lines = []
    for dataset in in_order(registrations, "dataset"):
        rows = [row for row in registrations if row["dataset"] == dataset and row["preset"] == "paper"]
        theirs = [str(value) for value in PAPER_TIMES.get(dataset, ("-",) * 4)]
        dense = mean(rows, "dense_iteration_s")
        total = np.mean([row["preparation_s"] + row["iterations"] * row["dense_iteration_s"] for row in rows])
        settled = np.mean([settled_after(runs[row["pair"]], row["voxel_size"]) for row in rows])
        lines.append([dataset, *theirs, f"{mean(rows, 'source_keypoints'):.0f} x {mean(rows, 'target_keypoints'):.0f}",
                      figure(mean(rows, "preparation_s")), f"{1000 * mean(rows, 'iteration_s'):.2f}",
                      f"{mean(rows, 'iterations'):.0f}", f"{settled:.0f}", figure(mean(rows, "total_s")),
                      f"{1000 * dense:.1f}", figure(total), f"{dense / mean(rows, 'iteration_s'):.0f}"])
    return markdown(["data set", "paper: T1 [s]", "T2 [s]", "k", "T [s]", "igsp: keypoints", "T1 [s]", "T2 [ms]", "k",
                     "settled after", "T [s]", "dense: T2 [ms]", "T [s]", "T2 to igsp's"], lines)


def errors_table(registrations: list[Row], peers: list[Row], dataset: str) -> str:
    """Table 4 for one data set: means over the right answers."""
    lines = []
    for name, paper, method, after in METHODS:
        if after is None:
            rows = [row for row in registrations if row["dataset"] == dataset and row["preset"] == method]
        else:
            rows = [row for row in peers if row["dataset"] == dataset and row["method"] == method and
                    row["after"] == after]
        if not rows:
            continue
        right = [row for row in rows if row["right"]]
        errors = ["/"] * 3 if not right else [figure(1000 * mean(right, column)) for column in (
            "rotation_error_deg", "translation_error_m", "centroid_displacement_m")]
        theirs = PAPER_ERRORS.get(dataset, {}).get(paper, ("-",) * 3)
        lines.append([name, f"{len(right)} of {len(rows)}", *errors, figure(mean(rows, "total_s")), *theirs])
    return markdown([dataset, "right", "e_r [mdeg]", "e_t [mm]", "centroid [mm]", "T [s]", "paper: e_r [mdeg]",
                     "e_t [mm]", "T [s]"], lines)


def growth_table(growth: list[Row]) -> str:
    lines = []
    for row in growth:
        dense = "" if row["dense_s"] == "" else row["matrix_s"] + row["dense_s"]
        ours = row["edges_s"] + row["sparse_s"]
        lines.append([f"{row['keypoints']:,}", str(row["k"]), f"{row['t_cd']:.0f}", f"{row['candidate_edges']:,}",
                      figure(1000 * ours),
                      *(["not run", "-"] if dense == "" else [figure(1000 * dense), f"{dense / ours:,.0f}"])])
    return markdown(["keypoints", "k", "T_cd [bits]", "candidate pairs", "sparse [ms]", "dense [ms]", "ratio"], lines)


def last_precision_table(iterations: list[Row]) -> str:
    """Fig. 8 in numbers: means over the pairs at the first, the best and the last iteration."""
    lines = []
    for dataset in in_order(iterations, "dataset"):
        for preset in ("paper", "default"):
            runs = [[row for row in iterations if row["pair"] == pair and row["preset"] == preset]
                    for pair in in_order([row for row in iterations if row["dataset"] == dataset], "pair")]
            runs = [run for run in runs if run]
            both = [max(run, key=lambda row: min(row["precision"], row["recall"])) for run in runs]
            line = [dataset, preset]
            for rows in ([run[0] for run in runs], both, [run[-1] for run in runs]):
                line.append(f"{mean(rows, 'precision'):.2f} / {mean(rows, 'recall'):.2f}")
            lines.append([*line, f"{mean([run[-1] for run in runs], 'precision_within_r_k'):.2f}"])
    return markdown(["data set", "preset", "first iteration", "best", "last iteration", "precision within r_k"], lines)


def left_out(pairs: list[Row]) -> str:
    if any(not row["origin"].startswith("igsp") for row in pairs):
        return ""
    return ("**The folder of real scans was not there when this page was made: Stanford and Facade are left out of "
            "every table and figure.**\n\n")


def filled(template: str, values: dict[str, str]) -> str:
    """Replaces every {{name}}; an unknown or an unused name is an error."""
    wanted = set(re.findall(r"\{\{(\w+)\}\}", template))
    if wanted != set(values):
        raise ValueError(f"template and tables differ in {sorted(wanted ^ set(values))}")
    return re.sub(r"\{\{(\w+)\}\}", lambda match: values[match.group(1)], template)


def page(data: Path, template: str) -> str:
    pairs, registrations, peers, growth, iterations = (
        read_rows(data / f"{name}.csv") for name in ("pairs", "registrations", "peers", "growth", "iterations"))
    tables = [errors_table(registrations, peers, dataset) for dataset in in_order(registrations, "dataset")]
    return filled(template, {
        "left_out": left_out(pairs), "machine": (data / "machine.txt").read_text().strip(), "pairs": pairs_table(pairs),
        "times": times_table(registrations, iterations), "growth": growth_table(growth), "errors": "\n\n".join(tables),
        "precision": last_precision_table(iterations)})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--data", type=Path, required=True, help="folder of the CSV files")
    parser.add_argument("--template", type=Path, default=Path(__file__).with_name("README.template.md"))
    parser.add_argument("--out", type=Path, required=True, help="the page")
    arguments = parser.parse_args()
    arguments.out.write_text(page(arguments.data, arguments.template.read_text()))


if __name__ == "__main__":
    main()
