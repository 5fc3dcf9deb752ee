"""The rows of the benchmark: the columns of `igsp benchmark`'s results.csv, then those that only peers need."""

import csv
import os
from pathlib import Path

SAME_AS_IGSP = ("name group preset scramble truth verdict success confidence e_r_deg e_t centroid_displacement overlap "
                "precision recall iterations source_keypoints target_keypoints voxel_size stage_seconds cpu_seconds "
                "wall_seconds peak_memory_bytes reason error").split()
# preset is the method's name. cpu_seconds and wall_seconds are of the registration from points in memory, those of the
# process are of everything, as is the peak of the memory; memory_before_bytes is that peak when the clouds had been
# read and nothing had been done yet: Python and its libraries make most of it. The seconds of igsp belong to its run on
# the same pair just before, with as many threads.
OF_PEERS = ("version voxels threads seed score process_cpu_seconds process_wall_seconds memory_before_bytes "
            "igsp_cpu_seconds igsp_wall_seconds").split()
COLUMNS = SAME_AS_IGSP + OF_PEERS

Row = dict[str, str]


def text_of(value: object) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.9g}"
    return " ".join(str(value).split())


def key_of(row: Row) -> tuple[str, ...]:
    """What a run answers; several rows, one per answer, may share it."""
    method = row["preset"].split("+")[0]
    return row["name"], method, row["voxels"], row["threads"], row["seed"], row["scramble"]


def read_rows(path: Path) -> list[Row]:
    """All whole rows; the last line of a run that was stopped in the middle is left out."""
    if not path.exists():
        return []
    text = path.read_text()
    lines = text[:text.rfind("\n") + 1].splitlines()
    if not lines or next(csv.reader(lines[:1])) != COLUMNS:
        raise SystemExit(f"{path}: line 1: not the rows of this benchmark, which start with {','.join(COLUMNS[:4])}")
    return list(csv.DictReader(lines))


def write_rows(path: Path, rows: list[Row]) -> None:
    """The whole file at once, or not at all."""
    temporary = path.with_suffix(".part")
    with open(temporary, "w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    os.replace(temporary, path)


def append_rows(path: Path, rows: list[Row]) -> None:
    with open(path, "a", newline="") as file:
        csv.DictWriter(file, COLUMNS, lineterminator="\n").writerows(rows)
