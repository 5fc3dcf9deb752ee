"""LAS, LAZ and COPC: what is read, and what an aligned file keeps."""

from __future__ import annotations

import struct
from pathlib import Path

import laspy
import numpy as np
import pytest
from formats_testing import UTM_ORIGIN, WKT, make_copc, make_las, motion, moved, random_points
from igsp import formats

WAVEFORM_FORMATS = (4, 5, 9, 10)


def attributes_of(las: laspy.LasData) -> dict[str, np.ndarray]:
    return {name: np.array(las[name]) for name in las.point_format.dimension_names if name not in "XYZ"}


def assert_same_attributes(actual: laspy.LasData, expected: laspy.LasData, turned: tuple[str, ...] = ()) -> None:
    want = attributes_of(expected)
    assert attributes_of(actual).keys() == want.keys()
    for name, values in attributes_of(actual).items():
        if name not in turned:
            np.testing.assert_array_equal(values, want[name], err_msg=name)


def assert_valid_header(path: Path) -> None:
    las = laspy.read(path)
    points = np.column_stack([las.x, las.y, las.z])
    np.testing.assert_allclose(las.header.mins, points.min(axis=0), rtol=0, atol=1e-9)
    np.testing.assert_allclose(las.header.maxs, points.max(axis=0), rtol=0, atol=1e-9)
    returns = [int(np.sum(las["return_number"] == number)) for number in range(1, 6)]
    assert list(las.header.number_of_points_by_return[:5]) == returns


@pytest.mark.parametrize(
    ("point_format", "extension"),
    [(number, extension) for number in range(11) for extension in ("las", "laz")],
)
def test_every_point_format_keeps_every_attribute(tmp_path: Path, point_format: int, extension: str) -> None:
    points = random_points(1500) + UTM_ORIGIN
    source, output = tmp_path / f"source.{extension}", tmp_path / f"aligned.{extension}"
    if point_format in WAVEFORM_FORMATS:
        output = output.with_suffix(".las")
    make_las(points, point_format).write(source)
    cloud = formats.read_cloud(source)
    assert cloud.format == extension
    assert cloud.points.dtype == np.float64
    np.testing.assert_allclose(cloud.points, points, rtol=0, atol=0.5001e-3)

    formats.write_aligned(source, output, motion())
    aligned = formats.read_cloud(output)
    np.testing.assert_allclose(aligned.points, moved(motion(), cloud.points), rtol=0, atol=0.5001e-3)
    assert aligned.metadata.scale == (0.001, 0.001, 0.001)
    pulse = ("x_t", "y_t", "z_t") if point_format in WAVEFORM_FORMATS else ()
    assert_same_attributes(laspy.read(output), laspy.read(source), pulse)
    assert_valid_header(output)


@pytest.mark.parametrize("point_format", [4, 10])
def test_direction_of_the_waveform_turns_with_the_points(tmp_path: Path, point_format: int) -> None:
    make_las(random_points(100), point_format).write(tmp_path / "source.las")
    formats.write_aligned(tmp_path / "source.las", tmp_path / "aligned.las", motion())
    before, after = (laspy.read(tmp_path / f"{name}.las") for name in ("source", "aligned"))
    pulse = np.column_stack([before["x_t"], before["y_t"], before["z_t"]])
    turned = np.column_stack([after["x_t"], after["y_t"], after["z_t"]])
    np.testing.assert_allclose(turned, pulse @ motion()[:3, :3].T, rtol=0, atol=1e-6)


@pytest.mark.parametrize("version", ["1.0", "1.1", "1.2", "1.3", "1.4"])
def test_bytes_that_do_not_depend_on_the_coordinates_stay(tmp_path: Path, version: str) -> None:
    las = make_las(random_points(200) + UTM_ORIGIN, 1, max(version, "1.1"))
    las.header.vlrs.append(laspy.VLR("surveyor", 77, "field book", bytes(range(256))))
    las.header.extra_header_bytes = b"header of the instrument"
    las.header.extra_vlr_bytes = b"gap before the points"
    las.header.system_identifier, las.header.generating_software = "SCANNER 9", "office"
    if version == "1.4":
        las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("surveyor", 78, "", b"e" * 1000)])
    source, output = tmp_path / "source.las", tmp_path / "aligned.las"
    las.write(source)
    content = bytearray(source.read_bytes())
    content[25] = int(version[-1])
    source.write_bytes(content)
    formats.write_aligned(source, output, motion())
    assert formats.read_cloud(output).points.shape == (200, 3)
    before, after = bytearray(source.read_bytes()), bytearray(output.read_bytes())
    assert len(before) == len(after)
    start, length = struct.unpack_from("<I", before, 96)[0], las.point_format.size
    for content in (before, after):
        content[131:227] = bytes(96)  # scale, offset, bounds
        for index in range(200):
            content[start + index * length : start + index * length + 12] = bytes(12)  # the coordinates
    assert before == after


