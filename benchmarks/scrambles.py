#!/usr/bin/env python3
"""Every case under many scrambles: the table of docs/benchmarks.md and its raw rows.

usage: benchmarks/scrambles.py path/to/igsp CASES.csv OUT.csv [--scrambles 20] [--jobs 2]

Runs `igsp benchmark` once per scramble (0, 1, ...) with the default preset, keeps the columns that the page speaks of, adds
the case's own overlap, and prints the tables as Markdown. With the rows there already, prints the tables alone.
"""
import argparse
import csv
import pathlib
import statistics
import subprocess
import sys
import tempfile

COLUMNS = ["name", "group", "scramble", "case_overlap", "success", "verdict", "confidence", "e_r_deg",
           "centroid_displacement", "overlap", "iterations", "source_keypoints", "target_keypoints", "cpu_seconds",
           "reason", "error"]
BANDS = [(">= 0.4", 0.4, 2.0), ("0.3 to 0.4", 0.3, 0.4), ("< 0.3", 0.0, 0.3)]


def overlaps(cases: pathlib.Path) -> dict[str, str]:
    with open(cases, newline="") as file:
        return {row["name"]: row["overlap"] if row["truth"] != "none" else "none" for row in csv.DictReader(file)}


def run(igsp: str, cases: pathlib.Path, out: pathlib.Path, scrambles: int, jobs: int) -> None:
    overlap = overlaps(cases)
    with tempfile.TemporaryDirectory() as folder, open(out, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        for scramble in range(scrambles):
            results = pathlib.Path(folder) / "results.csv"
            subprocess.run([igsp, "benchmark", str(cases), "--scramble", str(scramble), "--jobs", str(jobs), "--quiet",
                            "--out", str(results)], check=True, stdout=subprocess.DEVNULL)
            with open(results, newline="") as rows:
                for row in csv.DictReader(rows):
                    writer.writerow(row | {"case_overlap": overlap[row["name"]]})
            print(f"scramble {scramble + 1} of {scrambles}", file=sys.stderr)


def is_right(row: dict[str, str]) -> bool:
    return row["success"] in ("1", "yes", "true") and row["case_overlap"] != "none"


def is_registered(row: dict[str, str]) -> bool:
    return row["verdict"] == "registered"


def verdict_table(rows: list[dict[str, str]]) -> str:
    lines = ["| overlap | cases | right | right but refused | wrong but registered |", "|---|---|---|---|---|"]
    for label, low, high in BANDS:
        band = [row for row in rows if row["case_overlap"] != "none" and low <= float(row["case_overlap"]) < high]
        right = [row for row in band if is_right(row)]
        refused = sum(not is_registered(row) for row in right)
        false = sum(is_registered(row) and not is_right(row) for row in band)
        lines.append(f"| {label} | {len({row['name'] for row in band})} | {len(right)} of {len(band)} | {refused} | {false} |")
    without = [row for row in rows if row["case_overlap"] == "none"]
    false = sum(is_registered(row) for row in without)
    lines.append(f"| none | {len({row['name'] for row in without})} | - | - | {false} of {len(without)} |")
    return "\n".join(lines)


def error_table(rows: list[dict[str, str]]) -> str:
    lines = ["| group, overlap >= 0.4 | median e_r [deg] | median displacement of the centroid | median CPU [s] |",
             "|---|---|---|---|"]
    for group in dict.fromkeys(row["group"] for row in rows):
        right = [row for row in rows if row["group"] == group and is_right(row) and float(row["case_overlap"]) >= 0.4]
        if not right:
            continue
        e_r, displacement, cpu = (statistics.median(float(row[column]) for row in right)
                                  for column in ("e_r_deg", "centroid_displacement", "cpu_seconds"))
        lines.append(f"| {group} | {e_r:.3f} | {1000 * displacement:.3g} mm | {cpu:.3f} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("igsp")
    parser.add_argument("cases", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--scrambles", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    if not arguments.out.exists():
        run(arguments.igsp, arguments.cases, arguments.out, arguments.scrambles, arguments.jobs)
    with open(arguments.out, newline="") as file:
        rows = list(csv.DictReader(file))
    right = [row for row in rows if is_right(row)]
    refused = sum(not is_registered(row) for row in right)
    print(verdict_table(rows), error_table(rows), sep="\n\n")
    print(f"\nright {len(right)}, of them refused {refused} ({100 * refused / len(right):.1f} %); median CPU of the right "
          f"and registered {statistics.median(float(r['cpu_seconds']) for r in right if is_registered(r)):.3f} s")


main()
