"""All Python of the project passes ruff, with the short list of rules in pyproject.toml."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_ruff_finds_nothing():
    ruff = [sys.executable, "-m", "ruff", "check", "--no-cache", "--output-format", "concise", ROOT]
    found = subprocess.run(ruff, capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout + found.stderr


def test_and_it_would(tmp_path):
    (tmp_path / "wrong.py").write_text("import os\n")
    ruff = [sys.executable, "-m", "ruff", "check", "--no-cache", "--config", ROOT / "pyproject.toml", tmp_path]
    assert "F401" in subprocess.run(ruff, capture_output=True, text=True, check=False).stdout
