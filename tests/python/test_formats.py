"""What holds for every survey format: chunks, faults, missing packages, complete files or none."""

from __future__ import annotations

import re
import stat
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from formats_testing import (
    UTM_ORIGIN,
    e57_attributes,
    make_double_e57,
    make_e57,
    make_las,
    motion,
    moved,
    ptx_text,
    random_points,
)
from igsp import formats
from igsp.formats import _e57_file

COUNT = 2000


def make(path: Path, points: np.ndarray) -> Path:
    """A file of the format that its extension names; points that are not finite in those that can have them."""
    if path.suffix in (".las", ".laz"):
        make_las(points, 1, "1.2").write(path)
    elif path.suffix == ".e57":
        make_e57(path, [(e57_attributes(half), motion(i)) for i, half in enumerate(np.array_split(points, 2))])
    elif path.suffix == ".ptx":
        halves = np.array_split(points, 2)
        path.write_text(ptx_text([(half, motion(i)) for i, half in enumerate(halves)], columns=5))
    else:
        rows = "".join(f"{x} {y} {z} 7 1 2 3\n" for x, y, z in points.tolist())
        path.write_text(f"{len(points)}\n{rows}")
    return path


EXTENSIONS = ["las", "laz", "e57", "ptx", "pts"]
each_format = pytest.mark.parametrize("extension", EXTENSIONS)


@pytest.mark.parametrize(("name", "supported"), [("a.las", True), ("b.LAZ", True), ("c.copc.laz", True)])
def test_supported_names(name: str, supported: bool) -> None:
    assert formats.is_supported(name) is supported
    assert formats.is_supported(Path("folder.ply") / name)


@pytest.mark.parametrize("name", ["a.ply", "b.xyz", "las", "c.las.gz", ""])
def test_other_names(name: str) -> None:
    assert not formats.is_supported(name)
    with pytest.raises(formats.FormatError, match="not a survey format: the name must end in one of .las, .laz, .e57"):
        formats.read_cloud(name)


@each_format
@pytest.mark.parametrize("points_per_chunk", [1, 7, 999, 1000, 1001, 10**9])
def test_chunks_equal_the_whole(tmp_path: Path, extension: str, points_per_chunk: int) -> None:
    count = 40 if points_per_chunk == 1 else COUNT
    path = make(tmp_path / f"source.{extension}", random_points(count))
    whole = formats.read_cloud(path)
    reader = formats.read_chunks(path, points_per_chunk)
    chunks = list(reader)
    assert 0 < max(map(len, chunks)) <= points_per_chunk
    np.testing.assert_array_equal(np.concatenate(chunks), whole.points)
    assert reader.metadata.no_return == whole.metadata.no_return
    assert len(reader.metadata.scans) == len(formats.read_metadata(path).scans) == len(whole.metadata.scans)
    assert whole.points.flags.c_contiguous and whole.points.flags.owndata


@each_format
def test_memory_is_bounded_by_the_chunk(tmp_path: Path, extension: str) -> None:
    path = make(tmp_path / f"source.{extension}", random_points(60_000))
    list(formats.read_chunks(path, 20_000))  # what is imported at first use is not meant
    tracemalloc.start()
    count = sum(map(len, formats.read_chunks(path, 500)))
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert count > 50_000
    assert peak < count * 24 / 3  # bytes of a whole cloud


def test_chunk_of_no_points(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="points_per_chunk must be at least 1, got 0"):
        formats.read_chunks(make(tmp_path / "source.pts", random_points(3)), 0)


@pytest.mark.parametrize("extension", ["e57", "ptx", "pts"])
def test_points_that_are_not_finite_are_left_out_and_counted(tmp_path: Path, extension: str) -> None:
    """LAS cannot hold such points."""
    points = random_points(COUNT)
    points[5, 0], points[6, 1], points[1500, 2] = np.nan, np.inf, -np.inf
    attributes = e57_attributes(points)
    path = tmp_path / f"source.{extension}"
    if extension == "e57":
        make_double_e57(path, {name: attributes[name].copy() for name in ("cartesianX", "cartesianY", "cartesianZ")})
    else:
        make(path, points)
    cloud = formats.read_cloud(path)
    assert cloud.dropped == 3 and cloud.points.shape == (COUNT - 3, 3)
    assert np.isfinite(cloud.points).all()
    reader = formats.read_chunks(path, 100)
    assert sum(map(len, reader)) == COUNT - 3 and reader.dropped == 3
    output = tmp_path / f"aligned.{extension}"
    formats.write_aligned(path, output, motion())
    aligned = formats.read_cloud(output)
    assert aligned.dropped == 3
    np.testing.assert_allclose(aligned.points, moved(motion(), cloud.points), rtol=0, atol=1e-9)


