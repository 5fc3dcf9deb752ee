"""Options, progress, and giving up in time: 03_options_and_progress.py SOURCE TARGET"""

import sys
import time

import igsp

start = time.monotonic()


def progress(stage: str, fraction: float) -> bool:
    print(f"{stage} {100 * fraction:.0f} %", end="\r", file=sys.stderr)
    return time.monotonic() - start < 60  # False: igsp.Cancelled is raised


try:
    # Levelled scanners: yaw and translation only. The answer is the same for any number of threads.
    result = igsp.align(sys.argv[1], sys.argv[2], dof=4, voxel_size=0.3, threads=2, progress=progress)
    print(result.reason)
    sys.exit(not result.registered)
except igsp.Cancelled:
    sys.exit("given up after a minute")
