"""The README's Python works as printed, on a LAZ and an E57 file of two simulated scans."""

import re
import subprocess
import sys
from pathlib import Path

import laspy
import pye57

README = Path(__file__).parents[2] / "README.md"


def test_snippets_run_in_order(tmp_path, pair):
    las = laspy.create(point_format=0)
    las.header.scales = [0.0001, 0.0001, 0.0001]
    las.x, las.y, las.z = pair[0].T
    las.write(tmp_path / "source.laz")
    file = pye57.E57(str(tmp_path / "target.e57"), mode="w")
    file.write_scan_raw({f"cartesian{axis}": column.copy() for axis, column in zip("XYZ", pair[1].T, strict=True)})
    file.close()

    text = README.read_text()
    snippets = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    assert snippets
    summary = re.compile(r"registered \(confidence \d\.\d{3}\), overlap \d\.\d\d, rmse \d\.\d+, \d+ iterations")
    assert summary.search(text)
    for snippet in snippets:
        done = subprocess.run([sys.executable, "-c", snippet], capture_output=True, text=True, cwd=tmp_path)
        assert done.returncode == 0, snippet + done.stderr
        assert summary.match(done.stdout), done.stdout
