"""Every Python example does what it says."""

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples/python").glob("*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_it_runs(example, scans, tmp_path):
    source, target = (scans / f"park/station_{i}.ply" for i in (1, 0))
    text = example.read_text()
    arguments = [target, source] if "TARGET SOURCE" in text else [source, target] if "SOURCE TARGET" in text else []
    run = subprocess.run([sys.executable, example, *arguments], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout
