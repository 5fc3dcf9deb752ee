"""The report page as a file. usage: report_test.py IGSP [unittest arguments]"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from report_page import contradicting, distances, drawn_points, page_data

IGSP = os.path.abspath(sys.argv.pop(1))
MEGABYTE = 1_000_000


def read_ply(path):
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    kind = "<f8" if b"property double x" in content[:end] else "<f4"
    return np.frombuffer(content, kind, offset=end).reshape(-1, 3).astype(float)


def write_ply(path, points):
    header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
    header += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    path.write_bytes(header.encode() + np.asarray(points, "<f8").tobytes())


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    scans = Path(folder.name)
    subprocess.run([IGSP, "simulate", "park", "--out", scans, "--points", "60000"], check=True,
                   stdout=subprocess.DEVNULL)
    ReportTest.source, ReportTest.target = scans / "station_1.ply", scans / "station_0.ply"


class ReportTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def igsp(self, *arguments, code=0, cwd=None):
        run = subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=cwd or self.folder)
        self.assertEqual(run.returncode, code, f"igsp {arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def refuses(self, *arguments, saying, code=3, cwd=None):
        run = self.igsp(*arguments, code=code, cwd=cwd)
        for word in saying:
            self.assertIn(word, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
        self.assertFalse((self.folder / "r.html").exists())

    def aligned(self, source=None, target=None, *options, code=0):
        """A run's JSON and the data of its page."""
        self.igsp("align", source or self.source, target or self.target, "--report", "run.json", "--html", "run.html",
                  *options, code=code)
        return json.loads((self.folder / "run.json").read_text()), page_data(self.folder / "run.html")


class Json(ReportTest):
    def test_keypoints_and_correspondences_explain_every_iteration(self):
        run, _ = self.aligned()
        source, target = np.array(run["source_keypoints"]), np.array(run["target_keypoints"])
        self.assertEqual((len(source), len(target)), (run["keypoints"]["source"], run["keypoints"]["target"]))
        self.assertGreater(len(run["iterations"]), 2)
        residuals = []
        for record in run["iterations"]:
            pairs = np.array(record["correspondences"])
            self.assertEqual(pairs.shape, (record["matches"], 2))
            pose = np.array(record["target_from_source"])
            moved = source[pairs[:, 0]] @ pose[:3, :3].T + pose[:3, 3]
            residuals.append(np.sqrt(np.mean(np.sum((moved - target[pairs[:, 1]]) ** 2, axis=1))))
        self.assertLess(residuals[-1], run["voxel_size"])
        self.assertLess(residuals[-1], residuals[0])

    def test_arrays_of_numbers_stay_on_a_line(self):
        run, _ = self.aligned()
        text = (self.folder / "run.json").read_text()
        self.assertLess(text.count("\n"), 500)
        self.assertGreater(text.count("\n"), 100)  # yet a person can read the rest
        self.assertIn(f'\n  "verdict": "{run["verdict"]}",\n', text)


