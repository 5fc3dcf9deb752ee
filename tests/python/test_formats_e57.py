"""E57: every scan with its pose, and files that are moved by their poses alone."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pye57
import pytest
from formats_testing import (
    UTM_ORIGIN,
    WKT,
    e57_attributes,
    make_double_e57,
    make_e57,
    motion,
    moved,
    random_points,
)
from igsp import formats
from igsp.formats import _e57_file
from pye57 import libe57

POSES = [motion(0.4, tuple(UTM_ORIGIN)), motion(-2.6, tuple(UTM_ORIGIN + [30, -20, 1.5]))]


@pytest.fixture
def two_scans(tmp_path: Path) -> Path:
    path = tmp_path / "source.e57"
    make_e57(path, [(e57_attributes(random_points(3000 + i, seed=i)), pose) for i, pose in enumerate(POSES)])
    return path


def raw_scans(path: Path) -> list[dict[str, np.ndarray]]:
    with pye57.E57(str(path)) as file:
        return [file.read_scan_raw(index) for index in range(file.scan_count)]


def local_points(raw: dict[str, np.ndarray]) -> np.ndarray:
    points = np.column_stack([raw[f"cartesian{axis}"] for axis in "XYZ"])
    return points[raw["cartesianInvalidState"] == 0]


def header_of(path: Path) -> tuple[int, ...]:
    return struct.unpack("<8s2I4Q", path.read_bytes()[:48])[3:]


def test_all_scans_are_read_with_their_poses(two_scans: Path) -> None:
    cloud = formats.read_cloud(two_scans)
    local = [local_points(raw) for raw in raw_scans(two_scans)]
    expected = np.concatenate([moved(pose, points) for pose, points in zip(POSES, local, strict=True)])
    np.testing.assert_allclose(cloud.points, expected, rtol=0, atol=1e-8)
    assert cloud.format == "e57" and cloud.dropped == 0
    assert cloud.metadata.pose_applied
    assert cloud.metadata.no_return == 6001 - len(expected) > 800
    assert [(scan.name, scan.point_count) for scan in cloud.metadata.scans] == [("Scan 0", 3000), ("Scan 1", 3001)]
    for scan, pose in zip(cloud.metadata.scans, POSES, strict=True):
        np.testing.assert_allclose(scan.pose, pose, rtol=0, atol=1e-9)


@pytest.mark.parametrize("index", [0, 1])
def test_one_scan_in_the_frame_of_its_scanner(two_scans: Path, index: int) -> None:
    cloud = formats.read_cloud(two_scans, scan=index, apply_pose=False)
    np.testing.assert_array_equal(cloud.points, local_points(raw_scans(two_scans)[index]))
    assert not cloud.metadata.pose_applied and len(cloud.metadata.scans) == 2


@pytest.mark.parametrize("index", [-1, 2])
def test_scan_that_is_not_there(two_scans: Path, tmp_path: Path, index: int) -> None:
    with pytest.raises(ValueError, match=rf"scan: .*source\.e57 has no scan {index}; its scans: 0 to 1"):
        formats.read_cloud(two_scans, scan=index)
    with pytest.raises(ValueError, match="has no scan"):
        formats.write_aligned(two_scans, tmp_path / "aligned.e57", motion(), scan=index)


def test_aligned_file_differs_in_its_poses_alone(two_scans: Path, tmp_path: Path) -> None:
    output = tmp_path / "aligned.e57"
    formats.write_aligned(two_scans, output, motion())
    for before, after in zip(raw_scans(two_scans), raw_scans(output), strict=True):
        assert before.keys() == after.keys() >= {"intensity", "colorRed", "rowIndex", "columnIndex"}
        for name in before:
            np.testing.assert_array_equal(before[name], after[name])
    before_points, after_points = (formats.read_cloud(path).points for path in (two_scans, output))
    np.testing.assert_allclose(after_points, moved(motion(), before_points), rtol=0, atol=1e-8)

    sections = header_of(output)[1] // 1024 * 1024  # the points come before the XML section
    assert header_of(output)[1] == header_of(two_scans)[1]
    assert output.read_bytes()[1024:sections] == two_scans.read_bytes()[1024:sections]
    assert header_of(output)[0] == len(output.read_bytes())
    texts = [_e57_file.read_layout(path).document for path in (two_scans, output)]
    for document in texts:
        for scan in _e57_file.scan_elements(document):
            scan.removeChild(_e57_file.child(scan, "pose"))
    assert texts[0].toxml().split() == texts[1].toxml().split()


def test_one_scan_moves_the_other_stays(two_scans: Path, tmp_path: Path) -> None:
    output = tmp_path / "aligned.e57"
    formats.write_aligned(two_scans, output, motion(), scan=1)
    first, second = formats.read_metadata(output).scans
    np.testing.assert_allclose(first.pose, POSES[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(second.pose, motion() @ POSES[1], rtol=0, atol=1e-8)


def test_result_for_points_without_pose_becomes_the_pose(two_scans: Path, tmp_path: Path) -> None:
    output = tmp_path / "aligned.e57"
    formats.write_aligned(two_scans, output, motion(), scan=0, apply_pose=False)
    local = formats.read_cloud(two_scans, scan=0, apply_pose=False).points
    np.testing.assert_allclose(formats.read_cloud(output, scan=0).points, moved(motion(), local), rtol=0, atol=1e-9)


def test_spherical_double_precision_scan_without_pose(tmp_path: Path) -> None:
    source, output = tmp_path / "source.e57", tmp_path / "aligned.e57"
    points = random_points(500)
    distance = np.linalg.norm(points, axis=1)
    fields = {
        "sphericalRange": distance,
        "sphericalAzimuth": np.arctan2(points[:, 1], points[:, 0]),
        "sphericalElevation": np.arcsin(points[:, 2] / distance),
        "sphericalInvalidState": (np.arange(500) % 5 == 0).astype(np.uint8),
    }
    make_double_e57(source, fields)
    valid = points[np.arange(500) % 5 != 0]
    cloud = formats.read_cloud(source)
    np.testing.assert_allclose(cloud.points, valid, rtol=0, atol=1e-12)
    assert cloud.metadata.scans[0].pose is None and cloud.metadata.no_return == 100
    formats.write_aligned(source, output, motion())
    np.testing.assert_allclose(formats.read_cloud(output).points, moved(motion(), valid), rtol=0, atol=1e-11)


def test_fields_unknown_to_the_reader_are_kept(tmp_path: Path) -> None:
    points = random_points(300)
    fields = {f"cartesian{axis}": points[:, i].copy() for i, axis in enumerate("XYZ")}
    fields |= {"nor:normalX": np.arange(300.0), "isIntensityInvalid": (np.arange(300) % 2).astype(np.uint8)}
    source, output = tmp_path / "source.e57", tmp_path / "aligned.e57"
    make_double_e57(source, fields)
    formats.write_aligned(source, output, motion())
    np.testing.assert_allclose(formats.read_cloud(output).points, moved(motion(), points), rtol=0, atol=1e-12)
    image = libe57.ImageFile(str(output), "r")
    normals, flags = np.empty(300), np.empty(300, np.uint8)
    buffers = libe57.VectorSourceDestBuffer()
    buffers.append(libe57.SourceDestBuffer(image, "nor:normalX", normals, 300, True, True))
    buffers.append(libe57.SourceDestBuffer(image, "isIntensityInvalid", flags, 300, True, True))
    reader = image.root()["data3D"][0]["points"].reader(buffers)
    assert reader.read() == 300
    reader.close()
    image.close()
    np.testing.assert_array_equal(normals, fields["nor:normalX"])
    np.testing.assert_array_equal(flags, fields["isIntensityInvalid"])


def pose_node(image: Any, pose: np.ndarray) -> Any:
    node, rotation, translation = (libe57.StructureNode(image) for _ in range(3))
    for name, value in zip("wxyz", pye57.e57.Quaternion(matrix=pose).elements, strict=True):
        rotation.set(name, libe57.FloatNode(image, value))
    for name, value in zip("xyz", pose[:3, 3], strict=True):
        translation.set(name, libe57.FloatNode(image, value))
    node.set("rotation", rotation)
    node.set("translation", translation)
    return node


def add_pictures(image: Any, file: pye57.E57) -> None:
    """One that names the scan, which gets a pose, and one that does not."""
    file.data3d[0].set("pose", pose_node(image, motion(0.3)))
    for guid, x in (("{scan}", 1.0), ("", 2.0)):
        picture = libe57.StructureNode(image)
        picture.set("pose", pose_node(image, motion(0, (x, 0.0, 0.0))))
        if guid:
            picture.set("associatedData3DGuid", libe57.StringNode(image, guid))
        file.root["images2D"].append(picture)


def picture_positions(path: Path) -> list[np.ndarray]:
    elements = _e57_file.image_elements(_e57_file.read_layout(path).document)
    return [_e57_file.pose_of_image(path, element, index)[:3, 3] for index, element in enumerate(elements)]


def test_pictures_move_with_their_scan(tmp_path: Path) -> None:
    points = random_points(10)
    fields = {f"cartesian{axis}": points[:, i].copy() for i, axis in enumerate("XYZ")}
    source, whole, one = (tmp_path / f"{name}.e57" for name in ("source", "whole", "one"))
    make_double_e57(source, fields, add_pictures)
    before = picture_positions(source)
    np.testing.assert_array_equal(before, [[1, 0, 0], [2, 0, 0]])
    formats.write_aligned(source, whole, motion())
    np.testing.assert_allclose(picture_positions(whole), moved(motion(), np.array(before)), rtol=0, atol=1e-12)
    formats.write_aligned(source, one, motion(), scan=0)  # what belongs to no scan stays
    np.testing.assert_allclose(picture_positions(one)[0], picture_positions(whole)[0], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(picture_positions(one)[1], [2, 0, 0])


def rebuild(path: Path, old: bytes, new: bytes, trailing_pages: int = 0) -> None:
    """Replaces text in the XML section, and puts pages after it."""
    layout = _e57_file.read_layout(path)
    content = path.read_bytes()
    payload = b"".join(content[i : i + 1020] for i in range(0, len(content), 1024))
    xml = payload[layout.xml_start : layout.xml_end].replace(old, new)
    body = payload[: layout.xml_start] + xml
    pages = _e57_file.make_pages(body + bytes(-len(body) % 1020) + b"t" * 1020 * trailing_pages)
    header = bytearray(pages[0, :1020].tobytes())
    struct.pack_into("<Q", header, 16, pages.size)
    struct.pack_into("<Q", header, 32, len(xml))
    pages[0] = _e57_file.make_pages(bytes(header))[0]
    path.write_bytes(pages.tobytes())


def test_sections_after_the_description_are_kept(two_scans: Path, tmp_path: Path) -> None:
    rebuild(two_scans, b"", b"", trailing_pages=3)
    output = tmp_path / "aligned.e57"
    formats.write_aligned(two_scans, output, motion())
    before, after = two_scans.read_bytes(), output.read_bytes()
    assert after[1024 : len(before)] == before[1024:]
    assert header_of(output)[1] == len(before)
    expected = moved(motion(), formats.read_cloud(two_scans).points)
    np.testing.assert_allclose(formats.read_cloud(output).points, expected, rtol=0, atol=1e-8)


def test_coordinate_system(two_scans: Path, tmp_path: Path) -> None:
    text = f'<coordinateMetadata type="String"><![CDATA[{WKT}]]></coordinateMetadata>'.encode()
    rebuild(two_scans, b'<coordinateMetadata type="String"/>', text)
    formats.write_aligned(two_scans, tmp_path / "aligned.e57", motion())
    for path in (two_scans, tmp_path / "aligned.e57"):
        metadata = formats.read_cloud(path).metadata
        assert (metadata.crs_wkt, metadata.epsg) == (WKT, 25832)


def test_pose_that_is_no_motion(two_scans: Path) -> None:
    rebuild(two_scans, b'<w type="Float">', b'<w type="Float">7')
    with pytest.raises(formats.FormatError, match=r"source\.e57: scan 0: its pose is not a rigid motion"):
        formats.read_cloud(two_scans)


def test_pose_of_a_picture_that_is_no_motion(tmp_path: Path) -> None:
    points = random_points(10)
    fields = {f"cartesian{axis}": points[:, i].copy() for i, axis in enumerate("XYZ")}
    make_double_e57(tmp_path / "source.e57", fields, add_pictures)
    document = _e57_file.read_layout(tmp_path / "source.e57").document
    pictures = document.toxml().split("images2D")[1]
    number = pictures.split('<w type="Float">')[1].split("</w>")[0]
    for wrong in ("seven", "7"):
        source = tmp_path / f"{wrong}.e57"
        source.write_bytes((tmp_path / "source.e57").read_bytes())
        rebuild(source, f'<w type="Float">{number}</w>'.encode(), f'<w type="Float">{wrong}</w>'.encode())
        with pytest.raises(formats.FormatError, match="image 0: "):
            formats.write_aligned(source, tmp_path / "aligned.e57", motion())


def test_fewer_than_no_points(two_scans: Path) -> None:
    rebuild(two_scans, b'recordCount="3000"', b'recordCount="-300"')
    with pytest.raises(formats.FormatError, match=r"source\.e57: scan 0: it claims -300 points"):
        formats.read_cloud(two_scans)


def test_entities_that_grow_are_refused(two_scans: Path) -> None:
    """A few hundred bytes that would be gigabytes: the parser's limit is an error of the file."""
    levels = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 11))
    rebuild(two_scans, b"?>", f'?><!DOCTYPE e57Root [<!ENTITY e0 "{"x" * 100}">{levels}]>'.encode())
    rebuild(two_scans, b'<coordinateMetadata type="String"/>', b"<coordinateMetadata>&e10;</coordinateMetadata>")
    with pytest.raises(formats.FormatError, match=r"source\.e57: byte \d+: XML section: "):
        formats.read_metadata(two_scans)


