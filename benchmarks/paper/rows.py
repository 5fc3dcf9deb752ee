"""CSV files of the evaluation: read as typed rows, written whole or not at all."""

from __future__ import annotations

import csv
from pathlib import Path

Row = dict[str, str | float | int]


def typed(text: str) -> str | float | int:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def read_rows(path: Path) -> list[Row]:
    """A dictionary per line; what looks like a number is one, an empty field stays an empty text."""
    with open(path, newline="") as file:
        rows = [{name: typed(text) for name, text in row.items()} for row in csv.DictReader(file)]
    if not rows:
        raise SystemExit(f"{path}: no rows")
    return rows


def write_rows(path: Path, rows: list[Row]) -> None:
    temporary = path.with_suffix(".part")
    with open(temporary, "w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    temporary.replace(path)


def in_order(rows: list[Row], name: str) -> list:
    """The different values of a column in the order in which they appear."""
    return list(dict.fromkeys(row[name] for row in rows))
