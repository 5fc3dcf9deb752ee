#!/usr/bin/env python3
"""Writes docs/benchmarks-peers.md from the rows of bench_peers.py."""

import argparse
import os
import re
from pathlib import Path

from launch import Programs, missing_programs
from methods import METHODS
from rows import Row, read_rows, write_rows
from tallies import Tally, groups_of, tallies, title_of

ROOT = Path(__file__).resolve().parents[2]
FINE = ("igsp_refine", "small_gicp_refine")


def table(header: list[str], lines: list[list[str]]) -> str:
    return "\n".join("| " + " | ".join(line) + " |" for line in [header, ["---"] * len(header), *lines]) + "\n"


def shown(value: float | None, digits: int = 3) -> str:
    """Rounded to significant digits, never in powers of ten for what people read as a plain number."""
    if value is None:
        return "-"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text and abs(value) >= 1 else text


def millimetres(value: float | None) -> str:
    return "-" if value is None else shown(1000 * value) + " mm"


def of(part: int | str, whole: int) -> str:
    return f"{part} of {whole}" if whole else "-"


def in_a_pass(tally: Tally, rows: list[Row]) -> str:
    return f"{tally.in_a_pass(rows):.1f}".removesuffix(".0")


def overview(all_tallies: dict[str, Tally], igsp: Tally) -> str:
    lines = []
    for preset, tally in all_tallies.items():
        ours = igsp.only(lambda row: row["name"] in tally.pairs)  # noqa: B023 - used at once
        negative = tally.only(lambda row: row["truth"] == "none")
        lines.append([title_of(preset), f"{len(tally.rows)} on {len(tally.pairs)}",
                      of(in_a_pass(tally, tally.right), tally.known_pairs),
                      f"{len(tally.solved(all))} / {len(tally.solved(any))}",
                      of(in_a_pass(ours, ours.right), ours.known_pairs),
                      f"{len(ours.solved(all) - tally.solved(any))} / {len(tally.solved(any) - ours.solved(all))}",
                      in_a_pass(tally, tally.said),
                      f"{in_a_pass(tally, tally.false_accepts)} ({in_a_pass(negative, negative.false_accepts)} of "
                      f"{len(negative.pairs)})", str(len(tally.failures))])
    return table(["method", "runs on pairs", "right", "always / ever right", "igsp right, same pairs",
                  "only igsp right / only it", "right and said", "false accepts (without overlap)", "no answer"], lines)


def costs(all_tallies: dict[str, Tally]) -> str:
    lines = []
    for preset, tally in all_tallies.items():
        peak, before = tally.median("peak_memory_bytes"), tally.median("memory_before_bytes")
        memory = "-" if peak is None else f"{peak / 2**20:.0f} MiB"
        lines.append([title_of(preset), shown(tally.median("cpu_seconds")) + " s",
                      shown(tally.ratio("cpu_seconds", "igsp_cpu_seconds")),
                      shown(tally.ratio("wall_seconds", "igsp_wall_seconds")),
                      shown(tally.median("process_cpu_seconds")) + " s",
                      memory + (f" ({before / 2**20:.0f} MiB)" if before else "")])
    return table(["method", "CPU", "CPU / igsp's", "wall / igsp's", "CPU of the whole process", "peak memory (before)"],
                 lines)


def by_group(all_tallies: dict[str, Tally], groups: list[str]) -> str:
    lines = []
    for preset, tally in all_tallies.items():
        cells = []
        for group in groups:
            part = tally.only(lambda row: row["group"] == group)  # noqa: B023 - used at once
            cells.append(of(in_a_pass(part, part.right), part.known_pairs))
        lines.append([title_of(preset), *cells])
    return table(["right", *groups], lines)


def errors_by_group(all_tallies: dict[str, Tally], groups: list[str]) -> str:
    lines = []
    for preset, tally in all_tallies.items():
        cells = []
        for group in groups:
            part = tally.only(lambda row: row["group"] == group)  # noqa: B023 - used at once
            e_r, shift = part.median("e_r_deg", True), part.median("centroid_displacement", True)
            cells.append("-" if e_r is None else f"{shown(e_r, 2)} deg, {millimetres(shift)}")
        lines.append([title_of(preset), *cells])
    return table(["medians of the right", *groups], lines)


def hindsight(all_tallies: dict[str, Tally]) -> str:
    lines = []
    for preset, tally in all_tallies.items():
        best = tally.right_without_false_accept()
        if best is not None:
            lines.append([title_of(preset), of(in_a_pass(tally, tally.said), tally.known_pairs),
                          in_a_pass(tally, tally.false_accepts), of(in_a_pass(tally, best), tally.known_pairs)])
    return table(["method", "right and said", "false accepts", "right above the best wrong score"], lines)


def compared(first: dict[str, Tally], second: dict[str, Tally], names: tuple[str, str]) -> str:
    """Two ways to run the same methods, on the pairs that both ways have."""
    lines = []
    for preset in second:
        if preset not in first:
            continue
        both = {(row["name"], row["seed"]) for row in first[preset].rows}
        both &= {(row["name"], row["seed"]) for row in second[preset].rows}
        sides = [side[preset].only(lambda row: (row["name"], row["seed"]) in both)  # noqa: B023 - used at once
                 for side in (first, second)]
        lines.append([title_of(preset), *(of(in_a_pass(t, t.right), t.known_pairs) for t in sides),
                      *(millimetres(t.median("centroid_displacement", True)) for t in sides),
                      *(shown(t.median("cpu_seconds")) + " s" for t in sides),
                      *(shown(t.median("wall_seconds")) + " s" for t in sides),
                      *(shown(t.ratio("wall_seconds", "igsp_wall_seconds")) for t in sides)])
    heads = ["right", "displacement", "CPU", "wall", "wall / igsp's"]
    return table(["method", *(f"{head}: {name}" for head in heads for name in names)], lines)


