"""The version has one home, project(VERSION) in CMakeLists.txt; what must repeat it says the same.
usage: version_test.py IGSP [unittest arguments]
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

IGSP = sys.argv.pop(1)
ROOT = Path(__file__).resolve().parent.parent
VERSION = re.search(r"project\(igsp VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


class Version(unittest.TestCase):
    def test_it_is_a_semantic_version(self):
        self.assertRegex(VERSION, r"^(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)$")

    def test_the_command_says_it(self):
        said = subprocess.run([IGSP, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(said, f"igsp {VERSION}\n")

    def test_the_citation_says_it(self):
        self.assertRegex((ROOT / "CITATION.cff").read_text(), rf"(?m)^version: {re.escape(VERSION)}$")

    def test_the_changelog_begins_with_it(self):
        first = re.search(r"(?m)^## (\S+)", (ROOT / "CHANGELOG.md").read_text())[1]
        self.assertEqual(first, VERSION)


if __name__ == "__main__":
    unittest.main()
