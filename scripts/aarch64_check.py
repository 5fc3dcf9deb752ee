"""Whether the command for aarch64, under qemu-user, gives the bits that the one for this machine gives.

    python3 scripts/aarch64_check.py build/release/bin/igsp build/aarch64/bin/igsp LIBRARIES

Simulates scans with both and registers them with both; compares scans, transformations and reports, all but what tells
of time. LIBRARIES: where scripts/aarch64_libraries.sh unpacked Debian's.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

# Scene, points a scan, target: "" is the scene's own.
PAIRS = [("park", "20000", ""), ("indoor", "30000", ""), ("object", "20000", ""), ("park", "20000", "indoor")]
OF_THE_RUN = {"timings_s", "cpu_seconds", "peak_memory_bytes", "seconds"}


def without_time(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: without_time(inner) for key, inner in value.items() if key not in OF_THE_RUN}
    return [without_time(inner) for inner in value] if isinstance(value, list) else value


def answer(command: list[str], folder: Path, scene: str, points: str, target: str) -> dict[str, Any]:
    """What the command makes of a pair, by name."""

    def igsp(*arguments: str) -> None:
        done = subprocess.run([*command, *arguments], cwd=folder, capture_output=True, text=True)
        if done.returncode not in (0, 1):  # 1: not registered
            sys.exit(f"igsp {' '.join(arguments)}: {done.stderr}")

    for name in {scene, target} - {""}:
        igsp("simulate", name, "--points", points, "--out", name)
    clouds = f"{scene}/station_1.ply", f"{target or scene}/station_0.ply"
    igsp("align", *clouds, "--force", "--transform", "T.txt", "--report", "report.json", "--quiet", "--no-diagnose")
    report = without_time(json.loads((folder / "report.json").read_text()))
    return {cloud: (folder / cloud).read_bytes() for cloud in clouds} | {
        "transformation": (folder / "T.txt").read_text(),
        "report": report,
    }


def differing(native: Any, other: Any, path: str = "") -> list[str]:
    """The places at which two answers differ."""
    if isinstance(native, dict) and isinstance(other, dict) and native.keys() == other.keys():
        return [line for key in native for line in differing(native[key], other[key], f"{path}/{key}")]
    if isinstance(native, list) and isinstance(other, list) and len(native) == len(other):
        pairs = enumerate(zip(native, other, strict=True))
        return [line for i, (a, b) in pairs for line in differing(a, b, f"{path}[{i}]")]
    return [] if native == other else [f"{path}: {str(native)[:60]} and {str(other)[:60]}"]


def main() -> None:
    here, there, libraries = sys.argv[1], sys.argv[2], Path(sys.argv[3]).resolve()
    shared = libraries / "usr/lib/aarch64-linux-gnu"
    emulated = ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", "-E", f"LD_LIBRARY_PATH={shared}"]
    commands = [[str(Path(here).resolve())], [*emulated, str(Path(there).resolve())]]
    same = True
    for scene, points, target in PAIRS:
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            folders = Path(one), Path(two)
            answers = [answer(c, f, scene, points, target) for c, f in zip(commands, folders, strict=True)]
        lines = differing(*answers)
        same = same and not lines
        verdict = answers[0]["report"]["verdict"]
        print(f"{scene} {points} {target}: {verdict}, {'the same bits' if not lines else f'{len(lines)} differ'}")
        for line in lines[:10]:
            print(f"  {line}")
    sys.exit(0 if same else 1)


if __name__ == "__main__":
    main()
