"""igsp.network: files and clouds in, one frame out; the same as the command."""

import csv
import pickle
import subprocess
import sys

import laspy
import numpy as np
import pytest
from formats_testing import UTM_ORIGIN, e57_attributes, make_e57, make_las, motion, ptx_text
from test_portable import values

import igsp

FAST = {"target_points": 3000}


@pytest.fixture(scope="module")
def site():
    return igsp.simulate("park", stations=4, points=30000, station_distance=8, seed=3)


@pytest.fixture(scope="module")
def answer(site):
    return igsp.network(site, **FAST)


def expect_right(network, site, frames=None):
    """`frames`: what the points of each scan were moved by before."""
    frames = frames or [np.eye(4)] * len(site)
    world = [pose @ frame for pose, frame in zip(network.poses, frames, strict=True)]
    for pose, scan in zip(world, site, strict=True):
        expected = np.linalg.inv(site[0].world_from_scanner) @ scan.world_from_scanner
        np.testing.assert_allclose(np.linalg.inv(world[0]) @ pose, expected, atol=0.1)


def test_one_frame_and_what_is_known_of_it(site, answer):
    assert str(answer).startswith("registered 4 of 4 scans: 4 in one frame\n")
    expect_right(answer, site)
    assert answer.components == [[0, 1, 2, 3]] and [scan.name for scan in answer.scans][1] == "scan 1"
    assert answer.poses.shape == (4, 4, 4) and answer.covariances.shape == (4, 6, 6)
    np.testing.assert_array_equal(answer.poses[2], answer.scans[2].world_from_scan)
    np.testing.assert_array_equal(answer.covariances[2], answer.scans[2].covariance)
    assert (np.linalg.eigvalsh(answer.covariances[1:]) > 0).all() and not answer.covariances[0].any()
    assert {(link.source, link.target) for link in answer.links} == {(i, j) for i in range(4) for j in range(i)}
    assert {link.state for link in answer.links} <= {"used", "unconfirmed", "rejected", "not_registered"}
    closing = [cycle for cycle in answer.cycles if cycle.closes]
    for index, link in ((i, link) for i, link in enumerate(answer.links) if link.state == "used"):
        through = [c for c in closing if {link.source, link.target} <= set(c.scans)]
        assert len(through) == link.consistent_triangles, index
    assert closing and all(0 <= cycle.error < 4.2 for cycle in closing)


