"""Where scanners stood: keywords, objects and files that know it, and clouds that show it."""

import subprocess

import numpy as np
import pytest
from formats_testing import e57_attributes, make_e57, motion, ptx_text

import igsp
from igsp import formats


@pytest.fixture(scope="module")
def room():
    """A scan of 60,000 points in its scanner's frame."""
    return igsp.simulate("indoor", stations=4, points=60000, seed=1)[0]


def test_keywords_and_objects_that_know_theirs(room):
    def align(*clouds, **keywords):
        return igsp.align(*clouds, initial=np.eye(4), **keywords)

    np.testing.assert_array_equal(room.viewpoint, [0, 0, 0])
    known = align(room, room)
    np.testing.assert_array_equal(known.source.viewpoint, [0, 0, 0])
    given = align(room, room, source_viewpoint=[0.1, 0, 0], target_viewpoint=None)
    np.testing.assert_allclose(given.source.viewpoint, [0.1, 0, 0], atol=1e-12)
    assert given.target.viewpoint is None
    features = igsp.extract_features(room.points, viewpoint=(0.1, 0, 0), voxel_size=0.2)
    np.testing.assert_allclose(features.viewpoint + features.origin, [0.1, 0, 0], atol=1e-12)
    assert igsp.extract_features(room, viewpoint=None, voxel_size=0.2).viewpoint is None
    kept = align(features, room)
    np.testing.assert_allclose(kept.source.viewpoint, [0.1, 0, 0], atol=1e-12)
    np.testing.assert_array_equal(kept.target.viewpoint, [0, 0, 0])
    with pytest.raises(ValueError, match="source_viewpoint is given, but source is Features"):
        align(features, room, source_viewpoint=[0, 0, 0])


def test_what_is_no_viewpoint_is_named(room):
    for wrong in ["1,2", [0, 0], [0, 0, np.nan], "origin"]:
        with pytest.raises(ValueError, match=r"target_viewpoint is '.*'; it must be three finite numbers x,y,z"):
            igsp.align(room, room, target_viewpoint=wrong)
    with pytest.raises(ValueError, match="viewpoint is 'origin'"):
        igsp.extract_features(room, viewpoint="origin")
    with pytest.raises(ValueError, match="source"):  # of an unusable cloud, not of a viewpoint
        igsp.align(np.empty((0, 3)), room)


def test_one_that_the_cloud_contradicts_is_not_used_unless_insisted_on(room):
    behind = room.points.min(axis=0) - [0.2, 0.2, 0]
    with pytest.warns(
        UserWarning, match=r"viewpoint=.* is not used: \d+ % of the points are hidden .*!' insists"
    ) as seen:
        assert igsp.extract_features(room, viewpoint=behind, voxel_size=0.2).viewpoint is None
    assert seen[0].filename == __file__
    text = ",".join(map(repr, behind.tolist())) + "!"
    assert igsp.extract_features(room, viewpoint=text, voxel_size=0.2).viewpoint is not None


def test_auto_finds_it(room, tmp_path):
    found = igsp.find_viewpoint(room.points)
    np.testing.assert_array_equal(found.viewpoint, [0, 0, 0])
    assert "believed, though the file does not say it" in found.reason
    assert igsp.find_viewpoint(room.points + [2, 1, 0]).viewpoint is None
    assert igsp.find_viewpoint(room).reason == "the file says so"
    assert igsp.find_viewpoint(room, None).viewpoint is None
    shift = np.array([20.0, -30, 5])
    for name in ("moved.ply", "moved.pcd"):
        igsp.write_points(tmp_path / name, room.points + shift, viewpoint=shift)
        np.testing.assert_array_equal(igsp.find_viewpoint(tmp_path / name).viewpoint, shift)
        igsp.write_points(tmp_path / name, room.points + shift)
        assert igsp.find_viewpoint(tmp_path / name).viewpoint is None
    with pytest.raises(ValueError, match="viewpoint has shape"):
        igsp.write_points(tmp_path / "a.ply", room.points, viewpoint=[1, 2])


def test_poses_of_survey_formats(room, tmp_path):
    points = room.points[:20000]
    one, two = tmp_path / "one.ptx", tmp_path / "two.ptx"
    one.write_text(ptx_text([(points, motion())], 1))
    two.write_text(ptx_text([(points, motion()), (points, np.eye(4))], 1))
    make_e57(tmp_path / "one.e57", [(e57_attributes(points), motion())])
    make_e57(tmp_path / "two.e57", [(e57_attributes(points), motion()), (e57_attributes(points), motion(0.1))])
    for name in ("one.ptx", "one.e57"):
        path = tmp_path / name
        np.testing.assert_allclose(formats.read_cloud(path).viewpoint, motion()[:3, 3], rtol=1e-12)
        np.testing.assert_array_equal(formats.read_cloud(path, apply_pose=False).viewpoint, [0, 0, 0])
        np.testing.assert_allclose(igsp.find_viewpoint(path).viewpoint, motion()[:3, 3], rtol=1e-12)
        aligned = tmp_path / f"aligned_{name}"
        formats.write_aligned(path, aligned, motion(-0.3))
        np.testing.assert_allclose(formats.read_cloud(aligned).viewpoint, (motion(-0.3) @ motion())[:3, 3])
    for name in ("two.ptx", "two.e57"):
        both = formats.read_cloud(tmp_path / name)
        assert both.viewpoint is None and both.scan_count == 2  # test_parts.py has the rest
        assert igsp.find_viewpoint(tmp_path / name).viewpoint is None and igsp.find_viewpoint(both).viewpoint is None
        np.testing.assert_allclose(formats.read_cloud(tmp_path / name, scan=0).viewpoint, motion()[:3, 3], rtol=1e-12)
    assert formats.read_cloud(two, scan=1).viewpoint is None  # the identity: nobody said anything


def test_the_command_takes_it_from_them(room, tmp_path, pip_command):
    (tmp_path / "one.ptx").write_text(ptx_text([(room.points, motion())], 1))
    (tmp_path / "two.ptx").write_text(ptx_text([(room.points, motion()), (room.points, np.eye(4))], 1))

    def info(name):
        return subprocess.run([pip_command, "info", tmp_path / name], capture_output=True, text=True, check=True).stdout

    assert "at 1250.25 -310.5 12.125: the file says so" in info("one.ptx")
    assert "2 scans in one file, all of their viewpoints known" in info("two.ptx")
