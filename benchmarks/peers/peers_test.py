"""The driver of the peers, without the peers. usage: peers_test.py IGSP [unittest arguments]"""
import csv
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

from bench_peers import judged, key_of_run, rows_of, runs_of
from launch import Programs, launch, missing_programs
from methods import ALL_THREADS, METHODS, Method, Run, rounds
from metrics import pose_errors, rotation_angle_rad
from pairs import export_pair, perturbed_truth, read_cloud
from rows import COLUMNS, SAME_AS_IGSP, append_rows, key_of, read_rows, write_rows
from summary import document, not_run
from tallies import tallies

IGSP = Path(sys.argv.pop(1)).resolve()
HERE = Path(__file__).resolve().parent
CASES = """name,group,source,target,truth,max_rotation_error_deg,max_translation_error_m
park/[1]--0,park,scans/station_1.ply,scans/station_0.ply,scans/station_1_to_0.txt,2,0.3
odd,negative,scans/station_1.ply,scans/noise.xyz,none,0,0
"""
# A peer in a few lines of Python; its second answer is a reflection.
PEER = """
import numpy as np
VERSION = "1.2"
def register(method, source, target, voxel_size, seed, threads, guess):
    assert source.shape[1] == target.shape[1] == 3 and guess is None
    if method == "fails": raise RuntimeError("no luck")
    if method == "never_ends":
        while True: pass
    sorted(source.ravel().tolist())  # some seconds to measure
    yield {"label": "", "target_from_source": np.eye(4), "score": 0.5, "converged": False}
    yield {"label": "icp", "target_from_source": np.diag([1, 1, -1, 1.0]), "score": voxel_size, "converged": True}
"""


def rotation(axis, angle):
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def motion(axis, angle, translation):
    transformation = np.eye(4)
    transformation[:3, :3] = rotation(np.array(axis, float), angle)
    transformation[:3, 3] = translation
    return transformation


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    global root, pair, own_row
    root = Path(folder.name)
    subprocess.run([IGSP, "simulate", "park", "--out", root / "scans", "--points", "60000"], check=True,
                   stdout=subprocess.DEVNULL)
    np.savetxt(root / "scans/noise.xyz", np.random.default_rng(0).normal(size=(500, 3)))
    (root / "cases.csv").write_text(CASES)
    subprocess.run([IGSP, "benchmark", root / "cases.csv", "--out", root / "own.csv"], check=True,
                   stdout=subprocess.DEVNULL)
    with open(root / "own.csv", newline="") as file:
        own_row = next(csv.DictReader(file))
    pair = export_pair(IGSP, root / "cases.csv", "park/[1]--0", 7, root / "pair")


class Metrics(unittest.TestCase):
    def test_angles_from_tiny_to_half_a_turn(self):
        for axis in ([1, 0, 0], [0, 1, 0], [0, 0, 1], [1, -2, 3], [-1, 1e-3, 1]):
            for angle in (1e-9, 1e-5, 0.1, 2, np.pi - 1e-7, np.pi):
                self.assertAlmostEqual(rotation_angle_rad(rotation(np.array(axis, float), angle)) / angle, 1, 9)
        self.assertEqual(rotation_angle_rad(np.eye(3)), 0)

    def test_errors_by_hand(self):
        truth = motion([0, 0, 1], 0.7, [5, 6, 7])
        centroid = np.array([1.0, 2.0, 3.0])
        for value in pose_errors(truth, truth, centroid).values():
            self.assertLess(value, 1e-12)
        place = truth[:3, :3] @ centroid + truth[:3, 3]
        off = motion([0, 0, 1], np.radians(90), [0, 0, 0])  # about the target's origin
        errors = pose_errors(off @ truth, truth, centroid)
        self.assertAlmostEqual(errors["e_r_deg"], 90)
        self.assertAlmostEqual(errors["e_t"], 0)
        self.assertAlmostEqual(errors["centroid_displacement"], np.sqrt(2) * np.hypot(place[0], place[1]))

    def test_what_is_no_rigid_motion(self):
        for wrong in (np.diag([1, 1, -1, 1.0]), np.diag([2, 2, 2, 1.0]), np.full((4, 4), np.nan)):
            with self.assertRaises(ValueError):
                pose_errors(wrong, np.eye(4), np.zeros(3))

    def test_the_same_errors_as_igsp_benchmark(self):
        outcome = launch(Run(METHODS[0], "igsp", 1, 1), pair, 0.0, None, Programs(IGSP, IGSP, IGSP), root)
        centroid = read_cloud(pair.source).mean(axis=0)
        values = judged(pair, outcome.answers[0], centroid)
        self.assertEqual((values["verdict"], values["success"]), ("registered", True))
        self.assertEqual((own_row["verdict"], own_row["success"]), ("registered", "yes"))
        for name in ("e_r_deg", "e_t", "centroid_displacement"):
            self.assertAlmostEqual(values[name], float(own_row[name]), 7, name)
        perfect = {"target_from_source": pair.truth, "converged": True}
        self.assertLess(judged(pair, perfect, centroid)["centroid_displacement"], 1e-9)
        self.assertGreater(np.abs(pair.truth - np.eye(4)).max(), 0.5)  # moved, so not by chance


