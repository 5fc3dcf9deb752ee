"""Survey formats: LAS, LAZ, COPC, E57, PTX and PTS, read as points and written moved with all that belongs to them.

The vertices of OBJ, OFF and STL are read with `pip install 'igsp[mesh]'`, the points of legacy VTK files with nothing.

LAZ and COPC need `pip install 'igsp[las]'`, E57 needs `pip install 'igsp[e57]'`; LAS, PTX and PTS need nothing.
What each format keeps and how its poses, scales and coordinate systems are treated: docs/formats.md.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from types import ModuleType

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import points_array
from . import (
    _e57_reader,
    _e57_writer,
    _las_layout,
    _las_points,
    _las_reader,
    _las_writer,
    _mesh,
    _motion,
    _pts,
    _ptx,
    _vtk,
)
from ._cloud import Cloud, FormatError, Metadata, MissingPackageError, Part, PathLike, Points, Scan, Selection

__all__ = [
    "ChunkReader",
    "Cloud",
    "FormatError",
    "Metadata",
    "MissingPackageError",
    "Part",
    "Scan",
    "is_supported",
    "is_written",
    "read_chunks",
    "read_cloud",
    "read_metadata",
    "scan_names",
    "split_name",
    "write_aligned",
    "write_chunks",
]

POINTS_PER_CHUNK = 1_000_000

_READERS: dict[str, ModuleType] = {
    ".las": _las_reader,
    ".laz": _las_reader,
    ".e57": _e57_reader,
    ".ptx": _ptx,
    ".pts": _pts,
    ".obj": _mesh,
    ".off": _mesh,
    ".stl": _mesh,
    ".vtk": _vtk,
}
_WRITERS: dict[str, ModuleType] = {
    ".las": _las_writer,
    ".laz": _las_writer,
    ".e57": _e57_writer,
    ".ptx": _ptx,
    ".pts": _pts,
}


def split_name(path: PathLike) -> tuple[str, int | None]:
    """(FILE, 1) of FILE#1, which names one scan of a file; (FILE, None) of anything else."""
    name = os.fspath(path)
    file, mark, number = name.rpartition("#")
    if mark and number.isdecimal() and not os.path.exists(name):
        return file, int(number)
    return name, None


def scan_names(path: PathLike) -> list[str]:
    """The names of the scans in a file by which each is read alone: FILE#0, FILE#1, ...; FILE if it holds one."""
    name = os.fspath(path)
    if split_name(name)[1] is not None:
        return [name]
    count = len(read_metadata(name).scans)
    return [f"{name}#{index}" for index in range(count)] if count > 1 else [name]


def is_written(path: PathLike) -> bool:
    """True if `write_aligned` takes a source of this name."""
    return _extension(path) in _WRITERS


def is_supported(path: PathLike) -> bool:
    """True if the name of the file ends like one of a survey format, in capital letters or not."""
    return _extension(path) in _READERS


class ChunkReader(Iterator[Points]):
    """The finite points of a file, chunk by chunk, with memory bounded by a chunk. `metadata` fills as it reads."""

    def __init__(self, path: PathLike, points_per_chunk: int, selection: Selection) -> None:
        if points_per_chunk < 1:
            raise ValueError(f"points_per_chunk must be at least 1, got {points_per_chunk}")
        self.metadata = Metadata(_known_extension(path)[1:])
        self.dropped = 0
        """Points met so far that were left out because a coordinate is not finite."""
        self.part = 0
        """Of which of `parts` the latest chunk is."""
        self._selection = selection
        self._counts: dict[int, int] = {}  # of points met so far, by the scan that they are of
        reader = _READERS[_known_extension(path)]
        self._chunks: Iterator[Points] = reader.read(path, selection, self.metadata, points_per_chunk)

    def __next__(self) -> Points:
        for points in self._chunks:
            finite = np.isfinite(points).all(axis=1)
            if not finite.all():
                self.dropped += int(len(points) - np.count_nonzero(finite))
                points = points[finite]
            if len(points):
                self._counts[self.metadata.current] = self._counts.get(self.metadata.current, 0) + len(points)
                self.part = len(self._counts) - 1
                return points
        raise StopIteration

    @property
    def note(self) -> str:
        """What was left out beside `dropped`, in words; mostly empty."""
        if not self.metadata.noise:
            return ""
        return (
            f"left out {self.metadata.noise} points that are classified as noise (7, 18) or withheld; "
            "igsp.formats.read_cloud(path, keep_noise=True) keeps them"
        )

    @property
    def scan_count(self) -> int:
        """How many scans of the file the points are of, as far as it has been read."""
        return len(self._counts)

    @property
    def viewpoint(self) -> Points | None:
        """(3,): where the scanner stood in the frame of the points, once the last chunk has been read.

        None if the file does not say it (no pose, or one that moves nothing), and for several scans: see `parts`.
        """
        return self._viewpoint_of(next(iter(self._counts))) if len(self._counts) == 1 else None

    @property
    def parts(self) -> tuple[Part, ...]:
        """Of several scans, what is of each and its viewpoint, once the last chunk has been read; none of a single one."""
        if len(self._counts) < 2:
            return ()
        return tuple(Part(count, self._viewpoint_of(scan)) for scan, count in self._counts.items())

    def _viewpoint_of(self, scan: int) -> Points | None:
        pose = self.metadata.scans[scan].pose
        if pose is None or (pose == np.eye(4)).all():
            return None
        return pose[:3, 3].copy() if self._selection.apply_pose else np.zeros(3)


