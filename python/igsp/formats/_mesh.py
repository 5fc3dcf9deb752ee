"""Vertices of meshes, through meshio; read only."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ._cloud import FormatError, Metadata, PathLike, Points, Scan, Selection, require, single_scan


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    metadata.scans = [Scan("scan 0", len(_vertices(path)), None)]


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    return single_scan(_vertices, path, selection, metadata, points_per_chunk)


def _vertices(path: PathLike) -> Points:
    """Each once, as the file has them; faces are not sampled."""
    extension = Path(path).suffix.lower()[1:]
    reader = getattr(require("meshio", path, "mesh"), extension)
    with open(path, "rb"):  # what the system says of a file comes before what meshio does
        pass
    try:
        vertices = np.asarray(reader.read(str(path)).points, np.float64)
    except MemoryError:
        raise
    except (Exception, SystemExit) as error:  # whatever a damaged file makes of its parser
        reason = str(error) or type(error).__name__
        fault = f"no {extension.upper()} file that meshio can read ({reason}): save the cloud as PLY"
        raise FormatError(path, fault) from error
    if vertices.ndim != 2 or vertices.shape[1] < 3:
        raise FormatError(path, f"vertices of shape {vertices.shape}; expected x, y and z: save the cloud as PLY")
    return np.ascontiguousarray(vertices[:, :3])  # colours may follow
