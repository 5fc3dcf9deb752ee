"""Clouds and rigid motions as the evaluation's scripts need them."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def read_points(path: Path) -> np.ndarray:
    """(N, 3) from a binary little-endian PLY with x, y, z alone, as `igsp_paper pairs` writes it."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode("ascii").splitlines()
    properties = [line.split()[1:] for line in header if line.startswith("property")]
    if properties != [["float", "x"], ["float", "y"], ["float", "z"]]:
        raise SystemExit(f"{path}: properties {properties}; wanted are float x, y, z")
    return np.frombuffer(data, "<f4", offset=end).reshape(-1, 3).astype(float)


def transformed(transformation: np.ndarray, points: np.ndarray) -> np.ndarray:
    """(N, 3) points moved by a 4x4 or 3x4 rigid motion."""
    return points @ transformation[:3, :3].T + transformation[:3, 3]


def rotation_angle_deg(rotation: np.ndarray) -> float:
    """In [0, 180]; by sine and cosine, as the arccosine of Eq. 13 loses half of the digits near 0. NaN if there is none."""
    sine = 0.5 * np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0],
                           rotation[1, 0] - rotation[0, 1]])
    return float(np.degrees(np.arctan2(np.linalg.norm(sine), 0.5 * (np.trace(rotation) - 1))))


def displacement(a: np.ndarray, b: np.ndarray, place: np.ndarray) -> float:
    """Between the images of one place under two motions."""
    return float(np.linalg.norm(transformed(a, place[None]) - transformed(b, place[None])))
