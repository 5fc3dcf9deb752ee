"""A run among others: Ctrl-C, the interpreter lock, several threads."""

import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import igsp

# Many keypoints, and a loop that may not converge: hours when the run is not interrupted.
LONG_RUN = """
import sys, igsp
source, target = (igsp.read_points(path) for path in sys.argv[2:])
def say(stage, fraction):
    if stage == "loop": print("running", flush=True)
try:
    print("starting", flush=True)
    igsp.align(source, target, progress=say if sys.argv[1] == "heard" else False, preset="paper", voxel_size=0.2,
               min_curvature=0, suppression_radius=1.5, weight_changing_rate=1e6, rotation_tolerance_rad=0,
               translation_tolerance=0, max_iterations=10000)
except KeyboardInterrupt:
    print("interrupted")
"""


@pytest.mark.parametrize("progress", ["heard", "unheard"])
def test_ctrl_c_is_a_keyboard_interrupt(progress, scans):
    paths = [scans / "park/station_1.ply", scans / "park/station_0.ply"]
    process = subprocess.Popen([sys.executable, "-c", LONG_RUN, progress, *paths], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "starting\n"
        if progress == "heard":
            assert process.stdout.readline() == "running\n"
        else:
            time.sleep(2)  # by now it is in the library
        process.send_signal(signal.SIGINT)
        assert process.communicate(timeout=60)[0].split()[-1] == "interrupted"
    finally:
        process.kill()
    assert process.returncode == 0


@pytest.mark.parametrize(
    "call",
    [
        "igsp.simulate('park', points=100_000_000)",
        "igsp.extract_features(cloud, voxel_size=0.005, pca_radius=99)",
        "igsp.align(cloud, cloud, voxel_size=0.005, pca_radius=99)",
    ],
)
def test_other_threads_run_meanwhile(call):
    """One thread is in the library for very long; if it held the interpreter lock, the other could never go on."""
    program = f"""
import os, threading, time, numpy, igsp
cloud = numpy.random.default_rng(0).uniform(size=(1_000_000, 3))
threading.Thread(target=lambda: {call}, daemon=True).start()
time.sleep(1)
print("awake", flush=True)
os._exit(0)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (0, "awake\n"), done.stderr


def test_parallel_runs_give_the_same_answers(pair, result):
    backward = igsp.align(pair[1], pair[0])
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda clouds: igsp.align(*clouds), [pair, pair[::-1]] * 4))
    for answer, expected in zip(answers, [result, backward] * 4, strict=True):
        np.testing.assert_array_equal(answer.target_from_source, expected.target_from_source)
        assert answer.confidence == expected.confidence
