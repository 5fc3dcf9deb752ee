"""Runs one Python peer once: python run_python_peer.py MODULE METHOD SOURCE TARGET VOXEL_SIZE SEED THREADS [INITIAL]

The module's register() gets both clouds as (N, 3) doubles in memory and yields its answers as they come; seconds are
counted from its start. The answers go to standard output as one JSON object on a line of its own, the last.
"""

import importlib
import json
import resource
import sys
import time
from pathlib import Path

import numpy as np

from pairs import read_cloud


def main() -> None:
    module, method, source, target, voxel_size, seed, threads, *initial = sys.argv[1:]
    peer = importlib.import_module(module)
    clouds = [read_cloud(Path(path)) for path in (source, target)]
    guess = np.loadtxt(initial[0]) if initial else None
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    answers = []
    cpu, wall = time.process_time(), time.perf_counter()
    for answer in peer.register(method, *clouds, float(voxel_size), int(seed), int(threads), guess):
        seconds = {"cpu_seconds": time.process_time() - cpu, "wall_seconds": time.perf_counter() - wall}
        answers.append({**answer, "target_from_source": np.asarray(answer["target_from_source"]).tolist(), **seconds})
    print("\n" + json.dumps({"version": peer.VERSION, "memory_before_bytes": before, "answers": answers}))


if __name__ == "__main__":
    main()