@each_format
def test_file_cut_short_anywhere_is_an_error(tmp_path: Path, extension: str) -> None:
    content = make(tmp_path / f"source.{extension}", random_points(400)).read_bytes()
    path = tmp_path / f"cut.{extension}"
    first_scan = content.index(b"\n", len(content) // 2 - 20) if extension == "ptx" else -1
    cuts = sorted({*range(0, len(content) - 30, 211), len(content) - 30, 3, 100, 300})
    assert len(cuts) > 50
    for cut in cuts:
        if abs(cut - first_scan) < 200:
            continue  # see test_end_between_two_ptx_scans
        path.write_bytes(content[:cut])
        for action in actions(path, tmp_path / f"aligned.{extension}"):
            with pytest.raises(formats.FormatError, match=f"cut.{extension}: "):
                action()
    assert sorted(file.name for file in tmp_path.iterdir()) == [f"cut.{extension}", f"source.{extension}"]


def test_end_between_two_ptx_scans(tmp_path: Path) -> None:
    """A PTX file does not say how many scans it has: this is the one cut that cannot be told from a whole file."""
    path = make(tmp_path / "source.ptx", random_points(400))
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:210]))
    assert len(formats.read_cloud(path).points) == 200


def actions(source: Path, output: Path) -> list[Callable[[], object]]:
    return [lambda: formats.read_cloud(source), lambda: formats.write_aligned(source, output, motion())]


@each_format
def test_rubbish(tmp_path: Path, extension: str) -> None:
    path = tmp_path / f"source.{extension}"
    for content in (b"", b"\n", b"\0" * 5000, bytes(range(256)) * 50, b"LASF", b"ASTM-E57" + b"\xff" * 2000):
        path.write_bytes(content)
        for action in actions(path, tmp_path / f"aligned.{extension}"):
            with pytest.raises(formats.FormatError, match=f"source.{extension}: (line|byte) "):
                action()


@each_format
def test_damaged_bytes_are_read_or_named(tmp_path: Path, extension: str) -> None:
    """Whatever a damaged file does to the reader, it is a FormatError: no other exception, no endless loop."""
    content = make(tmp_path / f"source.{extension}", random_points(100)).read_bytes()
    path = tmp_path / f"damaged.{extension}"
    random = np.random.default_rng(5)
    faults = 0
    for _ in range(150):
        damaged = bytearray(content)
        reach = random.choice([120, 400, len(content)])
        for position in random.integers(0, reach, random.choice([1, 2, 8])):
            damaged[position] = random.choice([0, 255, random.integers(256)])
        path.write_bytes(_with_checksums(damaged) if extension == "e57" else damaged)
        for action in actions(path, tmp_path / f"aligned.{extension}"):
            try:
                action()
            except formats.FormatError as error:
                assert str(error).startswith(f"{path}: ")
                faults += 1
    assert faults > 30


def _with_checksums(content: bytearray) -> bytes:
    """Of E57: otherwise they find all damage, and nothing behind them is tested."""
    return _e57_file.make_pages(b"".join(content[i : i + 1020] for i in range(0, len(content), 1024))).tobytes()


@each_format
def test_no_file(tmp_path: Path, extension: str) -> None:
    for action in actions(tmp_path / f"absent.{extension}", tmp_path / f"aligned.{extension}"):
        with pytest.raises(FileNotFoundError, match=f"absent.{extension}"):
            action()


@each_format
def test_source_may_be_the_output(tmp_path: Path, extension: str) -> None:
    path = make(tmp_path / f"source.{extension}", random_points(100))
    path.chmod(0o640)
    before = formats.read_cloud(path).points
    formats.write_aligned(path, path, motion())
    np.testing.assert_allclose(formats.read_cloud(path).points, moved(motion(), before), rtol=0, atol=1e-3)
    assert [file.name for file in tmp_path.iterdir()] == [f"source.{extension}"]


@each_format
def test_output_has_the_format_of_the_source(tmp_path: Path, extension: str) -> None:
    path = make(tmp_path / f"source.{extension}", random_points(10))
    for other in ["ply", *EXTENSIONS]:
        if {extension, other} <= {"las", "laz"} or extension == other:
            continue
        with pytest.raises(formats.FormatError, match=rf"aligned\.{other}: the source is written in its own format"):
            formats.write_aligned(path, tmp_path / f"aligned.{other}", motion())


