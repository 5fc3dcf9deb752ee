"""What more threads bring: `igsp align` of a pair on one thread and on several, in turn.

Prints the least seconds by the clock of each and of their stages, and the ratio. Arguments after the files go to igsp.

usage: threads.py IGSP SOURCE TARGET [--threads 2] [--rounds 5] [-- options of igsp align]
"""
import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def seconds_of(command):
    start = time.perf_counter()
    subprocess.run(command, capture_output=True, check=False)  # exit code 1: not registered
    return time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("igsp")
    parser.add_argument("source")
    parser.add_argument("target")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = sys.argv[1:]
    end = arguments.index("--") if "--" in arguments else len(arguments)
    settings, options = parser.parse_args(arguments[:end]), arguments[end + 1:]
    best = {}
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "run.json"
        for _ in range(settings.rounds):
            for threads in (1, settings.threads):
                seconds = seconds_of([settings.igsp, "align", settings.source, settings.target, "--quiet", "--report",
                                      report, "--threads", str(threads), *options])
                if threads not in best or seconds < best[threads][0]:
                    best[threads] = seconds, json.loads(report.read_text())
    (one, of_one), (several, of_several) = best[1], best[settings.threads]
    points = [of_one[cloud]["points"] for cloud in ("source", "target")]
    print(f"{points[0]:,} and {points[1]:,} points, {of_one['verdict']}: "
          f"{one:.3f} s on one thread, {several:.3f} s on {settings.threads}, ratio {one / several:.2f}")
    for stage, seconds in of_one["timings_s"].items():
        print(f"  {stage:<16}{seconds:8.3f}{dict(of_several['timings_s']).get(stage, 0):8.3f}")


if __name__ == "__main__":
    main()
