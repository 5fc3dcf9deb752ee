"""The igsp command as a user meets it. usage: cli_test.py IGSP [unittest arguments]"""
import json
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

IGSP = sys.argv.pop(1)


def write_ply(path, points, kind="<f4", count=None):
    name = {"<f4": "float", "<f8": "double"}[kind]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points) if count is None else count}"]
    header += [f"property {name} {axis}" for axis in "xyz"] + ["end_header", ""]
    path.write_bytes("\n".join(header).encode() + np.asarray(points, kind).tobytes())


def read_ply(path):
    """Coordinates and the type they are stored in, of what igsp writes."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    kind = "<f8" if b"property double x" in content[:end] else "<f4"
    return np.frombuffer(content, kind, offset=end).reshape(-1, 3).astype(float), kind


def rotation_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    scans = Path(folder.name)
    subprocess.run([IGSP, "simulate", "park", "--out", scans, "--points", "60000"], check=True,
                   stdout=subprocess.DEVNULL)
    CommandTest.source, CommandTest.target = scans / "station_1.ply", scans / "station_0.ply"
    CommandTest.truth = scans / "station_1_to_0.txt"


class CommandTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def igsp(self, *arguments, code=0):
        run = subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        if code is None:
            self.assertIn(run.returncode, [0, 1])
            return run
        self.assertEqual(run.returncode, code, f"igsp {arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def refuses(self, *arguments, code, saying):
        run = self.igsp(*arguments, code=code)
        for word in [saying] if isinstance(saying, str) else saying:
            self.assertIn(word, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    def file(self, name, content=b""):
        path = self.folder / name
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return path

    def cloud(self, name, points, **options):
        write_ply(self.folder / name, points, **options)
        return self.folder / name


    def under_terminal(self, arguments, wait_for=None, then=None):
        """Exit code and what was sent to the terminal that stands in for standard error. When `wait_for` was sent,
        the process gets the signal `then`."""
        reader, writer = pty.openpty()
        process = subprocess.Popen([IGSP, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=writer,
                                   cwd=self.folder)
        os.close(writer)
        sent = b""
        while True:
            try:
                piece = os.read(reader, 4096)
            except OSError:  # the other end is closed
                break
            sent += piece
            if wait_for and wait_for in sent:
                process.send_signal(then)
                wait_for = None
        os.close(reader)
        return process.wait(), sent.decode()


class Align(CommandTest):
    def test_registers_and_writes_what_was_asked_for(self):
        run = self.igsp("align", self.source, self.target, "-o", "a.ply", "--transform", "T.txt", "--report", "r.json")
        self.assertTrue(run.stdout.startswith("registered: "), run.stdout)
        for word in ["target_from_source", "confidence", "overlap", "RMSE", "chosen from both clouds", "iterations",
                     "time"]:
            self.assertIn(word, run.stdout)
        self.assertEqual(run.stderr, "")  # not a terminal: no bars
        self.assertEqual(sorted(os.listdir(self.folder)), ["T.txt", "a.ply", "r.json"])
        matrix = np.loadtxt(self.folder / "T.txt")
        lines = run.stdout.split("target_from_source\n")[1].split("\n")[:4]
        np.testing.assert_array_equal(np.array([line.split() for line in lines], float), matrix)
        report = json.loads((self.folder / "r.json").read_text())
        np.testing.assert_array_equal(np.array(report["target_from_source"]), matrix)
        moved, kind = read_ply(self.folder / "a.ply")
        expected = read_ply(self.source)[0] @ matrix[:3, :3].T + matrix[:3, 3]
        np.testing.assert_allclose(moved, expected, atol=1e-5)
        self.assertEqual(kind, "<f4")
        error = json.loads(self.igsp("evaluate", "--transform", "T.txt", "--truth", self.truth, "--source", self.source,
                                     "--json").stdout)
        self.assertLess(error["e_r_deg"], 0.5)
        self.assertLess(error["centroid_displacement"], 0.3)

    def test_starts_from_a_guess_and_refuses_a_wrong_one(self):
        self.igsp("align", self.source, self.target, "--initial", self.truth, "--transform", "T.txt")
        error = json.loads(self.igsp("evaluate", "--transform", "T.txt", "--truth", self.truth, "--json").stdout)
        self.assertLess(error["e_r_deg"], 0.5)
        wrong = np.loadtxt(self.truth)
        wrong[:3, 3] += 1000.0
        np.savetxt(self.folder / "wrong.txt", wrong, fmt="%.17g")
        self.igsp("align", self.source, self.target, "--initial", "wrong.txt", code=1)
        self.refuses("align", self.source, self.target, "--initial", "nowhere.txt", code=3, saying="nowhere.txt")
        self.refuses("align", self.source, self.target, "--initial", "T.txt", "--transform", "T.txt", code=2,
                     saying="--transform and --initial")

    def test_report_has_all_that_is_promised(self):
        self.igsp("align", self.source, self.target, "--report", "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        for key in ["verdict", "reason", "confidence", "target_from_source", "overlap", "rmse", "voxel_size",
                    "options", "iterations", "timings_s", "keypoints", "peak_memory_bytes", "version", "warnings",
                    "evidence", "runner_up", "precision", "diagnosis"]:
            self.assertIn(key, report)
        self.assertEqual(report["verdict"], "registered")
        self.assertEqual(np.array(report["target_from_source"]).shape, (4, 4))
        self.assertGreater(report["overlap"], 0.3)
        self.assertGreater(report["keypoints"]["source"], 10)
        self.assertEqual(report["source"]["points"], len(read_ply(self.source)[0]))
        self.assertGreater(report["peak_memory_bytes"], 1 << 20)
        self.assertGreater(len(report["iterations"]), 0)
        for record in report["iterations"]:
            self.assertEqual(set(record), {"k", "w_fd", "w_ed", "t_cd", "candidate_edges", "matches", "energy",
                                           "rotation_step_rad", "translation_step", "seconds", "target_from_source",
                                           "correspondences"})
        self.assertEqual(np.array(report["precision"]["information"]).shape, (6, 6))
        self.assertGreater(report["evidence"]["agreeing_matches"], 3)
        self.assertIn("read", report["timings_s"])
        self.assertEqual(report["options"]["degrees_of_freedom"], 6)
        self.assertIn("pca_radius", report["options"]["keypoints"])

    def test_viewpoints_are_kept_and_what_they_saw_through_is_measured(self):
        run = self.igsp("align", self.source, self.target, "--source-viewpoint=0,0,0", "--target-viewpoint=0,0,0",
                        "--report", "r.json")
        self.assertIn("in space that the other scanner saw through", run.stdout)
        report = json.loads((self.folder / "r.json").read_text())
        for cloud in ["source", "target"]:
            self.assertEqual(report[cloud]["viewpoint"], [0, 0, 0])
            self.assertEqual(report[cloud]["viewpoint_because"], "given")
            self.assertGreater(report["evidence"]["free_space"][cloud]["in_view"], 100)
        self.assertLess(report["evidence"]["free_space"]["violation"], 0.03)
        self.assertEqual(report["warnings"], [])

    def test_half_known_pairs_use_the_half_they_have(self):
        run = self.igsp("align", self.source, self.target, "--target-viewpoint=0,0,0", "--source-viewpoint=none",
                        "--report", "r.json")
        self.assertIn("% of the source in space", run.stdout)
        self.assertNotIn("% of the target", run.stdout)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertIsNone(report["source"]["viewpoint"])
        self.assertIsNone(report["evidence"]["free_space"]["target"])

    def test_a_viewpoint_that_its_cloud_contradicts_is_not_used_unless_insisted_on(self):
        rng = np.random.default_rng(1)
        walls = rng.uniform(-1, 1, (50000, 3))
        walls[np.arange(50000), rng.integers(0, 3, 50000)] = rng.choice([-1, 1], 50000)
        room = self.cloud("room.ply", walls * [5, 4, 2])
        behind = "-5.5,0,0"
        run = self.igsp("align", room, room, f"--source-viewpoint={behind}", "--report", "r.json", code=None)
        self.assertRegex(run.stderr, rf"room.ply: --source-viewpoint={behind} is not used: \d\d % of the points are "
                                     rf"hidden .*; --source-viewpoint={behind}! insists")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertIsNone(report["source"]["viewpoint"])
        self.assertEqual(len(report["warnings"]), 1)
        run = self.igsp("align", room, room, f"--source-viewpoint={behind}!", "--report", "r.json", code=None)
        self.assertNotIn("not used", run.stderr)
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(report["source"]["viewpoint"], [-5.5, 0, 0])

    def test_auto_takes_the_viewpoint_from_the_file(self):
        self.igsp("align", self.source, self.target, "--report", "r.json", "-o", "a.ply", "--transform", "T.txt")
        report = json.loads((self.folder / "r.json").read_text())
        for cloud in ["source", "target"]:  # the simulation writes it
            self.assertEqual(report[cloud]["viewpoint"], [0, 0, 0])
            self.assertEqual(report[cloud]["viewpoint_because"], "the file says so")
        moved = self.igsp("info", "a.ply").stdout
        words = re.search(r"scanner +at (\S+) (\S+) (\S+): the file says so\n", moved).groups()
        np.testing.assert_allclose([float(w) for w in words], np.loadtxt(self.folder / "T.txt")[:3, 3], rtol=1e-6)
        self.igsp("align", self.source, self.target, "-o", "a.pcd")
        self.assertIn("the file says so", self.igsp("info", "a.pcd").stdout)

    def test_auto_believes_the_origin_where_the_cloud_agrees(self):
        points = read_ply(self.source)[0]
        silent = self.igsp("info", self.cloud("silent.ply", points)).stdout
        self.assertRegex(silent, r"scanner +at 0 0 0: believed, though the file does not say it: from its origin "
                                 r"\d\.\d % of the points are hidden behind others, from places about it \d+")
        shifted = self.igsp("info", self.cloud("shifted.ply", points + [5, 0, 0])).stdout
        self.assertIn("scanner               unknown: the file does not say, and", shifted)
        fused = np.vstack([points + [4, 0, 0], points @ np.diag([-1, -1, 1]) - [4, 0, 0]])
        self.assertIn("scanner               unknown: ", self.igsp("info", self.cloud("fused.ply", fused)).stdout)

    def test_survey_coordinates_are_written_as_doubles(self):
        offset = np.array([500000.0, 5000000.0, 300.0])
        source = self.cloud("s.ply", read_ply(self.source)[0] + offset, kind="<f8")
        target = self.cloud("t.ply", read_ply(self.target)[0] + offset, kind="<f8")
        self.igsp("align", source, target, "-o", "a.ply", "--transform", "T.txt")
        moved, kind = read_ply(self.folder / "a.ply")
        self.assertEqual(kind, "<f8")
        nowhere = ["--source-viewpoint", "none", "--target-viewpoint", "none"]  # as with the offset
        self.igsp("align", self.source, self.target, "--transform", "near.txt", *nowhere)
        near = np.loadtxt(self.folder / "near.txt")
        expected = read_ply(self.source)[0] @ near[:3, :3].T + near[:3, 3] + offset
        np.testing.assert_allclose(moved, expected, atol=1e-5)

    def test_every_output_format_holds_the_same_points(self):
        for name in ["a.ply", "a.pcd", "a.xyz"]:
            self.igsp("align", self.source, self.target, "-o", name)
            printed = self.igsp("info", name).stdout
            self.assertIn(f"points                {len(read_ply(self.source)[0])}\n", printed)

    def test_a_pair_that_is_not_registered_leaves_nothing_but_the_report(self):
        plane = np.c_[np.random.default_rng(0).uniform(0, 10, (5000, 2)), np.zeros(5000)]
        flat = self.cloud("flat.ply", plane)
        old = self.file("T.txt", "old")
        run = self.igsp("align", flat, self.target, "-o", "a.ply", "--transform", "T.txt", "--report", "r.json", code=1)
        self.assertTrue(run.stdout.startswith("not registered: "), run.stdout)
        self.assertIn("not written, since the pair is not registered: a.ply T.txt", run.stdout)
        self.assertFalse((self.folder / "a.ply").exists())
        self.assertEqual(old.read_text(), "old")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(report["verdict"], "not_registered")
        self.assertGreater(len(report["reason"]), 10)

    def test_a_refusal_names_its_cause_unless_told_not_to(self):
        points = read_ply(self.source)[0]
        mirrored, flat = self.cloud("m.ply", points * [1, -1, 1]), self.cloud("flat.ply", points * [1, 1, 0])
        run = self.igsp("align", mirrored, self.target, "--report", "r.json", code=1)
        self.assertIn("\ndiagnosis: the mirrored source would register", run.stdout)
        report = json.loads((self.folder / "r.json").read_text())
        [cause] = report["diagnosis"]
        self.assertEqual(cause["cause"], "mirrored")
        np.testing.assert_allclose(np.array(cause["target_from_source"]), np.loadtxt(self.truth) * [1, -1, 1, 1],
                                   atol=0.2)
        self.assertIn("diagnosis", report["timings_s"])
        silent = self.igsp("align", mirrored, self.target, "--no-diagnose", "--report", "r.json", code=1)
        self.assertNotIn("diagnosis", silent.stdout)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["diagnosis"], [])
        self.assertIn("\ndiagnosis: z is 0 everywhere in the source",
                      self.igsp("align", flat, self.target, code=1).stdout)
        # From a guess nothing is searched, neither for the pair nor for its mirror image.
        self.assertNotIn("diagnosis:", self.igsp("align", mirrored, self.target, "--initial", self.truth, code=1).stdout)

    def test_another_unit_of_length_is_named_and_found(self):
        points = read_ply(self.source)[0]
        feet = self.cloud("feet.ply", points / 0.3048)
        self.assertIn("0.3048 turns feet into metres", self.igsp("align", feet, self.target, code=1).stdout)
        for scale in ("auto", "0.3048"):
            run = self.igsp("align", feet, self.target, "--scale", scale, "--transform", "T.txt", "-o", "a.ply",
                            "--report", "r.json", "--html", "page.html")
            self.assertIn("\nscale       0.30", run.stdout)
            matrix = np.loadtxt(self.folder / "T.txt")
            truth = np.loadtxt(self.truth)
            expected = points @ truth[:3, :3].T + truth[:3, 3]
            np.testing.assert_allclose(points / 0.3048 @ matrix[:3, :3].T + matrix[:3, 3], expected, atol=0.05)
            np.testing.assert_allclose(read_ply(self.folder / "a.ply")[0], expected, atol=0.05)
            report = json.loads((self.folder / "r.json").read_text())
            self.assertAlmostEqual(report["scale"], 0.3048, delta=3e-4)
            rotation = np.array(report["target_from_source"])[:3, :3]
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-9)
            self.igsp("report", "r.json", "-o", "again.html")
            refused = self.igsp("evaluate", "--transform", "T.txt", "--truth", self.truth, code=3)
            self.assertIn("multiplies by 0.30", refused.stderr)

    def test_a_stray_point_is_left_out_and_said(self):
        points, kind = read_ply(self.source)
        stray = points.mean(0) + [10 * np.linalg.norm(np.ptp(points, axis=0)), 0, 0]
        run = self.igsp("align", self.cloud("stray.ply", np.vstack([points, stray]), kind=kind), self.target)
        self.assertRegex(run.stdout, rf"1 of {len(points) + 1} points lies \d+\.\d extents away and was left out")

    def test_a_scale_that_is_none_is_refused(self):
        for scale in ("big", "0", "-1", "nan", "1e300"):
            self.assertIn("it must be auto or a factor",
                          self.igsp("align", self.source, self.target, "--scale", scale, code=2).stderr)
        self.assertIn("exclude each other", self.igsp("align", self.source, self.target, "--scale", "auto", "--initial",
                                                      self.truth, code=2).stderr)

    def test_a_large_cloud_is_streamed_to_nearly_the_same_answer(self):
        self.igsp("align", self.source, self.target, "--max-points", "20000", "--transform", "T.txt",
                  "--report", "r.json")
        report = json.loads((self.folder / "r.json").read_text())
        self.assertTrue(report["source"]["streamed"])
        self.assertEqual(report["source"]["points"], len(read_ply(self.source)[0]))
        error = json.loads(self.igsp("evaluate", "--transform", "T.txt", "--truth", self.truth, "--json").stdout)
        self.assertLess(error["e_r_deg"], 0.5)

    def test_a_streamed_cloud_is_written_whole(self):
        for name in ["a.ply", "a.xyz"]:
            self.igsp("align", self.source, self.target, "--max-points", "20000", "-o", name, "--transform", "T.txt")
            printed = self.igsp("info", name).stdout
            self.assertIn(f"points                {len(read_ply(self.source)[0])}\n", printed)
        matrix = np.loadtxt(self.folder / "T.txt")
        expected = read_ply(self.source)[0] @ matrix[:3, :3].T + matrix[:3, 3]
        np.testing.assert_allclose(read_ply(self.folder / "a.ply")[0], expected, atol=1e-5)
        np.testing.assert_allclose(np.loadtxt(self.folder / "a.xyz"), expected, atol=1e-5)

    def test_the_output_keeps_what_belongs_to_the_points(self):
        points = read_ply(self.source)[0]
        normals = np.tile([0.0, 0.6, 0.8], (len(points), 1))
        lines = np.c_[points, np.arange(len(points)) % 256, normals]
        lines = np.round(lines, 6)
        np.savetxt(self.folder / "s.csv", lines, "%.17g", ",", header="x,y,z,intensity,nx,ny,nz", comments="")
        run = self.igsp("align", "s.csv", self.target, "-o", "a.csv", "--transform", "T.txt")
        self.assertEqual(run.stdout.count("a.csv"), 0, "nothing to say")
        matrix = np.loadtxt(self.folder / "T.txt")
        moved = np.loadtxt(self.folder / "a.csv", delimiter=",", skiprows=1)
        self.assertEqual((self.folder / "a.csv").read_text()[:25], "x,y,z,intensity,nx,ny,nz\n")
        np.testing.assert_allclose(moved[:, :3], lines[:, :3] @ matrix[:3, :3].T + matrix[:3, 3], atol=1e-9)
        np.testing.assert_array_equal(moved[:, 3], lines[:, 3])
        np.testing.assert_allclose(moved[:, 4:], normals @ matrix[:3, :3].T, atol=1e-9)
        run = self.igsp("align", "s.csv", self.target, "-o", "a.ply")
        self.assertIn("a.ply keeps x, y and z only; -o with .csv keeps intensity, nx, ny, nz as well\n", run.stdout)

    def test_floats_become_doubles_where_they_would_round(self):
        offset = np.array([500000.0, 5000000.0, 300.0])
        target = self.cloud("t.ply", read_ply(self.target)[0] + offset, kind="<f8")
        run = self.igsp("align", self.source, target, "-o", "a.ply")
        self.assertIn("a.ply holds its coordinates as doubles: floats would be exact to 0.3 only\n", run.stdout)
        self.assertEqual(read_ply(self.folder / "a.ply")[1], "<f8")

    def test_verbose_adds_iterations_and_stages_and_quiet_drops_warnings(self):
        verbose = self.igsp("align", self.source, self.target, "--verbose").stdout
        self.assertIn("T_cd", verbose)
        points = read_ply(self.source)[0]
        points[5] = np.nan
        source = self.cloud("s.ply", points)
        self.assertIn("dropped 1 of", self.igsp("align", source, self.target).stderr)
        self.assertEqual(self.igsp("align", source, self.target, "--quiet").stderr, "")

    def test_one_of_several_processors_is_enough(self):
        """As in a container that may use one: threads for the others are not asked for."""
        one = {min(os.sched_getaffinity(0))}
        run = subprocess.run([IGSP, "align", self.source, self.target, "--initial", self.truth, "--quiet"], cwd=self.folder,
                             capture_output=True, text=True, preexec_fn=lambda: os.sched_setaffinity(0, one))
        self.assertEqual((run.returncode, run.stderr), (0, ""))


class OptionsOfTheCommand(CommandTest):
    def used(self, *arguments):
        self.igsp("align", self.source, self.target, "--report", "r.json", *arguments)
        return json.loads((self.folder / "r.json").read_text())["options"]

    def test_printed_options_read_back_as_the_same(self):
        for preset in ["default", "paper"]:
            printed = self.igsp("options", "--preset", preset).stdout
            config = self.file("igsp.toml", printed)
            self.assertEqual(self.igsp("options", "--config", config).stdout, printed)
        self.assertNotEqual(self.igsp("options").stdout, printed)

    def test_file_flags_and_preset_meet_in_the_report(self):
        config = self.file("igsp.toml", 'preset = "paper"\nthreads = 2\n[descriptor]\nradius = 8\n')
        used = self.used("--config", config, "--threads", "1", "--voxel-size", "0.75")
        self.assertEqual(used["search"], "direct")
        self.assertEqual(used["threads"], 1)
        self.assertEqual(used["descriptor"]["radius"], 8.0)
        self.assertEqual(used["scale"]["voxel_size"], 0.75)
        self.assertFalse(used["refinement"]["enabled"])

    def test_boolean_options_have_two_flags(self):
        self.assertIn("enabled = false", self.igsp("options", "--no-refinement").stdout)
        self.assertIn("enabled = true", self.igsp("options", "--preset", "paper", "--refinement").stdout)

    def test_mistakes_are_named_with_the_way_out(self):
        pair = ["align", self.source, self.target]
        for arguments, words in [
            (["--voxelsize", "1"], ["--voxelsize", "did you mean --voxel-size?"]),
            (["--pca-raduis=1"], "did you mean --pca-radius?"),
            (["--pca-radius", "-1"], ["keypoints.pca_radius", "--pca-radius", "-1", "(0, 100]"]),
            (["--pca-radius", "wide"], ['"wide"', "a number"]),
            (["--pca-radius", "nan"], "keypoints.pca_radius"),
            (["--threads", "1.5"], ["threads", "an integer", '"1.5"']),
            (["--dof", "5"], "4 or 6"),
            (["--level", "0.4"], ["level", "--level", "0.4", "[0.5, 1]"]),
            (["--search", "drect"], ["drect", "direct, hypotheses"]),
            (["--preset", "papr"], ['"papr"', 'did you mean "paper"']),
            (["--threads"], "--threads"),
            (["--max-points", "5"], "at least 1000"),
            (["extra.ply"], "extra.ply"),
            (["--source-viewpoint=1,2"], ["--source-viewpoint is '1,2'", "x,y,z"]),
            (["--target-viewpoint=1,nan,2"], "--target-viewpoint is '1,nan,2'"),
            (["--target-viewpoint", "origin"], "--target-viewpoint is 'origin'"),
            (["--quiet", "--verbose"], "--verbose"),
        ]:
            with self.subTest(arguments):
                self.refuses(*pair, *arguments, code=2, saying=words)

    def test_a_value_that_loses_pairs_is_warned_of(self):
        for flag, usual in [("--descriptor-radius", "in [4, 30]"), ("--pca-radius", "in [3, 50]"),
                            ("--target-points", "at least 1000")]:
            run = self.igsp("align", self.source, self.target, flag, "100", "--report", "r.json", code=None)
            warning = next(line for line in run.stderr.split("\n") if flag in line)
            self.assertIn(usual, warning)
            self.assertIn(warning.removeprefix("igsp: warning: "), json.loads((self.folder / "r.json").read_text())["warnings"])
            quiet = self.igsp("align", self.source, self.target, flag, "100", "--quiet", code=None)
            self.assertEqual(quiet.stderr, "")

    def test_unknown_commands_and_missing_arguments(self):
        self.refuses("aling", self.source, code=2, saying="did you mean align?")
        self.refuses("align", code=2, saying="SOURCE")
        self.refuses("align", self.source, code=2, saying="TARGET")
        self.refuses("--versoin", code=2, saying="did you mean --version?")
        self.assertIn("Usage", self.igsp(code=2).stderr)

    def test_a_wrong_file_of_options_is_named_with_its_line(self):
        pair = ["align", self.source, self.target, "--config"]
        unknown = self.file("unknown.toml", "threads = 1\n[keypoints]\npca_raduis = 6.0\n")
        self.refuses(*pair, unknown, code=2, saying=["unknown.toml:3:", 'did you mean "keypoints.pca_radius"?'])
        outside = self.file("outside.toml", "[keypoints]\npca_radius = 0\n")
        self.refuses(*pair, outside, code=2, saying=["outside.toml:2:", "keypoints.pca_radius", "(0, 100]"])
        broken = self.file("broken.toml", "threads = 1\nsearch =\n")
        self.refuses(*pair, broken, code=3, saying="broken.toml:2:")
        self.refuses(*pair, "nowhere.toml", code=3, saying="nowhere.toml")
        self.refuses(*pair, unknown, "--preset", "paper", code=2, saying=["--config", "--preset"])

    def test_help_names_every_option_with_range_and_default(self):
        self.assertRegex(self.igsp("--version").stdout, r"^igsp \d+\.\d+\.\d+\n$")
        for command in ["align", "evaluate", "simulate", "info", "options"]:
            self.assertIn(f"igsp {command} ", self.igsp(command, "--help").stdout.split("Example")[1])
        text = " ".join(self.igsp("align", "--help").stdout.split())
        self.assertIn("--pca-radius NUMBER r_f: sphere of the principal component analysis [voxels]; in (0, 100]; "
                      "usual: in [3, 50]; default 6", text)
        for flag in ["--voxel-size", "--dof", "--threads", "--no-refinement", "--config", "--force"]:
            self.assertIn(f"{flag} ", text)


class BadInput(CommandTest):
    def as_either_cloud(self, path, words):
        self.refuses("align", path, self.target, "-o", "a.ply", "--report", "r.json", code=3, saying=words)
        self.refuses("align", self.source, path, code=3, saying=words)
        self.assertFalse((self.folder / "a.ply").exists() or (self.folder / "r.json").exists())

    def test_files_that_are_no_clouds(self):
        self.as_either_cloud("nowhere.ply", "nowhere.ply")
        self.as_either_cloud(self.folder, str(self.folder))
        for name in ["empty.ply", "empty.pcd", "empty.xyz"]:
            self.as_either_cloud(self.file(name), name)
        self.as_either_cloud(self.file("magic.ply", "hello\nworld\n"), "magic.ply: byte offset 0")
        self.as_either_cloud(self.file("text.xyz", "1 2 3\n1 two 3\n"), ["text.xyz", "line 2"])

    def test_bodies_that_end_early(self):
        points = np.random.default_rng(0).normal(size=(1000, 3))
        truncated = self.cloud("truncated.ply", points)
        os.truncate(truncated, truncated.stat().st_size - 5)
        self.as_either_cloud(truncated, ["truncated.ply", "byte"])
        self.as_either_cloud(self.cloud("count.ply", points, count=10**12), ["count.ply", "1000000000000"])

    def test_a_header_of_a_gigabyte(self):
        path = self.file("header.ply", "ply\nformat ascii 1.0\ncomment ")
        os.truncate(path, 1 << 30)  # sparse: takes no room on the disk
        self.as_either_cloud(path, "header.ply")

    def test_clouds_without_extent(self):
        point = np.array([[1.0, 2.0, 3.0]])
        for points, words in [(np.full((7, 3), np.nan), ["no finite point", "7 dropped"]), (point, "single point"),
                              (point.repeat(1000000, 0), "1000000 points are equal")]:
            self.as_either_cloud(self.cloud("cloud.ply", points), ["cloud.ply", *np.atleast_1d(words)])

    def test_clouds_without_shape_are_answered(self):
        line = np.linspace(0, 10, 5000)[:, None] * np.array([[1.0, 2.0, 3.0]])
        plane = np.c_[np.random.default_rng(0).uniform(0, 10, (5000, 2)), np.zeros(5000)]
        two = np.array([[0.0, 0, 0], [1, 1, 1]])
        duplicates = np.random.default_rng(0).normal(size=(10, 3)).repeat(100000, 0)
        for points in [line, plane, two, duplicates]:
            path = self.cloud("shapeless.ply", points)
            self.assertIn("not registered", self.igsp("align", path, path, code=1).stdout)

    def test_different_units(self):
        millimetres = self.cloud("mm.ply", 1000 * read_ply(self.source)[0])
        run = subprocess.run([IGSP, "align", millimetres, self.target, "--report", self.folder / "r.json"],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertIn("different units? Extents differ by a factor of about 1000", run.stderr)
        self.assertIn("different units", json.loads((self.folder / "r.json").read_text())["warnings"][0])

    def test_outputs_that_cannot_be_written_are_refused_before_reading(self):
        for flag in ["-o", "--transform", "--report", "--html"]:
            for path in ["nowhere/x.ply", "/proc/x.ply", "/dev/full"]:
                self.refuses("align", "missing.ply", "missing.ply", flag, path, code=3, saying=path)
            self.refuses("align", "missing.ply", "missing.ply", flag, self.folder, code=3, saying=str(self.folder))
        self.refuses("align", "missing.ply", "missing.ply", "-o", "x.foo", code=3, saying=["x.foo", ".ply"])

    def test_formats_that_the_package_knows_are_named(self):
        motion = self.file("T.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n")
        self.file("x.e57", "ASTM-E57")
        for arguments in [("info", "x.e57"), ("align", "x.e57", self.target), ("convert", self.source, "-o", "y.e57"),
                          ("transform", "x.e57", "--transform", motion, "-o", "y.e57")]:
            self.refuses(*arguments, code=3, saying="does not know .e57 files; the same command from pip install 'igsp[e57]'")
        self.refuses("transform", self.source, "--transform", motion, "-o", "y.las", code=2,
                     saying="-o y.las: .las is written only from a SOURCE of the same format")

    def test_an_output_never_replaces_an_input_or_another_output(self):
        before = self.source.read_bytes()
        self.refuses("align", self.source, self.target, "-o", self.source, code=2, saying=["-o", "SOURCE"])
        self.refuses("align", self.source, self.target, "--report", "x", "--transform", "./x", code=2,
                     saying="--report and --transform")
        self.assertEqual(self.source.read_bytes(), before)


class Terminal(CommandTest):
    def test_a_bar_per_stage(self):
        code, sent = self.under_terminal(["align", self.source, self.target])
        self.assertEqual(code, 0)
        bars = [line.split("\r")[-1] for line in sent.replace("\r\n", "\n").strip().split("\n")]
        self.assertGreater(len(bars), 4)
        for bar in bars:
            self.assertRegex(bar, r"^\w[\w -]+ \[#+\] 100% +\d+\.\d s$")
        code, sent = self.under_terminal(["align", self.source, self.target, "--quiet"])
        self.assertEqual((code, sent), (0, ""))

    def test_an_interrupt_stops_the_run_and_leaves_no_file(self):
        # With this many voxels the run takes minutes when it is not interrupted.
        long_run = ["align", self.source, self.target, "--voxel-size", "0.05", "--pca-radius", "60",
                    "--descriptor-radius", "60", "--search", "direct", "-o", "a.ply", "--transform", "T.txt", "--report", "r.json"]
        for stage, number in [(b"read source", signal.SIGTERM), (b"keypoints", signal.SIGINT)]:
            code, sent = self.under_terminal(long_run, wait_for=stage, then=number)
            self.assertEqual(code, 128 + number, sent)
            self.assertIn("igsp: interrupted", sent)
            self.assertEqual(os.listdir(self.folder), [])


class Evaluate(CommandTest):
    def matrix(self, name, rotation, translation):
        rows = np.eye(4)
        rows[:3, :3], rows[:3, 3] = rotation, translation
        np.savetxt(self.folder / name, rows, fmt="%.17g")
        return name

    def test_numbers_by_hand(self):
        # 90 degrees about z and a shift, against the identity: the centroid (3, 0, 0) goes to (0, 3, 0) + (0, 0, 4).
        self.matrix("T.txt", rotation_z(np.pi / 2), [0, 0, 4])
        self.matrix("truth.txt", np.eye(3), [0, 0, 0])
        cloud = self.cloud("s.ply", [[2, 0, 0], [4, 0, 0], [3, 1, 0], [3, -1, 0]])
        arguments = ["evaluate", "--transform", "T.txt", "--truth", "truth.txt"]
        error = json.loads(self.igsp(*arguments, "--source", cloud, "--json").stdout)
        self.assertAlmostEqual(error["e_r_deg"], 90, 10)
        self.assertAlmostEqual(error["e_r_mdeg"], 90000, 7)
        self.assertAlmostEqual(error["e_t"], 4, 12)
        self.assertAlmostEqual(error["centroid_displacement"], np.sqrt(9 + 9 + 16), 12)
        printed = self.igsp(*arguments, "--source", cloud).stdout
        self.assertIn("e_r  90 deg = 90000 mdeg", printed)
        self.assertIn("e_t  4 ", printed)
        self.assertIn("centroid displacement  5.83095", printed)
        self.assertIsNone(json.loads(self.igsp(*arguments, "--json").stdout)["centroid_displacement"])

    def test_translation_error_is_that_of_the_difference(self):
        # Eq. 12: dT = T T_gt^-1; with T_gt = (90 degrees, t) and T = (90 degrees, t + (0, 0, 1)), e_t = 1.
        self.matrix("T.txt", rotation_z(np.pi / 2), [5, 6, 8])
        self.matrix("truth.txt", rotation_z(np.pi / 2), [5, 6, 7])
        error = json.loads(self.igsp("evaluate", "--transform", "T.txt", "--truth", "truth.txt", "--json").stdout)
        self.assertAlmostEqual(error["e_t"], 1, 12)
        self.assertAlmostEqual(error["e_r_deg"], 0, 12)

    def test_small_angles_are_not_lost(self):
        self.matrix("T.txt", rotation_z(1e-9), [0, 0, 0])
        self.matrix("truth.txt", np.eye(3), [0, 0, 0])
        error = json.loads(self.igsp("evaluate", "--transform", "T.txt", "--truth", "truth.txt", "--json").stdout)
        self.assertAlmostEqual(error["e_r_deg"] / np.degrees(1e-9), 1, 6)

    def test_trajectories_in_the_forms_of_tum_and_kitti(self):
        rng = np.random.default_rng(1)
        truth = [(0.5 * i, rotation_z(0.3 * i), rng.uniform(-5, 5, 3)) for i in range(6)]
        world = rotation_z(1.0), np.array([10, 20, 30.0])  # the estimate has a frame of its own

        def tum(name, poses):
            line = "{} {} {} {} 0 0 {} {}\n"
            half = [np.arctan2(rotation[1, 0], rotation[0, 0]) / 2 for _, rotation, _ in poses]
            return self.file(name, "# time x y z qx qy qz qw\n" + "".join(
                line.format(time, *shift, np.sin(h), np.cos(h)) for (time, _, shift), h in zip(poses, half, strict=True)))

        moved = [(time + 1e-4, world[0] @ r, world[0] @ t + world[1]) for time, r, t in truth]
        tum("truth.tum", truth)
        tum("same.tum", moved[::-1])  # in any order
        arguments = ["evaluate", "--truth", "truth.tum", "--json", "--transform"]
        error = json.loads(self.igsp(*arguments, "same.tum", "--write", "same.kitti").stdout)
        self.assertEqual(error["poses"], 6)
        for value in [error["absolute"]["max"], error["relative"]["e_t"]["max"], error["relative"]["e_r_deg"]["max"]]:
            self.assertLess(value, 1e-5)
        kitti = np.loadtxt(self.folder / "same.kitti").reshape(-1, 3, 4)
        np.testing.assert_allclose(kitti[:, :, 3], [t for _, _, t in moved[::-1]], atol=1e-12)
        np.testing.assert_allclose(kitti[:, :, :3], [r for _, r, _ in moved[::-1]], atol=1e-12)
        wrong = [(time, rotation_z(0.3 * i + (0.1 if i == 3 else 0)), shift) for i, (time, _, shift) in enumerate(truth)]
        tum("wrong.tum", wrong[:5])
        error = json.loads(self.igsp(*arguments, "wrong.tum").stdout)
        self.assertEqual(error["poses"], 5)
        self.assertAlmostEqual(error["relative"]["e_r_deg"]["max"], np.degrees(0.1), 6)
        self.assertLess(error["absolute"]["rmse"], 1e-9)
        self.assertIn("poses     5 in both files", self.igsp(*arguments[:3], "--transform", "wrong.tum").stdout)
        self.refuses("evaluate", "--truth", "truth.tum", "--transform", tum("later.tum", [(99.0, np.eye(3), np.zeros(3))]),
                     code=2, saying="0 of 1 and 6 poses are of the same time")
        self.refuses("evaluate", "--truth", "truth.tum", "--transform", self.file("long.tum", "0 1 2 3 0 0 0 2\n" * 3),
                     code=3, saying=["long.tum", "line 1", "quaternion of length 2"])
        self.refuses("evaluate", "--truth", "truth.tum", "--transform", "same.kitti", "--write", "a.txt", code=2,
                     saying="6 poses need a name in .tum or .kitti")

    def test_what_is_no_transformation(self):
        self.matrix("truth.txt", np.eye(3), [0, 0, 0])
        self.file("short.txt", "1 0 0\n")
        for name in ["nowhere.txt", "short.txt", self.matrix("scaled.txt", 2 * np.eye(3), [0, 0, 0])]:
            self.refuses("evaluate", "--transform", name, "--truth", "truth.txt", code=3, saying=name)


class SimulateAndInfo(CommandTest):
    def test_simulated_files_and_the_commands_it_suggests(self):
        arguments = ["simulate", "indoor", "--points", "5000", "--stations", "3", "--seed", "1", "--out"]
        run = self.igsp(*arguments, "new/scans")
        expected = ["station_0.ply", "station_1.ply", "station_1_to_0.txt", "station_2.ply", "station_2_to_0.txt"]
        self.assertEqual(sorted(os.listdir(self.folder / "new/scans")), expected)
        self.assertIn("try: igsp align new/scans/station_1.ply new/scans/station_0.ply", run.stdout)
        self.igsp(*arguments, "again")
        for name in os.listdir(self.folder / "again"):
            first, second = self.folder / "new/scans" / name, self.folder / "again" / name
            self.assertEqual(first.read_bytes(), second.read_bytes())

    def test_simulation_mistakes(self):
        self.refuses("simulate", "prak", "--out", "x", code=2, saying=["prak", "park"])
        self.refuses("simulate", "park", "--out", "x", "--stations", "0", code=2, saying="stations")
        self.refuses("simulate", "park", code=2, saying="--out")
        self.refuses("simulate", "park", "--out", self.file("file"), code=3, saying="file")

    def test_info_by_hand(self):
        x, y = np.meshgrid(np.arange(40) * 0.5, np.arange(40) * 0.5)
        points = np.c_[x.ravel(), y.ravel(), np.zeros(1600)] + [100.0, 200.0, 300.0]
        points[0] = np.nan
        printed = self.igsp("info", self.cloud("grid.ply", points)).stdout
        for line in ["PLY, binary little endian", "1599 and 1 dropped", "19.5 x 19.5 x 0",
                     "from                  100 200 300\n", "to                    119.5 219.5 300\n",
                     "spacing               0.5\n", "suggested voxel size"]:
            self.assertIn(line, printed)
        self.refuses("info", "nowhere.ply", code=3, saying="nowhere.ply")

    def test_any_unit_of_length(self):
        x, y = np.meshgrid(np.arange(40) * 0.5, np.arange(40) * 0.5)
        for unit in [1e-40, 1e-10, 1e14, 1e40]:
            np.savetxt(self.folder / "grid.xyz", np.c_[x.ravel(), y.ravel(), np.zeros(1600)] * unit)
            self.assertIn(f"spacing               {0.5 * unit:.4g}\n", self.igsp("info", "grid.xyz").stdout)
        for arguments in [("--voxel-size", "1e39"), ("--initial", self.file("far.txt", "1 0 0 1e50\n0 1 0 0\n0 0 1 0"))]:
            self.assertIn("not registered", self.igsp("align", self.source, self.target, *arguments, code=1).stdout)
        np.savetxt(self.folder / "huge.xyz", np.c_[x.ravel(), y.ravel(), np.zeros(1600)] * 1e155)
        self.refuses("align", "huge.xyz", "huge.xyz", code=2, saying="in magnitude; at most 1e+150")


if __name__ == "__main__":
    unittest.main()
