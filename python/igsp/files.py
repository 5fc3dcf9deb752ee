"""Clouds and transformations in files."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from igsp import _core
from igsp._core import Features, Result
from igsp.arrays import Matrix, Points, matrix_array, points_array

Path = str | os.PathLike[str]
Parts: TypeAlias = Sequence[tuple[int, Points | None]]
"""For each scan of a cloud: how many points are of it, one scan after the other, and its viewpoint, (3,)."""


def read_points(path: Path) -> Points:
    """The (N, 3) float64 points of a file: PLY, PCD, text (XYZ, TXT, CSV, PTS), LAS, LAZ, E57 or PTX.

    Points with a coordinate that is not finite are left out, with a warning. OSError names path and line or byte,
    ImportError the optional package that the format needs. More of a survey format's content: `igsp.formats`.
    """
    return load_cloud(path, stacklevel=3).points


@dataclass(frozen=True)
class LoadedCloud:
    """What a file or an object in memory holds for `align`."""

    points: Points
    parts: Parts  # with viewpoints as stated


def load_cloud(path: Path, stacklevel: int = 5) -> LoadedCloud:
    """As `read_points`, with the viewpoints that the file states."""
    from igsp import formats  # not before it is needed

    name = os.fspath(path)
    if formats.is_supported(name) and not name.lower().endswith(".pts"):
        cloud = formats.read_cloud(name)
        points, dropped, viewpoint = cloud.points, cloud.dropped, cloud.viewpoint
        parts = [(part.point_count, part.viewpoint) for part in cloud.parts]
        if cloud.note:
            warnings.warn(f"{name}: {cloud.note}", stacklevel=stacklevel)
    else:
        points, dropped, viewpoint = _core.read_points(name)
        parts = []
    if dropped:
        warnings.warn(
            f"{name}: dropped {dropped} of {dropped + len(points)} points with a coordinate that is not finite",
            stacklevel=stacklevel,
        )
    return LoadedCloud(points, parts or [(len(points), viewpoint)])


def write_points(
    path: Path, points: object, *, single_precision: bool = False, viewpoint: npt.ArrayLike | None = None
) -> None:
    """Writes a cloud (see `align` for what may be one) to .ply, .pcd, .xyz, .txt, .csv or .pts; whole or not at all.

    Reads back as exactly the same coordinates, or as those rounded to float with `single_precision`. `viewpoint`: (3,),
    where the scanner stood, in the frame of the points; PLY and PCD keep it.
    """
    stated = None
    if viewpoint is not None:
        stated = np.require(np.asarray(viewpoint, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
        if stated.shape != (3,):
            raise ValueError(f"viewpoint has shape {stated.shape}; expected (3,)")
    _core.write_points(os.fspath(path), points_array(points, "points"), single_precision, stated)


def read_transformation(path: Path) -> Matrix:
    """The (4, 4) float64 transformation of a text file of 16 numbers, row by row, or the 12 of the upper three rows."""
    return _core.read_transformation(os.fspath(path))


def write_transformation(path: Path, transformation: npt.ArrayLike) -> None:
    """Writes a (4, 4) transformation as text that reads back as the same numbers."""
    _core.write_transformation(os.fspath(path), matrix_array(transformation, "transformation"))


def write_features(path: Path, features: Features) -> None:
    """Writes features to meet other clouds later, in another process or on another machine; whole or not at all.

    `read_features` gives back the same bits. So does a pickle, whose bytes are the same.
    """
    _core.write_features(os.fspath(path), features)


def read_features(path: Path) -> Features:
    """What `write_features` wrote.

    OSError says what is wrong with a file that was cut or changed, or that a version of igsp with other fields wrote.
    """
    return _core.read_features(os.fspath(path))


def write_result(path: Path, result: Result) -> None:
    """Writes a result, whole or not at all, for `read_result`."""
    _core.write_result(os.fspath(path), result)


def read_result(path: Path) -> Result:
    """What `write_result` wrote, bit for bit. OSError as for `read_features`."""
    return _core.read_result(os.fspath(path))