class Page(ReportTest):
    def test_both_ways_give_the_same_page(self):
        self.aligned()
        self.igsp("report", "run.json", "-o", "r.html")
        self.assertEqual((self.folder / "run.html").read_bytes(), (self.folder / "r.html").read_bytes())
        self.assertEqual(sorted(os.listdir(self.folder)), ["r.html", "run.html", "run.json"])

    def test_it_holds_the_whole_run(self):
        run, data = self.aligned()
        self.assertEqual(data["run"], run)
        kinds = [pose["kind"] for pose in data["scene"]["poses"]]
        count = len(run["iterations"])
        self.assertEqual(kinds[:count + 2], ["given"] + ["iteration"] * count + ["final"])

    def test_the_libraries_come_whole_and_with_their_licences(self):
        self.aligned()
        page = (self.folder / "run.html").read_text()
        for part in ["three/three.min.js", "three/examples/js/controls/OrbitControls.js", "chart.js/chart.min.js"]:
            self.assertIn(Path("/usr/share/javascript", part).read_text(), page)
        for package in ["libjs-three", "libjs-chart.js"]:
            text = Path("/usr/share/doc", package, "copyright").read_text()
            self.assertIn(text.replace("&", "&amp;").replace("<", "&lt;"), page)

    def test_drawn_points_and_distances_are_those_of_the_clouds(self):
        self.check_scene(self.source, self.target)

    def test_survey_coordinates_lose_nothing(self):
        offset = np.array([500_000.0, 5_000_000.0, 300.0])
        for name, path in [("s.ply", self.source), ("t.ply", self.target)]:
            write_ply(self.folder / name, read_ply(path) + offset)
        self.check_scene(self.folder / "s.ply", self.folder / "t.ply")

    def check_scene(self, source_path, target_path):
        run, data = self.aligned(source_path, target_path)
        scene = data["scene"]
        source, target = read_ply(source_path), read_ply(target_path)
        resolution = max(np.ptp(cloud, axis=0).max() for cloud in (source, target)) / 65535
        drawn = drawn_points(scene["source"])
        np.testing.assert_allclose(drawn, source, atol=resolution)  # few enough: all are drawn, in order
        np.testing.assert_allclose(drawn_points(scene["target"]), target, atol=resolution)
        tree = cKDTree(target)
        for pose in [scene["poses"][0], scene["poses"][2], scene["poses"][len(run["iterations"]) + 1]]:
            matrix = {"given": np.eye(4), "iteration": np.array(run["iterations"][1]["target_from_source"]),
                      "final": np.array(run["target_from_source"])}[pose["kind"]]
            moved = source @ matrix[:3, :3].T + matrix[:3, 3]
            shown = np.array(pose["matrix"])
            np.testing.assert_allclose((drawn - scene["source"]["origin"]) @ shown[:3, :3].T + shown[:3, 3],
                                       moved - scene["target"]["origin"], atol=2 * resolution)
            true, _ = tree.query(moved)
            found = distances(scene, pose)
            near = true < 0.99 * scene["reach"]
            self.assertGreater(near.sum(), 1000)
            np.testing.assert_allclose(found[near], true[near], atol=0.51 * scene["reach"] / 254 + 1e-6)
            self.assertTrue(np.all(np.isinf(found[true > 1.01 * scene["reach"]])))

    def test_points_in_space_that_the_other_scanner_saw_through(self):
        run, data = self.aligned()  # the files say where the scanners stood
        poses = {pose["kind"]: pose for pose in data["scene"]["poses"]}
        for cloud in ["source", "target"]:
            wrong, right = (contradicting(poses[kind], cloud) for kind in ["given", "final"])
            self.assertEqual(len(right), data["scene"][cloud]["drawn"])
            self.assertGreater(wrong.mean(), 3 * right.mean())
            # the evidence counts voxels of those in view, the page all points
            self.assertLess(right.mean(), 2 * run["evidence"]["free_space"][cloud]["share"] + 0.01)
        _, data = self.aligned(None, None, "--source-viewpoint=none")
        final = [pose for pose in data["scene"]["poses"] if pose["kind"] == "final"][0]
        self.assertIsNone(contradicting(final, "target"))
        self.assertIsNotNone(contradicting(final, "source"))

    def test_two_clouds_of_a_million_points_stay_below_15_megabytes(self):
        random = np.random.default_rng(5)
        for name, path in [("s.ply", self.source), ("t.ply", self.target)]:
            points = read_ply(path)
            write_ply(self.folder / name, random.permutation(np.resize(points, (1_000_000, 3)))
                      + random.normal(0, 0.01, (1_000_000, 3)))
        few, data = self.aligned(self.folder / "s.ply", self.folder / "t.ply")
        self.assertLess((self.folder / "run.html").stat().st_size, 15 * MEGABYTE)
        for cloud in ("source", "target"):
            self.assertEqual(data["run"][cloud]["points"], 1_000_000)
            self.assertGreater(data["scene"][cloud]["drawn"], 50_000)
            self.assertEqual(len(drawn_points(data["scene"][cloud])), data["scene"][cloud]["drawn"])
        # More iterations than any run has: fewer points are drawn instead.
        many = dict(few, iterations=few["iterations"] * 8)
        (self.folder / "many.json").write_text(json.dumps(many))
        self.igsp("report", "many.json", "-o", "many.html")
        self.assertLess((self.folder / "many.html").stat().st_size, 15 * MEGABYTE)
        fewer = page_data(self.folder / "many.html")["scene"]["source"]["drawn"]
        self.assertLess(fewer, data["scene"]["source"]["drawn"])

    def test_thinned_points_are_spread_over_the_file(self):
        count = 400_000
        lifted = np.outer(np.arange(count) * 1e-6, [0, 0, 1])  # so that every point tells its place in the file
        write_ply(self.folder / "s.ply", np.resize(read_ply(self.source), (count, 3)) + lifted)
        _, data = self.aligned(self.folder / "s.ply")
        drawn = drawn_points(data["scene"]["source"])
        found, index = cKDTree(read_ply(self.folder / "s.ply")).query(drawn)
        self.assertLess(found.max(), 0.01)
        counts, _ = np.histogram(index, bins=20, range=(0, count))
        self.assertLess(np.ptp(counts) / counts.mean(), 0.2)

    def test_file_names_cannot_break_the_page(self):
        folder = self.folder / "a<"
        folder.mkdir()
        source = folder / 'script><b>&"\'.ply'
        shutil.copy(self.source, source)
        named = self.folder / "a<" / ".." / "a<" / 'script><b>&"\'.ply'
        run, data = self.aligned(named)
        self.assertEqual(data["run"]["source"]["path"], str(named))
        self.assertEqual(data["run"], run)

    def test_a_pair_that_is_not_registered_has_its_page(self):
        random = np.random.default_rng(1)
        write_ply(self.folder / "noise.ply", random.uniform(-10, 10, (20_000, 3)))
        run, data = self.aligned(self.folder / "noise.ply", code=1)
        self.assertEqual(data["run"]["verdict"], "not_registered")

    def test_no_estimate_at_all(self):
        write_ply(self.folder / "line.ply", np.linspace([0, 0, 0], [10, 0, 0], 500))
        run, data = self.aligned(self.folder / "line.ply", self.folder / "line.ply", code=1)
        self.assertIsNone(run["target_from_source"])
        self.assertEqual([pose["kind"] for pose in data["scene"]["poses"]], ["given"])

    def test_a_source_far_away_is_drawn_beside_the_target(self):
        write_ply(self.folder / "s.ply", read_ply(self.source) + [500_000, 5_000_000, 0])
        _, data = self.aligned(self.folder / "s.ply")
        given, final = data["scene"]["poses"][0], data["scene"]["poses"][-1]
        self.assertAlmostEqual(given["drawn_nearer"], np.hypot(500_000, 5_000_000), delta=200)
        self.assertLess(np.linalg.norm(np.array(given["matrix"])[:3, 3]), 1000)
        self.assertTrue(np.all(np.isinf(distances(data["scene"], given))))
        self.assertIsNone(final["drawn_nearer"])


