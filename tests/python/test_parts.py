"""Files of several scans read as one cloud: each keeps where its scanner stood."""

import copy
import json
import pickle
import subprocess

import numpy as np
import pytest
from formats_testing import make_e57, motion, moved, ptx_text

import igsp
from igsp import formats


@pytest.fixture(scope="module")
def stations():
    """(points in the scanner's frame, (4, 4) world_from_scanner) of three scans of a building."""
    scans = igsp.simulate("indoor", stations=3, points=30000, seed=7)
    return [(scan.points, motion(0.3) @ scan.world_from_scanner) for scan in scans]


@pytest.fixture(scope="module", params=["two.e57", "two.ptx"])
def two_scans(request, stations, tmp_path_factory):
    """A file of the last two of them, in the world's frame by their poses."""
    path = tmp_path_factory.mktemp("parts") / request.param
    write_file(path, stations[1:])
    return path


@pytest.fixture(scope="module")
def target(stations, tmp_path_factory):
    path = tmp_path_factory.mktemp("target") / "target.ply"
    igsp.write_points(path, stations[0][0], viewpoint=[0, 0, 0])
    return path


def write_file(path, scans):
    if path.suffix == ".ptx":
        path.write_text(ptx_text(scans, 1, colour=False))
    else:
        names = ("cartesianX", "cartesianY", "cartesianZ")
        make_e57(path, [(dict(zip(names, points.T, strict=True)), pose) for points, pose in scans])


def places(scans):
    return np.array([pose[:3, 3] for _, pose in scans])


def test_each_scan_has_its_own(two_scans, stations):
    cloud = formats.read_cloud(two_scans)
    assert cloud.viewpoint is None and cloud.scan_count == 2
    assert [part.point_count for part in cloud.parts] == [len(points) for points, _ in stations[1:]]
    np.testing.assert_allclose([part.viewpoint for part in cloud.parts], places(stations[1:]), atol=1e-5)
    begin = cloud.parts[0].point_count
    np.testing.assert_allclose(cloud.points[begin:], moved(stations[2][1], stations[2][0]), atol=1e-4)
    for part in formats.read_cloud(two_scans, apply_pose=False).parts:
        np.testing.assert_array_equal(part.viewpoint, [0, 0, 0])
    alone = formats.read_cloud(two_scans, scan=1)
    assert alone.parts == ()
    np.testing.assert_allclose(alone.viewpoint, stations[2][1][:3, 3], atol=1e-5)


def test_chunks_say_which_scan_they_are_of(two_scans, stations):
    reader = formats.read_chunks(two_scans, 7000)
    counts = [0, 0]
    for chunk in reader:
        counts[reader.part] += len(chunk)
    assert counts == [len(points) for points, _ in stations[1:]]


def test_they_are_found_and_used(two_scans, stations, target):
    found = igsp.find_viewpoint(two_scans)
    assert found.viewpoint is None and found.reason == "2 scans in one file, all of their viewpoints known"
    assert [points for points, _ in found.parts] == [len(points) for points, _ in stations[1:]]
    np.testing.assert_allclose([place for _, place in found.parts], places(stations[1:]), atol=1e-5)
    assert pickle.loads(pickle.dumps(found)).parts[0][0] == found.parts[0][0]

    result = igsp.align(two_scans, target)
    assert result.registered, result.reason
    np.testing.assert_allclose(result.source.part_viewpoints, places(stations[1:]), atol=1e-5)
    assert len(result.target.part_viewpoints) == 0
    truth = np.linalg.inv(stations[0][1])
    np.testing.assert_allclose(result.target_from_source, truth, atol=0.03 * np.abs(truth[:3, 3]).max() / 100)
    in_memory = igsp.align(formats.read_cloud(two_scans), target)
    np.testing.assert_array_equal(in_memory.target_from_source, result.target_from_source)
    np.testing.assert_array_equal(in_memory.source.part_viewpoints, result.source.part_viewpoints)


def test_one_that_is_given_is_that_of_all(two_scans, stations):
    place = stations[1][1][:3, 3]
    given = igsp.extract_features(
        two_scans, viewpoint=",".join(map(repr, place.tolist())) + "!", voxel_size=0.2
    )
    np.testing.assert_allclose(given.viewpoint + given.origin, place, atol=1e-6)
    assert len(given.part_viewpoints) == 0
    none = igsp.extract_features(two_scans, viewpoint=None, voxel_size=0.2)
    assert none.viewpoint is None and len(none.part_viewpoints) == 0