@each_format
def test_output_that_is_no_file(tmp_path: Path, extension: str) -> None:
    path = make(tmp_path / f"source.{extension}", random_points(10))
    (tmp_path / f"folder.{extension}").mkdir()
    with pytest.raises(formats.FormatError, match="cannot write: not a regular file"):
        formats.write_aligned(path, tmp_path / f"folder.{extension}", motion())
    with pytest.raises(FileNotFoundError, match="no-folder"):
        formats.write_aligned(path, tmp_path / "no-folder" / f"aligned.{extension}", motion())


def test_output_has_ordinary_permissions_and_follows_links(tmp_path: Path) -> None:
    path = make(tmp_path / "source.pts", random_points(10))
    (tmp_path / "link.pts").symlink_to("aligned.pts")
    (tmp_path / "aligned.pts").touch()
    formats.write_aligned(path, tmp_path / "link.pts", motion())
    assert (tmp_path / "link.pts").is_symlink()
    assert len(formats.read_cloud(tmp_path / "aligned.pts").points) == 10
    assert stat.S_IMODE((tmp_path / "aligned.pts").stat().st_mode) == stat.S_IMODE(path.stat().st_mode)


def scaled() -> np.ndarray:
    matrix = motion()
    matrix[:3, :3] *= 1.01
    return matrix


@pytest.mark.parametrize(
    ("matrix", "fault"),
    [
        (np.eye(3), r"target_from_source must have shape \(4, 4\), got \(3, 3\)"),
        (np.full((4, 4), np.nan), "target_from_source must be finite"),
        (np.diag([1.0, 1.0, -1.0, 1.0]), "target_from_source must be a rigid motion"),
        (scaled(), "target_from_source must be a rigid motion"),
        (motion().T, "target_from_source must have the last row 0 0 0 1"),
    ],
)
def test_matrix_that_is_no_motion(tmp_path: Path, matrix: np.ndarray, fault: str) -> None:
    path = make(tmp_path / "source.pts", random_points(10))
    with pytest.raises(ValueError, match=fault):
        formats.write_aligned(path, tmp_path / "aligned.pts", matrix)


@each_format
def test_rounded_matrix_at_utm_coordinates(tmp_path: Path, extension: str) -> None:
    """Six digits of a rotation are metres at the origin of UTM: the points go where the matrix as given puts them."""
    path, output = tmp_path / f"source.{extension}", tmp_path / f"aligned.{extension}"
    if extension == "e57":
        make_e57(path, [(e57_attributes(random_points(50)), motion(1, tuple(UTM_ORIGIN)))])
    elif extension == "ptx":
        path.write_text(ptx_text([(random_points(50), motion(1, tuple(UTM_ORIGIN)))], columns=5))
    else:
        make(path, random_points(50) + UTM_ORIGIN)
    matrix = np.round(motion(), 6)
    formats.write_aligned(path, output, matrix)
    expected = moved(matrix, formats.read_cloud(path).points)
    np.testing.assert_allclose(formats.read_cloud(output).points, expected, rtol=0, atol=5e-4)


@pytest.mark.parametrize(
    ("extension", "package", "extra"),
    [("laz", "laspy", "las"), ("laz", "lazrs", "las"), ("e57", "pye57", "e57")],
)
def test_missing_package_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, extension: str, package: str, extra: str
) -> None:
    path = make(tmp_path / f"source.{extension}", random_points(10))
    monkeypatch.setitem(sys.modules, package, None)  # an import of it fails
    with pytest.raises(ImportError) as error:
        formats.read_cloud(path)
    assert isinstance(error.value, formats.MissingPackageError)
    assert f"{path}: this format needs the package '{package}': pip install 'igsp[{extra}]'" in str(error.value)
    if extension == "e57":  # moved by its poses, without reading a point
        formats.write_aligned(path, tmp_path / "aligned.e57", motion())
    else:
        with pytest.raises(formats.MissingPackageError):
            formats.write_aligned(path, tmp_path / f"aligned.{extension}", motion())


def test_las_and_text_need_no_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    paths = [make(tmp_path / f"source.{extension}", random_points(10)) for extension in ("las", "ptx", "pts")]
    for package in ("laspy", "lazrs", "pye57"):
        monkeypatch.setitem(sys.modules, package, None)
    for path in paths:
        assert len(formats.read_cloud(path).points) == 10
        formats.write_aligned(path, path.with_stem("aligned"), motion())


def test_example_of_the_documentation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document = (Path(__file__).parents[2] / "docs" / "formats.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", document, re.DOTALL)
    make(tmp_path / "station.e57", random_points(100))
    make(tmp_path / "block.laz", random_points(100))
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(code, names)
    expected = moved(np.array(names["target_from_source"]), names["cloud"].points)
    np.testing.assert_allclose(formats.read_cloud("aligned.e57", scan=1).points, expected, rtol=0, atol=1e-9)
