"""igsp benchmark as a user meets it. usage: benchmark_test.py IGSP [unittest arguments]"""
import csv
import os
import pty
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

IGSP = sys.argv.pop(1)
HEADER = "name,group,source,target,truth,max_rotation_error_deg,max_translation_error_m,overlap\n"
GOOD = "park/1--0,park,scans/station_1.ply,scans/station_0.ply,scans/station_1_to_0.txt,2,0.3,0.6\n"
SELF = "self,park,scans/station_0.ply,scans/station_0.ply,identity.txt,0.1,0.01,1\n"
# Two clouds without anything in common, and too small for keypoints.
NONE = "odd,negative,noise.xyz,scans/station_0.ply,none,0,0,0\n"
OPEN = "open,other,scans/station_1.ply,scans/station_0.ply,-,,,\n"
MISSING = "missing,park,nowhere.ply,scans/station_0.ply,identity.txt,2,0.3,0.6\n"


def setUpModule():
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    BenchmarkTest.root = root = Path(folder.name)
    subprocess.run([IGSP, "simulate", "park", "--out", root / "scans", "--points", "60000"], check=True,
                   stdout=subprocess.DEVNULL)
    np.savetxt(root / "identity.txt", np.eye(4))
    np.savetxt(root / "mirrored.txt", np.diag([1, 1, -1, 1]))
    np.savetxt(root / "noise.xyz", np.random.default_rng(0).normal(size=(500, 3)))


class BenchmarkTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # never the folder of the cases: their paths are not relative to it
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.cases = self.root / "cases.csv"
        self.out = self.folder / "results.csv"

    def igsp(self, *arguments, code=0):
        run = subprocess.run([IGSP, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)
        self.assertEqual(run.returncode, code, f"igsp {arguments}\n{run.stdout}\n{run.stderr}")
        return run

    def benchmark(self, cases, *arguments, code=0):
        self.cases.write_text(HEADER + cases)
        return self.igsp("benchmark", self.cases, *arguments, code=code)

    def refuses(self, cases, *arguments, code, saying):
        run = self.benchmark(cases, *arguments, code=code)
        for word in [saying] if isinstance(saying, str) else saying:
            self.assertIn(word, run.stderr)
        self.assertEqual((run.stdout, run.stderr.count("\n")), ("", 1), run.stderr)

    def rows(self, path=None):
        with open(path or self.out, newline="") as file:
            return list(csv.DictReader(file))


class Answers(BenchmarkTest):
    def test_every_kind_of_case(self):
        run = self.benchmark(GOOD + SELF + NONE + OPEN)
        self.assertEqual(run.stderr, "")  # not a terminal: no progress
        self.assertTrue(run.stdout.startswith("false accepts: 0\n"), run.stdout)
        self.assertRegex(run.stdout, r"\npark +0 +2 +1\.000 \(2/2\) +2 +0 +0 ")
        self.assertRegex(run.stdout, r"\nnegative +0 +1 +- +0 +1 +0 ")
        good, same, none, unknown = self.rows()
        for row in [good, same]:
            self.assertEqual((row["verdict"], row["success"], row["truth"], row["scramble"], row["preset"]),
                             ("registered", "yes", "known", "7", "default"))
            self.assertLess(float(row["centroid_displacement"]), 0.3)
        # The pair lies as it belongs: only if the scramble is folded into the truth rightly is the error tiny.
        self.assertLess(float(same["e_r_deg"]), 0.01)
        self.assertLess(float(same["e_t"]), 0.005)  # of hundreds of metres; a voxel is 0.8 m
        for key in ["confidence", "overlap", "precision", "recall", "iterations", "source_keypoints",
                    "target_keypoints", "voxel_size", "cpu_seconds", "wall_seconds", "peak_memory_bytes"]:
            self.assertGreater(float(good[key]), 0, key)
        # Nearly 0 unless they are judged where the scramble has put the source.
        self.assertGreater(float(same["precision"]), 0.6)
        self.assertGreater(float(same["recall"]), 0.6)
        self.assertEqual((none["precision"], unknown["precision"]), ("", ""))
        stages = dict(stage.split("=") for stage in good["stage_seconds"].split(";"))
        self.assertIn("read", stages)
        self.assertAlmostEqual(sum(map(float, stages.values())) / float(good["wall_seconds"]), 1, 1)
        self.assertEqual((none["verdict"], none["success"], none["e_r_deg"]), ("not_registered", "yes", ""))
        self.assertEqual((unknown["verdict"], unknown["success"], unknown["e_t"]), ("registered", "", ""))

    def test_the_answer_to_a_pair_that_does_not_overlap_is_a_false_accept(self):
        run = self.benchmark(SELF.replace("identity.txt", "none"))
        self.assertTrue(run.stdout.startswith("false accepts: 1\n  self (default)"), run.stdout)
        self.assertEqual(self.rows()[0]["success"], "no")

    def test_same_answers_with_more_jobs_and_another_place_of_the_source_with_another_seed(self):
        def answers(*arguments):
            self.benchmark(GOOD + SELF + NONE, *arguments)
            skipped = {"stage_seconds", "cpu_seconds", "wall_seconds", "peak_memory_bytes"}
            return [{key: row[key] for key in row if key not in skipped} for row in self.rows()]

        once = answers()
        self.assertEqual(once, answers("--jobs", "3"))
        self.assertNotEqual(once[0]["e_r_deg"], answers("--scramble", "8")[0]["e_r_deg"])
        still = answers("--no-scramble")
        self.assertEqual({row["scramble"] for row in still}, {"none"})
        self.assertEqual([row["success"] for row in still], ["yes"] * 3)

    def test_presets_and_selection(self):
        self.benchmark(GOOD + SELF + NONE, "--preset", "default", "--preset", "paper", "--only", "negative", "--out",
                       "x.csv")
        rows = self.rows(self.folder / "x.csv")
        self.assertEqual([(row["name"], row["preset"]) for row in rows], [("odd", "default"), ("odd", "paper")])
        self.benchmark(GOOD + SELF + NONE, "--only", "s?lf", "--only", "o*")
        self.assertEqual([row["name"] for row in self.rows()], ["self", "odd"])


class Export(BenchmarkTest):
    def test_other_programs_get_the_same_pairs(self):
        self.benchmark(GOOD + SELF + NONE + OPEN)
        own = self.rows()
        run = self.benchmark(GOOD + SELF + NONE + OPEN, "--export", "pairs")
        self.assertEqual(run.stdout, f"4 of 4 cases are in {Path('pairs') / 'cases.csv'}\n")
        self.igsp("benchmark", "pairs/cases.csv", "--no-scramble", "--out", "again.csv")
        again = self.rows(self.folder / "again.csv")
        for first, second in zip(own, again, strict=True):
            for key in ["name", "group", "truth", "verdict", "success", "precision", "recall", "voxel_size"]:
                self.assertEqual(first[key], second[key], key)
            for key in ["e_r_deg", "e_t", "centroid_displacement"]:  # up to the rounding of the truth's file
                self.assertEqual(first[key] == "", second[key] == "")
                self.assertAlmostEqual(float(first[key] or 0), float(second[key] or 0), 6)
        moved = np.loadtxt(self.folder / "pairs/002_truth.txt")
        self.assertGreater(np.abs(moved - np.eye(4)).max(), 0.5)  # the source did move

    def test_selection_seed_and_mistakes(self):
        def truth(folder, *arguments):
            self.benchmark(GOOD + SELF, "--only", "self", "--export", folder, *arguments)
            return np.loadtxt(self.folder / folder / "001_truth.txt")

        self.assertGreater(np.abs(truth("7") - truth("8", "--scramble", "8")).max(), 0.1)
        np.testing.assert_array_equal(truth("still", "--no-scramble"), np.eye(4))
        run = self.benchmark(MISSING + SELF, "--export", "some", code=3)
        self.assertEqual(run.stderr.count("\n"), 1)
        self.assertIn("missing: left out: ", run.stderr)
        self.assertEqual([row["name"] for row in self.rows(self.folder / "some/cases.csv")], ["self"])
        self.refuses(SELF, "--export", "pairs", "--resume", code=2, saying="--export")
        self.refuses(SELF, "--export", self.root, code=2, saying="is there already")  # another list, maybe precious
        (self.folder / "file").write_text("")
        self.refuses(SELF, "--export", "file", code=3, saying="file")


class Mistakes(BenchmarkTest):
    def test_broken_lists_are_refused_before_anything_runs(self):
        self.refuses(GOOD + GOOD.replace("2,0.3", "two,0.3"), code=3, saying=["cases.csv: line 3, column 6", "'two'"])
        self.refuses(GOOD + "x,y\n", code=3, saying=["line 3, column 3"])
        self.refuses("", code=3, saying="line 2")
        self.assertEqual(os.listdir(self.folder), [])
        self.igsp("benchmark", "nowhere.csv", code=3)

    def test_wrong_flags(self):
        self.refuses(GOOD, "--only", "prak", code=2, saying=["prak", "park"])
        self.refuses(GOOD, "--preset", "papre", code=2, saying="papre")
        self.refuses(GOOD, "--preset", "paper", "--preset", "paper", code=2, saying="--preset paper is given twice")
        self.refuses(GOOD, "--jobs", "0", code=2, saying="--jobs")
        self.refuses(GOOD, "--scramble", "1", "--no-scramble", code=2, saying="--scramble")
        self.refuses(GOOD, "--out", self.cases, code=2, saying="--out and CASES")
        self.refuses(GOOD, "--out", "nowhere/r.csv", code=3, saying="nowhere/r.csv")
        (self.folder / "mine.csv").write_text("precious,data\n")
        self.refuses(GOOD, "--out", "mine.csv", code=3, saying="mine.csv: line 1")
        self.assertEqual((self.folder / "mine.csv").read_text(), "precious,data\n")

    def test_a_bad_file_does_not_stop_the_rest(self):
        mirrored = SELF.replace("self", "mirrored").replace("identity", "mirrored")
        run = self.benchmark(MISSING + mirrored + SELF, code=3)
        missing, mirrored, same = self.rows()
        self.assertIn("nowhere.ply", missing["error"])
        self.assertEqual((missing["verdict"], missing["success"]), ("", ""))
        self.assertIn("mirrored.txt", mirrored["error"])
        self.assertEqual(same["success"], "yes")
        self.assertRegex(run.stdout, r"\npark +0 +3 +0\.333 \(1/3\) +1 +0 +2 ")
        self.assertIn("missing (default): ", run.stdout)


class Resumption(BenchmarkTest):
    def interrupted(self, *arguments, number=signal.SIGINT):
        """Runs until the first row is shown on the terminal, then gets the signal. Exit code and what was sent."""
        reader, writer = pty.openpty()
        process = subprocess.Popen([IGSP, "benchmark", self.cases, *arguments], stdout=subprocess.DEVNULL,
                                   stderr=writer, cwd=self.folder)
        os.close(writer)
        sent, signalled = b"", False
        while True:
            try:
                sent += os.read(reader, 4096)
            except OSError:  # the other end is closed
                break
            if not signalled and b"self  " in sent:
                process.send_signal(number)
                signalled = True
        os.close(reader)
        return process.wait(), sent.decode()

    def test_an_interruption_loses_nothing(self):
        for number, expected in [(signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)]:
            self.cases.write_text(HEADER + SELF + GOOD + OPEN)
            code, sent = self.interrupted(number=number)
            self.assertEqual(code, expected, sent)
            self.assertEqual("--resume" in sent, number == signal.SIGINT)
            self.assertRegex(sent, r"1/3 +self +default +right +\S+ deg +\S+ +\S+ s")
            before = self.rows()
            self.assertEqual([row["name"] for row in before], ["self"])
            with open(self.out, "a") as file:
                file.write("park/1--0,park,defa")  # as of a process that died while it wrote
            run = self.benchmark(SELF + GOOD + OPEN, "--resume")
            after = self.rows()
            self.assertEqual([row["name"] for row in after], ["self", "park/1--0", "open"])
            self.assertEqual(after[0], before[0])  # its seconds, too: it was not run again
            self.assertRegex(run.stdout, r"\npark +0 +2 ")

    def test_rows_with_an_error_and_other_questions_are_run(self):
        self.benchmark(SELF + MISSING, code=3)
        first = self.rows()
        self.benchmark(SELF + MISSING.replace("nowhere.ply", "scans/station_0.ply"), "--resume")
        second = self.rows()
        self.assertEqual(first[0], second[0])
        self.assertEqual((second[1]["error"], second[1]["success"]), ("", "yes"))
        self.benchmark(SELF, "--resume", "--scramble", "8")
        self.assertEqual([(row["name"], row["scramble"]) for row in self.rows()],
                         [("self", "8"), ("missing", "7"), ("self", "7")])
        self.benchmark(NONE)  # without --resume the file is replaced
        self.assertEqual([row["name"] for row in self.rows()], ["odd"])


class Comparison(BenchmarkTest):
    def test_what_got_better_and_worse(self):
        self.benchmark(SELF + GOOD + NONE, "--out", "old.csv")
        old = (self.folder / "old.csv").read_text()
        run = self.benchmark(SELF + GOOD + NONE, "--compare", "old.csv")
        self.assertIn("compared: 3 of 3 rows are in both\nworse: 0\nbetter: 0\n", run.stdout)
        lines = old.splitlines(keepends=True)
        lines[1] = lines[1].replace("registered,yes", "not_registered,no", 1)
        lines[3] = lines[3].replace("not_registered,yes", "registered,no", 1)
        (self.folder / "old.csv").write_text("".join(lines))
        run = self.benchmark(SELF + GOOD + NONE, "--resume", "--compare", "old.csv")
        self.assertIn("better: 2\n  self (default): refused -> right\n"
                      "  odd (default): FALSE ACCEPT -> rightly refused\n", run.stdout)
        self.igsp("benchmark", self.cases, "--resume", "--out", "old.csv", "--compare", "results.csv")
        self.assertIn("worse: 2\n", self.igsp("benchmark", self.cases, "--resume", "--out", "old.csv", "--compare",
                                              "results.csv").stdout)
        self.refuses(SELF, "--compare", "nowhere.csv", code=3, saying="nowhere.csv")
        self.refuses(SELF, "--compare", self.cases, code=3, saying="cases.csv: line 1")


if __name__ == "__main__":
    unittest.main()
