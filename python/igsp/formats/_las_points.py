"""Points alone as LAS 1.2 of point format 0, which every program reads: all but their coordinates is zero."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from . import _las_layout
from ._atomic import atomic_output
from ._cloud import FormatError, PathLike, Points
from ._laz_writer import RecordWriter

# Signature, source, encoding, GUID, version, two names, day and year, sizes (see _las_layout), five counts by return,
# then scale, offset and bounds.
HEADER = struct.Struct("<4sHH16xBB32s32sHHHIIBHI5I12d")
POINT_FORMAT = 0
RECORD = np.dtype(
    {
        "names": ["X", "Y", "Z", "returns"],
        "formats": ["<i4", "<i4", "<i4", "u1"],
        "offsets": [0, 4, 8, 14],
        "itemsize": _las_layout.RECORD_LENGTHS[POINT_FORMAT],
    }
)
FIRST_OF_ONE = 1 | 1 << 3  # a point's return number, and how many its pulse has
LARGEST = 2**31 - 1  # magnitude of a stored coordinate
MOST_POINTS = 2**32 - 1


def record_writer(path: PathLike) -> RecordWriter:
    return RecordWriter(path, POINT_FORMAT, RECORD.itemsize)


def write_chunks(path: PathLike, chunks: Iterable[Points], scale: Points, offset: Points) -> None:
    writer = record_writer(path)
    records = _Records(path, chunks, scale, offset)
    with atomic_output(path) as file:
        file.write(bytes(HEADER.size) + writer.description)
        start = file.tell()
        writer.write(file, records)
        file.seek(0)
        file.write(records.header(writer, start))


class _Records:
    """The point records of a cloud, chunk by chunk, and then the header that tells their number and bounds."""

    def __init__(self, path: PathLike, chunks: Iterable[Points], scale: Points, offset: Points) -> None:
        self.path, self.chunks, self.scale, self.offset = path, chunks, scale, offset
        self.count = 0
        self.lowest = np.full(3, LARGEST, np.int64)
        self.highest = np.full(3, -LARGEST, np.int64)

    def __iter__(self) -> Iterator[Any]:
        for points in self.chunks:
            if not len(points):
                continue
            stored = np.rint((points - self.offset) / self.scale)
            if not (np.abs(stored) <= LARGEST).all():  # nor is what is not a number
                fault = f"32 bits hold no coordinates so far from the offset {tuple(self.offset.tolist())} in steps of"
                raise FormatError(self.path, f"{fault} {tuple(self.scale.tolist())}: choose a coarser scale")
            self.count += len(stored)
            self.lowest = np.minimum(self.lowest, stored.min(axis=0).astype(np.int64))
            self.highest = np.maximum(self.highest, stored.max(axis=0).astype(np.int64))
            records = np.zeros(len(stored), RECORD)
            records["X"], records["Y"], records["Z"] = stored.T
            records["returns"] = FIRST_OF_ONE
            yield records

    def header(self, writer: RecordWriter, start: int) -> bytes:
        if self.count > MOST_POINTS:
            raise FormatError(self.path, f"{self.count} points; LAS 1.2 holds {MOST_POINTS}")
        bounds = np.zeros((3, 2))
        if self.count:
            bounds = np.column_stack([self.highest, self.lowest]) * self.scale[:, None] + self.offset[:, None]
        sizes = (HEADER.size, start, 1 if writer.description else 0, writer.format_byte, RECORD.itemsize, self.count)
        names = (b"LASF", 0, 0, 1, 2, b"OTHER", b"igsp", 0, 0)
        coordinates = (*self.scale, *self.offset, *bounds.ravel())
        return HEADER.pack(*names, *sizes, self.count, 0, 0, 0, 0, *coordinates)
