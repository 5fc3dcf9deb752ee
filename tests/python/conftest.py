"""What the tests of the Python package share. They run against the installed wheel, see install.py."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import igsp


@pytest.fixture(scope="session")
def cpp_command():
    """The command as CMake built it."""
    return os.environ["IGSP_COMMAND"]


@pytest.fixture(scope="session")
def pip_command():
    """The command as pip installed it."""
    return str(Path(sys.executable).parent / "igsp")


@pytest.fixture(scope="session")
def scans(tmp_path_factory, cpp_command):
    """A folder per scene, each with station_0.ply, station_1.ply and station_1_to_0.txt."""
    folder = tmp_path_factory.mktemp("scans")
    for scene in ("park", "indoor", "object"):
        subprocess.run(
            [cpp_command, "simulate", scene, "--points", "60000", "--out", folder / scene],
            check=True,
            stdout=subprocess.DEVNULL,
        )
    return folder


@pytest.fixture(scope="session")
def pair(scans):
    """Source and target, (N, 3) float64 whose coordinates are also exact in single precision."""
    return igsp.read_points(scans / "park/station_1.ply"), igsp.read_points(scans / "park/station_0.ply")


@pytest.fixture(scope="session")
def truth(scans):
    return np.loadtxt(scans / "park/station_1_to_0.txt")


@pytest.fixture(scope="session")
def result(pair):
    return igsp.align(*pair)