class Runs(unittest.TestCase):
    def setUp(self):
        (root / "fake_peer.py").write_text(PEER)
        os.environ["PYTHONPATH"] = f"{root}"
        self.programs = Programs(IGSP, root / "nowhere", Path(sys.executable))

    def launch(self, method, limit=60):
        run = Run(Method("fake", "fake_peer", method, seeds=3, time_limit_s=limit), "igsp", 1, 2)
        outcome = launch(run, pair, 0.25, None, self.programs, root)
        return rows_of(pair, run, outcome, 0.25, np.zeros(3), 7, {"igsp_cpu_seconds": 0.5}), run

    def test_a_row_per_answer(self):
        (first, second), run = self.launch("works")
        self.assertEqual(first["preset"], "fake")
        self.assertEqual((first["verdict"], first["success"], first["error"]), ("not_registered", "no", ""))
        self.assertEqual((first["version"], first["seed"], first["threads"], first["score"]), ("1.2", "2", "1", "0.5"))
        self.assertEqual((first["voxel_size"], first["igsp_cpu_seconds"], first["scramble"]), ("0.25", "0.5", "7"))
        for name in ("cpu_seconds", "wall_seconds", "process_cpu_seconds", "peak_memory_bytes", "memory_before_bytes"):
            self.assertGreater(float(first[name]), 0, name)
        self.assertLess(float(first["cpu_seconds"]), float(first["process_cpu_seconds"]))
        self.assertEqual((second["preset"], second["verdict"], second["success"]), ("fake+icp", "", ""))
        self.assertIn("reflection", second["error"])
        self.assertEqual(key_of(first), key_of_run(pair.name, run, 7))
        self.assertEqual(key_of(second), key_of(first))

    def test_errors_are_rows(self):
        (row,), _ = self.launch("fails")
        self.assertEqual((row["error"], row["verdict"]), ("exit code 1: RuntimeError: no luck", ""))
        (row,), _ = self.launch("never_ends", limit=1)
        self.assertEqual(row["error"], "stopped after 1 s of CPU")

    def test_igsp_without_an_answer(self):
        odd = export_pair(IGSP, root / "cases.csv", "odd", 7, root / "odd")
        run = Run(METHODS[0], "igsp", 1, 1)
        outcome = launch(run, odd, 0.0, None, self.programs, root)
        (row,) = rows_of(odd, run, outcome, 0.1, np.zeros(3), 7, {})
        self.assertEqual((row["verdict"], row["success"], row["e_r_deg"]), ("not_registered", "yes", ""))

    def test_missing_peers_are_named(self):
        missing = missing_programs({"igsp", "pcl", "fake_peer", "no_such_peer"}, self.programs)
        self.assertEqual(set(missing), {"pcl", "no_such_peer"})
        self.assertIn("No such file", missing["pcl"])
        self.assertIn("no_such_peer", missing["no_such_peer"])

    def test_the_whole_driver_with_only_igsp(self):
        out = root / "peers.csv"
        command = [sys.executable, HERE / "bench_peers.py", "--igsp", IGSP, "--pcl-peer", root / "nowhere", "--python",
                   root / "nowhere", "--cases", root / "cases.csv", "--out", out]
        run = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("cannot be run: pcl: nowhere: No such file", run.stdout)
        rows = read_rows(out)
        self.assertEqual({row["preset"] for row in rows}, {"igsp", "igsp_paper", "igsp_refine"})
        fine = next(row for row in rows if row["preset"] == "igsp_refine")
        self.assertEqual(fine["success"], "yes")
        out.write_text("".join(out.read_text().splitlines(True)[:-1]) + "park/[1]--0,par")  # stopped while it wrote
        run = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(run.stdout.count("/1 "), 1, run.stdout)
        self.assertEqual(len(read_rows(out)), len(rows))
        run = subprocess.run(command + ["--peer", "igsp", "--again"], capture_output=True, text=True)
        self.assertEqual(len(read_rows(out)), len(rows))
        self.assertEqual(read_rows(out)[-1]["preset"], "igsp")  # in place of the old ones
        # What this writes, igsp benchmark reads.
        compared = subprocess.run([IGSP, "benchmark", root / "cases.csv", "--compare", out, "--quiet", "--out",
                                   root / "compared.csv"], capture_output=True, text=True)
        self.assertIn("compared: ", compared.stdout, compared.stderr)
        run = subprocess.run(command + ["--only", "nothing"], capture_output=True, text=True)
        self.assertIn("selects no case", run.stderr)


