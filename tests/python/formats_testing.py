"""Survey files made from arrays, for the tests of igsp.formats."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import laspy
import lazrs
import numpy as np
import pye57
from numpy.typing import NDArray
from pye57 import libe57

Array = NDArray[Any]

UTM_ORIGIN = np.array([691_000.0, 5_334_000.0, 520.0])
WKT = 'PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",AUTHORITY["EPSG","4258"]],AUTHORITY["EPSG","25832"]]'


def motion(angle: float = 0.7, translation: tuple[float, float, float] = (1250.25, -310.5, 12.125)) -> Array:
    """A rotation by `angle` radians about a tilted axis, then a translation."""
    axis = np.array([0.2, -0.3, 0.9]) / np.linalg.norm([0.2, -0.3, 0.9])
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    matrix[:3, 3] = translation
    return matrix


def moved(matrix: Array, points: Array) -> Array:
    """p' = matrix * p, taken about the first point so that large coordinates cost nothing."""
    first = points[:1]
    return (points - first) @ matrix[:3, :3].T + (first @ matrix[:3, :3].T + matrix[:3, 3])


def random_points(count: int, seed: int = 1, extent: float = 50.0) -> Array:
    return np.random.default_rng(seed).uniform(-extent, extent, (count, 3))


def make_las(points: Array, point_format: int = 3, version: str | None = None, scale: float = 0.001) -> laspy.LasData:
    """Every dimension of the point format holds something, and so do two extra ones; no point is noise or withheld."""
    header = laspy.LasHeader(point_format=point_format, version=version)
    header.scales = np.full(3, scale)
    header.offsets = np.round(points.mean(axis=0)) if len(points) else np.zeros(3)
    header.add_extra_dims([laspy.ExtraBytesParams("deviation", np.float32), laspy.ExtraBytesParams("rings", "2u2")])
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.T
    random = np.random.default_rng(2)
    for name in las.point_format.dimension_names:
        if name in "XYZ":
            continue
        information = las.point_format.dimension_by_name(name)
        if information.kind.name == "FloatingPoint":
            las[name] = random.normal(size=len(points))
        else:
            shape = (len(points), 2) if name == "rings" else len(points)
            las[name] = random.integers(0, min(2**information.num_bits, 2**16), shape)
    las["classification"] = random.integers(0, 7, len(points))
    las["withheld"] = np.zeros(len(points), np.uint8)
    las["return_number"] = random.integers(1, 6, len(points))
    return las


def make_copc(path: Path, points: Array) -> None:
    """A COPC file of one octree node and one child: LAZ with variable chunks, whose places a hierarchy record gives."""
    halves = [np.arange(0, len(points), 2), np.arange(1, len(points), 2)]
    vlr = lazrs.LazVlr.new_for_compression(7, 0, True)
    las = copc_points(points, vlr)
    las.write(path)  # uncompressed, for its header
    content = path.read_bytes()
    start = struct.unpack_from("<I", content, 96)[0]
    with open(path, "w+b") as file:
        file.write(content[:start])
        compressor = lazrs.LasZipCompressor(file, vlr)
        compressor.compress_many(np.frombuffer(las.points.array[halves[0]].tobytes(), np.uint8))
        compressor.finish_current_chunk()
        compressor.compress_many(np.frombuffer(las.points.array[halves[1]].tobytes(), np.uint8))
        compressor.done()
        evlr_start = file.seek(0, 2)
        file.seek(start)
        sizes = [size for _, size in lazrs.read_chunk_table(file, vlr)]
        root = struct.pack("<4iQ2i", 0, 0, 0, 0, start + 8, sizes[0], len(halves[0]))
        child = struct.pack("<4iQ2i", 1, 0, 0, 0, start + 8 + sizes[0], sizes[1], len(halves[1]))
        file.seek(evlr_start)
        file.write(struct.pack("<H16sHQ32s", 0, b"copc", 1000, 64, b"hierarchy") + root + child)
        file.seek(104)
        file.write(bytes([7 | 0x80]))
        file.seek(235)
        file.write(struct.pack("<QI", evlr_start, 1))
        file.seek(375 + 54)
        cube = (*points.mean(axis=0), np.ptp(points, axis=0).max())
        file.write(struct.pack("<5d2Q2d", *cube, 1.0, evlr_start + 60, 64, 0.0, 0.0))


