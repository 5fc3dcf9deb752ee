"""Viewpoints as the command takes and writes them, and those that say nothing. usage: viewpoints_test.py IGSP"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

IGSP = sys.argv.pop(1)
DEFAULT = b"VIEWPOINT 0 0 0 1 0 0 0"


def read_ply(path):
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    return np.frombuffer(content, "<f8" if b"property double x" in content[:end] else "<f4", offset=end).reshape(-1, 3)


def write_ply(path, points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + np.asarray(points, "<f8").tobytes())
    return path


def write_pcd(path, points, viewpoint=DEFAULT):
    header = f"VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(points)}\nHEIGHT 1\n".encode()
    header += viewpoint + f"\nPOINTS {len(points)}\nDATA binary\n".encode()
    path.write_bytes(header + np.asarray(points, "<f8").tobytes())
    return path


def written_viewpoint(path):
    """(3,) of the header, or None."""
    header = path.read_bytes()[:400]
    words = re.search(rb"VIEWPOINT (.*)|comment viewpoint (.*)", header)
    if words is None or words.group(0) == DEFAULT:
        return None
    return np.array((words.group(1) or words.group(2)).split()[:3], float)


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    ViewpointTest.scans = Path(folder.name)
    subprocess.run([IGSP, "simulate", "indoor", "--out", folder.name, "--points", "20000", "--seed", "1"], check=True,
                   stdout=subprocess.DEVNULL)


class ViewpointTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.source, self.target = self.scans / "station_1.ply", self.scans / "station_0.ply"
        self.truth = self.scans / "station_1_to_0.txt"

    def igsp(self, *arguments):
        run = subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        self.assertIn(run.returncode, [0, 1], run.stderr)
        return run

    def align(self, *arguments):
        """The run and its report."""
        run = self.igsp("align", *arguments, "--report", "r.json")
        return run, json.loads((self.folder / "r.json").read_text())


class Written(ViewpointTest):
    """VIEWPOINT in what `-o` writes."""

    def moved(self, source, output, *arguments):
        """Where the output says that the scanner stood, in the frame of the source."""
        self.igsp("align", source, self.target, "-o", output, "--transform", "T.txt", "--initial", self.truth, *arguments)
        there = written_viewpoint(self.folder / output)
        motion = np.loadtxt(self.folder / "T.txt")
        return None if there is None else motion[:3, :3].T @ (there - motion[:3, 3])

    def test_one_that_the_file_states_moves_with_the_cloud(self):
        shift = np.array([3.0, -2, 0.5])
        source = write_pcd(self.folder / "a.pcd", read_ply(self.source) + shift, b"VIEWPOINT 3 -2 0.5 1 0 0 0")
        truth = np.loadtxt(self.truth)
        truth[:3, 3] -= truth[:3, :3] @ shift
        np.savetxt(self.folder / "shifted.txt", truth)
        self.truth = self.folder / "shifted.txt"
        for output in ["b.pcd", "b.ply"]:
            np.testing.assert_allclose(self.moved(source, output), shift, atol=1e-9)

    def test_the_default_one_moves_if_the_cloud_shows_it_or_it_was_said(self):
        source = write_pcd(self.folder / "a.pcd", read_ply(self.source))
        for output in ["b.pcd", "b.ply"]:
            np.testing.assert_allclose(self.moved(source, output), [0, 0, 0], atol=1e-9)
            given = self.moved(source, output, "--source-viewpoint=0.25,0,0")
            np.testing.assert_allclose(given, [0.25, 0, 0], atol=1e-9)
        self.igsp("align", source, self.target, "-o", "b.pcd")
        self.assertIn("the file says so", self.igsp("info", "b.pcd").stdout)

    def test_the_default_one_claims_nothing_where_nobody_knows(self):
        points = read_ply(self.source)
        source = write_pcd(self.folder / "a.pcd", points)
        self.assertIsNone(self.moved(source, "b.pcd", "--source-viewpoint=none"))
        self.igsp("transform", source, "--transform", self.truth, "-o", "c.pcd")
        self.assertIsNone(written_viewpoint(self.folder / "c.pcd"))
        turned = points @ np.diag([-1, -1, 1])  # another scanner's, somewhere else in the room
        fused = write_pcd(self.folder / "fused.pcd", np.vstack([points, turned + [1.5, 1, 0]]))
        self.assertIn("unknown", self.igsp("info", fused).stdout)
        self.assertIsNone(self.moved(fused, "d.pcd", "--force"))

    def test_a_network_moves_what_it_believes(self):
        first, second = self.folder / "first.pcd", self.folder / "second.pcd"
        write_pcd(first, read_ply(self.target))
        write_pcd(second, read_ply(self.source))
        run = self.igsp("network", first, second, "-o", "survey", "--write", "aligned")
        self.assertIn("registered 2 of 2", run.stdout)
        np.testing.assert_allclose(written_viewpoint(self.folder / "aligned" / "second.pcd"),
                                   np.loadtxt(self.truth)[:3, 3], atol=0.01)


class SayingNothing(ViewpointTest):
    """Viewpoints that are finite numbers and of no use."""

    def test_where_no_point_is_in_view_nothing_is_said(self):
        points = read_ply(self.target)
        ahead = write_ply(self.folder / "ahead.ply", points[points[:, 0] > 0.3])
        behind = write_ply(self.folder / "behind.ply", points[points[:, 0] < 0])
        np.savetxt(self.folder / "still.txt", np.eye(4))
        run, report = self.align(ahead, behind, "--source-viewpoint=0,0,0", "--target-viewpoint=0,0,0",
                                 "--initial", "still.txt")
        space = report["evidence"]["free_space"]
        for cloud in ["source", "target"]:
            self.assertEqual(space[cloud], {"in_view": 0, "contradicting": 0, "share": 0})
            self.assertIn(f"the other scanner could see nothing of the {cloud}", run.stdout)
        self.assertEqual(space["violation"], 0)
        self.assertNotIn("saw through", run.stdout)
        self.assertEqual(report["verdict"], "not_registered")

    def test_all_points_in_one_direction(self):
        random = np.random.default_rng(1)
        pole = write_ply(self.folder / "pole.ply", np.c_[random.uniform(1, 9, 5000), random.normal(0, 0.002, (5000, 2))])
        for place in ["0,0,0", "-1e9,0,0"]:  # along it, near and far
            run, report = self.align(pole, self.target, f"--source-viewpoint={place}")
            self.assertRegex(run.stderr, rf"pole.ply: --source-viewpoint={place} is not used: 9\d % of the points are hidden")
            self.assertIsNone(report["source"]["viewpoint"])
            insisted, report = self.align(pole, self.target, f"--source-viewpoint={place}!")
            self.assertNotIn("not used", insisted.stderr)
            self.assertIsNotNone(report["source"]["viewpoint"])
            self.assertEqual(report["verdict"], "not_registered")

    def test_inside_a_wall_of_points(self):
        points = read_ply(self.source)
        place = points[np.argmin(np.abs(np.linalg.norm(points, axis=1) - 2))].astype(float)
        wall = place + np.random.default_rng(1).uniform(-0.3, 0.3, (20000, 3))
        source = write_ply(self.folder / "wall.ply", np.vstack([points, wall]))
        text = ",".join(map(repr, place.tolist()))
        run, report = self.align(source, self.target, f"--source-viewpoint={text}")
        self.assertRegex(run.stderr, r"is not used: \d\d % of the points are hidden from it behind others")
        self.assertIsNone(report["source"]["viewpoint"])
        for arguments in [[source, f"--source-viewpoint={text}!"], [self.source, f"--source-viewpoint={text}"]]:
            _, report = self.align(arguments[0], self.target, arguments[1])  # a point of the cloud itself, too
            self.assertLess(np.abs(np.array(report["target_from_source"]) - np.loadtxt(self.truth)).max(), 0.05)
            self.assertLess(report["evidence"]["free_space"]["violation"], 0.03)


if __name__ == "__main__":
    unittest.main()
