#!/usr/bin/env python3
"""Runs igsp and its peers on the same pairs of clouds and keeps a row for every answer.

Each run is a process of its own on the same files, with a limit of its CPU time, and shortly after a run of igsp on
that pair whose seconds stand in the same row. Rows are on the disk as they come; the same command does what is left of
an interrupted run, and runs what had an error again. What the rows say is written by summary.py and plots.py.
"""

import argparse
import fnmatch
import random
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from launch import Outcome, Programs, launch, missing_programs
from methods import METHODS, Method, Run, rounds, wanted
from metrics import is_right, pose_errors
from pairs import Pair, export_pair, perturbed_truth, read_cloud, read_list
from rows import COLUMNS, Row, append_rows, key_of, read_rows, text_of, write_rows

ROOT = Path(__file__).resolve().parents[2]
STALE_S = 30.0  # a run of igsp older than this is no reference any more


def judged(pair: Pair, answer: dict, centroid: np.ndarray) -> dict:
    """Verdict, success and errors of one answer, as `igsp benchmark` has them."""
    accepted = answer["converged"]
    verdict = {"verdict": "registered" if accepted else "not_registered"}
    if pair.truth_kind == "none":
        return {**verdict, "success": not accepted}
    if pair.truth_kind == "-":
        return verdict
    errors = pose_errors(np.array(answer["target_from_source"]), pair.truth, centroid)
    return {**verdict, **errors, "success": is_right(errors, pair.max_rotation_error_deg, pair.max_displacement)}


def rows_of(pair: Pair, run: Run, outcome: Outcome, voxel_size: float, centroid: np.ndarray, scramble: int,
            reference: dict) -> list[Row]:
    """A row per answer; one with the error, or with the refusal, if there is none."""
    same = {"name": pair.name, "group": pair.group, "scramble": scramble, "truth": pair.truth_kind,
            "voxel_size": voxel_size, "peak_memory_bytes": outcome.peak_memory_bytes, "error": outcome.error,
            "memory_before_bytes": outcome.report.get("memory_before_bytes"),
            "version": outcome.report.get("version"), "voxels": run.voxels, "threads": run.threads_text,
            "seed": run.seed_text, "process_cpu_seconds": outcome.cpu_seconds,
            "process_wall_seconds": outcome.wall_seconds, **reference}
    if run.method.program == "igsp" and not outcome.error:
        report = outcome.report
        same |= {"confidence": report["confidence"], "overlap": report["overlap"], "reason": report["reason"],
                 "iterations": len(report["iterations"]), "source_keypoints": report["keypoints"]["source"],
                 "target_keypoints": report["keypoints"]["target"],
                 "stage_seconds": ";".join(f"{stage}={s:.6f}" for stage, s in report["timings_s"].items())}
    found = []
    for answer in outcome.answers:
        try:
            found.append({"label": answer["label"], **judged(pair, answer, centroid), "score": answer["score"],
                          "cpu_seconds": answer["cpu_seconds"], "wall_seconds": answer["wall_seconds"]})
        except ValueError as error:  # no rigid motion
            found.append({"label": answer["label"], "error": f"{answer['label'] or 'answer'}: {error}"})
    if not found and not outcome.error:
        found = [{"verdict": "not_registered", "success": {"known": False, "none": True}.get(pair.truth_kind)}]
    rows = []
    for values in found or [{}]:
        label = values.pop("label", "")
        values = {**same, **values, "preset": run.method.name + ("+" + label if label else "")}
        rows.append({column: text_of(values.get(column)) for column in COLUMNS})
    return rows