def read_chunks(
    path: PathLike,
    points_per_chunk: int = POINTS_PER_CHUNK,
    *,
    scan: int | None = None,
    apply_pose: bool = True,
    keep_noise: bool = False,
) -> ChunkReader:
    """Iterates over the points in arrays of at most `points_per_chunk` rows, (N, 3) float64; see `read_cloud`."""
    file, named = split_name(path)
    if named is not None and scan is not None:
        raise ValueError(f"scan: {os.fspath(path)} names its scan already")
    selection = Selection(named if scan is None else scan, apply_pose, keep_noise)
    return ChunkReader(file, points_per_chunk, selection)


def read_cloud(path: PathLike, *, scan: int | None = None, apply_pose: bool = True, keep_noise: bool = False) -> Cloud:
    """Reads the points of a file.

    Args:
        path: its extension says which format: .las, .laz (also COPC), .e57, .ptx, .pts, .obj, .off, .stl or .vtk;
            FILE#1 is the scan 1 of FILE.
        scan: index of the scan to read, from 0; all of them by default. LAS and PTS files are one scan.
        apply_pose: whether the points of every scan are brought to the file's frame by its pose (E57, PTX);
            otherwise they stay in the frame of their scanner.
        keep_noise: whether points of LAS that are classified as noise (7, 18) or withheld are among the points;
            otherwise `metadata.noise` counts them.

    Raises:
        FormatError: an OSError; names the path, what is wrong and at which line or byte.
        MissingPackageError: an ImportError; names the package to install.
        ValueError: the file has no such scan.
    """
    reader = read_chunks(path, scan=scan, apply_pose=apply_pose, keep_noise=keep_noise)
    points = np.empty((0, 3))
    count = 0
    for chunk in reader:
        if count + len(chunk) > len(points):  # grown in place where the system can, so that there is one copy
            points.resize((max(count + len(chunk), 2 * count), 3), refcheck=False)
        points[count : count + len(chunk)] = chunk
        count += len(chunk)
    points.resize((count, 3), refcheck=False)
    return Cloud(
        points,
        reader.metadata.format,
        reader.dropped,
        reader.metadata,
        reader.viewpoint,
        reader.scan_count,
        reader.note,
        reader.parts,
    )


def read_metadata(path: PathLike) -> Metadata:
    """What a file says beside its points: its scans and poses, scale, offset and coordinate reference system."""
    extension = _known_extension(path)
    metadata = Metadata(extension[1:])
    _READERS[extension].read_metadata(path, metadata)
    return metadata


def write_aligned(
    source_path: PathLike,
    output_path: PathLike,
    target_from_source: ArrayLike,
    *,
    scan: int | None = None,
    apply_pose: bool = True,
) -> None:
    """Writes the source moved into the target's frame: its format, all its points, all their attributes.

    Args:
        source_path: the file that was registered.
        output_path: must be of the same format, where LAS and LAZ count as one. The file appears complete or not at
            all, and may be the source itself.
        target_from_source: (4, 4), rigid; p_target = target_from_source @ p_source, where p_source is a point as
            `read_cloud` gives it with the same `scan` and `apply_pose`.
        scan: the one that moves, the others stay where they are; by default all move.
        apply_pose: whether target_from_source is for points in the file's frame or in that of their scanner, as in
            `read_cloud`; in the latter case it becomes the pose.

    Raises:
        FormatError, MissingPackageError: as `read_cloud`; a source that is cut short or damaged is not copied.
        ValueError: target_from_source is not a rigid motion, or the file has no such scan.
    """
    motion = _motion.as_rigid(target_from_source, "target_from_source")
    writer = _WRITERS.get(_known_extension(source_path))
    if writer is None:
        raise FormatError(output_path, f"{_extension(source_path)} is only read: igsp.write_points writes the points")
    if _WRITERS.get(_extension(output_path)) is not writer:
        known = " or ".join(extension for extension, module in _WRITERS.items() if module is writer)
        raise FormatError(output_path, f"the source is written in its own format: the name must end in {known}")
    source, named = split_name(source_path)
    writer.write_aligned(source, output_path, motion, Selection(named if scan is None else scan, apply_pose))


def write_chunks(path: PathLike, chunks: Iterable[ArrayLike], *, scale: ArrayLike, offset: ArrayLike = 0.0) -> None:
    """Writes points that come in arrays of (N, 3), in memory of the largest of them.

    Args:
        path: .las or .laz. The points have their coordinates and nothing else; `igsp.write_points` knows other formats.
            The file appears complete or not at all.
        chunks: such as `read_chunks` gives.
        scale: coordinates are rounded to whole multiples of it, one or one an axis, ...
        offset: ... from here, which is at most 2^31 of them away.

    Raises:
        FormatError, MissingPackageError: as `read_cloud`, also for coordinates that are too far away or not finite.
        ValueError: scale or offset is out of range.
    """
    if _WRITERS.get(_extension(path)) is not _las_writer:
        raise FormatError(path, "the name must end in .las or .laz; igsp.write_points writes other formats")
    steps, origin = (np.broadcast_to(np.asarray(value, np.float64), 3) for value in (scale, offset))
    if not ((steps > 0) & (steps < _las_layout.LARGEST_COORDINATE)).all():
        raise ValueError(f"scale must be positive and finite, got {steps}")
    if not (np.abs(origin) < _las_layout.LARGEST_COORDINATE).all():
        raise ValueError(f"offset must be finite, got {origin}")
    _las_points.write_chunks(path, (points_array(chunk, "chunk") for chunk in chunks), steps, origin)


def _extension(path: PathLike) -> str:
    return os.path.splitext(split_name(path)[0])[1].lower()


def _known_extension(path: PathLike) -> str:
    extension = _extension(path)
    if extension not in _READERS:
        raise FormatError(path, f"not a survey format: the name must end in one of {', '.join(_READERS)}")
    return extension
