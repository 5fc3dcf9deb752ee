"""PTS: text, the number of points on a line of its own, then a line x y z [intensity] [red green blue] for each.

Several such blocks may follow each other; a file without counts is read to its end.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from . import _motion
from ._atomic import atomic_output
from ._cloud import Metadata, PathLike, Points, Scan, Selection
from ._lines import Block, LineReader, as_count

LINES_AT_ONCE = 65536
FEWEST_DECIMALS = 4  # of moved coordinates, a tenth of a millimetre: turning whole metres takes more than whole metres
MOST_DECIMALS = 12
COORDINATES = re.compile(r"(\s*)\S+(\s+)\S+(\s+)\S+")


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    for _ in _blocks(path, LINES_AT_ONCE, metadata):
        pass


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    selection.require_scan(path, 1)
    for reader, _, block in _blocks(path, points_per_chunk, metadata):
        yield reader.coordinates(block)


def write_aligned(source: PathLike, output: PathLike, target_from_source: Points, selection: Selection) -> None:
    """Everything after the coordinates of a line stays as it is; the coordinates get as many decimals as the finest."""
    selection.require_scan(source, 1)
    decimals = FEWEST_DECIMALS
    for reader, _, block in _blocks(source, LINES_AT_ONCE):
        decimals = _decimals_of(reader.coordinates(block), decimals)
    with atomic_output(output) as moved:
        for reader, count_line, block in _blocks(source, LINES_AT_ONCE):
            points = _motion.apply(target_from_source, reader.coordinates(block))
            moved.write((count_line + "".join(_moved_lines(block, points, decimals))).encode("latin-1"))


def _blocks(
    path: PathLike, lines_at_once: int, metadata: Metadata | None = None
) -> Iterator[tuple[LineReader, str, Block]]:
    """(reader, text before the points, points): these texts one after the other are the whole file."""
    total = 0
    with LineReader(path) as reader:
        head = reader.take(1)
        count = _count_of(head)
        if count is None:
            parts = _uncounted(reader, head, lines_at_once)
        else:
            parts = _counted(reader, head, count, lines_at_once)
        for text, block in parts:
            total += block.filled
            yield reader, text, block
    if metadata is not None:
        metadata.scans = [Scan("scan 0", total, None)]


def _uncounted(reader: LineReader, block: Block, lines_at_once: int) -> Iterator[tuple[str, Block]]:
    if not block.filled:
        reader.fail("the file is empty: PTS begins with the number of its points", 1)
    columns = block.columns()
    text = reader.mark
    while block.lines:
        if block.filled:
            reader.require_columns(block, columns)
        yield text, block
        text, block = "", reader.take(lines_at_once)


def _counted(reader: LineReader, head: Block, count: int | None, lines_at_once: int) -> Iterator[tuple[str, Block]]:
    text, columns = reader.mark, 0
    while count is not None:
        text += "".join(head.lines)
        declared, missing = count, count
        while missing > 0:
            block = reader.take(min(missing, lines_at_once))
            missing -= block.filled
            if block.filled < lines_at_once and missing > 0:
                reader.fail(f"the file ends {missing} points too early: it may have been cut short")
            columns = columns or block.columns()
            reader.require_columns(block, columns)
            yield text, block
            text = ""
        head = reader.take(1)
        count = _count_of(head)
        if count is None and head.filled:
            reader.fail(f"more points than the {declared} that were declared")
    yield text, Block(head.first, [], 0)
    yield "".join(head.lines), Block(head.first, [], 0)


def _count_of(block: Block) -> int | None:
    return as_count("".join(block.lines))


def _decimals_of(points: Points, at_least: int) -> int:
    """The fewest decimals that say every coordinate as it was read."""
    values = points[np.isfinite(points)]
    decimals = at_least
    while decimals < MOST_DECIMALS and (np.round(values, decimals) != values).any():
        decimals += 1
    return decimals


def _moved_lines(block: Block, points: Points, decimals: int) -> Iterator[str]:
    """The lines with new coordinates; blank ones and those of points that are not finite as they are."""
    rows = iter(points.tolist())
    finite = iter(np.logical_and.reduce(np.isfinite(points), axis=1).tolist())
    for line in block.lines:
        found = COORDINATES.match(line)
        x, y, z = next(rows) if found else (0, 0, 0)
        if found and next(finite):
            a, b, c = found.groups()
            line = f"{a}{x:.{decimals}f}{b}{y:.{decimals}f}{c}{z:.{decimals}f}{line[found.end() :]}"
        yield line
