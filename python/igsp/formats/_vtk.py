"""Points of legacy VTK files, ASCII and binary, of every data set that lists them; what belongs to them is left out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import BinaryIO

import numpy as np

from ._cloud import FormatError, Metadata, PathLike, Points, Scan, Selection, single_scan

TYPES = {"float": ">f4", "double": ">f8", "int": ">i4", "unsigned_int": ">u4", "short": ">i2", "long": ">i8"}
LONGEST_LINE = 4096
HEADER_LINES = 64  # before the points: version, title, kind, data set, dimensions, fields
SIGNATURE = b"# vtk DataFile"


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    metadata.scans = [Scan("scan 0", len(_points(path)), None)]


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    return single_scan(_points, path, selection, metadata, points_per_chunk)


def _points(path: PathLike) -> Points:
    with open(path, "rb") as file:
        if not file.readline(LONGEST_LINE).startswith(SIGNATURE):
            raise FormatError(
                path, "byte 0: no legacy VTK file, which begins with '# vtk DataFile': save the cloud as PLY"
            )
        file.readline(LONGEST_LINE)  # the title
        kind = file.readline(LONGEST_LINE).strip().upper()
        if kind not in (b"ASCII", b"BINARY"):
            raise FormatError(path, f"line 3: {kind[:40]!r} where ASCII or BINARY is expected")
        count, scalar = _find_points(path, file)
        values = _ascii(path, file, 3 * count) if kind == b"ASCII" else _binary(path, file, 3 * count, scalar)
    return values.reshape(-1, 3)


def _find_points(path: PathLike, file: BinaryIO) -> tuple[int, str]:
    """How many points follow, and of which type."""
    for _ in range(HEADER_LINES):
        words = file.readline(LONGEST_LINE).decode("latin-1").split()
        if words and words[0].upper() == "POINTS":
            if len(words) == 3 and words[1].isdigit() and words[2].lower() in TYPES:
                return int(words[1]), TYPES[words[2].lower()]
            raise FormatError(path, f"{' '.join(words)[:60]!r}: expected POINTS, their number and their type")
    raise FormatError(
        path, "no POINTS among its first lines: a VTK file without points of its own; save the cloud as PLY"
    )


def _ascii(path: PathLike, file: BinaryIO, count: int) -> Points:
    words: list[bytes] = []
    while len(words) < count and (line := file.readline()):
        words += line.split()
    try:
        values = np.array(words[:count], np.float64)
    except ValueError as error:
        raise FormatError(path, f"its points: {error}") from error
    _require(path, len(values), count)
    return values


def _binary(path: PathLike, file: BinaryIO, count: int, scalar: str) -> Points:
    size = np.dtype(scalar).itemsize
    content = file.read(count * size)
    values = np.frombuffer(content[: len(content) // size * size], scalar).astype(np.float64)
    _require(path, len(values), count)
    return values


def _require(path: PathLike, found: int, expected: int) -> None:
    if found != expected:
        raise FormatError(path, f"the file ends after {found // 3} of {expected // 3} points: cut short?")
