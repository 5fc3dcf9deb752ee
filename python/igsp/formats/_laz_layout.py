"""What a LAZ file says of its compression, checked before lazrs sees it: that takes memory for every number it reads.

The record that describes the compression and the chunk table are those of LASzip: a signed offset to the table stands
before the first chunk (-1: in the last 8 bytes of the file), the table begins with a version and the number of chunks.
"""

from __future__ import annotations

import struct
from typing import BinaryIO

from ._cloud import FormatError, PathLike
from ._las_layout import Layout

USER, NUMBER = "laszip encoded", 22204  # of the record
RECORD = struct.Struct("<HHBBHIIqqH")  # compressor, coder, version (4 parts), options, chunk size, 2 unused, items
ITEM = struct.Struct("<HHH")  # type, bytes, version
CHUNKED = (2, 3)  # compressors of points, and of layers of points; 1, of old programs, has no chunks
TABLE = struct.Struct("<II")  # version, number of chunks


def check(path: PathLike, layout: Layout) -> None:
    """Throws FormatError unless the items make up a point and the chunks fit into the file."""
    with open(path, "rb") as file:
        _check_items(path, layout, _record(path, layout, file))
        if layout.point_count:
            _check_chunk_table(path, layout, file)


def _record(path: PathLike, layout: Layout, file: BinaryIO) -> tuple[int, bytes]:
    for record in layout.records:
        if (record.user, record.number) == (USER, NUMBER):
            file.seek(record.content)
            return record.content, file.read(record.end - record.content)
    raise FormatError(path, "its points are compressed, but no record says how")


def _check_items(path: PathLike, layout: Layout, record: tuple[int, bytes]) -> None:
    start, content = record
    if len(content) < RECORD.size:
        raise FormatError(path, f"byte {start}: a record of {len(content)} bytes cannot describe the compression")
    compressor, *_, count = RECORD.unpack_from(content)
    if compressor not in CHUNKED:
        fault = f"compressor {compressor} of LAZ is not supported: write it anew as LAS or LAZ 1.4, with PDAL or LAStools"
        raise FormatError(path, fault)
    if len(content) < RECORD.size + count * ITEM.size:
        raise FormatError(path, f"byte {start}: {count} items do not fit into the record of the compression")
    size = sum(item[1] for item in ITEM.iter_unpack(content[RECORD.size : RECORD.size + count * ITEM.size]))
    if size != layout.record_length:
        fault = f"the items of the compression have {size} bytes, a point has {layout.record_length}"
        raise FormatError(path, f"byte {start}: {fault}")


def _check_chunk_table(path: PathLike, layout: Layout, file: BinaryIO) -> None:
    first = layout.points_start + 8
    table = _number(path, layout, file, layout.points_start)
    if table == -1:
        table = _number(path, layout, file, layout.length - 8)
    if not first <= table <= layout.length - TABLE.size:
        fault = f"the table of its chunks would be at byte {table}: cut short?"
        raise FormatError(path, f"byte {layout.points_start}: {fault}")
    file.seek(table)
    _, chunks = TABLE.unpack(file.read(TABLE.size))
    if chunks > table - first:
        raise FormatError(path, f"byte {table}: {chunks} chunks do not fit into the {table - first} bytes before it")


def _number(path: PathLike, layout: Layout, file: BinaryIO, start: int) -> int:
    if start + 8 > layout.length:
        raise FormatError(path, f"byte {layout.length}: the file ends before its points begin")
    file.seek(start)
    (value,) = struct.unpack("<q", file.read(8))
    return int(value)
