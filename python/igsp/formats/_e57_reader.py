"""The points of E57 files, through pye57."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _crs, _e57_file, _motion
from ._cloud import FormatError, Metadata, PathLike, Points, Selection, faults_of_package, require

CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
INVALID_STATE = {CARTESIAN: "cartesianInvalidState", SPHERICAL: "sphericalInvalidState"}


def describe(path: PathLike, layout: _e57_file.Layout, metadata: Metadata) -> None:
    elements = _e57_file.scan_elements(layout.document)
    metadata.scans = [_e57_file.describe(path, element, index) for index, element in enumerate(elements)]
    wkt = _e57_file.coordinate_metadata(layout.document)
    metadata.crs_wkt, metadata.epsg = wkt or None, _crs.epsg_of_wkt(wkt)


def read_metadata(path: PathLike, metadata: Metadata) -> None:
    describe(path, _e57_file.read_layout(path), metadata)


def read(path: PathLike, selection: Selection, metadata: Metadata, points_per_chunk: int) -> Iterator[Points]:
    libe57 = require("pye57", path, "e57").libe57
    layout = _e57_file.read_layout(path)
    describe(path, layout, metadata)
    metadata.pose_applied = selection.apply_pose
    selection.require_scan(path, len(metadata.scans))
    elements = _e57_file.scan_elements(layout.document)
    for index, scan in enumerate(metadata.scans):
        if not selection.includes(index) or scan.point_count == 0:
            continue
        reader = _ScanReader(libe57, path, index, scan.point_count, _e57_file.point_fields(elements[index]))
        pose = scan.pose if selection.apply_pose else None
        metadata.current = index
        for points, valid in reader.records(points_per_chunk):
            metadata.no_return += int(len(valid) - np.count_nonzero(valid))
            yield points[valid] if pose is None else _motion.apply(pose, points[valid])


class _ScanReader:
    """The records of one scan, in its scanner's frame."""

    def __init__(self, libe57: Any, path: PathLike, index: int, count: int, fields: set[str]) -> None:
        self.libe57, self.path, self.index, self.count = libe57, path, index, count
        self.names = CARTESIAN if fields.issuperset(CARTESIAN) else SPHERICAL
        if not fields.issuperset(self.names):
            raise FormatError(path, f"scan {index} has neither cartesian nor spherical coordinates")
        self.invalid_state = INVALID_STATE[self.names] if INVALID_STATE[self.names] in fields else None

    def records(self, capacity: int) -> Iterator[tuple[Points, NDArray[np.bool_]]]:
        """Points (N, 3), and which of them are valid (N,). Throws FormatError."""
        capacity = min(capacity, self.count)
        with faults_of_package(self.path, lambda: f"scan {self.index}"):
            image = self.libe57.ImageFile(os.fspath(self.path), "r")
            try:
                yield from self._read(image, capacity)
            finally:
                image.close()

    def _read(self, image: Any, capacity: int) -> Iterator[tuple[Points, NDArray[np.bool_]]]:
        coordinates = [np.empty(capacity) for _ in self.names]
        state = np.zeros(capacity, np.int8)
        buffers = self.libe57.VectorSourceDestBuffer()
        for name, values in zip(self.names, coordinates, strict=True):
            buffers.append(self.libe57.SourceDestBuffer(image, name, values, capacity, True, True))
        if self.invalid_state:
            buffers.append(self.libe57.SourceDestBuffer(image, self.invalid_state, state, capacity, True, True))
        reader = image.root()["data3D"][self.index]["points"].reader(buffers)
        try:
            total = 0
            while found := reader.read():
                total += found
                points = np.column_stack([values[:found] for values in coordinates])
                yield points if self.names is CARTESIAN else _from_spherical(points), state[:found] == 0
        finally:
            reader.close()
        if total != self.count:
            raise FormatError(self.path, f"scan {self.index} ends after {total} of {self.count} points")


def _from_spherical(points: Points) -> Points:
    """Of (range, azimuth, elevation in radians): azimuth from x towards y, elevation above the x-y plane."""
    distance, azimuth, elevation = points.T
    level = distance * np.cos(elevation)
    return np.column_stack([level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)])
