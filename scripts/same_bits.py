"""Whether the command gives the same bits on another processor or from another compiler.

    python3 scripts/same_bits.py build/release/bin/igsp [--cases CASES.csv] -- qemu-aarch64 ... build/aarch64/bin/igsp
    python3 scripts/same_bits.py build/release/bin/igsp -- build/compilers/clang/bin/igsp
    python3 scripts/same_bits.py --plain-libm build/release/bin/igsp -- qemu-x86_64 -cpu Nehalem build/release/bin/igsp

Simulates scans with both; registers what the first one simulated with both; compares scans, transformations and reports,
all but what tells of time, and says how far motion and confidence differ at most. With a list of cases, as `igsp benchmark`
reads it, both run the first of each group, and their rows are compared, too. --plain-libm has the first one use the sine, cosine, ... that glibc has for processors without fused
multiply-add, which round otherwise: what differs then is of igsp.
"""

import argparse
import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

Pair = tuple[str, str, str]  # scene, points a scan, target: "" is the scene's own
PAIRS: list[Pair] = [("park", "20000", ""), ("indoor", "30000", ""), ("object", "20000", ""), ("park", "20000", "indoor")]
OF_THE_RUN = {"timings_s", "cpu_seconds", "peak_memory_bytes", "seconds", "stage_seconds", "wall_seconds", "host"}
Command = list[str]
PLAIN_LIBM = ["env", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4"]


def run(command: Command, folder: Path, *arguments: str) -> None:
    done = subprocess.run([*command, *arguments], cwd=folder, capture_output=True, text=True)
    if done.returncode not in (0, 1):  # 1: not registered
        sys.exit(f"{' '.join(command)} {' '.join(arguments)}: {done.stderr}")


def without_time(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: without_time(inner) for key, inner in value.items() if key not in OF_THE_RUN}
    return [without_time(inner) for inner in value] if isinstance(value, list) else value


def differing(native: Any, other: Any, path: str = "") -> list[str]:
    """The places at which two answers differ."""
    if isinstance(native, dict) and isinstance(other, dict) and native.keys() == other.keys():
        return [line for key in native for line in differing(native[key], other[key], f"{path}/{key}")]
    if isinstance(native, list) and isinstance(other, list) and len(native) == len(other):
        pairs = enumerate(zip(native, other, strict=True))
        return [line for i, (a, b) in pairs for line in differing(a, b, f"{path}[{i}]")]
    return [] if native == other else [f"{path}: {str(native)[:60]} and {str(other)[:60]}"]


def distance(native: dict[str, Any], other: dict[str, Any]) -> str:
    """How far two reports differ in what counts: translation (in the cloud's unit), entries of the rotation, confidence."""
    if native["verdict"] != other["verdict"]:
        return f"{native['verdict']} there {other['verdict']}"
    rows = list(zip(native["target_from_source"], other["target_from_source"], strict=True))
    translation = math.dist([a[3] for a, _ in rows[:3]], [b[3] for _, b in rows[:3]])
    rotation = max(abs(a[k] - b[k]) for a, b in rows[:3] for k in range(3))
    confidence = abs(native["confidence"] - other["confidence"])
    return f"translation by {translation:.1g}, rotation by {rotation:.1g}, confidence by {confidence:.1g}"


def told(what: str, lines: list[str], by: str = "") -> bool:
    """Prints the outcome; whether both were the same."""
    print(f"{what}: {'the same bits' if not lines else f'{len(lines)} values differ'}{by and ': ' + by}", flush=True)
    for line in lines[:10]:
        print(f"  {line}")
    return not lines


def scenes_agree(here: Command, there: Command, work: Path, pairs: list[Pair]) -> bool:
    same = True
    for scene, points in dict(pair[:2] for pair in pairs).items():
        for command, side in ((here, "here"), (there, "there")):
            (work / side).mkdir(exist_ok=True)
            run(command, work / side, "simulate", scene, "--points", points, "--out", scene)
        names = sorted(path.name for path in (work / "here" / scene).iterdir())
        contents = [{n: (work / side / scene / n).read_bytes() for n in names} for side in ("here", "there")]
        same &= told(f"simulate {scene} {points}", differing(*contents))
    return same


def answer(command: Command, work: Path, clouds: tuple[str, str]) -> dict[str, Any]:
    run(command, work, "align", *clouds, "--force", "--transform", "T.txt", "--report", "report.json", "--quiet",
        "--no-diagnose")  # fmt: skip
    report = without_time(json.loads((work / "report.json").read_text()))
    return {"transformation": (work / "T.txt").read_text(), "report": report}


def answers_agree(here: Command, there: Command, work: Path, pairs: list[Pair]) -> bool:
    same = True
    for scene, _, target in pairs:
        clouds = f"here/{scene}/station_1.ply", f"here/{target or scene}/station_0.ply"
        answers = [answer(command, work, clouds) for command in (here, there)]
        what = f"align {scene} {target}".strip()
        same &= told(f"{what}, {answers[0]['report']['verdict']}", differing(*answers))
    return same


def first_of_each_group(cases: Path, subset: Path) -> None:
    with cases.open(newline="") as file:
        rows = list(csv.DictReader(file))
    first = {row["group"]: row for row in reversed(rows)}
    for row in first.values():
        for column in ("source", "target", "truth"):
            if row[column] not in ("none", "-"):
                row[column] = str(cases.resolve().parent / row[column])
    with subset.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(first.values())


def rows_of(command: Command, work: Path) -> list[dict[str, str]]:
    run(command, work, "benchmark", "subset.csv", "--out", "rows.csv", "--quiet")
    with (work / "rows.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def cases_agree(here: Command, there: Command, cases: Path, work: Path) -> bool:
    first_of_each_group(cases, work / "subset.csv")
    same = True
    for one, other in zip(rows_of(here, work), rows_of(there, work), strict=True):
        what = f"case {one['name']}, {one['verdict']}, right: {one['success'] or '-'}"
        same &= told(what, differing(without_time(one), without_time(other)))
    return same


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("here", type=Path)
    parser.add_argument("--cases", type=Path)
    parser.add_argument("--plain-libm", action="store_true")
    parser.add_argument("there", nargs="+", help="the other command, after --: an emulator, its arguments, igsp")
    arguments = parser.parse_args()
    here = [*(PLAIN_LIBM if arguments.plain_libm else []), str(arguments.here.resolve())]
    there = [*arguments.there[:-1], str(Path(arguments.there[-1]).resolve())]
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        same = scenes_agree(here, there, work, PAIRS)
        same &= answers_agree(here, there, work, PAIRS)
        if arguments.cases and arguments.cases.exists():
            same &= cases_agree(here, there, arguments.cases, work)
        elif arguments.cases:
            print(f"LEFT OUT: {arguments.cases} is not there")
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    main()