def unsolved(all_tallies: dict[str, Tally]) -> str:
    """Pairs that igsp gets wrong or refuses, and who else is right about them."""
    lines = []
    for row in sorted(all_tallies["igsp"].known, key=lambda row: row["name"]):
        if row["success"] == "yes" and row["verdict"] == "registered":
            continue
        others = []
        for preset, tally in all_tallies.items():
            runs = [r for r in tally.known if r["name"] == row["name"]]
            count = sum(r["success"] == "yes" for r in runs)
            if count and preset != "igsp":
                others.append(title_of(preset) + (f" ({count} of {len(runs)} runs)" if len(runs) > 1 else ""))
        lines.append([row["name"], "right but refused" if row["success"] == "yes" else "wrong, " +
                      row["verdict"].replace("_", " "), row["reason"], ", ".join(others) or "nobody"])
    return table(["pair", "igsp", "why, in its own words", "right about it"], lines)


def failures(rows: list[Row]) -> str:
    lines = [f"- {row['name']}, {title_of(row['preset'])} ({row['voxels']} voxels, {row['threads']} threads, seed "
             f"{row['seed'] or '-'}): {row['error']}" for row in rows if row["error"]]
    return "\n".join(lines) + "\n" if lines else "Every run ended with an answer.\n"


def machine() -> str:
    model = re.search(r"^model name\s*: (.*)$", Path("/proc/cpuinfo").read_text(), re.MULTILINE)
    memory = re.search(r"^MemTotal:\s*(\d+)", Path("/proc/meminfo").read_text())
    release = re.search(r'^PRETTY_NAME="(.*)"$', Path("/etc/os-release").read_text(), re.MULTILINE)
    return (f"{os.cpu_count()} processors ({model[1] if model else 'unknown'}), {int(memory[1]) / 2**20:.0f} GiB, "
            f"{release[1] if release else 'unknown system'}")


def versions(rows: list[Row]) -> str:
    found: dict[str, set[str]] = {}
    names = {"igsp": "igsp", "open3d": "Open3D", "kiss": "KISS-Matcher", "small": "small_gicp", "pcl": "PCL"}
    for row in rows:
        if row["version"]:
            found.setdefault(names[row["preset"].split("_")[0]], set()).add(row["version"])
    return ", ".join(f"{name} {' and '.join(sorted(of_name))}" for name, of_name in found.items())


def not_run(rows: list[Row], programs: Programs) -> str:
    present = {row["preset"].split("+")[0] for row in rows}
    absent = [method for method in METHODS if method.name not in present]
    reasons = missing_programs({method.program for method in absent}, programs)
    return "".join(f"\n**Not run:** {title_of(method.name)}: {reasons.get(method.program, 'left out')}.\n"
                   for method in absent)


def document(rows: list[Row], absent: str) -> str:
    everything = tallies(rows)
    coarse = {preset: tally for preset, tally in everything.items() if preset not in FINE}
    groups = groups_of(rows)
    own_voxels = tallies(rows, voxels="recommended")
    all_threads = tallies(rows, threads="all")
    known = {row["name"] for row in rows if row["truth"] == "known"}
    negative = {row["name"] for row in rows if row["truth"] == "none"}
    text = (Path(__file__).parent / "document.md").read_text()
    return text.format(
        machine=machine(), versions=versions(rows), absent=absent, pairs=len(known),
        negatives=len(negative), rows=len(rows), scramble=", ".join(sorted({row["scramble"] for row in rows})),
        overview=overview(coarse, everything["igsp"]), costs=costs(coarse), by_group=by_group(coarse, groups),
        errors_by_group=errors_by_group(coarse, groups), hindsight=hindsight(coarse), unsolved=unsolved(everything),
        fine=by_group({p: everything[p] for p in FINE if p in everything}, groups),
        fine_errors=errors_by_group({p: everything[p] for p in FINE if p in everything}, groups),
        fine_costs=costs({p: everything[p] for p in FINE if p in everything}),
        own_voxels=compared(everything, own_voxels, ("igsp's voxels", "the peer's own")),
        all_threads=compared(everything, all_threads, ("one thread", "all")), failures=failures(rows))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=Path, default=ROOT / "docs/data/peers.csv")
    parser.add_argument("--out", type=Path, default=ROOT / "docs/benchmarks-peers.md")
    parser.add_argument("--pcl-peer", type=Path, default=ROOT / "build/release/bin/pcl_peer")
    parser.add_argument("--python", type=Path, default=ROOT / "build/peers-venv/bin/python",
                        help="with the Python peers")
    args = parser.parse_args()
    rows = read_rows(args.rows)
    if not any(row["preset"] == "igsp" for row in rows):
        raise SystemExit(f"{args.rows}: no row of igsp to compare with")
    rows.sort(key=lambda row: [row[key] for key in ("group", "name", "preset", "voxels", "threads", "seed")])
    write_rows(args.rows, rows)  # in an order that does not depend on the run
    programs = Programs(args.pcl_peer.parent / "igsp", args.pcl_peer, args.python)
    args.out.write_text(document(rows, not_run(rows, programs)))


if __name__ == "__main__":
    main()
