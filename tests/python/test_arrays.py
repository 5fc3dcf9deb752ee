"""Clouds in all the forms that Python has for them."""

import subprocess
import sys
from types import SimpleNamespace

import laspy
import numpy as np
import pytest

import igsp
from igsp.arrays import points_array


def same_numbers(cloud):
    """The same (N, 3) coordinates, which are exact in single precision, in other clothes."""
    strided = np.zeros((2 * len(cloud), 5))
    strided[::2, 1:4] = cloud
    read_only = cloud.copy()
    read_only.flags.writeable = False
    unaligned = np.frombuffer(b"\0" + cloud.tobytes(), np.uint8)[1:].view(np.float64).reshape(-1, 3)
    single = cloud.astype(np.float32)
    open3d_tensor = SimpleNamespace(cpu=lambda: SimpleNamespace(numpy=lambda: single))
    return {
        "strided": strided[::2, 1:4],
        "reversed": cloud[::-1][::-1],
        "Fortran-ordered": np.asfortranarray(cloud),
        "read-only": read_only,
        "unaligned": unaligned,
        "float32": single,
        "big-endian": cloud.astype(">f8"),
        "list": cloud.tolist(),
        "Open3D or PyVista": SimpleNamespace(points=cloud),
        "Open3D, tensor": SimpleNamespace(point={"positions": open3d_tensor}),
        "masked, nothing masked": np.ma.masked_array(cloud),
    }


def test_the_form_of_a_cloud_does_not_matter(pair):
    expected = igsp.extract_features(pair[0], voxel_size=0.5)
    for form, cloud in same_numbers(pair[0]).items():
        features = igsp.extract_features(cloud, voxel_size=0.5)
        np.testing.assert_array_equal(features.descriptors, expected.descriptors, err_msg=form)
        np.testing.assert_array_equal(features.points, expected.points, err_msg=form)


def test_integers_are_numbers():
    cloud = np.random.default_rng(0).integers(0, 1000, (5000, 3))
    features = igsp.extract_features(cloud, voxel_size=50)
    np.testing.assert_array_equal(features.points, igsp.extract_features(cloud.astype(float), voxel_size=50).points)


def test_laspy_is_read_in_real_coordinates(pair):
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.offsets, header.scales = [-5, 0, 100], [0.001, 0.001, 0.001]
    las = laspy.LasData(header)
    las.x, las.y, las.z = pair[0].T
    expected = igsp.extract_features(np.c_[las.x, las.y, las.z], voxel_size=0.5)
    np.testing.assert_array_equal(igsp.extract_features(las, voxel_size=0.5).points, expected.points)
    np.testing.assert_allclose(points_array(las, "las"), pair[0], atol=0.00051)


def test_contiguous_float64_is_not_copied(pair):
    read_only = pair[0].copy()
    read_only.flags.writeable = False
    for cloud in [pair[0], read_only, pair[0][1000:]]:
        assert np.shares_memory(points_array(cloud, "cloud"), cloud)


def test_nor_is_it_copied_on_the_way_into_the_library():
    """The largest memory of a process that hands over 240 MB grows by far less than that."""
    program = """
import resource, numpy, igsp
peak = lambda: 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
cloud = numpy.ones((10_000_000, 3))
cloud[:, 0] = numpy.linspace(0, 10, len(cloud))
igsp.extract_features(cloud[:10], voxel_size=1.0)
before = peak()
igsp.extract_features(cloud, voxel_size=1.0)
print((peak() - before) / cloud.nbytes)
"""
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True)
    assert float(run.stdout) < 0.3


@pytest.mark.parametrize(
    ("cloud", "words"),
    [
        (np.zeros((5, 2)), r"source has shape \(5, 2\); expected \(N, 3\)"),
        (np.zeros((3, 5)), r"source has shape \(3, 5\); expected \(N, 3\); transposed\?"),
        (np.zeros(3), r"source has shape \(3,\)"),
        (np.zeros((2, 3, 3)), r"source has shape \(2, 3, 3\)"),
        ([], r"source has shape \(0,\)"),
        (np.zeros((0, 3)), "source has no points; at least one is needed"),
        ([[1, 2, 3], [4, float("nan"), 6]], r"source: point 1 is \(4, nan, 6\); coordinates must be finite"),
        ([[1, 2, 3], [4, 5, float("inf")]], "source: point 1"),
        (np.zeros((5, 3), complex), "source has dtype complex128"),
        (np.zeros((5, 3), bool), "source has dtype bool"),
        (np.zeros((5, 3), "<U1"), "source has dtype <U1"),
        (np.zeros(5, [("x", float), ("y", float)]), "source is a structured array with the fields x, y"),
        (np.ma.masked_equal([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], 5), "source is a masked array"),
        (None, "source has dtype object"),
        (object(), "source has dtype object"),
        ([[1, 2, 3], [4, 5]], "source"),
    ],
)
def test_what_is_no_cloud_is_named(pair, cloud, words):
    with pytest.raises(ValueError, match=words):
        igsp.align(cloud, pair[1])
    with pytest.raises(ValueError, match=words.replace("source", "target")):
        igsp.align(pair[0], cloud)


@pytest.mark.parametrize(
    ("matrix", "words"),
    [
        (np.eye(3), r"initial has shape \(3, 3\); expected \(4, 4\)"),
        (2 * np.eye(4), "initial has the last row"),
        (np.diag([2.0, 2, 2, 1]), "initial is not a rigid motion: R\\^T R differs from the identity by 3"),
        (np.diag([1.0, 1, -1, 1]), "initial is not a rigid motion but a reflection"),
        (np.full((4, 4), np.nan), "initial holds a number that is not finite"),
    ],
)
def test_what_is_no_transformation_is_named(pair, matrix, words):
    with pytest.raises(ValueError, match=words):
        igsp.align(*pair, initial=matrix)


def test_a_transformation_may_have_any_layout(pair, truth):
    expected = igsp.transform_points(pair[0], truth)
    np.testing.assert_allclose(expected, pair[0] @ truth[:3, :3].T + truth[:3, 3], atol=1e-9)
    for matrix in [np.asfortranarray(truth), truth.tolist(), np.repeat(truth, 2, axis=1)[:, ::2]]:
        np.testing.assert_array_equal(igsp.transform_points(pair[0], matrix), expected)


def test_correspondences_out_of_range_are_named():
    points = np.zeros((4, 3))
    with pytest.raises(ValueError, match="index outside of 4 source_keypoints and 4 target_keypoints"):
        igsp.match_quality([[0, 4]], points, points, np.eye(4), 0.1)
    with pytest.raises(ValueError, match=r"expected \(M, 2\) integers"):
        igsp.match_quality([[0.0, 1.0]], points, points, np.eye(4), 0.1)