def test_translation_is_lossless(tmp_path: Path) -> None:
    make_las(random_points(500) + UTM_ORIGIN).write(tmp_path / "source.laz")
    matrix = motion(angle=0, translation=(0.12345678, -1e6, 3.3))
    formats.write_aligned(tmp_path / "source.laz", tmp_path / "aligned.laz", matrix)
    before, after = (laspy.read(tmp_path / f"{name}.laz") for name in ("source", "aligned"))
    for axis in "XYZ":
        np.testing.assert_array_equal(before[axis], after[axis])
    np.testing.assert_allclose(after.header.offsets, before.header.offsets + matrix[:3, 3], rtol=0, atol=1e-9)


def test_back_and_forth_stays_within_the_resolution(tmp_path: Path) -> None:
    make_las(random_points(500) + UTM_ORIGIN).write(tmp_path / "a.las")
    formats.write_aligned(tmp_path / "a.las", tmp_path / "b.las", motion(2.5))
    formats.write_aligned(tmp_path / "b.las", tmp_path / "c.las", np.linalg.inv(motion(2.5)))
    error = formats.read_cloud(tmp_path / "c.las").points - formats.read_cloud(tmp_path / "a.las").points
    assert np.abs(error).max() < 2e-3


def test_local_scan_moves_far_from_its_offset(tmp_path: Path) -> None:
    """With the source's offset of zero, UTM coordinates at a hundredth of a millimetre would not fit into 32 bits."""
    make_las(random_points(300), scale=1e-5).write(tmp_path / "source.las")
    matrix = motion(translation=tuple(UTM_ORIGIN))
    formats.write_aligned(tmp_path / "source.las", tmp_path / "aligned.las", matrix)
    cloud = formats.read_cloud(tmp_path / "aligned.las")
    expected = moved(matrix, formats.read_cloud(tmp_path / "source.las").points)
    np.testing.assert_allclose(cloud.points, expected, rtol=0, atol=0.51e-5)
    assert cloud.metadata.scale == (1e-5, 1e-5, 1e-5)


def test_range_of_32_bits_left_by_turning(tmp_path: Path) -> None:
    """The corners of a cube that fills the range: turned, they need the next coarser scale; one corner moves out."""
    corner = 2.1e9
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * corner * 1e-7
    make_las(corners, scale=1e-7).write(tmp_path / "source.las")
    quarter = motion(np.pi / 4)
    formats.write_aligned(tmp_path / "source.las", tmp_path / "aligned.las", quarter)
    cloud = formats.read_cloud(tmp_path / "aligned.las")
    np.testing.assert_allclose(cloud.points, moved(quarter, corners), rtol=0, atol=1e-6)
    assert set(np.round(np.log10(cloud.metadata.scale))) <= {-7, -6}
    assert max(cloud.metadata.scale) > 5e-7
    assert_valid_header(tmp_path / "aligned.las")


def test_offset_far_from_the_points_is_centred_before_resolution_is_given_up(tmp_path: Path) -> None:
    las = make_las(random_points(50, extent=5), scale=1e-6)
    las.change_scaling(offsets=np.array([2100.0, 2100.0, 2100.0]))
    las.write(tmp_path / "source.las")
    formats.write_aligned(tmp_path / "source.las", tmp_path / "aligned.las", motion(np.pi / 2))
    cloud = formats.read_cloud(tmp_path / "aligned.las")
    assert cloud.metadata.scale == (1e-6, 1e-6, 1e-6)
    expected = moved(motion(np.pi / 2), formats.read_cloud(tmp_path / "source.las").points)
    np.testing.assert_allclose(cloud.points, expected, rtol=0, atol=0.51e-6)


def test_axes_of_different_scale(tmp_path: Path) -> None:
    """A turn about z leaves z its scale, a tilt gives all axes the finest."""
    las = make_las(random_points(50))
    las.change_scaling(scales=np.array([0.01, 0.01, 0.001]))
    las.write(tmp_path / "source.las")
    about_z = np.eye(4)
    about_z[:2, :2] = [[0.6, -0.8], [0.8, 0.6]]
    formats.write_aligned(tmp_path / "source.las", tmp_path / "level.las", about_z)
    formats.write_aligned(tmp_path / "source.las", tmp_path / "tilted.las", motion())
    assert formats.read_metadata(tmp_path / "level.las").scale == (0.01, 0.01, 0.001)
    assert formats.read_metadata(tmp_path / "tilted.las").scale == (0.001, 0.001, 0.001)