class Files(ReportTest):
    def setUp(self):
        super().setUp()
        (self.folder / "deep").mkdir()
        shutil.copy(self.source, self.folder / "deep" / "s.ply")
        shutil.copy(self.target, self.folder / "deep" / "t.ply")
        self.igsp("align", "s.ply", "t.ply", "--report", "run.json", cwd=self.folder / "deep")
        self.report = self.folder / "deep" / "run.json"

    def test_clouds_are_found_from_the_working_folder_or_beside_the_report(self):
        self.igsp("report", "run.json", "-o", "a.html", cwd=self.folder / "deep")
        self.igsp("report", "deep/run.json", "-o", "b.html")
        self.assertEqual((self.folder / "deep" / "a.html").read_bytes(), (self.folder / "b.html").read_bytes())

    def test_flags_say_where_the_clouds_are_now(self):
        (self.folder / "deep" / "s.ply").rename(self.folder / "elsewhere.ply")
        self.refuses("report", self.report, "-o", "r.html", saying=["s.ply", "the source of", "not there", "--source"])
        self.igsp("report", self.report, "-o", "r.html", "--source", "elsewhere.ply")

    def test_another_cloud_than_the_run_had(self):
        other = self.folder / "other.ply"
        write_ply(other, read_ply(self.target)[:5000])
        self.refuses("report", self.report, "-o", "r.html", "--target", other,
                     saying=["other.ply", "5000 points", "target"])
        self.refuses("report", self.report, "-o", "r.html", "--target", "no.ply", saying=["no.ply"])

    def test_what_is_no_report(self):
        whole = self.report.read_text()
        broken = self.folder / "broken.json"
        for text in ["", " ", "{", whole[:100], whole[:len(whole) // 2], whole[:-3], "ply\nformat ascii 1.0\n"]:
            broken.write_text(text)
            self.refuses("report", broken, "-o", "r.html", saying=["broken.json", "not JSON, at byte"])
        for text in ["{}", "[]", "null", "7", '{"version": "0.1.0"}', '{"name": "package", "version": "1.0.0"}']:
            broken.write_text(text)
            self.refuses("report", broken, "-o", "r.html", saying=["broken.json", "igsp align --report"])
        broken.write_text("[" * 100_000 + "]" * 100_000)
        self.refuses("report", broken, "-o", "r.html", saying=["broken.json", "nested too deep"])
        broken.write_text('{"version": 1e999}')
        self.refuses("report", broken, "-o", "r.html", saying=["broken.json", "1e999"])
        broken.write_bytes(b'{"version": "\xff\xfe"}')
        self.refuses("report", broken, "-o", "r.html", saying=["broken.json", "not JSON"])
        self.refuses("report", "nowhere.json", "-o", "r.html", saying=["nowhere.json"])
        self.refuses("report", self.folder, "-o", "r.html", saying=[str(self.folder)])

    def test_every_entry_that_the_page_needs_is_checked(self):
        whole = json.loads(self.report.read_text())
        optional = {"overlap", "keypoints", "cpu_seconds"}  # said twice in the report, or not shown
        for key in set(whole) - optional:
            for value in [None, "wrong", {"wrong": [1]}, [[["wrong"]]]]:
                if value is None and key in ("target_from_source", "runner_up"):
                    continue
                if isinstance(value, str) and key in ("version", "reason", "termination"):
                    continue
                self.report.write_text(json.dumps(dict(whole, **{key: value})))
                self.refuses("report", self.report, "-o", "r.html", saying=["run.json", f"/{key}"])
            self.report.write_text(json.dumps({name: value for name, value in whole.items() if name != key}))
            self.refuses("report", self.report, "-o", "r.html", saying=["run.json", f"/{key}", "missing"])

    def test_every_entry_of_an_iteration_is_checked(self):
        whole = json.loads(self.report.read_text())
        for key in whole["iterations"][1]:
            run = json.loads(json.dumps(whole))
            run["iterations"][1][key] = "wrong"
            self.report.write_text(json.dumps(run))
            self.refuses("report", self.report, "-o", "r.html", saying=["run.json", f"/iterations/1/{key}"])
        for pair in [[0, 10**6], [-1, 0], [0.5, 1], [1], "ab"]:
            run = json.loads(json.dumps(whole))
            run["iterations"][1]["correspondences"][0] = pair
            self.report.write_text(json.dumps(run))
            self.refuses("report", self.report, "-o", "r.html", saying=["run.json", "/iterations/1/correspondences"])
        whole["iterations"][1]["target_from_source"][0][0] += 0.1
        self.report.write_text(json.dumps(whole))
        self.refuses("report", self.report, "-o", "r.html", saying=["/iterations/1/target_from_source", "rigid"])

    def test_pages_never_replace_an_input(self):
        for output in [self.report, self.folder / "deep" / "s.ply", self.folder / "deep" / "t.ply"]:
            before = output.read_bytes()
            self.refuses("report", self.report, "-o", output, code=2, saying=["-o and", "the same file"])
            self.assertEqual(output.read_bytes(), before)
        self.refuses("align", self.source, self.target, "--html", self.source, code=2, saying=["--html", "SOURCE"])
        self.refuses("align", self.source, self.target, "--html", "x", "--report", "x", code=2, saying=["--html"])
        self.refuses("align", self.source, self.target, "--html", "no/r.html", saying=["no/r.html"])
        self.refuses("report", self.report, "-o", "no/r.html", saying=["no/r.html"])
        self.refuses("report", self.report, code=2, saying=["--output"])


if __name__ == "__main__":
    unittest.main()
