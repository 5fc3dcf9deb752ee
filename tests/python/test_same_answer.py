"""One library: the C++ command, the command from pip and Python give the same numbers to the last bit."""

import json
import subprocess

import numpy as np
import pytest

import igsp

RUNS = {
    "park": {},
    "indoor": {"dof": 4, "threads": 1},
    "object": {"preset": "paper", "voxel_size": 0.003},
}


def report_of(command, folder, options, path):
    flags = [word for name, value in options.items() for word in (f"--{name.replace('_', '-')}", str(value))]
    run = subprocess.run(
        [command, "align", folder / "station_1.ply", folder / "station_0.ply", *flags, "--report", path],
        capture_output=True,
        text=True,
    )
    assert run.returncode in (0, 1), run.stderr
    return json.loads(path.read_text())


@pytest.mark.parametrize("scene", RUNS)
def test_commands_and_python_agree(scene, scans, tmp_path, cpp_command, pip_command):
    folder, options = scans / scene, RUNS[scene]
    result = igsp.align(folder / "station_1.ply", str(folder / "station_0.ply"), **options)
    points = [igsp.read_points(folder / f"station_{i}.ply") for i in (1, 0)]  # the files say where the scanner stood
    arrays = igsp.align(*points, source_viewpoint=[0, 0, 0], target_viewpoint=(0.0, 0.0, 0.0), **options)
    np.testing.assert_array_equal(arrays.target_from_source, result.target_from_source)
    for command in [cpp_command, pip_command]:
        report = report_of(command, folder, options, tmp_path / "run.json")
        np.testing.assert_array_equal(result.target_from_source, np.array(report["target_from_source"]))
        assert result.registered == (report["verdict"] == "registered")
        for name in ["confidence", "overlap", "rmse", "voxel_size", "reason"]:
            assert getattr(result, name) == report[name], name
        for record, row in zip(result.iterations, report["iterations"], strict=True):
            assert (record.energy, record.matches, record.t_cd) == (row["energy"], row["matches"], row["t_cd"])
            np.testing.assert_array_equal(record.target_from_source, np.array(row["target_from_source"]))


def test_simulated_scans_agree(scans):
    for number, scan in enumerate(igsp.simulate("indoor", points=60000)):
        np.testing.assert_array_equal(
            scan.points.astype(np.float32), igsp.read_points(scans / f"indoor/station_{number}.ply")
        )
    poses = [scan.world_from_scanner for scan in igsp.simulate("indoor", points=100)]
    np.testing.assert_allclose(
        np.linalg.inv(poses[0]) @ poses[1], igsp.read_transformation(scans / "indoor/station_1_to_0.txt"), atol=1e-12
    )