@pytest.mark.parametrize(("old", "new"), [(b"UTF-8", b"UTF-9"), (b"</pose>", b"</nose>")])
def test_description_that_is_no_xml(two_scans: Path, old: bytes, new: bytes) -> None:
    rebuild(two_scans, old, new)
    with pytest.raises(formats.FormatError, match=r"source\.e57: byte \d+: XML section: "):
        formats.read_metadata(two_scans)


def test_fewer_points_than_declared(two_scans: Path) -> None:
    rebuild(two_scans, b'recordCount="3000"', b'recordCount="3500"')
    with pytest.raises(formats.FormatError, match=r"source\.e57: scan 0"):
        formats.read_cloud(two_scans)


def test_longer_than_declared(two_scans: Path, tmp_path: Path) -> None:
    length = two_scans.stat().st_size
    two_scans.write_bytes(two_scans.read_bytes() + bytes(1024))
    for action in (
        lambda: formats.read_cloud(two_scans),
        lambda: formats.write_aligned(two_scans, tmp_path / "aligned.e57", motion()),
    ):
        with pytest.raises(formats.FormatError, match=f"the file ends here, its header says at {length}"):
            action()


def test_no_points_and_no_scans(tmp_path: Path) -> None:
    empty = np.empty(0)
    make_double_e57(tmp_path / "points.e57", {f"cartesian{axis}": empty for axis in "XYZ"})
    make_e57(tmp_path / "scans.e57", [])
    for name in ("points", "scans"):
        assert formats.read_cloud(tmp_path / f"{name}.e57").points.shape == (0, 3)
        formats.write_aligned(tmp_path / f"{name}.e57", tmp_path / "aligned.e57", motion())
        assert formats.read_cloud(tmp_path / "aligned.e57").points.shape == (0, 3)


def test_scan_without_coordinates(tmp_path: Path) -> None:
    make_double_e57(tmp_path / "source.e57", {"timeStamp": np.arange(3.0)})
    with pytest.raises(formats.FormatError, match="scan 0 has neither cartesian nor spherical coordinates"):
        formats.read_cloud(tmp_path / "source.e57")


def test_damage_is_found_by_the_checksums(two_scans: Path, tmp_path: Path) -> None:
    content = bytearray(two_scans.read_bytes())
    content[5 * 1024 + 17] ^= 1
    two_scans.write_bytes(content)
    with pytest.raises(formats.FormatError, match=r"source\.e57: scan 0: checksum mismatch"):
        formats.read_cloud(two_scans)
    with pytest.raises(formats.FormatError, match=r"source\.e57: byte 5120: wrong checksum"):
        formats.write_aligned(two_scans, tmp_path / "aligned.e57", motion())
    assert sorted(path.name for path in tmp_path.iterdir()) == ["source.e57"]
