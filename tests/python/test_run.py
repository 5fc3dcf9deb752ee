"""A run among others: Ctrl-C, the interpreter lock, several threads."""

import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import igsp

# With these options a run takes minutes when it is not interrupted.
LONG = "dict(voxel_size=0.05, pca_radius=60, descriptor_radius=60)"


def start(program, *arguments):
    """A Python process that has got as far as printing a line."""
    process = subprocess.Popen(
        [sys.executable, "-c", program, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "running\n"
    return process


def test_ctrl_c_is_a_keyboard_interrupt(scans):
    process = start(
        f"""
import sys, igsp
def say(stage, fraction):
    if stage == "keypoints" and fraction > 0: print("running", flush=True)
try:
    igsp.align(sys.argv[1], sys.argv[2], progress=say, **{LONG})
except KeyboardInterrupt:
    print("interrupted")
""",
        scans / "park/station_1.ply",
        scans / "park/station_0.ply",
    )
    process.send_signal(signal.SIGINT)
    output, error = process.communicate(timeout=60)
    assert (process.returncode, output.split()[-1]) == (0, "interrupted"), error


def test_ctrl_c_needs_no_progress_function(scans):
    process = start(
        f"""
import os, signal, sys, threading, time, igsp
source, target = (igsp.read_points(path) for path in sys.argv[1:])
def interrupt():
    time.sleep(1)  # this thread goes on only because the run lets it
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
print("running", flush=True)
igsp.align(source, target, **{LONG})
""",
        scans / "park/station_1.ply",
        scans / "park/station_0.ply",
    )
    _, error = process.communicate(timeout=60)
    assert process.returncode == -signal.SIGINT and error.rstrip().endswith("KeyboardInterrupt")


def test_other_threads_run_meanwhile(pair):
    """While one thread is in the library, this one wakes up many times; it could not if the lock were held."""
    for work in [
        lambda: igsp.align(*pair, threads=1),
        lambda: igsp.extract_features(pair[0], voxel_size=0.2),
        lambda: igsp.simulate("park", points=100000),
    ]:
        thread = threading.Thread(target=work)
        thread.start()
        awake = 0
        while thread.is_alive():
            time.sleep(0.001)
            awake += 1
        assert awake > 5


def test_parallel_runs_give_the_same_answers(pair, result):
    backward = igsp.align(pair[1], pair[0])
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(lambda clouds: igsp.align(*clouds), [pair, pair[::-1]] * 4))
    for answer, expected in zip(answers, [result, backward] * 4, strict=True):
        np.testing.assert_array_equal(answer.target_from_source, expected.target_from_source)
        assert answer.confidence == expected.confidence
