"""The package is typed: what ships with it says what the extension is, and type checkers believe it."""

import re
import subprocess
import sys

import pytest

import igsp

RIGHT = """
import numpy as np
import igsp

scans = igsp.simulate("park", stations=2, points=1000)
result: igsp.Result = igsp.align(scans[1].points, "target.laz", voxel_size=0.1, dof=4, preset="paper", progress=True)
result = igsp.align([[0.0, 0.0, 0.0]], igsp.extract_features(scans[0].points), initial=np.eye(4),
                    progress=lambda stage, fraction: print(stage.upper(), 100 * fraction))
row: np.ndarray = result.raise_if_not_registered().target_from_source[0]
energies: list[float] = [record.energy for record in result.iterations]
error: float = igsp.pose_error(result.target_from_source, np.eye(4), [0, 0, 0]).rotation_rad
options = igsp.options(search="direct")
network: igsp.Network = igsp.network(["a.e57", scans[0], scans[1].points], viewpoints={"a": None}, progress=True, dof=4)
first: str = network.scans[network.components[0][0]].name + network.links[0].state
closing: list[tuple[int, int, int]] = [cycle.scans for cycle in network.cycles if cycle.closes]
"""

WRONG = {
    'igsp.align("a", "b", voxel_sise=0.1)': 'Unexpected keyword argument "voxel_sise"',
    'igsp.align("a", "b", search="fast")': 'Argument "search"',
    'igsp.align("a", "b", dof="4")': 'Argument "dof"',
    'igsp.align("a", "b").iteration': '"Result" has no attribute "iteration"',
    'igsp.align("a", "b").registered = True': 'Property "registered"',
}


def mypy(program, folder):
    path = folder / "program.py"
    path.write_text(program)
    return subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", folder / "cache", path],
        capture_output=True,
        text=True,
        cwd=folder,
    )


def test_a_right_program_passes(tmp_path):
    checked = mypy(RIGHT, tmp_path)
    assert checked.returncode == 0, checked.stdout


def test_wrong_lines_do_not(tmp_path):
    checked = mypy("import igsp\n" + "\n".join(WRONG) + "\n", tmp_path)
    for number, words in enumerate(WRONG.values(), 2):
        assert any(line.startswith(f"program.py:{number}: error: {words}") for line in checked.stdout.splitlines()), (
            checked.stdout
        )


def test_the_package_itself_passes(tmp_path):
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "-p", "igsp"], capture_output=True, text=True, cwd=tmp_path
    )
    assert checked.returncode == 0, checked.stdout


# What every extension of nanobind is told: its functions, types and constructors are not the interpreter's own kind.
NANOBIND = re.compile(
    r"is not a function$|is inconsistent, metaclass differs$|is a disjoint base at runtime|"
    r"\.__init__ is inconsistent, stub does not have \*args parameter"
)


def test_the_stub_is_what_the_extension_has(tmp_path):
    checked = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "igsp"], capture_output=True, text=True, cwd=tmp_path
    )
    errors = [line for line in checked.stdout.splitlines() if line.startswith("error:")]
    assert errors and [line for line in errors if not NANOBIND.search(line)] == []


@pytest.mark.parametrize("name", igsp.__all__)
def test_everything_public_is_documented(name):
    if name != "__version__":
        assert getattr(igsp, name).__doc__
