"""Pairs to register: written by `igsp benchmark --export`, so that every program gets the same moved sources."""

import csv
import re
import subprocess
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np


@dataclass
class Pair:
    """One case on the disk. `truth` is a 4x4 target_from_source, None if the pair does not overlap or nobody knows."""

    name: str
    group: str
    source: Path
    target: Path
    truth_kind: str  # known, none, -
    truth: np.ndarray | None
    max_rotation_error_deg: float
    max_displacement: float


def read_list(path: Path) -> list[dict[str, str]]:
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def export_pair(igsp: Path, cases: Path, name: str, seed: int, folder: Path) -> Pair:
    """The named case with its source moved, as files in `folder`."""
    # The name as a pattern of --only: its own special characters mean themselves.
    pattern = re.sub(r"([*?\[])", r"[\1]", name)
    subprocess.run([igsp, "benchmark", cases, "--only", pattern, "--scramble", str(seed), "--export", folder],
                   check=True, stdout=subprocess.DEVNULL)
    return pair_of(next(row for row in read_list(folder / "cases.csv") if row["name"] == name), folder)


def pair_of(row: dict[str, str], folder: Path) -> Pair:
    known = row["truth"] not in ("none", "-")
    return Pair(row["name"], row["group"], folder / row["source"], folder / row["target"],
                "known" if known else row["truth"], np.loadtxt(folder / row["truth"]) if known else None,
                float(row["max_rotation_error_deg"]), float(row["max_translation_error_m"]))


def read_cloud(path: Path) -> np.ndarray:
    """(N, 3) doubles of a binary little-endian PLY with nothing but doubles x, y, z, as the export writes it."""
    content = path.read_bytes()
    header, mark, body = content.partition(b"end_header\n")
    properties = re.findall(rb"^property (\w+) (\w+)", header, re.MULTILINE)
    if not mark or b"binary_little_endian" not in header or properties != [(b"double", c) for c in (b"x", b"y", b"z")]:
        raise ValueError(f"{path}: not a binary little-endian PLY of doubles x, y, z")
    points = np.frombuffer(body, "<f8").reshape(-1, 3).copy()  # writable, which the peers want
    count = int(re.search(rb"^element vertex (\d+)", header, re.MULTILINE)[1])
    if len(points) != count:
        raise ValueError(f"{path}: {len(points)} points, the header says {count}")
    return points


def perturbed_truth(pair: Pair, voxel_size: float, centroid: np.ndarray) -> np.ndarray:
    """The truth after 2 degrees about an axis through the source's centroid and 2 voxels of translation, both in
    directions that depend on the case's name alone: the guess that a fine registration starts from."""
    random = np.random.default_rng(zlib.crc32(pair.name.encode()))
    axis, direction = (v / np.linalg.norm(v) for v in random.normal(size=(2, 3)))
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(2.0)
    motion = np.eye(4)
    motion[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    place = pair.truth[:3, :3] @ centroid + pair.truth[:3, 3]
    motion[:3, 3] = place - motion[:3, :3] @ place + 2.0 * voxel_size * direction
    return motion @ pair.truth
