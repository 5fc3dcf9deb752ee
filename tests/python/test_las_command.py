"""LAS without compression in the command that CMake built, against files that laspy writes and against igsp.formats."""

from __future__ import annotations

import subprocess
from pathlib import Path

import igsp
import laspy
import numpy as np
import pytest
from formats_testing import UTM_ORIGIN, make_las, motion, random_points
from igsp import formats


def run(command: str, *arguments: object, cwd: Path, code: int = 0) -> subprocess.CompletedProcess[str]:
    done = subprocess.run([command, *map(str, arguments)], cwd=cwd, capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done


def make_noisy(path: Path, point_format: int, count: int = 3000) -> laspy.LasData:
    """Every tenth point is noise, every ninth withheld; a record of the surveyor's before the points."""
    las = make_las(random_points(count) + UTM_ORIGIN, point_format)
    las.header.vlrs.append(laspy.VLR("surveyor", 77, "field book", bytes(range(256))))
    classes, withheld = np.array(las["classification"]), np.zeros(count, np.uint8)
    classes[::10], withheld[::9] = 7, 1
    classes[::20] = 18
    las["classification"], las["withheld"] = classes, withheld
    if point_format >= 6:
        las.evlrs = laspy.vlrs.vlrlist.VLRList([laspy.VLR("surveyor", 78, "", b"e" * 1000)])
    las.write(path)
    return las


@pytest.mark.parametrize("point_format", range(11))
def test_same_points_and_same_moved_file_as_the_package(cpp_command: str, tmp_path: Path, point_format: int) -> None:
    make_noisy(tmp_path / "a.las", point_format)
    expected = formats.read_cloud(tmp_path / "a.las")
    assert 0 < expected.metadata.noise < 3000
    for flags, points in [([], expected.points), (["--keep-noise"], laspy.read(tmp_path / "a.las").xyz)]:
        said = run(cpp_command, "convert", "a.las", "-o", "b.ply", *flags, cwd=tmp_path).stderr
        np.testing.assert_array_equal(igsp.read_points(tmp_path / "b.ply"), points)
        assert (f"left out {expected.metadata.noise} points that are classified as noise (7, 18)" in said) == (
            not flags
        )
    for matrix in (motion(), motion(0, (0.125, -1e6, 3.3)), motion(translation=(5e7, 0, 0))):
        np.savetxt(tmp_path / "T.txt", matrix, fmt="%.17g")
        run(cpp_command, "transform", "a.las", "--transform", "T.txt", "-o", "moved.las", cwd=tmp_path)
        formats.write_aligned(tmp_path / "a.las", tmp_path / "expected.las", matrix)
        assert (tmp_path / "moved.las").read_bytes() == (tmp_path / "expected.las").read_bytes()
    laspy.read(tmp_path / "moved.las")


@pytest.mark.parametrize("point_format", range(11))
def test_converted_with_every_attribute(cpp_command: str, tmp_path: Path, point_format: int) -> None:
    las = make_las(random_points(500), point_format)
    if point_format in (4, 5, 9, 10):  # an integer beyond 2^53 is refused
        las["wavepacket_offset"] = np.arange(500)
    las.write(tmp_path / "a.las")
    run(cpp_command, "convert", "a.las", "-o", "b.csv", cwd=tmp_path)
    table = np.genfromtxt(tmp_path / "b.csv", delimiter=",", names=True)
    las = laspy.read(tmp_path / "a.las")
    names = [name for name in las.point_format.dimension_names if name not in ("X", "Y", "Z", "rings")]
    assert list(table.dtype.names) == ["x", "y", "z", *names, "rings_0", "rings_1"]
    np.testing.assert_array_equal(np.column_stack([table["x"], table["y"], table["z"]]), las.xyz)
    for name in names:
        stored = np.array(las[name])
        values = [float(str(v)) for v in stored] if stored.dtype == np.float32 else stored
        np.testing.assert_array_equal(table[name], values, err_msg=name)
    np.testing.assert_array_equal(np.column_stack([table["rings_0"], table["rings_1"]]), las["rings"])


def test_align_writes_las_and_network_reads_it(cpp_command: str, scans: Path, tmp_path: Path) -> None:
    for i in range(2):
        make_las(igsp.read_points(scans / f"park/station_{i}.ply"), 3).write(tmp_path / f"{i}.las")
    run(cpp_command, "align", "1.las", "0.las", "-o", "aligned.las", "--transform", "T.txt", cwd=tmp_path)
    run(cpp_command, "transform", "1.las", "--transform", "T.txt", "-o", "moved.las", cwd=tmp_path)
    assert (tmp_path / "aligned.las").read_bytes() == (tmp_path / "moved.las").read_bytes()
    assert "LAS" in run(cpp_command, "info", "aligned.las", cwd=tmp_path).stdout
    run(cpp_command, "network", "0.las", "1.las", "-o", "network", "--write", "moved", cwd=tmp_path)
    assert len(laspy.read(tmp_path / "moved/1.las")) == len(laspy.read(tmp_path / "1.las"))


def test_laz_is_for_the_package(cpp_command: str, pip_command: str, tmp_path: Path) -> None:
    make_noisy(tmp_path / "a.laz", 3, 100)
    (tmp_path / "named_plain.las").write_bytes((tmp_path / "a.laz").read_bytes())
    make_las(random_points(100)).write(tmp_path / "plain.las")
    for arguments in (["info", "a.laz"], ["info", "named_plain.las"], ["convert", "plain.las", "-o", "b.laz"]):
        said = run(cpp_command, *arguments, cwd=tmp_path, code=3).stderr
        assert said.count("\n") == 1
        assert "compressed LAS (LAZ): use the Python package, pip install 'igsp[las]'" in said
        assert run(pip_command, *arguments, cwd=tmp_path).stderr.count("\n") <= 1
    assert "left out" in run(pip_command, "info", "a.laz", cwd=tmp_path).stdout
    assert "left out" not in run(pip_command, "info", "a.laz", "--keep-noise", cwd=tmp_path).stdout
    igsp.write_points(tmp_path / "a.ply", random_points(10))
    said = run(cpp_command, "convert", "a.ply", "-o", "b.las", cwd=tmp_path, code=2).stderr
    assert said == "igsp: -o b.las: .las is written only from a SOURCE of the same format, not from a.ply\n"
