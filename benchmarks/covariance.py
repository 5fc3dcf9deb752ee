"""Is the covariance of `igsp align` what it says? Many draws of noise and of the sampling pattern of simulated pairs, each
registered from the true pose; the error of the pose, squared and normalised by the stated covariance, against chi-square.

Prints a row a scene: draws that were registered, median of the normalised squared error over that of chi-square (1 is right,
more is too sure), the share of draws inside of the stated 95 % ellipsoid, and how much of the squared error
is the same in all draws of a scene: a bias, not noise. With --csv the single draws as well.

With --pair a real one in place of the simulated: a draw is a random part of its points, whose noise they carry, and the
error is that against the pose which all points give, refined from TRUTH; what is wrong with that is not seen.

usage: covariance.py IGSP [--draws 200] [--seeds 10] [--points 40000] [--scenes park,indoor,object] [--dof 6] [--csv FILE]
                     [--pair SOURCE TARGET TRUTH]
"""
import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

# Scene: standard deviation of the noise along the ray [m], as the simulated scanners have it.
NOISE = {"park": 0.01, "indoor": 0.003, "object": 0.0001}
DENSE = 5  # times as many points as are drawn, so that two draws share few


def read_ply(path):
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    kind = "<f8" if b"property double x" in content[:end] else "<f4"
    return np.frombuffer(content, kind, offset=end).reshape(-1, 3).astype(float)


def write_ply(path, points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + points.astype("<f8").tobytes())


def drawn(points, count, noise, random):
    """Another sampling pattern of the surface, and noise along the ray from the scanner in the origin."""
    points = points[np.sort(random.choice(len(points), min(count, len(points)), replace=False))]
    ray = points / np.linalg.norm(points, axis=1, keepdims=True)
    return points + ray * random.normal(0, noise, (len(points), 1))


def error_of(run, truth):
    """(6,) rotation and translation of estimate against truth, about the centre that the covariance is for."""
    estimate, centre = np.array(run["target_from_source"]), np.array(run["precision"]["centre"])
    delta = estimate @ np.linalg.inv(truth)
    return np.concatenate([Rotation.from_matrix(delta[:3, :3]).as_rotvec(), delta[:3, :3] @ centre + delta[:3, 3] - centre])


def whitened_error(run, truth, dof):
    """(dof,) of independent unit normal numbers, if the covariance is right."""
    used = [2, 3, 4, 5] if dof == 4 else range(6)  # with 4, rotations about x and y are known to be none
    information = np.array(run["precision"]["information"])[np.ix_(used, used)]
    return np.linalg.cholesky(information).T @ error_of(run, truth)[used]


def aligned(igsp, dof, folder):
    """The report on source.ply and target.ply of the folder, registered from initial.txt."""
    subprocess.run([igsp, "align", "source.ply", "target.ply", "--initial", "initial.txt", "--report", "r.json",
                    "--quiet", "--threads", "1", "--dof", str(dof)], cwd=folder, stdout=subprocess.DEVNULL, check=False)
    return json.loads((folder / "r.json").read_text())


def errors_of_draws(igsp, clouds, noise, truth, arguments, draws, folder):
    """(n, dof) of those that were registered."""
    random = np.random.default_rng(1)
    errors = []
    for _ in range(draws):
        for name, points in zip(("source", "target"), clouds, strict=True):
            write_ply(folder / f"{name}.ply", drawn(points, arguments.points, noise, random))
        run = aligned(igsp, arguments.dof, folder)
        if run["verdict"] == "registered":
            errors.append(whitened_error(run, truth, arguments.dof))
    return np.array(errors).reshape(-1, arguments.dof)


def errors_of_scene(igsp, scene, seed, arguments, folder):
    subprocess.run([igsp, "simulate", scene, "--seed", str(seed), "--points", str(DENSE * arguments.points), "--noise", "0",
                    "--out", folder], check=True, stdout=subprocess.DEVNULL)
    dense = [read_ply(folder / f"station_{i}.ply") for i in (1, 0)]
    truth = np.loadtxt(folder / "station_1_to_0.txt")
    np.savetxt(folder / "initial.txt", truth, fmt="%.17g")
    return errors_of_draws(igsp, dense, NOISE[scene], truth, arguments, max(1, arguments.draws // arguments.seeds), folder)


def errors_of_pair(igsp, paths, arguments, folder):
    clouds = [read_ply(path) for path in paths[:2]]
    np.savetxt(folder / "initial.txt", np.loadtxt(paths[2]), fmt="%.17g")
    for name, points in zip(("source", "target"), clouds, strict=True):
        write_ply(folder / f"{name}.ply", points)
    reference = np.array(aligned(igsp, arguments.dof, folder)["target_from_source"])
    return errors_of_draws(igsp, clouds, 0, reference, arguments, arguments.draws, folder)


def errors_by_seed(igsp, scene, arguments):
    """One array a scene of its kind; of a real pair, one."""
    found = []
    for seed in range(1, 1 + (1 if arguments.pair else arguments.seeds)):
        with tempfile.TemporaryDirectory() as folder:
            if arguments.pair:
                found.append(errors_of_pair(igsp, arguments.pair, arguments, Path(folder)))
            else:
                found.append(errors_of_scene(igsp, scene, seed, arguments, Path(folder)))
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("igsp", type=Path)
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seeds", type=int, default=10, help="scenes of each kind, which share the draws")
    parser.add_argument("--points", type=int, default=40000)
    parser.add_argument("--scenes", default="park,indoor,object")
    parser.add_argument("--dof", type=int, default=6, choices=[4, 6])
    parser.add_argument("--pair", nargs=3, type=Path, metavar=("SOURCE", "TARGET", "TRUTH"), help="a real pair")
    parser.add_argument("--csv", type=Path)
    arguments = parser.parse_args()
    rows = []
    print("| scene | points | registered of | median square / expected | inside 95 % | factor that would make it 95 % "
          "| same in all draws |")
    print("|---|---|---|---|---|---|---|")
    scenes = [arguments.pair[0].stem] if arguments.pair else arguments.scenes.split(",")
    for scene in scenes:
        by_seed = errors_by_seed(arguments.igsp.resolve(), scene, arguments)
        errors = np.concatenate(by_seed)
        same = sum(len(e) * (e.mean(axis=0)**2).sum() for e in by_seed if len(e)) / max(1, len(errors))
        squares = (errors**2).sum(axis=1)
        limit = chi2.ppf(0.95, arguments.dof)
        if len(squares) < 20:
            print(f"| {scene} | {arguments.points} | {len(squares)} of {arguments.draws} | too few to say | | | |", flush=True)
            continue
        print(f"| {scene} | {arguments.points} | {len(squares)} of {arguments.draws} | "
              f"{np.median(squares) / chi2.ppf(0.5, arguments.dof):.2f} | "
              f"{100 * np.mean(squares < limit):.0f} % | {np.quantile(squares, 0.95) / limit:.2f} | "
              f"{100 * same / squares.mean():.0f} % |", flush=True)
        rows += [(scene, arguments.points, arguments.dof, f"{square:.6g}") for square in squares]
    if arguments.csv:
        with open(arguments.csv, "w", newline="") as file:
            csv.writer(file).writerows([("scene", "points", "dof", "square"), *rows])


if __name__ == "__main__":
    sys.exit(main())
