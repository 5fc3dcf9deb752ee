"""Every C++ example does what it says. usage: examples_test.py IGSP FOLDER_OF_THE_EXAMPLES"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

IGSP, FOLDER = (Path(argument).resolve() for argument in sys.argv[1:])
SOURCES = Path(__file__).parents[1] / "examples"
SOURCE, TARGET = "scans/station_1.ply", "scans/station_0.ply"
# What each takes, and what its last lines say.
EXAMPLES = {
    "01_two_files": ([SOURCE, TARGET], "0 0 0 1"),
    "02_points_in_memory": ([], "deviations"),
    "03_options_and_progress": ([SOURCE, TARGET], "mutual matches"),
    "04_features_once": ([TARGET, SOURCE, "scans/station_2.ply"], "station_2.ply: "),
    "05_viewpoints": ([SOURCE, TARGET], "the file says so"),
    "06_refused": ([], "left-handed"),
    "07_own_poses": ([SOURCE, TARGET], "0 0 0 1"),
}


class Examples(unittest.TestCase):
    def test_each_is_listed_and_there_in_both_languages(self):
        listed = (SOURCES / "README.md").read_text()
        for kind, folder in [("cpp", "cpp"), ("py", "python")]:
            names = {path.stem for path in (SOURCES / folder).glob(f"*.{kind}")}
            self.assertEqual(names, set(EXAMPLES))
            for name in names:
                self.assertIn(f"({folder}/{name}.{kind})", listed)

    def test_they_run(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([IGSP, "simulate", "park", "--stations", "3", "--out", "scans", "--points", "60000", "--seed", "1"],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL)
            for name, (arguments, says) in EXAMPLES.items():
                with self.subTest(name):
                    run = subprocess.run([FOLDER / name, *arguments], cwd=folder, capture_output=True, text=True)
                    self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                    self.assertIn(says, " ".join(run.stdout.split()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
