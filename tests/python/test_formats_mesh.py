"""OBJ, OFF, STL and legacy VTK: their vertices."""

import subprocess

import meshio
import numpy as np
import pytest
from formats_testing import motion, random_points

import igsp
from igsp import formats

VERTICES = random_points(50)
FACES = np.arange(48).reshape(-1, 3)


@pytest.mark.parametrize("extension", ["obj", "off", "stl", "vtk"])
def test_vertices_are_read_each_once(tmp_path, extension):
    path = tmp_path / f"cloud.{extension.upper() if extension == 'obj' else extension}"
    mesh = meshio.Mesh(VERTICES, [("triangle", FACES)])
    writer = getattr(meshio, extension)
    writer.write(str(path), mesh, binary=False) if extension == "vtk" else writer.write(str(path), mesh)
    cloud = formats.read_cloud(path)
    expected = VERTICES[:48] if extension == "stl" else VERTICES  # STL holds no vertex without a face
    assert cloud.points.dtype == np.float64 and cloud.points.shape == expected.shape
    order = np.lexsort(cloud.points.T), np.lexsort(expected.T)
    np.testing.assert_allclose(cloud.points[order[0]], expected[order[1]], rtol=0, atol=1e-5)
    assert sum(map(len, formats.read_chunks(path, 7))) == len(expected)
    assert formats.read_metadata(path).scans[0].point_count == len(expected)
    np.testing.assert_array_equal(igsp.read_points(path), cloud.points)
    with pytest.raises(formats.FormatError, match="is only read"):
        formats.write_aligned(path, tmp_path / f"moved.{extension}", motion())


@pytest.mark.parametrize("scalar", ["float", "double", "int"])
@pytest.mark.parametrize("kind", ["ASCII", "BINARY"])
def test_points_of_vtk_whatever_the_data_set(tmp_path, kind, scalar):
    points = np.round(VERTICES) if scalar == "int" else VERTICES
    path = tmp_path / "points.vtk"
    dtype = {"float": ">f4", "double": ">f8", "int": ">i4"}[scalar]
    body = points.astype(dtype).tobytes() if kind == "BINARY" else " ".join(map(repr, points.ravel().tolist())).encode()
    head = f"# vtk DataFile Version 5.1\na title\n{kind}\nDATASET POLYDATA\nPOINTS 50 {scalar}\n".encode()
    path.write_bytes(head + body + b"\nVERTICES 0 0\n")
    np.testing.assert_allclose(formats.read_cloud(path).points, points, rtol=1e-6)
    path.write_bytes(head + body[: len(body) // 2])
    with pytest.raises(formats.FormatError, match=r"points.vtk: (the file ends after 2\d of 50 points|its points)"):
        formats.read_cloud(path)
    path.write_bytes(b"# vtk DataFile Version 3.0\nv\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n")
    with pytest.raises(formats.FormatError, match="no POINTS among its first lines"):
        formats.read_cloud(path)


def test_vertices_with_colours(tmp_path):
    path = tmp_path / "colours.obj"
    path.write_text("# made by hand\nv 1 2 3 0.5 0.5 0.5\nv 4 5 6 0 0 1\nv 7 8 9 1 1 1\nf 1 2 3\n")
    np.testing.assert_array_equal(formats.read_cloud(path).points, [[1, 2, 3], [4, 5, 6], [7, 8, 9]])


@pytest.mark.parametrize("extension", ["obj", "off", "stl", "vtk"])
def test_damaged_files_are_a_line_that_helps(tmp_path, extension, capfd):
    path = tmp_path / f"cloud.{extension}"
    with pytest.raises(OSError, match="No such file"):
        formats.read_cloud(path)
    for content in [
        b"",
        b"OFF\n3 1",
        b"v 1 2 x\n",
        b"\x00" * 90,
        b"# vtk DataFile Version 3.0\nv\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n1 2 3 x",
    ]:
        path.write_bytes(content)
        try:
            points = formats.read_cloud(path).points
        except formats.FormatError as error:
            assert str(error).startswith(f"{path}: ")
        else:
            assert len(points) == 0


def test_the_command_reads_them_and_writes_others(tmp_path, pip_command, scans):
    cloud = igsp.read_points(scans / "indoor/station_1.ply")
    meshio.obj.write(str(tmp_path / "source.obj"), meshio.Mesh(cloud, []))
    command = [pip_command, "align", tmp_path / "source.obj", scans / "indoor/station_0.ply", "-o"]
    run = subprocess.run([*command, tmp_path / "aligned.ply"], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert len(igsp.read_points(tmp_path / "aligned.ply")) == len(cloud)
    run = subprocess.run([*command, tmp_path / "aligned.obj"], capture_output=True, text=True)
    assert run.returncode == 2 and ".obj is only read; name it .ply" in run.stderr