def test_files_give_the_bits_of_the_command(site, tmp_path, cpp_command, pip_command):
    for i, scan in enumerate(site):
        igsp.write_points(tmp_path / f"s{i}.ply", scan.points, viewpoint=scan.viewpoint)
    (tmp_path / "broken.ply").write_bytes(b"ply\n")
    network = igsp.network(tmp_path, **FAST)
    assert [scan.name for scan in network.scans] == [str(path) for path in sorted(tmp_path.glob("*.ply"))]
    assert "broken.ply: " in network.scans[0].problem and network.components == [[1, 2, 3, 4], [0]]
    for command in (cpp_command, pip_command):
        run = subprocess.run(
            [command, "network", tmp_path, "-o", tmp_path / "survey", "--target-points", "3000"],
            capture_output=True,
            text=True,
        )
        assert (run.returncode, run.stdout) == (3, f"{network}\n"), run.stderr
        with open(tmp_path / "survey/poses.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        written = [[float(row[name]) for name in ("tx", "ty", "tz")] for row in rows]
        np.testing.assert_array_equal(written, network.poses[:, :3, 3])


def test_scans_of_one_file_are_inputs_of_their_own(site, tmp_path, pip_command):
    poses = [motion(0.3 * i) for i in range(3)]
    make_e57(tmp_path / "site.e57", [(e57_attributes(site[i].points), poses[i]) for i in range(3)])
    (tmp_path / "last.ptx").write_text(ptx_text([(site[3].points, np.eye(4))], 1))
    files = [tmp_path / "site.e57", tmp_path / "last.ptx"]
    network = igsp.network(files, **FAST)
    names = [f"{files[0]}#{i}" for i in range(3)] + [str(files[1])]
    assert [scan.name for scan in network.scans] == names
    expect_right(network, site, [*poses, np.eye(4)])
    run = subprocess.run(
        [pip_command, "network", *files, "-o", tmp_path / "survey", "--target-points", "3000"],
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stdout) == (0, f"{network}\n"), run.stderr
    with open(tmp_path / "survey/poses.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["scan"] for row in rows] == names
    written = [[float(row[name]) for name in ("tx", "ty", "tz")] for row in rows]
    np.testing.assert_array_equal(written, network.poses[:, :3, 3])
    moved = tmp_path / "moved"
    run = subprocess.run(
        [pip_command, "network", *files, "-o", tmp_path / "survey", "--target-points", "3000", "--write", moved],
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0 and sorted(path.name for path in moved.iterdir()) == ["last.ptx", "site.e57"], run.stderr
    for i, name in enumerate(["site.e57#0", "site.e57#1", "site.e57#2", "last.ptx"]):
        before = igsp.transform_points(igsp.read_points(names[i]), network.poses[i])
        np.testing.assert_allclose(igsp.read_points(moved / name), before, atol=1e-5)
    one = igsp.formats.read_cloud(names[1])
    np.testing.assert_array_equal(igsp.read_points(names[1]), one.points)
    assert one.scan_count == 1 and len(igsp.read_points(files[0])) > 2 * len(one.points)
    with pytest.raises(ValueError, match="has no scan 3; its scans: 0 to 2"):
        igsp.read_points(f"{files[0]}#3")


@pytest.mark.parametrize("name", ["all.laz", "all.las"])
def test_the_merged_cloud_as_las(site, tmp_path, pip_command, name):
    files = [str(tmp_path / f"{i}.laz") for i in range(2)]
    for file, scan in zip(files, site, strict=False):
        make_las(scan.points + UTM_ORIGIN).write(file)
    for merged in [name, "all.ply"]:
        arguments = ["-o", tmp_path / "survey", "--target-points", "3000", "--merged", tmp_path / merged]
        run = subprocess.run([pip_command, "network", *files, *arguments], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
    merged, expected = igsp.formats.read_cloud(tmp_path / name), igsp.read_points(tmp_path / "all.ply")
    assert merged.format == name[4:]
    scale = merged.metadata.scale[0]
    assert merged.metadata.scale == (scale, scale, scale) and str(scale) in ("0.001", "0.0001")
    np.testing.assert_allclose(merged.points, expected, rtol=0, atol=0.51 * scale)
    np.testing.assert_array_equal(laspy.read(tmp_path / name).return_number, 1)


def test_a_merged_laz_without_its_package_is_refused_before_the_work(tmp_path):
    without = (
        "import sys; sys.modules['lazrs'] = None\n"
        "sys.argv = ['igsp', 'network', 'a.ply', 'b.ply', '-o', 'survey', '--merged', 'all.laz']\n"
        "from igsp.__main__ import main; sys.exit(main())"
    )
    (tmp_path / "a.ply").touch()
    (tmp_path / "b.ply").touch()
    run = subprocess.run([sys.executable, "-c", without], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 3 and not (tmp_path / "survey").exists()
    assert run.stderr == "igsp: all.laz: this format needs the package 'lazrs': pip install 'igsp[las]'\n"


def test_features_and_clouds_mix(site, answer):
    features = [igsp.extract_features(scan, voxel_size=answer.voxel_size, **FAST) for scan in site[:2]]
    mixed = igsp.network([*features, site[2].points, site[3]], viewpoints=["auto", "auto", [0, 0, 0], "auto"], **FAST)
    np.testing.assert_array_equal(mixed.poses, answer.poses)
    named = igsp.network(site, viewpoints={"scan 1": None}, **FAST)
    known = {(link.source, link.target): link.in_view > 0 for link in named.links}
    assert all(link.in_view > 0 for link in answer.links if link.state == "used")
    assert not any(known[pair] for pair in known if 1 in pair) and known[2, 0]


def test_which_pairs_are_tried(site, answer):
    listed = igsp.network(site[:3], pairs=np.array([[0, 1], [2, 1]]), **FAST)
    assert [(link.source, link.target) for link in listed.links] == [(1, 0), (2, 1)]
    likely = igsp.network(site, pairs="auto", **FAST)
    assert likely.components == answer.components and len(likely.links) <= len(answer.links)
    with pytest.raises(ValueError, match="pairs is some; it must be all, auto or pairs of indices"):
        igsp.network(site, pairs="some", **FAST)
    with pytest.raises(ValueError, match="a pair of scans 1 and 9 is listed"):
        igsp.network(site, pairs=[(1, 9)], **FAST)


def test_what_the_world_is(site, answer):
    fixed = igsp.network(site, fixed_scan=2, **FAST)
    np.testing.assert_array_equal(fixed.poses[2], np.eye(4))
    place = site[0].world_from_scanner + [[0, 0, 0, 100], [0, 0, 0, 50], [0, 0, 0, 5], [0, 0, 0, 0]]
    control = [igsp.Control(0, place[:3, 3], 0.01, place[:3, :3], 1e-3)]
    moved = igsp.network(site, control=control, dof=4, **FAST)
    np.testing.assert_allclose(moved.poses[0], place, atol=1e-3)
    assert moved.scans[0].control_residual < 1e-3 and moved.scans[1].control_residual is None
    lost = igsp.network(site, control=[igsp.Control(1, [0, 0, 0], 0.1)], **FAST)
    np.testing.assert_array_equal(lost.poses, answer.poses)
    assert "does not say where it lies" in lost.warnings[0]
    with pytest.raises(ValueError, match="control of scan 0: position has shape"):
        igsp.network(site, control=[igsp.Control(0, [0, 0], 0.1)], **FAST)
    with pytest.raises(ValueError, match="control of scan 9; there are 4 scans"):
        igsp.network(site, control=[igsp.Control(9, [0, 0, 0], 0.1)], **FAST)


def test_progress_stops_and_errors_pass(site):
    stages = []
    igsp.network(site[:2], progress=lambda stage, fraction: stages.append((stage, fraction)), **FAST)
    assert list(dict(stages)) == ["scale", "features", "pairs", "network"]
    with pytest.raises(igsp.Cancelled):
        igsp.network(site[:2], progress=lambda stage, fraction: stage != "pairs", **FAST)
    with pytest.raises(ZeroDivisionError):
        igsp.network(site[:2], progress=lambda stage, fraction: 1 / 0, **FAST)
    with pytest.raises(KeyboardInterrupt):
        igsp.network([site[0], Interrupting(site[1].points)], voxel_size=0.5)


class Interrupting:
    def __init__(self, points):
        self._points = points

    @property
    def points(self):
        raise KeyboardInterrupt


def test_mistakes_are_named(site, tmp_path):
    with pytest.raises(ValueError, match="a network needs at least two scans"):
        igsp.network(site[:1])
    with pytest.raises(ValueError, match="is given twice"):
        igsp.network([tmp_path / "a.ply", tmp_path / "a.ply"])
    with pytest.raises(OSError, match="a folder without any point cloud"):
        igsp.network(tmp_path)
    with pytest.raises(TypeError, match="unknown option"):
        igsp.network(site, voxel_sise=1)
    with pytest.raises(ValueError, match="min_unconfirmed_confidence is 2"):
        igsp.network(site[:2], min_unconfirmed_confidence=2, voxel_size=0.5)
    with pytest.raises(ValueError, match="1 viewpoints for 4 scans"):
        igsp.network(site, viewpoints=[None])
    with pytest.raises(ValueError, match="viewpoints: 'x' is none of the scans"):
        igsp.network(site, viewpoints={"x": None})
    lone = igsp.network([site[0], np.zeros((0, 3)), site[1], "nowhere.laz"], **FAST)
    assert lone.components[0] == [0, 2] and "no points" in lone.scans[1].problem
    assert "nowhere.laz" in lone.scans[3].problem


def test_a_network_passes_between_processes(answer):
    back = pickle.loads(pickle.dumps(answer))
    assert values(back) == values(answer) and str(back) == str(answer)
