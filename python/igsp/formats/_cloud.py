"""What the readers hand out, and the errors they raise."""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
PathLike = str | os.PathLike[str]


class FormatError(OSError):
    """A file that cannot be read or written: names the path and, where it applies, the line or the byte offset."""

    def __init__(self, path: PathLike, fault: str) -> None:
        super().__init__(f"{os.fspath(path)}: {fault}")
        self.path = os.fspath(path)


class MissingPackageError(ImportError):
    """An optional package that this format needs is not installed; the message says which to install."""


def require(module: str, path: PathLike, extra: str) -> Any:
    """Imports an optional package, or says what to install to handle the file at `path`."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise MissingPackageError(
            f"{os.fspath(path)}: this format needs the package '{module}': pip install 'igsp[{extra}]'", name=module
        ) from error


@contextmanager
def faults_of_package(path: PathLike, where: Callable[[], str]) -> Iterator[None]:
    """What a package raises over a file is the file's fault, and no list of it is complete: a division by zero in a
    table of dimensions, a panic of a decoder (which is no Exception)."""
    try:
        yield
    except (OSError, MemoryError):
        raise
    except BaseException as error:
        if not isinstance(error, Exception) and type(error).__name__ != "PanicException":
            raise
        reason = (str(error).splitlines() or [type(error).__name__])[0]  # the rest is for the package's authors
        lacking = re.search("not supported|is unknown", reason)
        advice = "write the file anew with another program" if lacking else "cut short or damaged?"
        raise FormatError(path, f"{where()}: {reason}: {advice}") from error


@dataclass(frozen=True)
class Scan:
    """One scan of a file that holds several (E57, PTX), or one block of a PTS file."""

    name: str
    point_count: int  # as declared: with cells without return
    pose: Points | None  # (4, 4), file_from_scan; None if the file gives none


@dataclass(frozen=True)
class Part:
    """Those points of a cloud that are of one scan: they lie one after the other, parts in the order of the scans."""

    point_count: int
    viewpoint: Points | None  # (3,): where the scanner stood in the frame of the cloud, if the file says it


@dataclass
class Metadata:
    """What a file says beside its points. Filled as the file is read: complete once its last chunk has been."""

    format: str  # "las", "laz", "copc", "e57", "ptx" or "pts"
    scans: list[Scan] = field(default_factory=list)  # every scan of the file, also those that were not asked for
    pose_applied: bool = False  # the points are in the file's frame, not each in its scanner's
    scale: tuple[float, float, float] | None = None  # LAS: metres (or feet) per stored unit
    offset: tuple[float, float, float] | None = None  # LAS
    crs_wkt: str | None = None  # coordinate reference system as well-known text
    epsg: int | None = None  # its EPSG code, where the file gives one
    noise: int = 0  # LAS: points classified as noise (7, 18) and withheld ones that were left out
    no_return: int = 0  # cells of a scan's grid, or points flagged invalid, that carry no point; left out
    current: int = 0  # while the file is read: of which of `scans` the latest points are


@dataclass(frozen=True)
class Cloud:
    """A whole cloud. `points` is (N, 3) float64, in the unit of the file (metres for all but some LAS files)."""

    points: Points
    format: str
    dropped: int  # points left out because a coordinate is not finite
    metadata: Metadata
    viewpoint: Points | None = None  # (3,): where the scanner stood in the frame of the points, if the file says it
    scan_count: int = 1  # of which the points are: several have no viewpoint in common, see `parts`
    note: str = ""  # what was left out beside `dropped`, in words
    parts: tuple[Part, ...] = ()  # of several scans, what is of each and its viewpoint


@dataclass(frozen=True)
class Selection:
    """Which points of a file, and in which frame."""

    scan: int | None = None  # None: all scans
    apply_pose: bool = True
    keep_noise: bool = False

    def includes(self, index: int) -> bool:
        return self.scan is None or self.scan == index

    def require_scan(self, path: PathLike, scan_count: int) -> None:
        """Throws ValueError if the file has no such scan."""
        if self.scan is not None and not 0 <= self.scan < scan_count:
            known = f"0 to {scan_count - 1}" if scan_count else "none"
            raise ValueError(f"scan: {os.fspath(path)} has no scan {self.scan}; its scans: {known}")


def single_scan(
    points_of: Callable[[PathLike], Points],
    path: PathLike,
    selection: Selection,
    metadata: Metadata,
    points_per_chunk: int,
) -> Iterator[Points]:
    """The points of a format that is read whole: one scan, without a pose."""
    selection.require_scan(path, 1)
    points = points_of(path)
    metadata.scans = [Scan("scan 0", len(points), None)]
    for start in range(0, len(points), points_per_chunk):
        yield points[start : start + points_per_chunk]
