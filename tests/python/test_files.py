"""Clouds and transformations in files."""

import laspy
import numpy as np
import pytest

import igsp


@pytest.mark.parametrize("extension", [".ply", ".pcd", ".xyz", ".csv", ".pts"])
def test_what_was_written_is_read(tmp_path, extension):
    points = np.random.default_rng(0).normal(size=(100, 3)) * [1, 1e6, 1e-6]
    path = tmp_path / f"cloud{extension}"
    igsp.write_points(path, points)
    np.testing.assert_array_equal(igsp.read_points(path), points)
    igsp.write_points(path, points, single_precision=True)
    np.testing.assert_array_equal(igsp.read_points(path), points.astype(np.float32))


def test_points_that_are_not_finite_are_dropped_and_told(tmp_path):
    path = tmp_path / "cloud.xyz"
    path.write_text("1 2 3\nnan 5 6\n7 8 9\n")
    with pytest.warns(UserWarning, match="cloud.xyz: dropped 1 of 3 points"):
        assert igsp.read_points(path).tolist() == [[1, 2, 3], [7, 8, 9]]


def test_a_transformation(tmp_path, truth):
    igsp.write_transformation(tmp_path / "T.txt", truth)
    np.testing.assert_array_equal(igsp.read_transformation(tmp_path / "T.txt"), truth)
    with pytest.raises(ValueError, match="transformation has shape"):
        igsp.write_transformation(tmp_path / "T.txt", truth[:3])


def test_faults_of_files_name_path_and_place(tmp_path, pair):
    broken = tmp_path / "broken.xyz"
    broken.write_text("1 2 3\n1 two 3\n")
    for path, words in [
        (broken, "broken.xyz.*line 2"),
        (tmp_path / "nowhere.ply", "nowhere.ply"),
        (tmp_path / "nowhere.laz", "nowhere.laz"),
        (tmp_path / "cloud.foo", "cloud.foo"),
    ]:
        with pytest.raises(OSError, match=words):
            igsp.read_points(path)
        with pytest.raises(OSError, match=words):
            igsp.align(path, pair[1])
    with pytest.raises(OSError, match="cloud.foo"):
        igsp.write_points(tmp_path / "cloud.foo", pair[0])
    with pytest.raises(ValueError, match=r"points\[0\] has the coordinate nan"):
        igsp.write_points(tmp_path / "cloud.ply", [[np.nan, 0, 0]])
    with pytest.raises(ValueError, match=r"points has shape \(2,\)"):
        igsp.write_points(tmp_path / "cloud.ply", [1, 2])
    assert not (tmp_path / "cloud.ply").exists()


def test_a_las_path_is_as_good_as_its_points(tmp_path, pair):
    las = laspy.create(point_format=0)
    las.header.scales = [0.001, 0.001, 0.001]
    las.x, las.y, las.z = pair[0].T
    las.write(tmp_path / "cloud.laz")
    np.testing.assert_array_equal(igsp.read_points(tmp_path / "cloud.laz"), las.xyz)