class PairRunner:
    """All runs on one pair, in turn with igsp's."""

    def __init__(self, pair: Pair, programs: Programs, scramble: int, folder: Path, version: str) -> None:
        self.pair, self.programs, self.scramble, self.folder, self.version = pair, programs, scramble, folder, version
        self.centroid = read_cloud(pair.source).mean(axis=0)
        self.references: dict[tuple[bool, int], tuple[float, Outcome]] = {}
        self.voxel_size = float(self.reference(False, 1).report["voxel_size"])

    def guess(self, method: Method) -> Path | None:
        if not method.from_guess:
            return None
        path = self.folder / "guess.txt"
        np.savetxt(path, perturbed_truth(self.pair, self.voxel_size, self.centroid), fmt="%.17g")
        return path

    def reference(self, from_guess: bool, threads: int) -> Outcome:
        """A run of igsp on the same pair, question and number of threads, not older than STALE_S."""
        when, outcome = self.references.get((from_guess, threads), (-np.inf, None))
        if time.monotonic() - when > STALE_S:
            method = next(m for m in METHODS if m.program == "igsp" and m.from_guess == from_guess)
            outcome = launch(Run(method, "igsp", threads, 1), self.pair, 0.0, self.guess(method), self.programs,
                             self.folder)
            if outcome.error:
                raise SystemExit(f"{self.pair.name}: igsp itself failed: {outcome.error}")
            self.references[from_guess, threads] = time.monotonic(), outcome
        return outcome

    def run(self, run: Run) -> list[Row]:
        method = run.method
        reference = self.reference(method.from_guess, run.threads)
        answer = reference.answers[0] if reference.answers else {"cpu_seconds": reference.report["cpu_seconds"]}
        seconds = {"igsp_cpu_seconds": answer["cpu_seconds"], "igsp_wall_seconds": answer.get("wall_seconds")}
        voxel_size = self.voxel_size if run.voxels == "igsp" else method.recommended_for(self.pair.group)
        if method.name in ("igsp", "igsp_refine"):
            outcome = reference
        else:
            outcome = launch(run, self.pair, voxel_size, self.guess(method), self.programs, self.folder)
        if method.program == "igsp":
            outcome.report["version"] = self.version
            voxel_size = float(outcome.report.get("voxel_size", voxel_size))
        return rows_of(self.pair, run, outcome, voxel_size, self.centroid, self.scramble, seconds)


def runs_of(case: dict[str, str], number: int, passes: list[tuple[Run, int]], every: int) -> list[Run]:
    """What a pass wants of a case, the number of which counts within its group."""
    negative, known = case["truth"] == "none", case["truth"] not in ("none", "-")
    return [run for run, share in passes
            if wanted(run, number, every, share, negative) and (known or not run.method.from_guess)
            and (run.voxels == "igsp" or run.method.recommended_for(case["group"]))]


def numbered(cases: list[dict[str, str]], only: list[str]) -> list[tuple[int, dict[str, str]]]:
    """The selected cases with their numbers within the groups, in an order that mixes the groups."""
    counts: dict[str, int] = {}
    selected = []
    for case in cases:
        number = counts.get(case["group"], 0)
        counts[case["group"]] = number + 1
        if not only or any(case["group"] == one or fnmatch.fnmatchcase(case["name"], one) for one in only):
            selected.append((number, case))
    random.Random(0).shuffle(selected)
    return selected


def line_of(row: Row) -> str:
    judgement = {"yes": "right", "no": "wrong"}.get(row["success"], "not judged")
    judged_as = row["error"] or f"{row['verdict']}, {judgement}"
    errors = f"{float(row['e_r_deg']):.3g} deg {float(row['centroid_displacement']):.3g}" if row["e_r_deg"] else ""
    seconds = f"{float(row['cpu_seconds']):.2f} s" if row["cpu_seconds"] else ""
    return f"{row['name']:<44.44} {row['preset']:<30} {row['threads']:>3} {judged_as:<28.60} {errors:<22} {seconds}"