def copc_points(points: Array, vlr: Any) -> laspy.LasData:
    """With the records that COPC has, the first of them still to be filled; red is the index of the point."""
    header = laspy.LasHeader(point_format=7, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), np.round(points.mean(axis=0))
    header.vlrs.append(laspy.VLR("copc", 1, "info", bytes(160)))
    header.vlrs.append(laspy.VLR("laszip encoded", 22204, "", vlr.record_data()))
    header.vlrs.append(laspy.VLR("LASF_Projection", 2112, "", WKT.encode() + b"\0"))
    header.global_encoding.wkt = True
    las = laspy.LasData(header)
    las.x, las.y, las.z = points.T
    las.red = np.arange(len(points)) % 65536
    return las


def e57_attributes(points: Array, columns: int = 50) -> dict[str, Array]:
    index = np.arange(len(points))
    return {
        "cartesianX": points[:, 0],
        "cartesianY": points[:, 1],
        "cartesianZ": points[:, 2],
        "intensity": (index % 100) / 100,
        "colorRed": index % 256,
        "colorGreen": index // 2 % 256,
        "colorBlue": index // 3 % 256,
        "rowIndex": index // columns,
        "columnIndex": index % columns,
        "cartesianInvalidState": np.where(index % 7 == 3, 2, 0),
    }


def make_e57(path: Path, scans: list[tuple[dict[str, Array], Array]]) -> None:
    """Of (attributes, pose (4, 4)) for every scan."""
    with pye57.E57(str(path), "w") as file:
        for data, pose in scans:
            rotation = pye57.e57.Quaternion(matrix=pose).elements
            file.write_scan_raw(data, rotation=rotation, translation=pose[:3, 3])


def make_double_e57(path: Path, fields: dict[str, Array], extra: Any = None) -> None:
    """One scan without pose, of double precision fields; `extra(image, scan)` may add nodes before it is closed."""
    count = len(next(iter(fields.values())))
    with pye57.E57(str(path), "w") as file:
        image = file.image_file
        image.extensionsAdd("nor", "http://www.libe57.org/E57_NOR_surface_normals.txt")
        scan, prototype = libe57.StructureNode(image), libe57.StructureNode(image)
        scan.set("guid", libe57.StringNode(image, "{scan}"))
        buffers = libe57.VectorSourceDestBuffer()
        for name, values in fields.items():
            if values.dtype.kind == "f":
                prototype.set(name, libe57.FloatNode(image, 0.0, libe57.E57_DOUBLE, -1e9, 1e9))
            else:
                prototype.set(name, libe57.IntegerNode(image, 0, 0, 255))
            buffers.append(libe57.SourceDestBuffer(image, name, values, max(count, 1), True, True))
        points = libe57.CompressedVectorNode(image, prototype, libe57.VectorNode(image, True))
        scan.set("points", points)
        file.data3d.append(scan)
        if extra:
            extra(image, file)
        writer = points.writer(buffers)
        if count:
            writer.write(count)
        writer.close()


def ptx_text(scans: list[tuple[Array, Array]], columns: int, colour: bool = True) -> str:
    """Of (points (columns * rows, 3), pose) for every scan, with six decimals as scanners write them."""
    lines = []
    for points, pose in scans:
        lines += [str(columns), str(len(points) // columns)]
        for row in [pose[:3, 3], *pose[:3, :3].T]:
            lines.append(" ".join(f"{value:.6f}" for value in row))
        lines += [" ".join(f"{value:.6f}" for value in row) for row in pose.T]
        for index, (x, y, z) in enumerate(points):
            lines.append(f"{x:.6f} {y:.6f} {z:.6f} {index % 100 / 100:.6f}" + (" 10 20 30" if colour else ""))
    return "\n".join(lines) + "\n"
