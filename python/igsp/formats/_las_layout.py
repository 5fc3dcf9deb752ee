"""Where the parts of a LAS or LAZ file lie, read from its header; what is here needs no package.

Offsets are those of the LAS 1.4 specification (ASPRS), tables 3, 6 and 7.
"""

from __future__ import annotations

import os
import struct
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from . import _crs
from ._cloud import FormatError, PathLike

VERSION_MINOR = 25
HEADER_SIZE = 94
# Header size, offset to the points, number of records (VLRs), point format, length of a point, number of points.
HEADER_SIZE_FIELDS = struct.Struct("<HIIBHI")
SCALE_AND_OFFSET = 131  # 6 doubles
BOUNDS = 179  # maximum, minimum of x, of y, of z
WAVEFORM_START = 227  # u64, from LAS 1.3
FIRST_EVLR = 235  # u64, then u32 count, u64 number of points, from LAS 1.4
SMALLEST_HEADER = 227
RECORD_LENGTHS = (20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67)  # bytes of a point of format 0, 1, ... without extra ones
FIRST_WITH_FLAGS = 6  # of the point formats, those that have a byte for flags; before, three bits beside the class
PULSE_DIRECTION = {4: 45, 5: 51, 9: 47, 10: 55}  # by point format with waveforms: where three floats lie in a point
LARGEST_COORDINATE = 1e30  # beyond it arithmetic would overflow
COMPRESSED = 0x80  # bit of the point format
VLR = struct.Struct("<2x16sHH32x")  # user, record, length
VLR_FULL = struct.Struct("<H16sHH32s")  # reserved, user, record, length, description
EVLR = struct.Struct("<2x16sHQ32x")


@dataclass(frozen=True)
class Record:
    """A (extended) variable length record, headers included: bytes `start` to `end` of the file."""

    user: str
    number: int
    start: int
    content: int  # where its content begins
    end: int


@dataclass(frozen=True)
class Layout:
    header: bytes
    length: int  # of the file, in bytes
    points_start: int
    point_format: int  # without the bits of compression
    compressed: bool
    record_length: int
    point_count: int
    waveform_start: int  # 0: none
    evlr_start: int  # 0: none
    records: list[Record]
    extended: list[Record]

    @property
    def points_end(self) -> int:
        """Of uncompressed points."""
        return self.points_start + self.point_count * self.record_length

    @property
    def is_copc(self) -> bool:
        return any(record.user == "copc" for record in self.records)

    @property
    def scale(self) -> tuple[float, float, float]:
        x, y, z = struct.unpack_from("<3d", self.header, SCALE_AND_OFFSET)
        return x, y, z

    @property
    def offset(self) -> tuple[float, float, float]:
        x, y, z = struct.unpack_from("<3d", self.header, SCALE_AND_OFFSET + 24)
        return x, y, z


def read_layout(path: PathLike) -> Layout:
    """Throws FormatError, also if the file ends before what its header declares."""
    with open(path, "rb") as file:
        length = os.fstat(file.fileno()).st_size
        header = file.read(SMALLEST_HEADER)
        if not header or header[:4] != b"LASF"[: len(header)]:
            raise FormatError(path, "byte 0: not a LAS or LAZ file: it does not begin with LASF")
        if len(header) < SMALLEST_HEADER:
            raise FormatError(path, f"byte {length}: the file ends within its header")
        size, points_start, record_count, point_format, record_length, count = HEADER_SIZE_FIELDS.unpack_from(
            header, HEADER_SIZE
        )
        header += file.read(max(0, size - SMALLEST_HEADER))
        minor = header[VERSION_MINOR]
        needed = {3: 235}.get(minor, SMALLEST_HEADER if minor < 3 else 375)
        if size < needed:
            raise FormatError(path, f"byte {HEADER_SIZE}: a header of {size} bytes, LAS 1.{minor} has {needed}")
        if len(header) < size or length < points_start:
            raise FormatError(path, f"byte {length}: the file ends before its points begin")
        if points_start < size:
            raise FormatError(path, f"byte {HEADER_SIZE + 2}: the points begin at byte {points_start}, in the header")
        waveform_start = struct.unpack_from("<Q", header, WAVEFORM_START)[0] if minor >= 3 else 0
        evlr_start, evlr_count = struct.unpack_from("<QI", header, FIRST_EVLR) if minor >= 4 else (0, 0)
        if minor >= 4:
            (count,) = struct.unpack_from("<Q", header, FIRST_EVLR + 12)
        records = _read_records(path, file, VLR, size, record_count, points_start)
        extended = _read_records(path, file, EVLR, evlr_start, evlr_count, length)
    layout = Layout(
        header,
        length,
        points_start,
        point_format & 0x3F,
        bool(point_format & COMPRESSED),
        record_length,
        count,
        waveform_start,
        evlr_start if evlr_count else 0,
        records,
        extended,
    )
    _check(path, layout)
    return layout


