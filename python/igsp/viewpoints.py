"""Where scanners stood: said by the caller, by the file, or found in the cloud."""

from __future__ import annotations

import os
import warnings
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from igsp import _core
from igsp._core import ViewpointFinding
from igsp.arrays import Points, points_array
from igsp.files import LoadedCloud, Parts, load_cloud

Viewpoint: TypeAlias = str | npt.ArrayLike | None
"""(3,) in the frame of the points, "auto", None (unknown, or of mixed scans), or "x,y,z!", which insists."""


def find_viewpoint(cloud: object, viewpoint: Viewpoint = "auto") -> ViewpointFinding:
    """Where the scanner of a cloud stood, and why that is believed: what `align` does with the same arguments.

    `cloud`: a path or points, see `align`. "auto": what the file or the object says, else the origin if the cloud has
    one depth a direction from there and not from places about it; of a file of several scans each by itself.
    """
    return _find(load(cloud, "cloud"), viewpoint, "viewpoint")


def load(cloud: object, name: str) -> LoadedCloud:
    """A path or an object in memory, with the viewpoints that it states."""
    if isinstance(cloud, (str, os.PathLike)):
        return load_cloud(cloud)
    points = points_array(cloud, name)
    if isinstance(cloud, np.ndarray):
        return LoadedCloud(points, [(len(points), None)])
    parts = _parts(getattr(cloud, "parts", ()), len(points))
    return LoadedCloud(points, parts or [(len(points), _point(getattr(cloud, "viewpoint", None)))])


def settle(cloud: LoadedCloud, viewpoint: Viewpoint, name: str) -> Parts:
    """Of each scan in the cloud the number of points and its viewpoint, (3,) or None; nothing if none is known.

    Warns where the cloud contradicts what was given. `name`: of the keyword, for errors.
    """
    found = _find(cloud, viewpoint, name)
    if found.warning:
        text = _text(viewpoint)
        warnings.warn(f"{name}={text} is not used: {found.warning}; {name}='{text}!' insists", stacklevel=4)
    if found.parts:
        return found.parts
    return [] if found.viewpoint is None else [(len(cloud.points), found.viewpoint)]


def _find(cloud: LoadedCloud, viewpoint: Viewpoint, name: str) -> ViewpointFinding:
    return _core.find_viewpoint(cloud.points, name, _text(viewpoint), cloud.parts)


def _text(viewpoint: Viewpoint) -> str:
    if viewpoint is None:
        return "none"
    if isinstance(viewpoint, str):
        return viewpoint
    return ",".join(repr(float(number)) for number in np.asarray(viewpoint, np.float64).ravel())


def _parts(stated: object, count: int) -> list[tuple[int, Points | None]]:
    try:
        parts = [(int(part.point_count), _point(part.viewpoint)) for part in stated]  # type: ignore[attr-defined]
    except (AttributeError, TypeError, ValueError):  # another library's attribute of that name
        return []
    return parts if len(parts) > 1 and sum(points for points, _ in parts) == count else []


def _point(stated: object) -> Points | None:
    if stated is None:
        return None
    try:
        array = np.require(np.asarray(stated, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
    except (TypeError, ValueError):  # another library's attribute of that name
        return None
    return array if array.shape == (3,) else None
