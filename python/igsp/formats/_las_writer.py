"""LAS and LAZ moved: a copy of the source in which only the coordinates, their bounds, scale and offset differ.

All else is copied byte by byte, so attributes, extra bytes, (extended) variable length records and the coordinate
reference system come through whatever they hold. The octree of COPC does not fit moved points and is left out.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from . import _las_layout, _laz_layout, _motion
from ._atomic import atomic_output
from ._cloud import PathLike, Points, Selection
from ._las_layout import Layout, Record
from ._las_reader import read_records
from ._laz_writer import RecordWriter

POINTS_AT_ONCE = 500_000
COPY_AT_ONCE = 1 << 22
LARGEST = 2**31 - 1  # magnitude of a stored coordinate


@dataclass(frozen=True)
class Grid:
    """How moved coordinates are stored: offset + scale * integer."""

    scale: Points  # (3,)
    offset: Points  # (3,)


def write_aligned(source: PathLike, output: PathLike, target_from_source: Points, selection: Selection) -> None:
    layout = _las_layout.read_layout(source)
    selection.require_scan(source, 1)
    writer = RecordWriter(output, layout.point_format, layout.record_length)
    grid = _choose_grid(source, layout, target_from_source)
    with open(source, "rb") as file, atomic_output(output) as moved:
        _Copy(source, layout, grid, target_from_source, file, moved).write(writer)


def _choose_grid(path: PathLike, layout: Layout, motion: Points) -> Grid:
    """The source's resolution and its offset moved along, unless the moved points would not fit into 32 bits."""
    contributes = np.abs(motion[:3, :3]) > 1e-9
    scale = np.where(contributes, layout.scale, np.inf).min(axis=1)  # turned axes mix: the finest resolution is kept
    offset = _motion.apply(motion, np.array([layout.offset]))[0]
    lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
    for records in read_records(path, layout, POINTS_AT_ONCE):
        local = _moved_local(records, layout, motion)
        lower, upper = np.minimum(lower, local.min(axis=0)), np.maximum(upper, local.max(axis=0))
    if layout.point_count and (np.maximum(-lower, upper) / scale > LARGEST).any():
        offset = offset + (lower + upper) / 2
        while (beyond := (upper - lower) / 2 / scale > LARGEST).any():
            scale = np.where(beyond, scale * 10, scale)
    return Grid(scale, offset)


def _moved_local(records: Any, layout: Layout, motion: Points) -> Points:
    """Turned, relative to the moved offset of the source: small numbers, whatever the coordinate system."""
    stored = np.column_stack([records["X"], records["Y"], records["Z"]])
    return _motion.turn(motion, stored * layout.scale)


class _Copy:
    """One file on its way into another: header, records, points, what follows, then the header as it turned out."""

    def __init__(
        self, path: PathLike, layout: Layout, grid: Grid, motion: Points, file: BinaryIO, moved: BinaryIO
    ) -> None:
        self.path, self.layout, self.grid, self.motion = path, layout, grid, motion
        self.file, self.moved = file, moved
        self.lowest = np.full(3, LARGEST, np.int64)
        self.highest = np.full(3, -LARGEST, np.int64)

    def write(self, writer: RecordWriter) -> None:
        header = bytearray(self.layout.header)
        records, record_count = self._records(writer.description)
        self.moved.write(bytes(header) + records)
        starts = (self.moved.tell(), record_count, writer.format_byte)
        struct.pack_into("<IIB", header, _las_layout.HEADER_SIZE + 2, *starts)
        writer.write(self.moved, self._moved_records())
        self._write_tail(header)
        self._patch_coordinates(header)
        self.moved.seek(0)
        self.moved.write(header)

    def _records(self, description: bytes) -> tuple[bytes, int]:
        """The variable length records, with the one that describes the compression if there is any; and their count."""
        kept = [record for record in self.layout.records if not _describes_storage(record)]
        data = [self._bytes(record.start, record.end) for record in kept]
        if description:
            data.append(description)
        end = self.layout.records[-1].end if self.layout.records else len(self.layout.header)
        return b"".join(data) + self._bytes(end, self.layout.points_start), len(data)

    def _bytes(self, start: int, end: int) -> bytes:
        self.file.seek(start)
        return self.file.read(end - start)

    def _moved_records(self) -> Iterator[Any]:
        shift = _motion.apply(self.motion, np.array([self.layout.offset]))[0] - self.grid.offset
        for records in read_records(self.path, self.layout, POINTS_AT_ONCE):
            local = _moved_local(records, self.layout, self.motion) + shift
            stored: NDArray[np.int64] = np.rint(local / self.grid.scale).astype(np.int64)
            self.lowest = np.minimum(self.lowest, stored.min(axis=0))
            self.highest = np.maximum(self.highest, stored.max(axis=0))
            records["X"], records["Y"], records["Z"] = stored.T
            if self.layout.point_format in _las_layout.PULSE_DIRECTION:  # the direction of the pulse turns with the points
                pulse = np.column_stack([records["x_t"], records["y_t"], records["z_t"]]).astype(np.float64)
                records["x_t"], records["y_t"], records["z_t"] = _motion.turn(self.motion, pulse).T
            yield records

    def _write_tail(self, header: bytearray) -> None:
        """What follows the points, and where it now begins."""
        layout = self.layout
        kept = [record for record in layout.extended if not _describes_storage(record)]
        starts = [start for start in (layout.evlr_start, layout.waveform_start) if start >= layout.points_start]
        begin = min(starts, default=layout.length) if layout.compressed else layout.points_end
        dropped = len(kept) < len(layout.extended)
        parts = [(record.start, record.end) for record in kept] if dropped else [(begin, layout.length)]
        new_begin = self.moved.seek(0, 2)
        for start, end in parts:
            self._copy(start, end)
        shift = new_begin - (parts[0][0] if parts else begin)
        if layout.evlr_start:
            first = kept[0].start + shift if kept else 0
            struct.pack_into("<QI", header, _las_layout.FIRST_EVLR, first, len(kept))
        if layout.waveform_start:
            struct.pack_into("<Q", header, _las_layout.WAVEFORM_START, layout.waveform_start + shift)

    def _copy(self, start: int, end: int) -> None:
        for position in range(start, end, COPY_AT_ONCE):
            self.moved.write(self._bytes(position, min(end, position + COPY_AT_ONCE)))

    def _patch_coordinates(self, header: bytearray) -> None:
        grid = self.grid
        struct.pack_into("<6d", header, _las_layout.SCALE_AND_OFFSET, *grid.scale, *grid.offset)
        bounds = np.zeros((3, 2))
        if self.layout.point_count:
            bounds = np.column_stack([self.highest * grid.scale + grid.offset, self.lowest * grid.scale + grid.offset])
        struct.pack_into("<6d", header, _las_layout.BOUNDS, *bounds.ravel())


def _describes_storage(record: Record) -> bool:
    """True of compression and octree, which are made anew or do not fit the moved points."""
    return (record.user, record.number) == (_laz_layout.USER, _laz_layout.NUMBER) or record.user == "copc"
