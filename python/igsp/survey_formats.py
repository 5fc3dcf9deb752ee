"""What the command line asks of igsp.formats, see apps/igsp/foreign_formats.hpp."""

from __future__ import annotations

import os

from igsp.formats import is_supported, is_written, read_chunks, split_name, write_aligned
from igsp.formats import scan_names as scans

__all__ = ["is_supported", "moves", "read_chunks", "scans", "write_aligned"]


def moves(source: str, output: str) -> bool:
    """Whether `write_aligned` takes this source and this output: of one format, where LAS and LAZ count as one."""
    return is_written(source) and _kind(source) == _kind(output)


def _kind(path: str) -> str:
    extension = os.path.splitext(split_name(path)[0])[1].lower()
    return ".las" if extension == ".laz" else extension
