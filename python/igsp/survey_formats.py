"""What the command line asks of igsp.formats, see apps/igsp/foreign_formats.hpp."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator

from igsp.formats import (
    _las_points,
    is_supported,
    is_written,
    read_chunks,
    split_name,
    write_aligned,
    write_chunks,
)
from igsp.formats import scan_names as scans
from igsp.formats._cloud import Points

__all__ = ["is_supported", "moves", "read_chunks", "scans", "write_aligned", "write_points", "writes_points"]


def moves(source: str, output: str) -> bool:
    """Whether `write_aligned` takes this source and this output: of one format, where LAS and LAZ count as one."""
    return is_written(source) and _kind(source) == _kind(output)


def writes_points(path: str) -> bool:
    """Whether `write_points` takes this name. Raises what it would raise over the name or a missing package."""
    if _kind(path) != ".las":
        return False
    _las_points.record_writer(path)
    return True


def write_points(path: str, next_chunk: Callable[[], Points], offset: tuple[float, float, float], scale: float) -> None:
    """Of chunks until one is empty."""
    write_chunks(path, _until_empty(next_chunk), scale=scale, offset=offset)


def _until_empty(next_chunk: Callable[[], Points]) -> Iterator[Points]:
    while len(points := next_chunk()):
        yield points


def _kind(path: str) -> str:
    extension = os.path.splitext(split_name(path)[0])[1].lower()
    return ".las" if extension == ".laz" else extension
