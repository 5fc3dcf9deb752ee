"""PTX and PTS: text formats of scanners."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from formats_testing import UTM_ORIGIN, motion, moved, ptx_text, random_points
from igsp import formats

POSES = [np.eye(4), motion(1.2, (3.0, 4.0, 1.6))]


def grid_points(seed: int) -> np.ndarray:
    """60 cells, 12 of them without return."""
    points = np.round(random_points(60, seed), 6)
    points[::5] = 0
    return points


@pytest.fixture
def two_scans(tmp_path: Path) -> Path:
    path = tmp_path / "source.ptx"
    path.write_text(ptx_text([(grid_points(i), pose) for i, pose in enumerate(POSES)], columns=6))
    return path


def returns(seed: int) -> np.ndarray:
    points = grid_points(seed)
    return points[(points != 0).any(axis=1)]


def test_ptx_scans_are_read_with_their_poses(two_scans: Path) -> None:
    cloud = formats.read_cloud(two_scans)
    expected = np.concatenate([returns(0), moved(POSES[1], returns(1))])
    np.testing.assert_allclose(cloud.points, expected, rtol=0, atol=1e-4)  # six decimals of the rotation
    assert (cloud.format, cloud.dropped, cloud.metadata.no_return) == ("ptx", 0, 24)
    assert [scan.point_count for scan in cloud.metadata.scans] == [60, 60]
    np.testing.assert_allclose(cloud.metadata.scans[1].pose, POSES[1], rtol=0, atol=1e-6)
    np.testing.assert_array_equal(formats.read_cloud(two_scans, scan=1, apply_pose=False).points, returns(1))
    assert [scan.point_count for scan in formats.read_metadata(two_scans).scans] == [60, 60]


def test_ptx_aligned_differs_in_its_headers_alone(two_scans: Path, tmp_path: Path) -> None:
    output = tmp_path / "aligned.ptx"
    matrix = motion(translation=tuple(UTM_ORIGIN))
    formats.write_aligned(two_scans, output, matrix)
    expected = moved(matrix, formats.read_cloud(two_scans).points)
    np.testing.assert_allclose(formats.read_cloud(output).points, expected, rtol=0, atol=1e-8)
    before, after = two_scans.read_text().splitlines(), output.read_text().splitlines()
    for start in (0, 70):
        assert after[start : start + 2] == before[start : start + 2]
        assert after[start + 10 : start + 70] == before[start + 10 : start + 70]
    header = [np.array(line.split(), float) for line in after[72:80]]
    pose = matrix @ POSES[1]
    np.testing.assert_allclose(header[0], pose[:3, 3], rtol=0, atol=1e-5)
    np.testing.assert_allclose(header[1:4], pose[:3, :3].T, rtol=0, atol=1e-5)
    np.testing.assert_allclose(np.array(header[4:]).T, pose, rtol=0, atol=1e-5)


def test_ptx_one_scan_moves(two_scans: Path, tmp_path: Path) -> None:
    output = tmp_path / "aligned.ptx"
    formats.write_aligned(two_scans, output, motion(), scan=1, apply_pose=False)
    assert output.read_text().splitlines()[:70] == two_scans.read_text().splitlines()[:70]
    np.testing.assert_allclose(formats.read_metadata(output).scans[1].pose, motion(), rtol=0, atol=1e-15)
    with pytest.raises(ValueError, match="has no scan 2; its scans: 0 to 1"):
        formats.write_aligned(two_scans, output, motion(), scan=2)


@pytest.mark.parametrize(
    ("line", "text", "fault"),
    [
        (1, "six", "line 1: a PTX scan begins with its counts"),
        (3, "0 0", "line 3: 2 values in the header of a scan where 3 are expected"),
        (7, "1 0 0 zero", "line 7: could not convert string to float: 'zero'"),
        (7, "2 0 0 0", "line 7: the pose must be a rigid motion"),
        (15, "1.0 2.0", "line 15: 2 values where x, y and z are expected"),
        (15, "1.0 2,0 3.0 0 1 2 3", "line 15: not a number: '2,0'"),
        (140, "1.0 2.0 3.0 0.5", "line 140: 4 values where 7 are expected"),
    ],
)
def test_ptx_fault_is_named_with_its_line(two_scans: Path, tmp_path: Path, line: int, text: str, fault: str) -> None:
    lines = two_scans.read_text().splitlines()
    lines[line - 1] = text
    two_scans.write_text("\n".join(lines))
    for action in (
        lambda: formats.read_cloud(two_scans),
        lambda: formats.write_aligned(two_scans, tmp_path / "aligned.ptx", motion()),
    ):
        with pytest.raises(formats.FormatError) as error:
            action()
        assert f"{two_scans}: {fault}" in str(error.value)


def test_ptx_line_ends_blank_lines_and_mark_are_kept(tmp_path: Path) -> None:
    lines = ptx_text([(grid_points(3), POSES[1])], 6, colour=False).splitlines()
    text = "\ufeff" + "\r\n".join([*lines[:20], "", "  ", *lines[20:]]) + "\r\n"
    source, output = tmp_path / "source.ptx", tmp_path / "aligned.ptx"
    source.write_bytes(text.encode())
    formats.write_aligned(source, output, np.eye(4))
    after = output.read_bytes().decode()
    assert after.split("\r\n")[10:] == text.split("\r\n")[10:] and after[0] == "\ufeff"
    np.testing.assert_allclose(formats.read_cloud(output).points, formats.read_cloud(source).points, rtol=0, atol=1e-12)


@pytest.mark.parametrize("colour", [True, False])
def test_pts_keeps_what_follows_the_coordinates(tmp_path: Path, colour: bool) -> None:
    rows = [
        f"{x:.3f} {y:.3f} {z:.3f} {i - 2000}" + (f" {i} {2 * i} 255" if colour else "")
        for i, (x, y, z) in enumerate(random_points(100) + UTM_ORIGIN)
    ]
    source, output = tmp_path / "source.pts", tmp_path / "aligned.pts"
    source.write_text("\n".join(["100", *rows]) + "\n")
    cloud = formats.read_cloud(source)
    assert cloud.format == "pts" and cloud.points.shape == (100, 3)
    formats.write_aligned(source, output, motion())
    expected = moved(motion(), cloud.points)
    np.testing.assert_allclose(formats.read_cloud(output).points, expected, rtol=0, atol=0.51e-4)
    before, after = source.read_text().splitlines(), output.read_text().splitlines()
    assert after[0] == "100"
    assert [line.split()[3:] for line in after] == [line.split()[3:] for line in before]


@pytest.mark.parametrize(
    ("coordinates", "error"),
    [("1 2 3", 0.5e-4), ("1.5 2 3", 0.5e-4), ("1.123456 2 3", 0.5e-6), ("1.5e-7 2 3", 0.5e-8), ("1E2 2 3", 0.5e-4)],
)
def test_pts_has_at_least_the_resolution_of_the_source(tmp_path: Path, coordinates: str, error: float) -> None:
    source, output = tmp_path / "source.pts", tmp_path / "aligned.pts"
    source.write_text(f"2\n{coordinates}\n7 8 9\n")
    formats.write_aligned(source, output, motion())
    expected = moved(motion(), formats.read_cloud(source).points)
    difference = np.abs(formats.read_cloud(output).points - expected).max()
    assert error / 1000 < difference <= error * 1.01


def test_pts_of_several_blocks_and_without_count(tmp_path: Path) -> None:
    for name, text in (
        ("blocks", "\ufeff2\n1 2 3 0\n4 5 6 0\n\n0\n1\n7 8 9 0\n\n"),
        ("bare", "\n1 2 3 0\n4 5 6 0\n\n7 8 9 0"),
    ):
        source, output = tmp_path / f"{name}.pts", tmp_path / f"{name}-aligned.pts"
        source.write_text(text)
        np.testing.assert_array_equal(formats.read_cloud(source).points, [[1, 2, 3], [4, 5, 6], [7, 8, 9]])
        assert formats.read_metadata(source).scans[0].point_count == 3
        formats.write_aligned(source, output, np.eye(4))
        written = output.read_text()
        for number in "123456789":
            written = written.replace(f"{number}.0000", number)
        assert written == text


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "line 1: the file is empty"),
        ("3\n1 2 3\n4 5 6\n", "line 3: the file ends 1 points too early"),
        ("1\n1 2 3\n4 5 6\n", "line 3: more points than the 1 that were declared"),
        ("2\n1 2 3 0\n4 5 6", "line 3: 3 values where 4 are expected"),
        ("2\n1 2 3\n4 5\n", "line 3: 2 values where"),
        ("2\n1 2 3\n4 x 6\n", "line 3: not a number: 'x'"),
        ("x y z\n1 2 3\n", "line 1: not a number: 'x'"),
        ("\x00\x01\xff", "line 1: 1 values where x, y and z are expected"),
    ],
)
def test_pts_fault_is_named_with_its_line(tmp_path: Path, text: str, fault: str) -> None:
    source = tmp_path / "source.pts"
    source.write_text(text)
    with pytest.raises(formats.FormatError) as error:
        formats.read_cloud(source)
    assert f"{source}: {fault}" in str(error.value)
    with pytest.raises(formats.FormatError):
        formats.write_aligned(source, tmp_path / "aligned.pts", motion())
    assert [path.name for path in tmp_path.iterdir()] == ["source.pts"]
