"""Every run is a process of its own: how it is started, measured, and what it answered."""

import json
import os
import resource
import signal
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from methods import ALL_THREADS, Run
from pairs import Pair

HERE = Path(__file__).resolve().parent
STUCK = 10  # a process that needs so many times its CPU time by the clock is waiting for something


@dataclass(frozen=True)
class Programs:
    """Where the programs are. `python` has the Python peers."""

    igsp: Path
    pcl_peer: Path
    python: Path


@dataclass
class Outcome:
    """What a process left behind. `report` is its JSON; with an error there are no answers."""

    report: dict
    error: str
    cpu_seconds: float
    wall_seconds: float
    peak_memory_bytes: int

    @property
    def answers(self) -> list[dict]:
        return self.report.get("answers", [])


def command_of(run: Run, pair: Pair, voxel_size: float, guess: Path | None, report: Path,
               programs: Programs) -> list[str]:
    method, threads = run.method, run.threads or os.cpu_count()
    if method.program == "igsp":
        start = ["--initial", guess] if guess else []
        return [programs.igsp, "align", pair.source, pair.target, "--preset", method.method, "--threads", threads,
                "--quiet", "--report", report, *start]
    if method.program == "pcl":
        return [programs.pcl_peer, method.method, pair.source, pair.target, "--voxel-size", repr(voxel_size), "--seed",
                run.seed, "--threads", threads, "--time-limit", method.time_limit_s // 3]
    start = [guess] if guess else []
    return [programs.python, HERE / "run_python_peer.py", method.program, method.method, pair.source, pair.target,
            repr(voxel_size), run.seed, threads, *start]


def answers_of_igsp(report: dict) -> dict:
    """`igsp align --report` in the words of the other programs."""
    estimate = report["target_from_source"]
    seconds = sum(value for stage, value in report["timings_s"].items() if stage != "read")
    answer = {"label": "", "target_from_source": estimate, "converged": report["verdict"] == "registered",
              "score": report["confidence"], "cpu_seconds": report["cpu_seconds"], "wall_seconds": seconds}
    return {**report, "answers": [answer] if estimate else []}


def measured(command: list, threads: int, time_limit_s: int, working_folder: Path) -> tuple[int, str, str, Outcome]:
    """Runs a command on one processor or on all, for a limited CPU time: the clock would be unjust on a busy machine.
    Exit code, output, complaints, resources."""
    count = threads or os.cpu_count()
    environment = dict(os.environ, OMP_NUM_THREADS=str(count), OPENBLAS_NUM_THREADS=str(count))
    processors = sorted(os.sched_getaffinity(0))

    def settle() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (time_limit_s, time_limit_s))
        if threads != ALL_THREADS:
            os.sched_setaffinity(0, processors[-threads:])

    with tempfile.TemporaryFile(dir=working_folder) as output, tempfile.TemporaryFile(dir=working_folder) as complaints:
        start = time.perf_counter()
        process = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=complaints, env=environment, cwd=working_folder, preexec_fn=settle)
        timer = threading.Timer(STUCK * time_limit_s, process.kill)
        timer.start()
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            process.wait()
            raise
        finally:
            timer.cancel()
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for file in (output, complaints):
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
    outcome = Outcome({}, "", usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss * 1024)
    return process.returncode, *texts, outcome


def launch(run: Run, pair: Pair, voxel_size: float, guess: Path | None, programs: Programs, folder: Path) -> Outcome:
    report = folder / "report.json"
    report.unlink(missing_ok=True)
    command = command_of(run, pair, voxel_size, guess, report, programs)
    code, output, complaints, outcome = measured(command, run.threads, run.method.time_limit_s, folder)
    is_igsp = run.method.program == "igsp"
    if code in ((0, 1) if is_igsp else (0,)):  # igsp: 1 is the verdict "not registered"
        text = report.read_text() if is_igsp else output.strip().splitlines()[-1]
        outcome.report = answers_of_igsp(json.loads(text)) if is_igsp else json.loads(text)
    elif -code in (signal.SIGKILL, signal.SIGXCPU):
        outcome.error = f"stopped after {run.method.time_limit_s} s of CPU"
    else:
        last = (complaints.strip() or output.strip() or "no word").splitlines()[-1]
        outcome.error = f"exit code {code}: {last}"
    return outcome


def missing_programs(names: set[str], programs: Programs) -> dict[str, str]:
    """Those of the programs that cannot be started, each with the reason."""
    reasons = {}
    for name in sorted(names):
        command = {"igsp": [programs.igsp, "--version"], "pcl": [programs.pcl_peer, "--help"]}.get(
            name, [programs.python, "-c", f"import {name}"])
        try:
            run = subprocess.run(command, capture_output=True, text=True, cwd=HERE)
        except OSError as error:
            reasons[name] = f"{Path(command[0]).name}: {error.strerror}"
            continue
        if run.returncode != 0:
            reasons[name] = (run.stderr.strip() or "no word").splitlines()[-1]
    return reasons
