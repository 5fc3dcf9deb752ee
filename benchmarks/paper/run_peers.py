#!/usr/bin/env python3
"""Runs PCL's methods on the pairs of `igsp_paper pairs` and writes peers.csv, a row per answer (Table 4).

Voxel size and start are those of our own runs; K-4PCS is told the true overlap. ICP and NDT run twice: from where the
clouds lie, three diagonals apart in any attitude, and with the centroids put on each other. K-4PCS, which draws at
random, runs three times. Seconds are CPU seconds of one thread, without reading the files.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

from clouds import read_points
from rows import Row, read_rows, write_rows

sys.path.append(str(Path(__file__).resolve().parents[1] / "peers"))
from metrics import is_right, pose_errors  # noqa: E402

METHODS = {
    "icp": ["icp", "--as-given"],
    "icp_centred": ["icp"],
    "ndt": ["ndt", "--as-given"],
    "ndt_centred": ["ndt"],
    "kfpcs": ["kfpcs"],
    "geometric_consistency": ["geometric_consistency"],
}
RUNS = {"kfpcs": 3}  # the others once: they draw nothing


def run(program: Path, arguments: list[str]) -> list[dict]:
    """The program's answers; when PCL crashes, one without a pose."""
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode == 0:
        return json.loads(done.stdout)["answers"]
    print(f"{' '.join(arguments)}: exit code {done.returncode}: {done.stderr.strip()}", file=sys.stderr)
    return [{"label": "", "target_from_source": np.full((4, 4), np.nan), "cpu_seconds": np.nan}]


def judged(estimate: np.ndarray, truth: np.ndarray, centroid: np.ndarray, pair: Row) -> Row:
    """The errors of 4x4 `estimate` as columns; NaN and wrong if it is no rigid motion."""
    try:
        errors = pose_errors(estimate, truth, centroid)
    except ValueError:
        errors = dict.fromkeys(("e_r_deg", "e_t", "centroid_displacement"), np.nan)
    return {"rotation_error_deg": f"{errors['e_r_deg']:.6g}", "translation_error_m": f"{errors['e_t']:.6g}",
            "centroid_displacement_m": f"{errors['centroid_displacement']:.6g}",
            "right": int(is_right(errors, pair["max_rotation_error_deg"], pair["max_translation_error_m"]))}


def rows_of(pair: Row, folder: Path, voxel_size: float, program: Path, time_limit_s: int) -> list[Row]:
    source, target = folder / pair["source"], folder / pair["target"]
    truth = np.loadtxt(folder / pair["truth"]).reshape(4, 4)
    centroid = read_points(source).mean(axis=0)
    rows = []
    for method, arguments in METHODS.items():
        for number in range(RUNS.get(method, 1)):
            if number > 0:
                time.sleep(1.1)  # K-4PCS takes the seconds of the clock as its seed
            for answer in run(program, [*arguments, str(source), str(target), "--voxel-size", str(voxel_size),
                                        "--threads", "1", "--overlap", str(pair["overlap"]),
                                        "--time-limit", str(time_limit_s)]):
                rows.append({"pair": pair["name"], "dataset": pair["group"], "method": method, "run": number,
                             "after": answer["label"], "total_s": f"{answer['cpu_seconds']:.4g}",
                             **judged(np.array(answer["target_from_source"]), truth, centroid, pair)})
                print(*rows[-1].values(), flush=True)
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=Path, required=True, help="pcl_peer")
    parser.add_argument("--pairs", type=Path, required=True, help="folder that igsp_paper pairs wrote")
    parser.add_argument("--data", type=Path, required=True, help="folder with registrations.csv, for peers.csv")
    parser.add_argument("--time-limit", type=int, default=30, help="of K-4PCS [s]")
    arguments = parser.parse_args()
    voxel_sizes = {row["pair"]: row["voxel_size"] for row in read_rows(arguments.data / "registrations.csv")}
    rows = []
    for pair in read_rows(arguments.pairs / "cases.csv"):
        rows += rows_of(pair, arguments.pairs, voxel_sizes[pair["name"]], arguments.program, arguments.time_limit)
    write_rows(arguments.data / "peers.csv", rows)


if __name__ == "__main__":
    main()