def row(preset, name, truth="known", verdict="registered", success="yes", **others):
    return dict.fromkeys(COLUMNS, "") | {
        "preset": preset, "name": name, "group": "g" if truth == "known" else "negative", "truth": truth,
        "verdict": verdict, "success": success, "voxels": "igsp", "threads": "1", "version": "1", "scramble": "7",
        **others}


class Tallies(unittest.TestCase):
    rows = [row("open3d_fgr", "a", e_r_deg="1", score="9", cpu_seconds="4", igsp_cpu_seconds="2", seed="1"),
            row("open3d_fgr", "a", e_r_deg="90", score="3", success="no", cpu_seconds="6", igsp_cpu_seconds="1",
                seed="2"),
            row("open3d_fgr", "b", e_r_deg="3", score="5", verdict="not_registered", seed="1"),
            row("open3d_fgr", "c", truth="none", score="7", success="no"),
            row("open3d_fgr", "d", truth="none", score="4", verdict="not_registered"),
            row("open3d_fgr", "e", verdict="", success="", error="stopped after 1 s of CPU"),
            row("open3d_fgr", "a", threads="all"), row("open3d_fgr", "a", voxels="recommended"),
            row("igsp", "a", reason="looks good"), row("igsp", "b", verdict="not_registered", reason="who knows"),
            row("igsp", "c", truth="none", verdict="not_registered"), row("igsp_refine", "a")]

    def test_counts_by_hand(self):
        tally = tallies(self.rows)["open3d_fgr"]
        self.assertEqual((len(tally.pairs), len(tally.known), len(tally.right), len(tally.said)), (5, 4, 2, 1))
        self.assertEqual((len(tally.false_accepts), len(tally.failures)), (2, 1))
        self.assertEqual((tally.solved(all), tally.solved(any)), ({"b"}, {"a", "b"}))
        self.assertEqual((tally.in_a_pass(tally.right), tally.known_pairs), (1.5, 3))  # a in one of two runs
        self.assertEqual(tally.median("e_r_deg", right_only=True), 2)
        self.assertEqual(tally.ratio("cpu_seconds", "igsp_cpu_seconds"), 4)  # of 2 and 6
        self.assertEqual([row["score"] for row in tally.right_without_false_accept()], ["9"])  # above 7; 5 is not
        self.assertEqual(list(tallies(self.rows)), ["igsp", "igsp_refine", "open3d_fgr"])

    def test_the_page(self):
        text = document(self.rows, not_run(self.rows, Programs(IGSP, root / "nowhere", root / "nowhere")))
        self.assertIn("| Open3D FGR | 6 on 5 | 1.5 of 3 | 1 / 2 | 2 of 2 | 0 / 0 | 0.5 | 1.5 (1 of 2) | 1 |", text)
        self.assertIn("| b | right but refused | who knows | Open3D FGR |", text)
        self.assertIn("**Not run:** PCL NDT: nowhere: No such file or directory.", text)
        self.assertIn("- e, Open3D FGR (igsp voxels, 1 threads, seed -): stopped after 1 s of CPU", text)
        self.assertNotIn("{", text)


