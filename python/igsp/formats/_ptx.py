"""PTX: text, one grid of points per scan with the pose of its scanner; moved by changing the poses alone.

A scan is ten lines (columns, rows, the scanner's position, its three axes, the pose as four rows that act on rows: the
last is the translation), then columns * rows lines x y z intensity [red green blue]; 0 0 0 is a cell without return.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from . import _motion
from ._atomic import atomic_output
from ._cloud import Metadata, PathLike, Points, Scan, Selection
from ._lines import Block, LineReader, as_count

HEADER_LINES = 10
VALUES_PER_LINE = (1, 1, 3, 3, 3, 3, 4, 4, 4, 4)
LINES_AT_ONCE = 65536


@dataclass(frozen=True)
class Header:
    block: Block
    count: int
    frame: Points  # (4, 3): the scanner's position, then its axes
    pose: Points  # (4, 4), file_from_scan


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    with LineReader(path) as reader:
        for header in _headers(reader):
            _add_scan(metadata, header)
            for _ in _bodies(reader, header.count, LINES_AT_ONCE):
                pass


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    metadata.pose_applied = selection.apply_pose
    with LineReader(path) as reader:
        for index, header in enumerate(_headers(reader)):
            _add_scan(metadata, header)
            metadata.current = index
            for block in _bodies(reader, header.count, points_per_chunk):
                if not selection.includes(index):
                    continue
                points = reader.coordinates(block)
                returned = (points != 0).any(axis=1)
                metadata.no_return += int(len(points) - np.count_nonzero(returned))
                points = points[returned]
                yield _motion.apply(header.pose, points) if selection.apply_pose else points
    selection.require_scan(path, len(metadata.scans))


def write_aligned(source: PathLike, output: PathLike, target_from_source: Points, selection: Selection) -> None:
    """The lines of the points stay as they are."""
    scan_count = 0
    with LineReader(source) as reader, atomic_output(output) as moved:
        moved.write(reader.mark.encode("latin-1"))
        for header in _headers(reader):
            lines = header.block.lines
            if selection.includes(scan_count):
                lines = _moved_header(header, target_from_source, selection)
            moved.write("".join(lines).encode("latin-1"))
            for block in _bodies(reader, header.count, LINES_AT_ONCE):
                reader.coordinates(block)  # a damaged source is not copied
                moved.write("".join(block.lines).encode("latin-1"))
            scan_count += 1
        selection.require_scan(source, scan_count)


def _headers(reader: LineReader) -> Iterator[Header]:
    """The header of every scan. Between two of them the caller reads the lines of the points."""
    while True:
        block = reader.take(HEADER_LINES)
        lines = list(block.numbered())
        if not lines:
            if reader.lines_read == 0 or block.first == 1:
                reader.fail("the file is empty: a PTX scan begins with ten lines of header", 1)
            return
        if len(lines) < HEADER_LINES:
            reader.fail(f"the file ends after {len(lines)} of the {HEADER_LINES} header lines of a scan")
        columns, rows = (_count(reader, number, line) for number, line in lines[:2])
        numbers = [
            _numbers(reader, number, line, expected)
            for (number, line), expected in zip(lines[2:], VALUES_PER_LINE[2:], strict=True)
        ]
        try:
            pose = _motion.as_rigid(np.array(numbers[4:]).T, "the pose")
        except ValueError as error:
            reader.fail(str(error), lines[6][0])
        yield Header(block, columns * rows, np.array(numbers[:4]), pose)


def _bodies(reader: LineReader, count: int, lines_at_once: int) -> Iterator[Block]:
    columns = 0
    while count > 0:
        block = reader.take(min(count, lines_at_once))
        count -= block.filled
        if block.filled < lines_at_once and count > 0:
            reader.fail(f"the file ends {count} points too early: it may have been cut short")
        columns = columns or block.columns()
        reader.require_columns(block, columns)
        yield block


def _add_scan(metadata: Metadata, header: Header) -> None:
    metadata.scans.append(Scan(f"scan {len(metadata.scans)}", header.count, header.pose))


def _moved_header(header: Header, target_from_source: Points, selection: Selection) -> list[str]:
    new = target_from_source @ header.pose if selection.apply_pose else target_from_source
    motion = new @ np.linalg.inv(header.pose)
    position = _motion.apply(motion, header.frame[:1])
    axes = _motion.turn(motion, header.frame[1:])
    rows = [*position, *axes, *new.T]
    lines = list(header.block.lines)
    numbered = [i for i, line in enumerate(lines) if not line.isspace()]
    for i, row in zip(numbered[2:], rows, strict=True):
        end = lines[i][len(lines[i].rstrip("\r\n")) :]
        lines[i] = " ".join(repr(float(value)) for value in row) + end
    return lines


def _count(reader: LineReader, number: int, line: str) -> int:
    count = as_count(line)
    if count is None:
        reader.fail(f"a PTX scan begins with its counts of columns and of rows, not with {line.strip()[:40]!a}", number)
    return count


def _numbers(reader: LineReader, number: int, line: str, expected: int) -> list[float]:
    values = line.split()
    if len(values) != expected:
        reader.fail(f"{len(values)} values in the header of a scan where {expected} are expected", number)
    try:
        return [float(value) for value in values]
    except ValueError as error:
        reader.fail(str(error), number)