def igsp_version(programs: Programs, commit: str | None) -> str:
    version = subprocess.run([programs.igsp, "--version"], capture_output=True, text=True).stdout.split()[-1]
    if commit is None:
        head = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
        commit = head.stdout.strip()
    return f"{version} {commit}".strip()


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    binaries = ROOT / "build/release/bin"
    parser.add_argument("--cases", type=Path, default=ROOT / "../shared/data/cases.csv", help="list of igsp benchmark")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/data/peers.csv", help="rows")
    parser.add_argument("--igsp", type=Path, default=binaries / "igsp")
    parser.add_argument("--pcl-peer", type=Path, default=binaries / "pcl_peer")
    parser.add_argument("--python", type=Path, default=ROOT / "build/peers-venv/bin/python",
                        help="with the Python peers")
    parser.add_argument("--every", type=int, default=1,
                        help="one of so many pairs of each group, and all that do not overlap")
    parser.add_argument("--only", action="append", default=[], metavar="GROUP|GLOB", help="may be given several times")
    parser.add_argument("--peer", action="append", default=[], metavar="NAME", choices=[m.name for m in METHODS],
                        help="only this method; may be given several times")
    parser.add_argument("--again", action="store_true", help="run what has an answer, in place of it")
    parser.add_argument("--minutes", type=float, default=float("inf"), help="start nothing after this time")
    parser.add_argument("--commit", help="that igsp was built from, for its version; by default the present one")
    parser.add_argument("--scramble", type=int, default=7, help="seed of the motions of the sources")
    args = parser.parse_args()
    if args.every < 1:
        parser.error(f"--every is {args.every}; it must be at least 1")
    for name in ("cases", "out", "igsp", "pcl_peer"):
        setattr(args, name, getattr(args, name).resolve())
    args.python = args.python.absolute()  # a virtual environment's is a link that must stay one
    return args


def key_of_run(name: str, run: Run, scramble: int) -> tuple[str, ...]:
    """The key that the rows of a run will have."""
    return name, run.method.name, run.voxels, run.threads_text, run.seed_text, str(scramble)


def todo_of(args: argparse.Namespace, methods: list[Method], done: set) -> list[tuple[dict[str, str], list[Run]]]:
    """What has no answer yet; with --again what has one."""
    cases = numbered(read_list(args.cases), args.only)
    if not cases:
        raise SystemExit(f"--only {' '.join(args.only)} selects no case of {args.cases.name}")
    todo = []
    for passes in rounds(methods):
        for number, case in cases:
            runs = [run for run in runs_of(case, number, passes, args.every)
                    if (key_of_run(case["name"], run, args.scramble) in done) == args.again]
            if runs:
                todo.append((case, runs))
    return todo


def main() -> None:
    args = arguments()
    start = time.monotonic()
    programs = Programs(args.igsp, args.pcl_peer, args.python)
    methods = [m for m in METHODS if not args.peer or m.name in args.peer]
    missing = missing_programs({m.program for m in methods} | {"igsp"}, programs)
    for name, reason in missing.items():
        print(f"cannot be run: {name}: {reason}")
    if "igsp" in missing:
        raise SystemExit("nothing to compare with")
    methods = [m for m in methods if m.program not in missing]
    rows = [row for row in read_rows(args.out) if not row["error"] or row["error"].startswith("stopped after")]
    todo = todo_of(args, methods, {key_of(row) for row in rows})
    again = {key_of_run(case["name"], run, args.scramble) for case, runs in todo for run in runs}
    rows = [row for row in rows if key_of(row) not in again]
    args.out.parent.mkdir(parents=True, exist_ok=True)
    write_rows(args.out, rows)
    version = igsp_version(programs, args.commit)
    total, count = sum(len(runs) for _, runs in todo), 0
    for case, runs in todo:
        if time.monotonic() - start > 60 * args.minutes:
            print(f"time is up: {count} of {total} runs done; the same command does the rest")
            return
        with tempfile.TemporaryDirectory() as folder:
            pair = export_pair(args.igsp, args.cases, case["name"], args.scramble, Path(folder))
            runner = PairRunner(pair, programs, args.scramble, Path(folder), version)
            for run in runs:
                new = runner.run(run)
                append_rows(args.out, new)
                count += 1
                for row in new:
                    print(f"{count:>5}/{total} {line_of(row)}", flush=True)


if __name__ == "__main__":
    main()