@pytest.mark.parametrize(("first", "second"), [("las", "laz"), ("laz", "las"), ("las", "LAZ")])
def test_las_and_laz_turn_into_each_other(tmp_path: Path, first: str, second: str) -> None:
    las = make_las(random_points(300), 7)
    las.header.vlrs.append(laspy.VLR("surveyor", 77, "field book", b"abc"))
    las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("surveyor", 78, "", b"e" * 1000)])
    source, output = tmp_path / f"source.{first}", tmp_path / f"aligned.{second}"
    las.write(source)
    formats.write_aligned(source, output, motion())
    after = laspy.read(output)
    assert_same_attributes(after, laspy.read(source))
    assert after.header.are_points_compressed == (second.lower() == "laz")
    assert [vlr.record_data for vlr in after.vlrs if vlr.user_id == "surveyor"] == [b"abc"]
    assert [evlr.record_data for evlr in after.evlrs] == [b"e" * 1000]
    assert formats.read_cloud(output).format == second.lower()
    assert_valid_header(output)


@pytest.mark.parametrize("point_format", WAVEFORM_FORMATS)
def test_waveforms_are_not_compressed(tmp_path: Path, point_format: int) -> None:
    make_las(random_points(10), point_format).write(tmp_path / "source.laz")
    with pytest.raises(formats.FormatError, match=r"aligned\.laz: point format \d+ with its waveforms .* \.las$"):
        formats.write_aligned(tmp_path / "source.laz", tmp_path / "aligned.laz", motion())


@pytest.mark.parametrize("extension", ["las", "laz"])
def test_waveforms_inside_the_file_are_found_again(tmp_path: Path, extension: str) -> None:
    las = make_las(random_points(300), 9)
    records = [laspy.VLR("other", 1, "", b"o" * 99), laspy.VLR("LASF_Spec", 65535, "", b"w" * 500)]
    las.evlrs = laspy.vlrs.vlrlist.VLRList(records)
    source, output = tmp_path / f"source.{extension}", tmp_path / "aligned.las"
    las.write(source)
    content = bytearray(source.read_bytes())
    struct.pack_into("<Q", content, 227, content.index(b"w" * 500) - 60)
    source.write_bytes(content)
    formats.write_aligned(source, output, motion())
    after = output.read_bytes()
    assert struct.unpack_from("<Q", after, 227)[0] == after.index(b"w" * 500) - 60


def test_coordinate_system_as_text(tmp_path: Path) -> None:
    las = make_las(random_points(10) + UTM_ORIGIN, 6)
    las.header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(WKT))
    las.header.global_encoding.wkt = True
    las.write(tmp_path / "source.laz")
    formats.write_aligned(tmp_path / "source.laz", tmp_path / "aligned.laz", motion())
    for name in ("source", "aligned"):
        metadata = formats.read_metadata(tmp_path / f"{name}.laz")
        assert (metadata.crs_wkt, metadata.epsg) == (WKT, 25832)
    assert laspy.open(tmp_path / "aligned.laz").header.global_encoding.wkt


def test_coordinate_system_as_geotiff_keys(tmp_path: Path) -> None:
    las = make_las(random_points(10) + UTM_ORIGIN, 3)
    keys = struct.pack("<16H", 1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 25832, 4096, 0, 1, 5783)
    las.header.vlrs.append(laspy.VLR("LASF_Projection", 34735, "", keys))
    las.write(tmp_path / "source.las")
    formats.write_aligned(tmp_path / "source.las", tmp_path / "aligned.las", motion())
    metadata = formats.read_metadata(tmp_path / "aligned.las")
    assert (metadata.crs_wkt, metadata.epsg) == (None, 25832)


@pytest.mark.parametrize("extension", ["las", "laz"])
@pytest.mark.parametrize("point_format", [3, 6])
def test_no_points(tmp_path: Path, extension: str, point_format: int) -> None:
    source, output = tmp_path / f"source.{extension}", tmp_path / f"aligned.{extension}"
    make_las(np.empty((0, 3)), point_format).write(source)
    assert formats.read_cloud(source).points.shape == (0, 3)
    formats.write_aligned(source, output, motion())
    assert formats.read_cloud(output).points.shape == (0, 3)
    assert laspy.read(output).header.maxs.tolist() == [0, 0, 0]


def test_copc_is_read_as_laz_and_written_without_its_octree(tmp_path: Path) -> None:
    points = random_points(4000) + UTM_ORIGIN
    source = tmp_path / "source.copc.laz"
    make_copc(source, points)
    with laspy.CopcReader.open(source) as reader:  # it is COPC
        assert len(reader.query()) == 4000
    cloud = formats.read_cloud(source)
    assert (cloud.format, cloud.metadata.epsg) == ("copc", 25832)
    order = np.concatenate([np.arange(0, 4000, 2), np.arange(1, 4000, 2)])
    np.testing.assert_allclose(cloud.points, points[order], rtol=0, atol=0.51e-3)

    formats.write_aligned(source, tmp_path / "aligned.laz", motion())
    aligned = formats.read_cloud(tmp_path / "aligned.laz")
    assert aligned.format == "laz"
    np.testing.assert_allclose(aligned.points, moved(motion(), cloud.points), rtol=0, atol=0.51e-3)
    after = laspy.read(tmp_path / "aligned.laz")
    np.testing.assert_array_equal(after.red, order)
    assert [vlr.user_id for vlr in after.vlrs] == ["LASF_Projection"] and not after.evlrs