def record_type(layout: Layout) -> np.dtype[np.void]:
    """What of a point has to be understood, under the names that laspy has; the bytes between are kept as they are."""
    fields = {"X": ("<i4", 0), "Y": ("<i4", 4), "Z": ("<i4", 8)}
    if layout.point_format < FIRST_WITH_FLAGS:
        fields["raw_classification"] = ("u1", 15)
    else:
        fields |= {"classification_flags": ("u1", 15), "classification": ("u1", 16)}
    if start := PULSE_DIRECTION.get(layout.point_format):
        fields |= {"x_t": ("<f4", start), "y_t": ("<f4", start + 4), "z_t": ("<f4", start + 8)}
    formats, offsets = zip(*fields.values(), strict=True)
    return np.dtype(
        {"names": [*fields], "formats": [*formats], "offsets": [*offsets], "itemsize": layout.record_length}
    )


def read_crs(path: PathLike, layout: Layout) -> tuple[str | None, int | None]:
    """(well-known text, EPSG code)."""
    wkt, epsg = None, None
    with open(path, "rb") as file:
        for record in layout.records + layout.extended:
            if record.user != "LASF_Projection" or record.number not in (2112, 34735):
                continue
            file.seek(record.content)
            content = file.read(record.end - record.content)
            if record.number == 2112:
                wkt = content.split(b"\0")[0].decode("utf-8", "replace") or None
            else:
                epsg = _crs.epsg_of_geotiff_keys(content)
    return wkt, (_crs.epsg_of_wkt(wkt) if wkt else None) or epsg


def _read_records(
    path: PathLike, file: BinaryIO, form: struct.Struct, start: int, count: int, limit: int
) -> list[Record]:
    records = []
    limited_by = "its points begin" if form is VLR else "the file ends"
    for index in range(count):
        content = start + form.size
        size = 0
        if content <= limit:
            file.seek(start)
            user, number, size = form.unpack(file.read(form.size))
        if content + size > limit:
            fault = f"{limited_by} before variable length record {index}, which is at byte {start}, ends"
            raise FormatError(path, f"byte {limit}: {fault}")
        records.append(Record(user.split(b"\0")[0].decode("latin-1"), number, start, content, content + size))
        start = content + size
    return records


def _check(path: PathLike, layout: Layout) -> None:
    scale, offset = np.array(layout.scale), np.abs(layout.offset)
    if not ((scale > 0).all() and (scale < LARGEST_COORDINATE).all() and (offset < LARGEST_COORDINATE).all()):
        raise FormatError(path, f"byte {SCALE_AND_OFFSET}: scale {layout.scale}, offset {layout.offset}")
    if layout.point_format >= len(RECORD_LENGTHS):
        raise FormatError(path, f"byte {HEADER_SIZE + 10}: point format {layout.point_format}; LAS has 0 to 10")
    if layout.record_length < (least := RECORD_LENGTHS[layout.point_format]):
        fault = f"points of {layout.record_length} bytes; point format {layout.point_format} has at least {least}"
        raise FormatError(path, f"byte {HEADER_SIZE + 11}: {fault}")
    if not layout.compressed and layout.points_end > layout.length:
        whole = (layout.length - layout.points_start) // layout.record_length
        fault = f"the file ends after {whole} of {layout.point_count} points: cut short?"
        raise FormatError(path, f"byte {layout.length}: {fault}")
