"""What more threads bring: `igsp align` of a pair on one thread and on several, in turn.

Prints the least seconds by the clock of each and their ratio, and the stages of the fastest run that wrote a report, which
takes some milliseconds more. Arguments after the files go to igsp.

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


def seconds_in(run):
    return sum(run["timings_s"].values())


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
    best, stages = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "run.json"
        for _ in range(settings.rounds):
            for threads in (1, settings.threads):
                command = [settings.igsp, "align", settings.source, settings.target, "--threads", str(threads), *options]
                best[threads] = min(best.get(threads, float("inf")), seconds_of(command))
                seconds_of([*command, "--report", report])
                run = json.loads(report.read_text())
                if threads not in stages or seconds_in(run) < seconds_in(stages[threads]):
                    stages[threads] = run
    one, several = best[1], best[settings.threads]
    of_one, of_several = stages[1], stages[settings.threads]
    points = [of_one[cloud]["points"] for cloud in ("source", "target")]
    print(f"{points[0]:,} and {points[1]:,} points, {of_one['verdict']}: "
          f"{one:.3f} s on one thread, {several:.3f} s on {settings.threads}, ratio {one / several:.2f}")
    for stage, seconds in of_one["timings_s"].items():
        print(f"  {stage:<16}{seconds:8.3f}{dict(of_several['timings_s']).get(stage, 0):8.3f}")


if __name__ == "__main__":
    main()
