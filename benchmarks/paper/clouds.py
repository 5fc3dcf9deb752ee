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
