"""Writes docs/profile.md: what callgrind counts in igsp_profile (benchmarks/profile).

    python3 scripts/instructions.py build/release/bin/igsp_profile docs/profile.md

Instructions do not depend on the load of the machine, so that a change of the page is a change of the code or of the
compiler. Takes some minutes.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

MILLION = 1e6
# Beside each kernel: what the least is, and per what it is counted.
LEAST = {
    "voxel filter": ("reading every coordinate once", "point"),
    "Hamming distances": ("one exclusive or, popcount and addition a word", "word of 64 bits"),
    "normals": ("touching each neighbour once", "neighbour"),
}

PAGE = """# Where the instructions go

What callgrind counts in one thread on three simulated pairs of 20,000 to 30,000 points a scan: two that overlap and one
that does not. `make profile` writes this page; in a review its difference shows which stage got dearer. Instructions are not
seconds, caches and vectors count differently, but they do not depend on what else the machine does. Made with {compiler};
valgrind shows a processor with {vectors}. Another compiler gives other numbers.

## Stages

Millions of instructions of `igsp::align`, and their share. The names are those of `timings_s` in a report; what lies between
two stages belongs to the later one.

{stages}

## Distance to the limit

A few kernels beside the least that any program has to do for the same answer, on the features of the park. A ratio is
how many instructions igsp takes for one of the least; below 1 a vector instruction does the work of several.

{kernels}

The voxel filter finds the cell of a point and adds to its sum exactly, in integers, which is what makes the answer independent of
the order of the points; the Hamming distances fill a whole matrix; normals sum nine products a neighbour and solve for
eigenvectors.
"""


def number_of(dump: Path) -> int:
    """callgrind numbers its dumps in the order of the stages: out.1, out.2, ..."""
    return int(dump.suffix[1:] or 0)


def count(program: Path) -> tuple[dict[str, int], dict[str, str]]:
    """Instructions by name, and what the program prints."""
    with tempfile.TemporaryDirectory() as folder:
        callgrind = ["valgrind", "--tool=callgrind", "--instr-atstart=no", f"--callgrind-out-file={folder}/out", "-q"]
        done = subprocess.run([*callgrind, str(program.resolve())], check=True, capture_output=True, text=True)
        counts: dict[str, int] = {}
        for dump in sorted(Path(folder).iterdir(), key=number_of):
            text = dump.read_text(errors="replace")
            name = re.search(r"^desc: Trigger: Client Request: (.*)$", text, re.MULTILINE)
            total = re.search(r"^(?:totals|summary): (\d+)", text, re.MULTILINE)
            if name and total:
                counts[name.group(1)] = counts.get(name.group(1), 0) + int(total.group(1))
    printed = dict(line.rsplit(" ", 1) for line in done.stdout.splitlines())
    return counts, printed


def table(rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return "\n".join(lines)


def stage_table(counts: dict[str, int], printed: dict[str, str]) -> str:
    pairs: dict[str, dict[str, int]] = {}
    for name, number in counts.items():
        pair, stage = name.split("/")
        if pair not in ("kernel", "least"):
            pairs.setdefault(pair, {})[stage] = number
    stages = list(dict.fromkeys(stage for of_pair in pairs.values() for stage in of_pair))
    rows = [["stage", *(f"{pair} ({answer(printed, pair)})" for pair in pairs)]]
    for stage in stages:
        rows.append([stage, *(cell(of_pair.get(stage, 0), sum(of_pair.values())) for of_pair in pairs.values())])
    rows.append(["all", *(f"{sum(of_pair.values()) / MILLION:,.1f}" for of_pair in pairs.values())])
    return table(rows)


def answer(printed: dict[str, str], pair: str) -> str:
    return "registered" if printed[f"{pair}/registered"] == "1" else "not registered"


def cell(number: int, total: int) -> str:
    return f"{number / MILLION:,.1f} ({number / total:.0%})" if number else "-"


def kernel_table(counts: dict[str, int], printed: dict[str, str]) -> str:
    rows = [["kernel", "the least", "done", "instructions of igsp", "of the least", "ratio"]]
    for name, (least, unit) in LEAST.items():
        work = int(printed[f"work/{name}"])
        own, limit = counts[f"kernel/{name}"] / work, counts[f"least/{name}"] / work
        rows.append(
            [name, least, f"{work:,} times", f"{own:.2f} a {unit}", f"{limit:.2f} a {unit}", f"{own / limit:.1f}"]
        )
    return table(rows)


def compiler_of(program: Path) -> str:
    """As the compiler left it in the program: "GCC 12.2.0"."""
    notes = subprocess.run(["readelf", "-p", ".comment", str(program)], check=True, capture_output=True, text=True)
    found = re.search(r"(GCC|clang version).*?(\d+\.\d+\.\d+)", notes.stdout)
    return " ".join(found.groups()) if found else "an unknown compiler"


def main() -> None:
    program, page = Path(sys.argv[1]), Path(sys.argv[2])
    counts, printed = count(program)
    page.write_text(
        PAGE.format(
            compiler=compiler_of(program),
            vectors=printed["vectors"],
            stages=stage_table(counts, printed),
            kernels=kernel_table(counts, printed),
        )
    )


if __name__ == "__main__":
    main()
