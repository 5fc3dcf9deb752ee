"""The engine dask: a scheduler and three workers, each a process of its own, give the bits of the local engine."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from formats_testing import e57_attributes, make_e57, motion
from test_portable import values

import igsp

distributed = pytest.importorskip("distributed", reason="left out: the package distributed is not installed")

FAST = {"target_points": 3000}
ANSWERS = ("poses.csv", "links.csv", "network.json", "network.g2o", "poses.tum")


class Processes:
    """A scheduler on loopback and its workers."""

    def __init__(self, folder):
        self.folder, self.file, self.all = folder, folder / "scheduler.json", []
        self.start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", self.file)
        wait_for(lambda: self.file.exists() and self.file.read_text().endswith("}"))  # it is made before it is filled
        self.address = json.loads(self.file.read_text())["address"]
        self.client = distributed.Client(self.address, set_as_default=False)

    def start(self, role, *arguments):
        command = [Path(sys.executable).parent / "dask", role, *arguments, "--no-dashboard"]
        with open(self.folder / f"{role}_{len(self.all)}.log", "w") as log:
            self.all.append(
                subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=log, cwd=self.folder)
            )

    def add_workers(self, count):
        before = len(self.client.nthreads())
        for _ in range(count):
            self.start("worker", self.address, "--nthreads", "1", "--no-nanny", "--local-directory", self.folder)
        wait_for(lambda: len(self.client.nthreads()) == before + count)

    def kill_busiest_worker(self):
        """How many results went with it."""
        held = self.client.has_what()
        worker = max(held, key=lambda one: len(held[one]))
        os.kill(self.client.run(os.getpid, workers=[worker])[worker], signal.SIGKILL)
        return len(held[worker])

    def end(self):
        self.client.close()
        for process in reversed(self.all):
            process.kill()
            process.wait()


def wait_for(condition, seconds=120):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.01)


@pytest.fixture
def cluster(tmp_path):
    folder = tmp_path / "cluster"
    folder.mkdir()
    processes = Processes(folder)
    try:
        processes.add_workers(3)
        yield processes
    finally:
        processes.end()


@pytest.fixture(scope="module")
def site():
    return igsp.simulate("park", stations=7, points=30000, station_distance=6, seed=3)


@pytest.fixture(scope="module")
def files(site, tmp_path_factory):
    """Five PLY files, one that cannot be read in their middle, and an E57 of two scans."""
    folder = tmp_path_factory.mktemp("site")
    for i, scan in enumerate(site[:5]):
        igsp.write_points(folder / f"s{i}.ply", scan.points, viewpoint=scan.viewpoint)
    (folder / "s2_broken.ply").write_bytes(b"ply\n")
    make_e57(folder / "two.e57", [(e57_attributes(scan.points), motion(0.3)) for scan in site[5:]])
    return sorted(folder.iterdir())


@pytest.fixture(scope="module")
def local(files, tmp_path_factory, pip_command):
    """The folder that the local engine writes."""
    folder = tmp_path_factory.mktemp("local") / "survey"
    run = command(pip_command, files, folder)
    assert run.returncode == 3 and "two.e57#1" in (folder / "poses.csv").read_text(), run.stderr
    assert run.stdout.startswith("registered 7 of 8 scans: 7 in one frame; 1 alone (s2_broken: "), run.stdout
    return folder


def arguments(program, files, folder, *more):
    return [program, "network", *files, "-o", folder, "--target-points", "3000", *more]


def command(*given):
    return subprocess.run(arguments(*given), capture_output=True, text=True)


def dask(scheduler):
    return ["--engine", "dask", "--scheduler", scheduler]


def kept_pairs(folder):
    return sorted(folder.glob("cache/*/pairs/*"))


def expect_same(folder, local):
    for name in ANSWERS:
        assert (folder / name).read_bytes() == (local / name).read_bytes(), name


def test_a_killed_workers_tasks_are_done_again(files, local, cluster, tmp_path, pip_command):
    folder = tmp_path / "survey"
    run = subprocess.Popen(
        arguments(pip_command, files, folder, *dask(cluster.address)), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    wait_for(lambda: len(kept_pairs(folder)) >= 2)
    held = cluster.kill_busiest_worker()
    kept = len(kept_pairs(folder))
    stdout, stderr = run.communicate()
    assert run.returncode == 3 and stdout.startswith(b"registered 7 of 8 scans: 7 in one frame"), stderr
    assert held > 0 and kept < len(kept_pairs(folder)) == 21, f"killed too late: {held} results, {kept} pairs"
    assert len(cluster.client.nthreads()) == 2
    expect_same(folder, local)
    wait_for(lambda: not any(cluster.client.has_what().values()))  # nothing stays with the workers


def test_an_interrupted_run_goes_on_with_either_engine(files, local, cluster, tmp_path, pip_command):
    folder = tmp_path / "survey"
    run = subprocess.Popen(
        arguments(pip_command, files, folder, *dask(cluster.address)), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    wait_for(lambda: len(kept_pairs(folder)) >= 2)
    run.send_signal(signal.SIGINT)
    assert (run.communicate(), run.returncode) == ((b"", b"igsp: interrupted\n"), 130)
    before = {path: path.stat().st_mtime_ns for path in kept_pairs(folder)}
    assert 2 <= len(before) < 21
    list_of_pairs = tmp_path / "pairs.csv"
    list_of_pairs.write_text("source,target\n" + "".join(f"{files[0]},{file}\n" for file in files[1:3]))
    run = command(pip_command, files, folder, "--pairs", list_of_pairs)  # the local one, a little further
    assert run.returncode == 3, run.stderr
    run = command(pip_command, files, folder, *dask(cluster.address))
    assert run.returncode == 3, run.stderr
    assert len(kept_pairs(folder)) == 21 and all(path.stat().st_mtime_ns == when for path, when in before.items())
    expect_same(folder, local)


def test_the_same_from_python(site, files, cluster):
    expected = igsp.network(files, **FAST)
    stages = []
    found = igsp.network(
        files, engine="dask", scheduler=cluster.address, progress=lambda *seen: stages.append(seen[0]), **FAST
    )
    assert values(found) == values(expected) and "s2_broken.ply" in found.scans[3].problem
    assert list(dict.fromkeys(stages)) == ["scale", "features", "pairs", "network"]
    features = igsp.extract_features(site[1], voxel_size=expected.voxel_size, **FAST)
    mixed = [files[0], features, site[2], site[3].points, "nowhere.ply"]
    options = {"pairs": "auto", "viewpoints": ["auto", "auto", None, [0, 0, 0], "auto"], **FAST}
    here = igsp.network(mixed, **options)
    assert values(igsp.network(mixed, engine="dask", scheduler=cluster.address, **options)) == values(here)
    assert here.scans[4].problem.startswith("nowhere.ply: ")
    with pytest.raises(igsp.Cancelled):
        igsp.network(
            files, engine="dask", scheduler=cluster.address, progress=lambda stage, done: stage != "pairs", **FAST
        )


def test_a_lost_scheduler_ends_the_run(files, cluster, tmp_path, pip_command):
    folder = tmp_path / "survey"
    run = subprocess.Popen(
        arguments(pip_command, files, folder, *dask(cluster.address)), stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    wait_for(lambda: len(kept_pairs(folder)) >= 1)
    cluster.all[0].kill()
    stdout, stderr = run.communicate()
    assert (run.returncode, stdout) == (3, b"")
    assert stderr == b"igsp: the connection to the Dask scheduler is lost\n"
    assert not (folder / "poses.csv").exists()


def test_what_is_missing_is_said(files, tmp_path, cpp_command, pip_command):
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    for scheduler, code, said in (
        (address, 3, f"igsp: no Dask scheduler answers at {address}: "),
        ("nowhere", 3, "igsp: no Dask scheduler answers at nowhere: missing port number"),
        ("", 2, "igsp: --engine dask and --scheduler ADDRESS belong together"),
    ):
        run = command(pip_command, files, tmp_path / "survey", *dask(scheduler))
        assert (run.returncode, run.stdout) == (code, "") and run.stderr.startswith(said), run.stderr
        assert run.stderr.count("\n") == 1 and not (tmp_path / "survey").exists()
    run = command(cpp_command, files[:2], tmp_path / "survey", *dask(address))
    assert run.returncode == 2 and "--engine dask comes with the Python package: pip install 'igsp[dask]'" in run.stderr
    without = "import sys; sys.modules['distributed'] = None; from igsp.__main__ import main; sys.exit(main())"
    run = subprocess.run(
        [sys.executable, "-c", without, *arguments("", files, tmp_path / "survey", *dask(address))[1:]],
        capture_output=True,
        text=True,
    )
    assert (run.returncode, run.stdout) == (3, "")
    assert run.stderr == "igsp: the engine dask needs the package 'distributed': pip install 'igsp[dask]'\n"
    with pytest.raises(OSError, match="no Dask scheduler answers at nowhere"):
        igsp.network(files, engine="dask", scheduler="nowhere")
    with pytest.raises(ValueError, match="belong together"):
        igsp.network(files, engine="dask")
    with pytest.raises(ValueError, match="engine is some; it must be local or dask"):
        igsp.network(files, engine="some")


def test_workers_must_have_the_same_igsp(files, cluster, monkeypatch):
    monkeypatch.setattr("igsp.cluster._METHOD_THERE", "'of another version'")
    with pytest.raises(ValueError, match=r"the Dask worker tcp://\S+ must have the igsp of the client"):
        igsp.network(files, engine="dask", scheduler=cluster.address)
    monkeypatch.setattr("igsp.cluster._METHOD_THERE", "__import__('nowhere')")
    with pytest.raises(ValueError, match="No module named 'nowhere'"):
        igsp.network(files, engine="dask", scheduler=cluster.address)


def test_without_workers_it_waits_and_says_so(site, tmp_path):
    processes = Processes(tmp_path)
    try:
        files = [tmp_path / f"{i}.ply" for i in range(2)]
        for file, scan in zip(files, site, strict=False):
            igsp.write_points(file, scan.points)
        with pytest.warns(UserWarning, match="the Dask scheduler has no workers; waiting for them") as seen:
            network = igsp.network(
                files,
                engine="dask",
                scheduler=processes.address,
                progress=lambda *_: not seen or len(processes.all) > 1 or processes.add_workers(1),
                **FAST,
            )
        np.testing.assert_array_equal(network.poses, igsp.network(files, **FAST).poses)
    finally:
        processes.end()
