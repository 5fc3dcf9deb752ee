"""Rigid motions as (4, 4) float64 matrices that act on columns: moved = motion @ [x, y, z, 1]."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ._cloud import Points

RIGID_TOLERANCE = 1e-3  # as for transformation files


def as_rigid(matrix: ArrayLike, name: str) -> Points:
    """The motion as (4, 4) float64. Throws ValueError if it is far from rigid.

    Its numbers are taken as they are: making the rotation of a text file orthonormal would turn it about the origin,
    and six digits at the coordinates of UTM are metres.
    """
    motion = np.array(matrix, dtype=np.float64)
    if motion.shape != (4, 4):
        raise ValueError(f"{name} must have shape (4, 4), got {motion.shape}")
    if not np.isfinite(motion).all():
        raise ValueError(f"{name} must be finite")
    if not np.allclose(motion[3], [0, 0, 0, 1], rtol=0, atol=RIGID_TOLERANCE):
        raise ValueError(f"{name} must have the last row 0 0 0 1, got {motion[3]}")
    left, stretch, right = np.linalg.svd(motion[:3, :3])
    if np.abs(stretch - 1).max() > RIGID_TOLERANCE or np.linalg.det(left @ right) < 0:
        raise ValueError(f"{name} must be a rigid motion: its rotation is not orthonormal with determinant 1")
    motion[3] = [0, 0, 0, 1]
    return motion


def apply(motion: Points, points: Points) -> Points:
    """(N, 3) moved; a point that is not finite stays so."""
    return turn(motion, points) + motion[:3, 3]


def turn(motion: Points, vectors: Points) -> Points:
    """(N, 3) rotated. Column by column: a matrix product rounds differently as the number of points changes."""
    x, y, z = vectors.T
    with np.errstate(invalid="ignore"):
        return np.column_stack([row[0] * x + row[1] * y + row[2] * z for row in motion[:3, :3]])


def from_quaternion(quaternion: ArrayLike, translation: ArrayLike) -> Points:
    """Of (w, x, y, z), of any length but zero, and (x, y, z)."""
    w, x, y, z = np.asarray(quaternion, dtype=np.float64) / np.linalg.norm(np.asarray(quaternion, dtype=np.float64))
    motion = np.eye(4)
    motion[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    motion[:3, 3] = translation
    return motion


def to_quaternion(motion: Points) -> Points:
    """(w, x, y, z) of unit length with w >= 0, of the nearest rotation: the eigenvector of the greatest eigenvalue."""
    r = motion[:3, :3]
    symmetric = np.array(
        [
            [r[0, 0] + r[1, 1] + r[2, 2], 0, 0, 0],
            [r[2, 1] - r[1, 2], r[0, 0] - r[1, 1] - r[2, 2], 0, 0],
            [r[0, 2] - r[2, 0], r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], 0],
            [r[1, 0] - r[0, 1], r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1]],
        ]
    )
    quaternion: Points = np.linalg.eigh(symmetric, UPLO="L")[1][:, -1]
    return -quaternion if quaternion[0] < 0 else quaternion
