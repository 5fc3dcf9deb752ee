"""The igsp command that pip installs."""

import json
import os
import pty
import signal
import subprocess
import sys

import laspy
import numpy as np
import pytest

import igsp


@pytest.fixture
def laz(tmp_path, pair):
    """The source of the pair as LAZ, in survey coordinates, with an intensity per point."""
    las = laspy.create(point_format=1)
    las.header.offsets, las.header.scales = [500000, 5000000, 0], [0.001, 0.001, 0.001]
    las.x, las.y, las.z = (pair[0] + [500000, 5000000, 0]).T
    las.intensity = np.arange(len(pair[0])) % 65536
    las.write(tmp_path / "source.laz")
    return tmp_path / "source.laz"


def run(command, *arguments, code=0, **options):
    done = subprocess.run([command, *map(str, arguments)], capture_output=True, text=True, **options)
    assert done.returncode == code, done.stdout + done.stderr
    return done


def test_is_the_same_program(pip_command, cpp_command, tmp_path):
    for arguments in [["--version"], ["align", "--help"], ["options", "--dof", "4"]]:
        assert run(pip_command, *arguments).stdout == run(cpp_command, *arguments).stdout
    assert run(pip_command, "--version").stdout == f"igsp {igsp.__version__}\n"
    assert run(sys.executable, "-m", "igsp", "--version").stdout == f"igsp {igsp.__version__}\n"
    for arguments, code in [(["aling"], 2), (["align", "a.ply"], 2), (["info", "nowhere.ply"], 3)]:
        own, other = (run(command, *arguments, code=code, cwd=tmp_path) for command in (pip_command, cpp_command))
        assert own.stderr == other.stderr


def test_reads_laz_and_writes_it_moved_with_its_attributes(pip_command, laz, scans, tmp_path):
    target = scans / "park/station_0.ply"
    run(pip_command, "align", laz, target, "-o", "aligned.laz", "--report", "run.json", cwd=tmp_path)
    report = json.loads((tmp_path / "run.json").read_text())
    result = igsp.align(laz, target)
    np.testing.assert_array_equal(np.array(report["target_from_source"]), result.target_from_source)
    source, aligned = laspy.read(laz), laspy.read(tmp_path / "aligned.laz")
    np.testing.assert_array_equal(aligned.intensity, source.intensity)
    moved = igsp.transform_points(source.xyz, result.target_from_source)
    np.testing.assert_allclose(aligned.xyz, moved, atol=0.0011)
    assert "format                LAZ" in run(pip_command, "info", laz).stdout


def test_a_laz_source_may_become_ply(pip_command, laz, scans, tmp_path):
    run(pip_command, "align", laz, scans / "park/station_0.ply", "-o", "aligned.ply", cwd=tmp_path)
    result = igsp.align(laz, scans / "park/station_0.ply")
    moved = igsp.transform_points(laz_points := laspy.read(laz).xyz, result.target_from_source)
    np.testing.assert_allclose(igsp.read_points(tmp_path / "aligned.ply"), moved, atol=1e-5)
    assert len(laz_points) == len(moved)


def test_pts_keeps_what_follows_the_coordinates(pip_command, pair, scans, tmp_path):
    rows = np.c_[pair[0], np.arange(len(pair[0])) % 2048]
    np.savetxt(tmp_path / "source.pts", rows, fmt="%.4f %.4f %.4f %d", header=str(len(rows)), comments="")
    run(pip_command, "align", "source.pts", scans / "park/station_0.ply", "-o", "aligned.pts", cwd=tmp_path)
    aligned = np.loadtxt(tmp_path / "aligned.pts", skiprows=1)
    np.testing.assert_array_equal(aligned[:, 3], rows[:, 3])
    result = igsp.align(tmp_path / "source.pts", scans / "park/station_0.ply")
    moved = igsp.transform_points(np.round(pair[0], 4), result.target_from_source)
    np.testing.assert_allclose(aligned[:, :3], moved, atol=1e-3)


def test_more_points_than_are_kept_are_streamed(pip_command, laz, scans, tmp_path):
    run(
        pip_command,
        "align",
        laz,
        scans / "park/station_0.ply",
        "--max-points",
        "20000",
        "--voxel-size",
        "0.2",
        "-o",
        "aligned.laz",
        cwd=tmp_path,
    )
    assert len(laspy.read(tmp_path / "aligned.laz")) == len(laspy.read(laz))


