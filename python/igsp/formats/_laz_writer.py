"""Point records on their way into a LAS file, compressed if its name ends in .laz."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, BinaryIO

import numpy as np

from . import _las_layout, _laz_layout
from ._cloud import FormatError, PathLike, require


class RecordWriter:
    """Of the file at `path`. Throws MissingPackageError where it would be compressed and nothing here can do it."""

    def __init__(self, path: PathLike, point_format: int, record_length: int) -> None:
        name = str(path).lower()
        if name.endswith(".copc.laz"):
            raise FormatError(path, "COPC cannot be written: name it .laz, which keeps all but the octree")
        self.description = b""  # the variable length record that describes the compression
        self.format_byte = point_format
        self._lazrs = None
        if not name.endswith(".laz"):
            return
        if point_format in _las_layout.PULSE_DIRECTION:
            # lazrs 0.8 garbles the wave packets of formats 9 and 10, and LASzip refuses what it makes of 4 and 5.
            fault = f"point format {point_format} with its waveforms cannot be compressed: name it .las"
            raise FormatError(path, fault)
        self._lazrs = require("lazrs", path, "las")
        extra_bytes = record_length - _las_layout.RECORD_LENGTHS[point_format]
        self._laszip = self._lazrs.LazVlr.new_for_compression(point_format, extra_bytes)
        data = self._laszip.record_data()
        head = _las_layout.VLR_FULL.pack(0, _laz_layout.USER.encode(), _laz_layout.NUMBER, len(data), b"by igsp")
        self.description = head + data
        self.format_byte |= _las_layout.COMPRESSED

    def write(self, file: BinaryIO, chunks: Iterable[Any]) -> None:
        """All points of the file, from where it stands now; in memory of a chunk."""
        if self._lazrs is None:
            for records in chunks:
                file.write(records.tobytes())
            return
        compressor = self._lazrs.ParLasZipCompressor(file, self._laszip)
        for records in chunks:
            compressor.compress_many(np.frombuffer(records.tobytes(), np.uint8))
        compressor.done()