def test_copc_cannot_be_written(tmp_path: Path) -> None:
    make_copc(tmp_path / "source.copc.laz", random_points(100))
    with pytest.raises(formats.FormatError, match=r"aligned\.copc\.laz: COPC cannot be written: name it \.laz"):
        formats.write_aligned(tmp_path / "source.copc.laz", tmp_path / "aligned.copc.laz", motion())
    assert not (tmp_path / "aligned.copc.laz").exists()


@pytest.mark.parametrize("extension", ["las", "laz"])
@pytest.mark.parametrize("point_format", [1, 6])
def test_noise_and_withheld_points_are_left_out_unless_asked_for(
    tmp_path: Path, point_format: int, extension: str
) -> None:
    points = random_points(100)
    source, aligned = tmp_path / f"source.{extension}", tmp_path / f"aligned.{extension}"
    las = make_las(points, point_format)
    classes = np.array(las["classification"])
    classes[:10], classes[10:15] = 7, 18
    las["classification"] = classes
    withheld = np.zeros(100, np.uint8)
    withheld[12:20] = 1
    las["withheld"] = withheld
    las["synthetic"] = np.ones(100, np.uint8)  # another flag, which says nothing of the kind
    las.write(source)
    cloud = formats.read_cloud(source)
    np.testing.assert_allclose(cloud.points, points[20:], rtol=0, atol=0.5001e-3)
    assert cloud.metadata.noise == 20
    assert cloud.note.startswith("left out 20 points that are classified as noise (7, 18) or withheld; ")
    assert sum(map(len, formats.read_chunks(source, 7))) == 80
    kept = formats.read_cloud(source, keep_noise=True)
    assert len(kept.points) == 100 and kept.metadata.noise == 0 and kept.note == ""
    formats.write_aligned(source, aligned, motion())  # which keeps all that the source holds
    assert_same_attributes(laspy.read(aligned), laspy.read(source))
    assert formats.read_cloud(aligned).metadata.noise == 20


@pytest.mark.parametrize("name", ["points.las", "points.LAZ"])
def test_points_alone_in_chunks(tmp_path: Path, name: str) -> None:
    points = random_points(120_000) + UTM_ORIGIN
    chunks = (points[start : start + 50_000] for start in range(0, len(points), 50_000))
    formats.write_chunks(tmp_path / name, chunks, scale=[0.001, 0.001, 0.01], offset=UTM_ORIGIN)
    cloud = formats.read_cloud(tmp_path / name)
    assert cloud.format == name[-3:].lower() and cloud.metadata.scale == (0.001, 0.001, 0.01)
    assert (np.abs(cloud.points - points).max(axis=0) < [0.5001e-3, 0.5001e-3, 0.5001e-2]).all()
    assert_valid_header(tmp_path / name)
    assert laspy.open(tmp_path / name).header.point_count == len(points)
    formats.write_chunks(tmp_path / name, [], scale=0.001)
    assert len(laspy.read(tmp_path / name)) == 0 and len(formats.read_cloud(tmp_path / name).points) == 0


def test_points_that_las_cannot_hold(tmp_path: Path) -> None:
    far = [np.zeros((3, 3)), [[0, 3e6, 0]]]
    formats.write_chunks(tmp_path / "a.laz", far, scale=0.002)
    before = (tmp_path / "a.laz").read_bytes()
    for chunks in (far, [[[0, np.nan, 0]]], [[[np.inf, 0, 0]]]):
        with pytest.raises(formats.FormatError, match="32 bits hold no coordinates so far from the offset"):
            formats.write_chunks(tmp_path / "a.laz", chunks, scale=0.001)
    for scale in (0, -1, np.nan, [0.1, 0, 0.1], 1e300):
        with pytest.raises(ValueError, match="scale must be positive"):
            formats.write_chunks(tmp_path / "a.laz", far, scale=scale)
    with pytest.raises(ValueError, match="chunk has shape"):
        formats.write_chunks(tmp_path / "a.laz", [np.zeros((3, 2))], scale=1)
    with pytest.raises(formats.FormatError, match=r"a\.ply: the name must end in \.las or \.laz"):
        formats.write_chunks(tmp_path / "a.ply", far, scale=1)
    assert [path.name for path in tmp_path.iterdir()] == ["a.laz"] and (tmp_path / "a.laz").read_bytes() == before