def test_transform_and_downsample_take_survey_formats(pip_command, laz, scans, tmp_path):
    run(pip_command, "align", laz, scans / "park/station_0.ply", "-o", "aligned.laz", "--transform", "T.txt", cwd=tmp_path)
    run(pip_command, "transform", laz, "--transform", "T.txt", "-o", "moved.laz", cwd=tmp_path)
    assert (tmp_path / "moved.laz").read_bytes() == (tmp_path / "aligned.laz").read_bytes()
    said = run(pip_command, "downsample", laz, "--voxel-size", "0.5", "-o", "thin.ply", cwd=tmp_path).stdout
    cells = np.unique(np.floor(laspy.read(laz).xyz / 0.5), axis=0)  # no boundary is near a point by chance
    thin = igsp.read_points(tmp_path / "thin.ply")
    assert said == f"{len(laspy.read(laz))} points in {len(thin)} voxels of 0.5\n"
    assert abs(len(thin) - len(cells)) <= 0.01 * len(cells)


def test_formats_that_do_not_meet(pip_command, cpp_command, laz, scans, tmp_path):
    ply = scans / "park/station_1.ply"
    said = run(pip_command, "align", ply, laz, "-o", "x.laz", code=2, cwd=tmp_path).stderr
    assert said == f"igsp: -o x.laz: .laz is written only from a SOURCE of the same format, not from {ply}\n"
    for arguments in [[laz, ply], [ply, laz], [ply, ply, "-o", "x.laz"]]:
        assert "pip install 'igsp[las]'" in run(cpp_command, "align", *arguments, code=3, cwd=tmp_path).stderr
    assert "pip install 'igsp[e57]'" in run(cpp_command, "info", "a.e57", code=3).stderr


def test_faults_of_files_end_with_their_own_code(pip_command, laz, tmp_path):
    said = run(pip_command, "info", "nowhere.laz", code=3, cwd=tmp_path).stderr
    assert said == "igsp: nowhere.laz: No such file or directory\n"
    cut = tmp_path / "cut.laz"
    cut.write_bytes(laz.read_bytes()[:5000])
    assert "cut.laz" in run(pip_command, "info", cut, code=3).stderr
    # As if laspy were not installed.
    without = (
        "import sys; sys.modules['laspy'] = None; sys.argv = ['igsp', 'info', 'source.laz']\n"
        "from igsp.__main__ import main; sys.exit(main())"
    )
    said = run(sys.executable, "-c", without, code=3, cwd=tmp_path).stderr
    assert said.startswith("igsp: source.laz: ") and "pip install 'igsp[las]'" in said and said.count("\n") == 1


def test_ctrl_c_ends_with_130_and_leaves_no_file(pip_command, laz, scans, tmp_path):
    folder = tmp_path / "empty"
    folder.mkdir()
    reader, writer = pty.openpty()  # a terminal: the bars tell how far it is
    # With these options the run goes on for long when it is not interrupted.
    process = subprocess.Popen(
        [
            pip_command,
            "align",
            laz,
            scans / "park/station_0.ply",
            "--voxel-size",
            "0.05",
            "--pca-radius",
            "60",
            "--descriptor-radius",
            "60",
            "--search",
            "direct",
            "-o",
            "a.laz",
            "--transform",
            "T.txt",
        ],
        cwd=folder,
        stderr=writer,
    )
    os.close(writer)
    sent = b""
    while b"keypoints" not in sent:
        sent += os.read(reader, 4096)
    process.send_signal(signal.SIGINT)
    assert process.wait(60) == 130
    assert b"igsp: interrupted" in os.read(reader, 65536) and list(folder.iterdir()) == []
    os.close(reader)


def test_an_interrupt_within_a_destructor_is_told_once():
    within = (
        "import igsp.__main__ as command\n"
        "class Destroyed:\n"
        "    def __init__(self, error): self.error = error\n"
        "    def __del__(self): raise self.error\n"
        "def run(arguments, formats):\n"
        "    for error in KeyboardInterrupt(), ValueError('of a destructor'): Destroyed(error)\n"
        "    return 0\n"
        "command._core.run_command_line = run\n"
        "command.main()"
    )
    said = run(sys.executable, "-c", within).stderr
    assert "ValueError: of a destructor" in said and "KeyboardInterrupt" not in said


def test_a_pipe_that_closes_early_is_no_error(pip_command):
    done = run("bash", "-c", f"{pip_command} options | head -1; echo ${{PIPESTATUS[0]}}")
    assert done.stdout.startswith("# Options of igsp") and done.stderr == ""
