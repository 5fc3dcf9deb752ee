"""What makes one cloud out of another: igsp transform, convert and downsample, on files of every format.
usage: clouds_test.py IGSP [unittest arguments]
"""
import os
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction
from math import floor
from pathlib import Path

import numpy as np

IGSP = os.path.abspath(sys.argv.pop(1))
CHUNK = 65536  # points that the readers hand out at once
PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
             "double": "f8"}


def rigid(seed: int) -> np.ndarray:
    random = np.random.default_rng(seed)
    rotation, _ = np.linalg.qr(random.normal(size=(3, 3)))
    motion = np.eye(4)
    motion[:3, :3] = rotation * np.sign(np.linalg.det(rotation))
    motion[:3, 3] = random.uniform(-5, 5, 3)
    return motion


class CloudTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def igsp(self, *arguments, code: int = 0, **keywords) -> subprocess.CompletedProcess:
        done = subprocess.run([IGSP, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, **keywords)
        self.assertEqual(done.returncode, code, f"{arguments}\n{done.stdout}{done.stderr}")
        return done

    def write_ply(self, name: str, points: np.ndarray, extra: dict[str, np.ndarray] | None = None, kind="f8") -> Path:
        """Binary, x y z of one type and other properties behind them."""
        names = {read: written for written, read in PLY_TYPES.items()}
        fields = [("x", points[:, 0].astype(kind)), ("y", points[:, 1].astype(kind)), ("z", points[:, 2].astype(kind))]
        fields += list((extra or {}).items())
        table = np.zeros(len(points), [(name, values.dtype) for name, values in fields])
        for field, values in fields:
            table[field] = values
        header = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n"
        header += "".join(f"property {names[values.dtype.str[1:]]} {field}\n" for field, values in fields)
        (self.folder / name).write_bytes((header + "end_header\n").encode() + table.tobytes())
        return self.folder / name

    def read_ply(self, name: str) -> np.ndarray:
        header, body = (self.folder / name).read_bytes().split(b"end_header\n", 1)
        words = [line.split() for line in header.decode().splitlines()]
        return np.frombuffer(body, [(line[2], "<" + PLY_TYPES[line[1]]) for line in words if line[0] == "property"])

    def xyz(self, name: str) -> np.ndarray:
        table = self.read_ply(name)
        return np.column_stack([table[axis].astype(float) for axis in "xyz"])

    def save_motion(self, motion: np.ndarray) -> None:
        (self.folder / "T.txt").write_text("\n".join(" ".join(map(repr, map(float, row))) for row in motion))


class Transform(CloudTest):
    def test_points_across_chunks_and_their_attributes(self):
        count = 2 * CHUNK + 1
        random = np.random.default_rng(1)
        points = random.normal(size=(count, 3))
        normals = random.normal(size=(count, 3)).astype("f4")
        extra = {"intensity": random.integers(0, 65536, count).astype("u2"), "nx": normals[:, 0], "ny": normals[:, 1],
                 "nz": normals[:, 2], "red": random.integers(0, 256, count).astype("u1")}
        self.write_ply("a.ply", points, extra)
        motion = rigid(2)
        self.save_motion(motion)
        self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", "b.ply")
        moved = self.read_ply("b.ply")
        np.testing.assert_allclose(self.xyz("b.ply"), points @ motion[:3, :3].T + motion[:3, 3], atol=1e-14)
        turned = np.column_stack([moved[axis] for axis in ("nx", "ny", "nz")])
        np.testing.assert_allclose(turned, normals @ motion[:3, :3].T, atol=1e-6)
        for name in ("intensity", "red"):
            np.testing.assert_array_equal(moved[name], extra[name])
        self.igsp("transform", "b.ply", "--transform", "T.txt", "--inverse", "-o", "c.ply")
        np.testing.assert_allclose(self.xyz("c.ply"), points, atol=1e-13)

    def test_is_what_align_writes(self):
        self.igsp("simulate", "park", "--points", "60000", "--out", ".")
        pair = ["station_1.ply", "station_0.ply"]
        self.igsp("align", *pair, "--transform", "T.txt", "-o", "aligned.ply", "--quiet")
        self.igsp("transform", pair[0], "--transform", "T.txt", "-o", "moved.ply")
        self.assertEqual((self.folder / "moved.ply").read_bytes(), (self.folder / "aligned.ply").read_bytes())

    def test_every_format_the_same_points(self):
        points = np.random.default_rng(3).normal(size=(CHUNK + 3, 3))
        self.write_ply("a.ply", points)
        self.save_motion(rigid(4))
        self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", "whole.ply")
        for name in ("a.pcd", "a.xyz", "a.csv", "a.pts"):
            self.save_motion(np.eye(4))
            self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", name)
            self.save_motion(rigid(4))
            self.igsp("transform", name, "--transform", "T.txt", "-o", "moved" + name[1:])
            self.save_motion(np.eye(4))
            self.igsp("transform", "moved" + name[1:], "--transform", "T.txt", "-o", "again.ply")
            self.assertEqual(self.xyz("again.ply").tobytes(), self.xyz("whole.ply").tobytes(), name)

    def test_floats_far_from_the_origin_become_doubles(self):
        points = np.random.default_rng(5).uniform(0, 10, (20000, 3))
        self.write_ply("a.ply", points, kind="f4")
        motion = np.eye(4)
        motion[:3, 3] = [500000, 5000000, 100]
        self.save_motion(motion)
        said = self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", "b.ply").stdout
        self.assertIn("b.ply holds its coordinates as doubles", said)
        np.testing.assert_allclose(self.xyz("b.ply") - motion[:3, 3], points.astype("f4"), atol=1e-8)

    def test_clouds_without_extent(self):
        self.save_motion(rigid(6))
        for count in (0, 1, 2):
            self.write_ply("a.ply", np.ones((count, 3)))
            self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", "b.ply")
            self.assertEqual(len(self.read_ply("b.ply")), count)

    def test_mistakes(self):
        self.write_ply("a.ply", np.ones((3, 3)))
        self.save_motion(np.eye(4))
        for output, code, saying in [("a.ply", 2, "same file"), ("no/b.ply", 3, "no/b.ply"), ("b.las", 2, "b.las"),
                                     ("b.unknown", 3, "unknown")]:
            done = self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", output, code=code)
            self.assertIn(saying, done.stderr)
        self.save_motion(2 * np.eye(4))
        self.assertIn("T.txt", self.igsp("transform", "a.ply", "--transform", "T.txt", "-o", "b.ply", code=3).stderr)
        self.assertFalse((self.folder / "b.ply").exists())


class Convert(CloudTest):
    def full_cloud(self, count: int) -> dict[str, np.ndarray]:
        random = np.random.default_rng(12)
        extra = {axis: random.normal(size=count).astype("f4") for axis in ("nx", "ny", "nz")}
        extra |= {colour: random.integers(0, 256, count).astype("u1") for colour in ("red", "green", "blue")}
        extra |= {"intensity": random.integers(0, 65536, count).astype("u2"), "gps_time": random.normal(size=count)}
        for kind in ("i1", "i2", "i4", "u4"):
            least, greatest = np.iinfo(kind).min, np.iinfo(kind).max
            extra[f"label_{kind}"] = random.integers(least, greatest, count, dtype=kind, endpoint=True)
            extra[f"label_{kind}"][:2] = least, greatest
        self.write_ply("a.ply", random.normal(size=(count, 3)), extra)
        return extra

    def test_there_and_back_every_bit_stays(self):
        """Through each format and encoding, across chunks."""
        self.full_cloud(CHUNK + 7)
        before = self.read_ply("a.ply")
        for name, encoding in [("b.pcd", "ascii"), ("b.pcd", "binary"), ("b.pcd", "compressed"), ("b.ply", "ascii")]:
            self.igsp("convert", "a.ply", "-o", name, "--encoding", encoding)
            self.igsp("convert", name, "-o", "c.ply", "--encoding", "binary")
            after = self.read_ply("c.ply")
            self.assertEqual(after.dtype.names, before.dtype.names, (name, encoding))
            self.assertEqual(after.tobytes(), before.tobytes(), (name, encoding))

    def test_text_keeps_every_value(self):
        self.full_cloud(1000)
        before = self.read_ply("a.ply")
        for name in ("b.csv", "b.xyz"):
            self.igsp("convert", "a.ply", "-o", name)
            self.igsp("convert", name, "-o", "c.ply")
            after = self.read_ply("c.ply")
            self.assertEqual(after.dtype.names, before.dtype.names, name)
            for field in before.dtype.names:
                expected = before[field] if before[field].dtype != "f4" else [float(str(v)) for v in before[field]]
                np.testing.assert_array_equal(after[field], expected, field)

    def test_pcd_has_the_names_that_its_programs_expect(self):
        self.full_cloud(10)
        self.igsp("convert", "a.ply", "-o", "b.pcd")
        header, body = (self.folder / "b.pcd").read_bytes().split(b"DATA binary\n")
        self.assertIn(b"FIELDS x y z normal_x normal_y normal_z rgb intensity gps_time label_i1 label_i2 label_i4 label_u4\n", header)
        self.assertIn(b"TYPE F F F F F F F U F I I I U\n", header)
        table = np.frombuffer(body, [("xyz", "<f8", 3), ("n", "<f4", 3), ("rgb", "<u4"), ("i", "<u2"), ("t", "<f8"), ("l1", "i1"),
                                    ("l2", "<i2"), ("l4", "<i4"), ("u4", "<u4")])
        red, green, blue = (self.read_ply("a.ply")[colour].astype("u4") for colour in ("red", "green", "blue"))
        np.testing.assert_array_equal(table["rgb"], red << 16 | green << 8 | blue)

    def test_colours_with_alpha_are_no_float(self):
        """Bits that a float would take for no number, and change."""
        header = "VERSION 0.7\nFIELDS x y z rgba\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
        rows = np.array([(1, 2, 3, 0xFF800001), (4, 5, 6, 0xFFBF1234)], "<f4,<f4,<f4,<u4")
        (self.folder / "a.pcd").write_bytes((header + "POINTS 2\nDATA binary\n").encode() + rows.tobytes())
        self.igsp("convert", "a.pcd", "-o", "b.ply")
        table = self.read_ply("b.ply")
        self.assertEqual(table.dtype.names[3:], ("red", "green", "blue", "alpha"))
        colours = table[["red", "green", "blue", "alpha"]].tolist()
        self.assertEqual(colours, [(0x80, 0, 1, 255), (0xBF, 0x12, 0x34, 255)])
        self.igsp("convert", "b.ply", "-o", "c.pcd")
        self.assertEqual((self.folder / "c.pcd").read_bytes().split(b"DATA binary\n")[1], rows.tobytes())

    def test_what_has_no_place_is_said(self):
        lines = ["ply", "format ascii 1.0", "element vertex 3", *(f"property double {axis}" for axis in "xyz"),
                 "property list uchar int seen", "element face 1", "property list uchar int vertex_indices",
                 "end_header", "0 0 0 2 7 8", "1 0 0 0", "nan 0 0 1 5", "3 0 1 2"]
        (self.folder / "a.ply").write_text("\n".join(lines) + "\n")
        done = self.igsp("convert", "a.ply", "-o", "b.csv")
        self.assertEqual(done.stdout, "b.csv has no place for seen, 1 x face\n")
        self.assertIn("dropped 1 of 3 points", done.stderr)
        self.assertEqual((self.folder / "b.csv").read_text(), "x,y,z\n0,0,0\n1,0,0\n")
        self.igsp("convert", "a.ply", "-o", "c.ply")  # the same format: a copy
        self.assertEqual((self.folder / "c.ply").read_bytes(), (self.folder / "a.ply").read_bytes())

    def test_words_in_columns_and_names_with_blanks(self):
        text = "Point;Easting [m];Northing [m];Height [m];Intensity [a.u.]\nA;1,5;2;3;7\nB;4;5;6;\n"
        (self.folder / "a.csv").write_text(text)
        done = self.igsp("convert", "a.csv", "-o", "b.pcd", "--encoding", "ascii")
        self.assertEqual(done.stdout, "b.pcd has no place for Point\n")
        header, body = (self.folder / "b.pcd").read_text().split("DATA ascii\n")
        self.assertIn("FIELDS x y z Intensity\n", header)
        self.assertEqual(body, "1.5 2 3 7\n4 5 6 nan\n")

    def test_integers_beyond_a_double_are_refused(self):
        header = "VERSION 0.7\nFIELDS x y z id\nSIZE 4 4 4 8\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 1\nHEIGHT 1\n"
        for value, code in [(2**53, 0), (2**60, 3)]:
            row = np.array([(1, 2, 3, value)], "<f4,<f4,<f4,<u8").tobytes()
            (self.folder / "a.pcd").write_bytes((header + "POINTS 1\nDATA binary\n").encode() + row)
            done = self.igsp("convert", "a.pcd", "-o", "b.csv", code=code)
        self.assertIn("beyond 2^53", done.stderr)
        self.assertIn(str(2**53), (self.folder / "b.csv").read_text())

    def test_mistakes(self):
        self.write_ply("a.ply", np.ones((3, 3)))
        for arguments, code, saying in [(["-o", "b.ply", "--encoding", "compressed"], 2, "--encoding compressed"),
                                        (["-o", "b.xyz", "--encoding", "ascii"], 2, "--encoding"),
                                        (["-o", "a.ply"], 2, "same file"), (["-o", "b.laz"], 3, "b.laz")]:
            self.assertIn(saying, self.igsp("convert", "a.ply", *arguments, code=code).stderr)
        cut = (self.folder / "a.ply").read_bytes()[:-1]
        (self.folder / "cut.ply").write_bytes(cut)
        self.igsp("convert", "cut.ply", "-o", "b.pcd", code=3)
        self.assertFalse((self.folder / "b.pcd").exists())


def centroids(points: np.ndarray, voxel_size: float) -> list[list[float]]:
    """Exactly, as fractions, save for the steps in which the filter counts and the last rounding."""
    voxels: dict[tuple, list] = {}
    inverse = 1.0 / voxel_size
    for point in points.tolist():
        place = [coordinate * inverse for coordinate in point]
        cell = tuple(floor(coordinate) for coordinate in place)
        steps = [int((coordinate - corner) * 2.0**42 + 0.5) for coordinate, corner in zip(place, cell, strict=True)]
        voxels.setdefault(cell[::-1], []).append(steps)
    mean = {cell: [sum(axis) for axis in zip(*steps, strict=True)] + [len(steps)] for cell, steps in voxels.items()}
    return [[float((corner + float(Fraction(total) / (2**42 * sums[3]))) * voxel_size)
             for corner, total in zip(cell[::-1], sums, strict=False)] for cell, sums in sorted(mean.items())]


class Downsample(CloudTest):
    def test_bit_for_bit_the_centroids_of_all_points_at_once(self):
        points = np.random.default_rng(7).uniform(-3, 3, (2 * CHUNK + 1, 3))
        self.write_ply("a.ply", points)
        said = self.igsp("downsample", "a.ply", "--voxel-size", "0.3", "-o", "b.xyz").stdout
        thin = np.loadtxt(self.folder / "b.xyz")
        expected = np.array(centroids(points, 0.3))
        self.assertIn(f"{len(points)} points in {len(expected)} voxels of 0.3", said)
        self.assertEqual(thin.astype("f4").tobytes(), expected.astype("f4").tobytes())

    def test_any_order_and_any_format_give_the_same_bytes(self):
        random = np.random.default_rng(8)
        points = random.uniform(-3, 3, (CHUNK + 5, 3)) + [4e5, 5e6, 0]  # beyond the reach of a grid through 0
        for name, order in [("a", np.arange(len(points))), ("b", random.permutation(len(points)))]:
            self.write_ply(f"{name}.ply", points[order])
            self.igsp("downsample", f"{name}.ply", "--voxel-size", "0.25", "-o", f"{name}_thin.pcd")
        whole = (self.folder / "a_thin.pcd").read_bytes()
        self.assertEqual((self.folder / "b_thin.pcd").read_bytes(), whole)
        np.savetxt(self.folder / "a.xyz", points, fmt="%.17g")
        self.igsp("downsample", "a.xyz", "--voxel-size", "0.25", "-o", "c_thin.pcd")
        self.assertEqual((self.folder / "c_thin.pcd").read_bytes(), whole)
        self.igsp("downsample", "a_thin.pcd", "--voxel-size", "0.25", "-o", "once_more.xyz")
        again = np.loadtxt(self.folder / "once_more.xyz")
        cells = {tuple(cell) for cell in np.floor(points / 0.25).tolist()}
        self.assertEqual(len(again), len(cells))
        self.assertEqual({tuple(cell) for cell in np.floor(again / 0.25).tolist()}, cells)

    def test_not_finite_points_are_told_and_the_viewpoint_stays(self):
        lines = ["ply", "format ascii 1.0", "comment viewpoint 1 2 3", "element vertex 3",
                 *(f"property double {axis}" for axis in "xyz"), "end_header", "0 0 0", "nan 0 0", "0.1 0 0"]
        (self.folder / "a.ply").write_text("\n".join(lines) + "\n")
        done = self.igsp("downsample", "a.ply", "--voxel-size", "1", "-o", "b.ply")
        self.assertIn("dropped 1 of 3 points", done.stderr)
        self.assertEqual(done.stdout, "2 points in 1 voxels of 1\n")
        self.assertIn(b"comment viewpoint 1 2 3", (self.folder / "b.ply").read_bytes())

    def test_mistakes(self):
        self.write_ply("a.ply", np.random.default_rng(9).uniform(0, 1, (9, 3)))
        for size in ("0", "-1", "nan", "inf"):
            done = self.igsp("downsample", "a.ply", "--voxel-size", size, "-o", "b.ply", code=2)
            self.assertIn("--voxel-size", done.stderr)
        done = self.igsp("downsample", "a.ply", "--voxel-size", "1e-9", "-o", "b.ply", code=2)
        self.assertIn("too small", done.stderr)
        self.assertFalse((self.folder / "b.ply").exists())


PEAK = """
import os, sys
pid = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ)
_, status, usage = os.wait4(pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_maxrss * 1024)
"""  # in a small process: a child's peak counts what its parent held when it was forked


class Memory(CloudTest):
    """All stream: a third of what the coordinates need as doubles suffices."""

    def test_peak(self):
        count = 5_000_000
        self.write_ply("a.ply", np.random.default_rng(10).uniform(0, 10, (count, 3)), kind="f4")
        self.save_motion(rigid(11))
        for command in (["convert", "a.ply", "-o", "b.pcd"],
                        ["transform", "a.ply", "--transform", "T.txt", "-o", "b.ply"],
                        ["downsample", "a.ply", "--voxel-size", "1", "-o", "b.ply"]):
            done = subprocess.run([sys.executable, "-c", PEAK, IGSP, *command, "--quiet"], cwd=self.folder, check=True,
                                  capture_output=True, text=True)
            code, peak = map(int, done.stdout.split()[-2:])
            self.assertEqual(code, 0, done.stderr)
            self.assertLess(peak, count * 24 / 3, command)


if __name__ == "__main__":
    unittest.main()
