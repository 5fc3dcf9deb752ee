"""igsp network as a user meets it. usage: network_command_test.py IGSP [unittest arguments]"""
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

IGSP = sys.argv.pop(1)
STATIONS = 4


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    NetworkCommand.site = Path(folder.name)
    subprocess.run([IGSP, "simulate", "park", "--out", folder.name, "--points", "30000", "--stations", str(STATIONS),
                    "--station-distance", "8", "--seed", "3"], check=True, stdout=subprocess.DEVNULL)


def pose_of(row):
    w, x, y, z = (float(row[k]) for k in ("qw", "qx", "qy", "qz"))
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = [float(row[k]) for k in ("tx", "ty", "tz")]
    return pose


class NetworkCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.scans = [self.site / f"station_{i}.ply" for i in range(STATIONS)]

    def network(self, *arguments, code=0):
        run = subprocess.run([IGSP, "network", *map(str, arguments), "--target-points", "3000"], capture_output=True,
                             text=True, cwd=self.folder)
        self.assertEqual(run.returncode, code, f"{arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def rows(self, name):
        with open(self.folder / "survey" / name, newline="") as file:
            return list(csv.DictReader(file))

    def check_poses(self, rows):
        for i, row in enumerate(rows[1:], 1):
            truth = np.loadtxt(self.site / f"station_{i}_to_0.txt")
            difference = np.linalg.inv(truth) @ np.linalg.inv(pose_of(rows[0])) @ pose_of(row)
            self.assertLess(np.linalg.norm(difference - np.eye(4)), 0.1, row)

    def test_writes_poses_links_and_everything(self):
        run = self.network(*self.scans, "-o", "survey")
        self.assertTrue(run.stdout.startswith("registered 4 of 4 scans: 4 in one frame\n"), run.stdout)
        self.assertRegex(run.stdout, r"[3-6] of 6 pairs registered, 0 rejected by the network, \d links? (are|is) unconfirmed "
                                     r"\(in no loop\); bundle error 0\.\d+")
        poses = self.rows("poses.csv")
        self.assertEqual([row["scan"] for row in poses], [str(path) for path in self.scans])
        self.assertEqual({row["component"] for row in poses}, {"0"})
        self.assertTrue((pose_of(poses[0]) == np.eye(4)).all())
        self.check_poses(poses)
        links = self.rows("links.csv")
        self.assertEqual(len(links), 6)
        everything = json.loads((self.folder / "survey/network.json").read_text())
        self.assertEqual([link["state"] for link in everything["links"]], [link["state"] for link in links])
        covariance = np.array(everything["scans"][2]["covariance"])
        self.assertTrue((np.linalg.eigvalsh(covariance) > 0).all())
        self.assertTrue((np.array(everything["scans"][0]["covariance"]) == 0).all())

    def test_g2o_and_tum_say_the_same(self):
        self.network(*self.scans, "-o", "survey")
        lines = [line.split() for line in (self.folder / "survey/network.g2o").read_text().splitlines()]
        vertices = [line[2:] for line in lines if line[0] == "VERTEX_SE3:QUAT"]
        tum = [line.split()[1:] for line in (self.folder / "survey/poses.tum").read_text().splitlines()]
        self.assertEqual(vertices, tum)
        edges = [line for line in lines if line[0] == "EDGE_SE3:QUAT"]
        used = [link for link in self.rows("links.csv") if link["state"] in ("used", "unconfirmed")]
        self.assertEqual(len(edges), len(used))
        for edge, link in zip(edges, used, strict=True):
            self.assertEqual(len(edge), 3 + 7 + 21)
            self.assertTrue(link["target"].endswith(f"station_{edge[1]}.ply"))
            self.assertEqual(edge[3:6], [link["tx"], link["ty"], link["tz"]])
            information, upper = np.zeros((6, 6)), np.array(edge[10:], float)
            information[np.triu_indices(6)] = upper
            information = information + np.triu(information, 1).T
            self.assertGreater(np.linalg.eigvalsh(information)[0], 0)

    def test_unreadable_scan_in_the_middle_does_not_stop_the_rest(self):
        broken = self.folder / "broken.ply"
        broken.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 5\nend_header\n")
        empty = self.folder / "empty.xyz"
        empty.write_bytes(b"")
        run = self.network(*self.scans[:2], broken, empty, *self.scans[2:], "-o", "survey", code=3)
        self.assertIn("registered 4 of 6 scans: 4 in one frame; 2 alone (broken: ", run.stdout)
        poses = self.rows("poses.csv")
        self.assertEqual([row["component"] for row in poses], ["0", "0", "1", "2", "0", "0"])
        self.check_poses(poses[:2] + poses[4:])

    def kept(self, kind):
        return {path.name: path.stat().st_mtime_ns for path in (self.cache() / kind).iterdir()}

    def cache(self):
        (folder,) = (self.folder / "survey/cache").iterdir()
        return folder

    def outputs(self, folder="survey"):
        return {path.name: path.read_bytes() for path in (self.folder / folder).iterdir() if path.is_file()}

    def test_goes_on_where_an_earlier_run_stopped(self):
        self.network(*self.scans, "-o", "survey")
        whole, features, pairs = self.outputs(), self.kept("features"), self.kept("pairs")
        self.assertEqual((len(features), len(pairs)), (4, 6))
        for name in sorted(pairs)[:3]:
            (self.cache() / "pairs" / name).unlink()
        damaged = self.cache() / "features" / sorted(features)[0]
        damaged.write_bytes(damaged.read_bytes()[:1000])
        self.network(*self.scans, "-o", "survey")
        self.assertEqual(self.outputs(), whole)
        again = self.kept("pairs")
        self.assertEqual(sum(again[name] == pairs[name] for name in pairs), 3)
        self.assertEqual(sum(self.kept("features")[name] == features[name] for name in features), 3)

    def test_answers_of_another_method_are_not_taken(self):
        self.network(*self.scans[:2], "-o", "survey")
        ours = self.cache()
        self.assertRegex(ours.name, "^[0-9a-f]{12}$")
        ours.rename(ours.parent / "0123456789ab")
        other = {path: path.stat().st_mtime_ns for path in ours.parent.rglob("*")}
        self.network(*self.scans[:2], "-o", "survey")
        self.assertEqual(len(list((ours / "features").iterdir())), 2)
        self.assertEqual(len(list((ours / "pairs").iterdir())), 1)
        self.assertEqual({path: path.stat().st_mtime_ns for path in other}, other)

    def test_the_method_has_another_number_when_its_sources_change(self):
        root = Path(__file__).resolve().parent.parent

        def number(folder):
            output = self.folder / "number.cpp"
            subprocess.run(["cmake", f"-DSOURCE_DIR={folder}", f"-DOUTPUT={output}", "-P",
                            str(root / "cmake/method_number.cmake")], check=True)
            return output.read_text()

        for part in ("src", "apps", "python/igsp/formats"):
            shutil.copytree(root / part, self.folder / part)
        first = number(self.folder)
        self.assertEqual(first, number(root))
        for name, changes in [("src/registration/verdict.cpp", True), ("src/features/bsc.hpp", True),
                              ("apps/igsp/files/cloud_input.cpp", True), ("src/features/bsc_test.cpp", False),
                              ("src/network/decide.cpp", False)]:
            source = self.folder / name
            text = source.read_text()
            source.write_text(text + "// changed\n")
            self.assertEqual(number(self.folder) != first, changes, name)
            source.write_text(text)
        (self.folder / "src/registration/new_stage.cpp").write_text("")
        self.assertNotEqual(number(self.folder), first)

    def test_scan_added_later_is_only_paired_with_the_others(self):
        self.network(*self.scans[:3], "-o", "survey")
        before = self.kept("pairs")
        self.network(*self.scans, "-o", "survey")
        after = self.kept("pairs")
        self.assertEqual(len(after), len(before) + 3)
        self.assertEqual({name: after[name] for name in before}, before)
        self.check_poses(self.rows("poses.csv"))

    def test_changed_file_is_noticed(self):
        copies = []
        for i in range(2):
            copies.append(self.folder / f"copy_{i}.ply")
            copies[i].write_bytes(self.scans[i].read_bytes())
        self.network(*copies, "-o", "survey")
        copies[1].write_bytes(self.scans[2].read_bytes())
        self.network(*copies, "-o", "survey")
        self.assertEqual(len(self.kept("features")), 3)
        truth = np.loadtxt(self.site / "station_2_to_0.txt")
        self.assertLess(np.abs(pose_of(self.rows("poses.csv")[1]) - truth).max(), 0.1)

    def test_folder_and_viewpoints(self):
        (self.folder / "viewpoints.csv").write_text("scan,x,y,z\nstation_1.ply,0,0,0\nstation_0,0,0,0\n")
        self.network(self.site, "-o", "survey", "--viewpoints", "viewpoints.csv")
        poses = self.rows("poses.csv")
        self.assertEqual([row["scan"] for row in poses], [str(path) for path in self.scans])
        self.check_poses(poses)

    def test_what_the_world_is(self):
        self.network(*self.scans[:3], "-o", "survey", "--fix", "station_2")
        poses = self.rows("poses.csv")
        self.assertTrue((pose_of(poses[2]) == np.eye(4)).all())
        self.check_poses(poses)
        self.assertIn("FIX 2\n", (self.folder / "survey/network.g2o").read_text())
        place = np.loadtxt(self.site / "station_1_to_0.txt")[:3, 3] + [1000, 2000, 0]
        lines = ["scan,x,y,z,sigma,qw,qx,qy,qz,sigma_deg", "station_0.ply,1000,2000,0,0.01,1,0,0,0,0.1",
                 f"station_1,{place[0]},{place[1]},{place[2]},0.01,,,,,"]
        (self.folder / "control.csv").write_text("\n".join(lines) + "\n")
        self.network(*self.scans[:3], "-o", "survey", "--control", "control.csv", "--levelled")
        poses = self.rows("poses.csv")
        self.check_poses(poses)
        np.testing.assert_allclose(pose_of(poses[1])[:3, 3], place, atol=0.05)
        self.assertEqual(pose_of(poses[1])[2, 2], 1)
        everything = json.loads((self.folder / "survey/network.json").read_text())
        self.assertLess(everything["scans"][1]["control_residual"], 0.05)
        self.assertNotIn("FIX", (self.folder / "survey/network.g2o").read_text())
        (self.folder / "control.csv").write_text("\n".join(["scan,x,y,z,sigma", "station_0,1,2,3,0.1"]))
        run = self.network(*self.scans[:3], "-o", "survey", "--control", "control.csv")
        self.assertIn("warning: the control of component 0 (3 scans) does not say where it lies", run.stderr)

    def test_moved_scans_and_the_merged_cloud(self):
        text = self.folder / "colours.xyz"
        points = self.points_of(self.scans[1])
        text.write_text("".join(f"{x} {y} {z} {i % 256} tree\n" for i, (x, y, z) in enumerate(points)))
        lone = self.folder / "lone.xyz"
        lone.write_text("".join(f"{x} {y} {z}\n" for x, y, z in np.random.default_rng(0).uniform(size=(2000, 3))))
        self.network(self.scans[0], text, lone, self.scans[2], "-o", "survey", "--write", "aligned", "--merged", "all.ply",
                     code=1)
        self.assertEqual(sorted(path.name for path in (self.folder / "aligned").iterdir()),
                         ["colours.xyz", "station_0.ply", "station_2.ply"])
        poses = self.rows("poses.csv")
        world = []
        for row, path, source in [(poses[0], "station_0.ply", self.points_of(self.scans[0])),
                                  (poses[3], "station_2.ply", self.points_of(self.scans[2]))]:
            pose = pose_of(row)
            world.append(source @ pose[:3, :3].T + pose[:3, 3])
            np.testing.assert_allclose(self.points_of(self.folder / "aligned" / path), world[-1], atol=1e-3)
        lines = [line.split() for line in (self.folder / "aligned/colours.xyz").read_text().splitlines()]
        self.assertEqual([line[3:] for line in lines[:300]], [[str(i % 256), "tree"] for i in range(300)])
        world.append(np.array([line[:3] for line in lines], float))
        pose = pose_of(poses[1])
        np.testing.assert_allclose(world[-1], points @ pose[:3, :3].T + pose[:3, 3], atol=1e-3)
        merged = self.points_of(self.folder / "all.ply")
        half = json.loads((self.folder / "survey/network.json").read_text())["voxel_size"] / 2
        everything = np.concatenate(world)
        centre = np.array(json.loads((self.folder / "survey/network.json").read_text())["scans"][0]["centre"])
        cells = {tuple(cell) for cell in np.floor((everything - centre) / half).astype(int)}
        self.assertAlmostEqual(len(merged), len(cells), delta=0.002 * len(cells))
        self.assertLess(np.abs(merged.mean(0) - [np.mean([(np.array(c) + 0.5) * half + centre for c in cells], 0)]).max(),
                        half)
        self.refuses(self.scans[0], self.scans[1], "-o", "survey", "--write", str(self.site), code=2,
                     saying="would be overwritten; choose another folder")

    def test_a_merged_las_is_for_the_package_which_is_said_before_the_work(self):
        for name in ["all.laz", "all.LAS"]:
            self.refuses(self.scans[0], self.scans[1], "-o", "survey", "--merged", name, code=3,
                         saying=f"--merged {name}: .{name[4:].lower()} is written by the same command from pip install "
                                "'igsp[las]'")
            self.assertFalse((self.folder / "survey").exists())

    @staticmethod
    def points_of(path):
        content = path.read_bytes()
        end = content.index(b"end_header\n") + 11
        head = content[:end].decode()
        kind = "<f8" if "property double x" in head or "property float64 x" in head else "<f4"
        count = next(int(line.split()[2]) for line in head.splitlines() if line.startswith("element vertex"))
        return np.frombuffer(content, np.dtype([(axis, kind) for axis in "xyz"]), count, end).view(kind).reshape(-1, 3
                                                                                                                 ).astype(float)

    def test_which_pairs_are_tried(self):
        (self.folder / "pairs.csv").write_text("source,target\nstation_0.ply,station_1\nstation_2,station_1\n")
        self.network(*self.scans[:3], "-o", "survey", "--pairs", "pairs.csv")
        self.assertEqual([(row["source"][-5:], row["target"][-5:]) for row in self.rows("links.csv")],
                         [("1.ply", "0.ply"), ("2.ply", "1.ply")])
        self.network(*self.scans, "-o", "survey", "--pairs", "auto")
        self.check_poses(self.rows("poses.csv"))

    def refuses(self, *arguments, code, saying):
        run = self.network(*arguments, code=code)
        self.assertIn(saying, run.stderr)
        self.assertEqual(run.stderr.count("\n"), 1, run.stderr)

    def test_the_help_names_the_defaults_that_hold(self):
        self.network(*self.scans[:2], "-o", "survey")
        options = json.loads((self.folder / "survey/network.json").read_text())
        said = " ".join(self.network("--help").stdout.split())
        for name in ["min_unconfirmed_confidence", "min_unconfirmed_matches"]:
            _, _, text = said.partition(f"--{name.replace('_', '-')} ")
            self.assertEqual(text.split("; default ")[1].split()[0], str(options[name]))

    def test_refusals_name_the_cause(self):
        self.refuses(self.scans[0], "-o", "survey", code=2, saying="a network needs at least two scans")
        self.refuses(self.scans[0], self.scans[0], "-o", "survey", code=2, saying="is given twice")
        (self.folder / "nothing").mkdir()
        self.refuses("nothing", "-o", "survey", code=3, saying="a folder without any point cloud")
        (self.folder / "v.csv").write_text("scan,x,y,z\nother,0,0,0\n")
        self.refuses(*self.scans, "-o", "survey", "--viewpoints", "v.csv", code=3,
                     saying='v.csv: line 2, column 1 (scan): "other" is none of the scans given')
        (self.folder / "v.csv").write_text("scan,x,y\nother,0,0\n")
        self.refuses(*self.scans, "-o", "survey", "--viewpoints", "v.csv", code=3, saying="has no column z")
        self.refuses(*self.scans, "-o", "survey", "--fix", "nobody", code=2, saying="--fix nobody: none of the scans")
        (self.folder / "c.csv").write_text("scan,x,y,z,sigma\nstation_0,0,0,0,0\n")
        self.refuses(*self.scans, "-o", "survey", "--control", "c.csv", code=3, saying="is not greater than 0")
        self.refuses(*self.scans, "-o", "survey", "--control", "c.csv", "--fix", "station_0", code=2,
                     saying="give one of them")
        self.refuses(*self.scans, "-o", "survey", "--pairs", "automatic", code=3, saying="automatic")
        (self.folder / "p.csv").write_text("source,target\nstation_0,station_0\n")
        self.refuses(*self.scans, "-o", "survey", "--pairs", "p.csv", code=3, saying="the scan is paired with itself")
        self.refuses(*self.scans, "-o", "survey", "--min-unconfirmed-confidence", "2", code=2,
                     saying="min_unconfirmed_confidence is 2")
        self.refuses(*self.scans, "-o", "survey", "--max-points", "10", code=2, saying="must be at least 1000")
        (self.folder / "v.csv").write_text("scan,x,y,z\nstation_0,1,2,nan\n")
        self.refuses(*self.scans, "-o", "survey", "--viewpoints", "v.csv", code=3,
                     saying='v.csv: line 2, column 4 (z): "nan" is not a finite number')

    def test_the_engine_of_the_package_is_named(self):
        pair = [*self.scans[:2], "-o", "survey"]
        self.refuses(*pair, "--engine", "remote", code=2, saying="it must be local or dask")
        self.refuses(*pair, "--engine", "dask", code=2, saying="belong together")
        self.refuses(*pair, "--scheduler", "tcp://127.0.0.1:1", code=2, saying="belong together")
        self.refuses(*pair, "--engine", "dask", "--scheduler", "tcp://127.0.0.1:1", code=2,
                     saying="pip install 'igsp[dask]'")

    def test_scans_of_one_name_cannot_be_written_beside_each_other(self):
        for folder, scan in [("a", self.scans[0]), ("b", self.scans[1])]:
            (self.folder / folder).mkdir()
            shutil.copy(scan, self.folder / folder / "scan.ply")
        self.refuses("a/scan.ply", "b/scan.ply", "-o", "survey", "--write", "moved", code=2,
                     saying="a/scan.ply and b/scan.ply would be written under one name")

    def test_a_scan_in_millimetres_among_metres_is_warned_of(self):
        points = self.points_of(self.scans[1]) * 1000
        np.savetxt(self.folder / "mm.xyz", points, "%.3f")
        run = self.network(self.scans[0], self.scans[2], "mm.xyz", "-o", "survey", code=1)
        self.assertIn("1 of 3 pairs registered, 0 rejected by the network, 1 link is unconfirmed (in no loop)", run.stdout)
        self.assertIn("igsp: warning: mm.xyz: in another unit than the others?", run.stderr)
        self.assertEqual(self.network(self.scans[0], self.scans[2], "mm.xyz", "-o", "other", "--quiet", code=1).stderr, "")


if __name__ == "__main__":
    unittest.main()
