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
from igsp.files import LoadedCloud, load_cloud

Viewpoint: TypeAlias = str | npt.ArrayLike | None
"""(3,) in the frame of the points, "auto", None (unknown, or a fused cloud), or "x,y,z!", which insists."""


def find_viewpoint(cloud: object, viewpoint: Viewpoint = "auto") -> ViewpointFinding:
    """Where the scanner of a cloud stood, and why that is believed: what `align` does with the same arguments.

    `cloud`: a path or points, see `align`. "auto": what the file or the object says, else the origin if the cloud has
    one depth a direction from there and not from places about it.
    """
    return _find(load(cloud, "cloud"), viewpoint, "viewpoint")


def load(cloud: object, name: str) -> LoadedCloud:
    """A path or an object in memory, with the viewpoint that it states."""
    if isinstance(cloud, (str, os.PathLike)):
        return load_cloud(cloud)
    points, scans = points_array(cloud, name), getattr(cloud, "scan_count", 1)
    stated = None if isinstance(cloud, np.ndarray) else getattr(cloud, "viewpoint", None)
    return LoadedCloud(points, None if stated is None else _point(stated), scans if isinstance(scans, int) else 1)


def settle(cloud: LoadedCloud, viewpoint: Viewpoint, name: str) -> Points | None:
    """(3,) or None, with a warning where the cloud contradicts what was given. `name`: of the keyword, for errors."""
    found = _find(cloud, viewpoint, name)
    if found.warning:
        text = _text(viewpoint)
        warnings.warn(f"{name}={text} is not used: {found.warning}; {name}='{text}!' insists", stacklevel=4)
    return found.viewpoint


def _find(cloud: LoadedCloud, viewpoint: Viewpoint, name: str) -> ViewpointFinding:
    text = _text(viewpoint)
    several = text == "auto" and cloud.scans > 1  # each with a viewpoint of its own
    return _core.find_viewpoint(cloud.points, name, "none" if several else text, cloud.viewpoint)


def _text(viewpoint: Viewpoint) -> str:
    if viewpoint is None:
        return "none"
    if isinstance(viewpoint, str):
        return viewpoint
    return ",".join(repr(float(number)) for number in np.asarray(viewpoint, np.float64).ravel())


def _point(stated: object) -> Points | None:
    try:
        array = np.require(np.asarray(stated, np.float64), requirements=["C_CONTIGUOUS", "ALIGNED"])
    except (TypeError, ValueError):  # another library's attribute of that name
        return None
    return array if array.shape == (3,) else None
