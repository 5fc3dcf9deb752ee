"""Points and transformations as they come: brought into the one form that the library takes, copied only if need be."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Points = npt.NDArray[np.float64]
Matrix = npt.NDArray[np.float64]

_RIGID_TOLERANCE = 1e-3


def points_array(cloud: Any, name: str) -> Points:
    """An (N, 3) float64 C-contiguous array of a cloud in memory: itself where it is one already.

    `cloud`: anything NumPy takes for an (N, 3) array of real numbers; an Open3D point cloud, a PyVista data set, a
    laspy LasData (its scaled x, y, z). `name` stands for it in errors.
    """
    try:
        array = np.asanyarray(_coordinates(cloud))
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is no array: {error}") from error
    if isinstance(array, np.ma.MaskedArray) and np.ma.is_masked(array):
        raise ValueError(f"{name} is a masked array with masked entries; leave out the points that are not there")
    if array.dtype.names is not None:
        raise ValueError(
            f"{name} is a structured array with the fields {', '.join(array.dtype.names)}; "
            "expected an (N, 3) array, such as numpy.stack of x, y and z along the last axis"
        )
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name} has dtype {array.dtype}; expected real numbers")
    if array.ndim != 2 or array.shape[1] != 3:
        transposed = "; transposed?" if array.ndim == 2 and array.shape[0] == 3 else ""
        raise ValueError(f"{name} has shape {array.shape}; expected (N, 3){transposed}")
    return np.require(array, np.float64, ["C_CONTIGUOUS", "ALIGNED", "ENSUREARRAY"])


def _coordinates(cloud: Any) -> Any:
    if isinstance(cloud, np.ndarray):
        return cloud
    if hasattr(cloud, "xyz"):  # laspy; its `points` are raw integers
        return cloud.xyz
    if hasattr(cloud, "point") and "positions" in cloud.point:  # Open3D's tensor point cloud
        return cloud.point["positions"].cpu().numpy()
    if hasattr(cloud, "points"):
        return cloud.points
    return cloud


def matrix_array(matrix: npt.ArrayLike, name: str) -> Matrix:
    """A (4, 4) float64 array of a rigid motion. `name` stands for it in errors."""
    array = np.require(np.asarray(matrix, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
    if array.shape != (4, 4):
        raise ValueError(f"{name} has shape {array.shape}; expected (4, 4)")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds a number that is not finite")
    if np.abs(array[3] - [0, 0, 0, 1]).max() > _RIGID_TOLERANCE:
        raise ValueError(f"{name} has the last row {array[3].tolist()}; expected 0, 0, 0, 1")
    rotation = array[:3, :3]
    deviation = np.abs(rotation.T @ rotation - np.eye(3)).max()
    if deviation > _RIGID_TOLERANCE:
        raise ValueError(
            f"{name} is not a rigid motion: R^T R differs from the identity by {deviation:.3g} "
            f"(at most {_RIGID_TOLERANCE})"
        )
    if np.linalg.det(rotation) < 0:
        raise ValueError(f"{name} is not a rigid motion but a reflection (determinant -1)")
    return array