class Bookkeeping(unittest.TestCase):
    def test_columns_are_those_of_igsp_benchmark(self):
        self.assertEqual(list(own_row), SAME_AS_IGSP)

    def test_rows_read_back(self):
        path = root / "rows.csv"
        row = dict.fromkeys(COLUMNS, "") | {"name": "a, \"b\"", "preset": "x+icp", "seed": "1"}
        write_rows(path, [row])
        append_rows(path, [row, row])
        self.assertEqual(read_rows(path), [row] * 3)
        path.write_text("precious,data\n1,2\n")
        with self.assertRaises(SystemExit):
            read_rows(path)

    def test_the_plan(self):
        passes = rounds([Method("a", "igsp"), Method("b", "x", seeds=3, every=2, recommended=(("g", 0.3),)),
                         Method("fine", "x", from_guess=True)])
        known, none = {"truth": "t.txt", "group": "g"}, {"truth": "none", "group": "negative"}

        def all_runs(case, number, every=1):
            runs = [run for some in passes for run in runs_of(case, number, some, every)]
            return sorted((r.method.name, r.voxels, r.threads, r.seed) for r in runs)

        self.assertEqual(all_runs(known, 1), [("a", "igsp", 1, 1), ("fine", "igsp", 1, 1)])
        self.assertEqual(all_runs(known, 0), sorted(
            [("a", "igsp", 1, 1), ("a", "igsp", ALL_THREADS, 1), ("fine", "igsp", 1, 1),
             ("fine", "igsp", ALL_THREADS, 1), ("b", "igsp", ALL_THREADS, 1), ("b", "recommended", 1, 1),
             ("b", "igsp", 1, 1), ("b", "igsp", 1, 2), ("b", "igsp", 1, 3)]))
        self.assertEqual(all_runs(known, 2, every=4), [])
        self.assertEqual(all_runs(none, 1, every=4), [("a", "igsp", 1, 1)])  # whatever --every
        self.assertEqual(len(all_runs(none, 2)), 4)
        wider, narrower = ({n for n in range(40) if all_runs(known, n, every)} for every in (2, 4))
        self.assertLess(narrower, wider)  # a sample can be widened later

    def test_guesses_are_two_degrees_and_two_voxels_away(self):
        centroid = read_cloud(pair.source).mean(axis=0)
        guess = perturbed_truth(pair, 0.1, centroid)
        errors = pose_errors(guess, pair.truth, centroid)
        self.assertAlmostEqual(errors["e_r_deg"], 2)
        self.assertAlmostEqual(errors["centroid_displacement"], 0.2)
        np.testing.assert_array_equal(guess, perturbed_truth(pair, 0.1, centroid))

    def test_clouds_that_are_none(self):
        for content in (b"", b"ply\nformat ascii 1.0\nend_header\n", pair.source.read_bytes()[:-24]):
            path = root / "broken.ply"
            path.write_bytes(content)
            with self.assertRaises(ValueError):
                read_cloud(path)


if __name__ == "__main__":
    unittest.main()
