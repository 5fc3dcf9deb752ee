"""What scripts/instructions.py makes of callgrind's numbers, and that the page in docs is of the program as it is."""

import importlib.util
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(sys.argv.pop(1))

specification = importlib.util.spec_from_file_location("instructions", ROOT / "scripts/instructions.py")
instructions = importlib.util.module_from_spec(specification)
specification.loader.exec_module(instructions)


class Page(unittest.TestCase):
    def test_shares_of_the_stages(self):
        counts = {"park/scale": 3_000_000, "park/loop": 1_000_000, "rooms/loop": 5_000_000, "kernel/a": 7, "least/a": 7}
        rows = instructions.stage_table(counts, {"park/registered": "1", "rooms/registered": "0"}).splitlines()
        self.assertEqual(rows[0], "| stage | park (registered) | rooms (not registered) |")
        self.assertEqual(
            rows[2:], ["| scale | 3.0 (75%) | - |", "| loop | 1.0 (25%) | 5.0 (100%) |", "| all | 4.0 | 5.0 |"]
        )

    def test_kernels_beside_the_least(self):
        names = instructions.LEAST
        counts = {f"{kind}/{name}": number for name in names for kind, number in (("kernel", 600), ("least", 200))}
        rows = instructions.kernel_table(counts, {f"work/{name}": "100" for name in names}).splitlines()
        self.assertEqual(len(rows), 2 + len(names))
        self.assertIn("| 100 times | 6.00 a point | 2.00 a point | 3.0 |", rows[2])

    def test_the_page_knows_the_stages_and_kernels_of_the_source(self):
        page = (ROOT / "docs/profile.md").read_text()
        known = {
            name
            for file in (ROOT / "src").rglob("*.cpp")
            for name in re.findall(r'clock_?\.start\("([^"]+)"\)', file.read_text())
        }
        shown = set(re.findall(r"^\| ([^|]+) \| [\d,.-]+ ?[(|]", page, re.MULTILINE)) - {"all", "rest"}
        self.assertGreater(len(shown), 5)
        self.assertEqual(shown - known, set(), "stages that are gone: make profile")
        for kernel in instructions.LEAST:
            self.assertIn(f"| {kernel} |", page)


if __name__ == "__main__":
    unittest.main()
