"""The points of LAS files and, through laspy and lazrs, of LAZ (COPC is LAZ)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _las_layout, _laz_layout
from ._cloud import FormatError, Metadata, PathLike, Points, Scan, Selection, faults_of_package, require
from ._las_layout import Layout

NOISE_CLASSES = (7, 18)  # low and high noise, table 17 of the LAS 1.4 specification
WITHHELD = 4
BYTES_AT_ONCE = 1 << 28  # of records, before a single one of them has been seen


def describe(path: PathLike, layout: Layout, metadata: Metadata) -> None:
    metadata.format = "copc" if layout.is_copc else "laz" if layout.compressed else "las"
    metadata.scale, metadata.offset = layout.scale, layout.offset
    metadata.crs_wkt, metadata.epsg = _las_layout.read_crs(path, layout)
    metadata.scans = [Scan("scan 0", layout.point_count, None)]


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    describe(path, _las_layout.read_layout(path), metadata)


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    layout = _las_layout.read_layout(path)
    describe(path, layout, metadata)
    selection.require_scan(path, 1)
    for records in read_records(path, layout, points_per_chunk, points_only=True):
        if not selection.keep_noise:
            noise = is_noise(records, layout.point_format)
            metadata.noise += int(np.count_nonzero(noise))
            records = records[~noise]
        stored = np.column_stack([records["X"], records["Y"], records["Z"]])
        yield stored * layout.scale + layout.offset


def is_noise(records: Any, point_format: int) -> NDArray[np.bool_]:
    """(N,): classified as noise, or withheld: what their maker asks to leave out."""
    if point_format < _las_layout.FIRST_WITH_FLAGS:
        flags, classes = records["raw_classification"] >> 5, records["raw_classification"] & 0x1F
    else:
        flags, classes = records["classification_flags"], records["classification"]
    noise: NDArray[np.bool_] = np.isin(classes, NOISE_CLASSES) | (flags & WITHHELD != 0)
    return noise


def read_records(path: PathLike, layout: Layout, points_per_chunk: int, points_only: bool = False) -> Iterator[Any]:
    """Structured arrays of point records, as stored. Throws FormatError if there are fewer than declared.

    `points_only`: nothing but coordinates, classes and flags has to be right.
    """
    points_per_chunk = min(points_per_chunk, max(1, BYTES_AT_ONCE // layout.record_length))
    chunks = _read_compressed if layout.compressed else _read_plain
    total = 0
    for records in chunks(path, layout, points_per_chunk, points_only):
        total += len(records)
        yield records
    if total != layout.point_count:
        raise FormatError(path, f"the file ends after {total} of {layout.point_count} points")


def _read_plain(path: PathLike, layout: Layout, points_per_chunk: int, points_only: bool) -> Iterator[Any]:
    with open(path, "rb") as file:
        file.seek(layout.points_start)
        for start in range(0, layout.point_count, points_per_chunk):
            count = min(points_per_chunk, layout.point_count - start)
            yield np.fromfile(file, _las_layout.record_type(layout), count)


def _read_compressed(path: PathLike, layout: Layout, points_per_chunk: int, points_only: bool) -> Iterator[Any]:
    laspy = require("laspy", path, "las")
    require("lazrs", path, "las")
    _laz_layout.check(path, layout)
    fields = laspy.DecompressionSelection.all()
    if points_only:  # spares LAZ of point formats 6 to 10 the decompression of the rest
        fields = laspy.DecompressionSelection.base().decompress_z().decompress_classification().decompress_flags()
    total = 0
    with (
        faults_of_package(path, lambda: f"after point {total} of {layout.point_count}"),
        laspy.open(
            path, laz_backend=laspy.LazBackend.LazrsParallel, read_evlrs=False, decompression_selection=fields
        ) as reader,
    ):
        while total < layout.point_count:
            records = reader.read_points(points_per_chunk).array
            if not len(records):
                break
            total += len(records)
            yield records