def test_features_keep_them(two_scans, stations, tmp_path):
    features = igsp.extract_features(two_scans, voxel_size=0.2)
    assert features.viewpoint is None
    np.testing.assert_allclose(features.part_viewpoints + features.origin, places(stations[1:]), atol=1e-5)
    igsp.write_features(tmp_path / "features", features)
    for kept in (pickle.loads(pickle.dumps(features)), copy.copy(features), igsp.read_features(tmp_path / "features")):
        np.testing.assert_array_equal(kept.part_viewpoints, features.part_viewpoints)


def test_what_no_cloud_of_several_scans_has_is_left_alone(stations):
    class Other:
        points = stations[0][0]
        parts = ("a", "b")  # another library's

    assert igsp.extract_features(Other(), voxel_size=0.2).part_viewpoints.shape == (0, 3)


def test_where_the_file_does_not_say_the_origin_is_tried(stations, tmp_path):
    reference, (points, pose) = stations[0], stations[1]
    known = np.linalg.inv(reference[1]) @ pose
    write_file(tmp_path / "a.ptx", [(reference[0], np.eye(4)), (points, known)])  # the file's frame is the first one's
    found = igsp.find_viewpoint(tmp_path / "a.ptx")
    assert found.reason == "2 scans in one file, all of their viewpoints known"
    np.testing.assert_allclose([place for _, place in found.parts], [[0, 0, 0], known[:3, 3]], atol=1e-5)
    world = np.diag([1.0, 1, 1, 1])
    write_file(tmp_path / "b.ptx", [(moved(pose, points), world) for points, pose in stations[1:]])  # no poses at all
    nothing = igsp.find_viewpoint(tmp_path / "b.ptx")
    assert nothing.reason.startswith("2 scans in one file, 0 of their viewpoints known, that of scan 0 is unknown: the file")


def test_one_that_its_own_points_contradict_is_left_out(stations, tmp_path):
    points, pose = stations[2]
    behind = points - (points.min(axis=0) - [0.2, 0.2, 0])  # as if the scanner had stood behind the wall
    write_file(tmp_path / "a.ptx", [stations[1], (behind, pose)])
    found = igsp.find_viewpoint(tmp_path / "a.ptx")
    assert "1 of their viewpoints known, that of scan 1 is unknown: what the file says contradicts" in found.reason
    assert found.parts[0][1] is not None and found.parts[1][1] is None


def test_the_command(two_scans, stations, target, tmp_path, pip_command):
    def run(*arguments):
        done = subprocess.run([pip_command, *map(str, arguments)], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 0, done.stderr + done.stdout
        return done.stdout

    info = run("info", two_scans)
    assert "2 scans in one file, all of their viewpoints known" in info
    assert f"scan 1              {len(stations[2][0])} points, scanner at " in info

    output = f"aligned{two_scans.suffix}"
    answer = run("align", two_scans, target, "-o", output, "--report", "r.json", "--transform", "T.txt")
    assert "scanner at 2 places" in answer
    report = json.loads((tmp_path / "r.json").read_text())
    parts = report["source"]["parts"]
    assert [part["points"] for part in parts] == [len(points) for points, _ in stations[1:]]
    np.testing.assert_allclose([part["viewpoint"] for part in parts], places(stations[1:]), atol=1e-5)
    assert report["source"]["viewpoint"] is None and report["target"]["parts"] == []
    assert report["evidence"]["free_space"]["target"]["in_view"] > 100
    assert report["evidence"]["free_space"]["violation"] < 0.01

    matrix = np.loadtxt(tmp_path / "T.txt")
    there = [part.viewpoint for part in formats.read_cloud(tmp_path / output).parts]
    np.testing.assert_allclose(there, moved(matrix, places(stations[1:])), atol=1e-4)
    run("align", two_scans, target, "--html", "page.html")
    run("report", "r.json", "-o", "again.html")
    assert (tmp_path / "page.html").stat().st_size == pytest.approx((tmp_path / "again.html").stat().st_size, rel=0.01)

    run("align", two_scans, target, "--max-points", 20000, "--report", "large.json")
    large = json.loads((tmp_path / "large.json").read_text())
    assert large["source"]["streamed"]
    assert [part["points"] for part in large["source"]["parts"]] == [part["points"] for part in parts]
    assert large["evidence"]["free_space"]["target"]["in_view"] > 100
    assert large["evidence"]["free_space"]["violation"] < 0.01
