"""Counts and medians over the rows: what the tables and the plots show."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import cached_property
from statistics import median

from rows import Row

TITLES = {"igsp": "igsp", "igsp_paper": "igsp, paper's preset", "igsp_refine": "igsp from the guess",
          "open3d_ransac_100k": "Open3D RANSAC 100 k", "open3d_ransac_4m": "Open3D RANSAC 4 M",
          "open3d_fgr": "Open3D FGR", "kiss_matcher": "KISS-Matcher", "small_gicp_refine": "small_gicp from the guess",
          "pcl_geometric_consistency": "PCL geometric consistency", "pcl_kfpcs": "PCL K-4PCS", "pcl_icp": "PCL ICP",
          "pcl_ndt": "PCL NDT", "pcl_prerejective": "PCL prerejective RANSAC"}
NEGATIVE = "none"
# Of PCL's scores those without a unit; -1: smaller is better.
PCL_SCORES = {"pcl_geometric_consistency": 1, "pcl_prerejective": 1, "pcl_kfpcs": -1}


def title_of(preset: str) -> str:
    method, _, label = preset.partition("+")
    return TITLES.get(method, method) + (" + " + label.upper() if label else "")


def number(row: Row, column: str) -> float | None:
    return float(row[column]) if row[column] else None


def median_of(values: Iterable[float | None]) -> float | None:
    known = [value for value in values if value is not None]
    return median(known) if known else None


@dataclass
class Tally:
    """The rows of one method with one choice of voxels and threads."""

    preset: str
    rows: list[Row] = field(default_factory=list)

    @cached_property
    def known(self) -> list[Row]:
        return [row for row in self.rows if row["truth"] == "known"]

    @cached_property
    def right(self) -> list[Row]:
        return [row for row in self.known if row["success"] == "yes"]

    @cached_property
    def said(self) -> list[Row]:
        return [row for row in self.right if row["verdict"] == "registered"]

    @cached_property
    def false_accepts(self) -> list[Row]:
        """Wrong, yet called registered: also where nothing overlaps."""
        return [row for row in self.rows if row["success"] == "no" and row["verdict"] == "registered"]

    @property
    def failures(self) -> list[Row]:
        return [row for row in self.rows if row["error"]]

    @property
    def pairs(self) -> set[str]:
        return {row["name"] for row in self.rows}

    @property
    def known_pairs(self) -> int:
        return len({row["name"] for row in self.known})

    def in_a_pass(self, rows: list[Row]) -> float:
        """How many of these rows a single run on every pair would have, on average."""
        runs = Counter(row["name"] for row in self.rows)
        return sum(1 / runs[row["name"]] for row in rows)

    def solved(self, of: Callable[[Iterable[bool]], bool]) -> set[str]:
        """Pairs that are right in all (of=all) or any (of=any) of their runs."""
        runs: dict[str, list[bool]] = {}
        for row in self.known:
            runs.setdefault(row["name"], []).append(row["success"] == "yes")
        return {name for name, answers in runs.items() if of(answers)}

    def median(self, column: str, right_only: bool = False) -> float | None:
        return median_of(number(row, column) for row in (self.right if right_only else self.rows))

    def ratio(self, column: str, reference: str) -> float | None:
        """Median of this program's seconds in terms of igsp's on the same pair."""
        return median_of(number(row, column) / number(row, reference) for row in self.rows
                         if row[column] and row[reference])

    def only(self, keep: Callable[[Row], bool]) -> "Tally":
        return Tally(self.preset, [row for row in self.rows if keep(row)])

    def right_without_false_accept(self) -> list[Row] | None:
        """Right answers above the highest score of a wrong one: the best that any threshold on the score could do.
        Nothing where the score is a length or belongs to another answer."""
        if self.preset.startswith("pcl_") and self.preset not in PCL_SCORES:
            return None
        sign = PCL_SCORES.get(self.preset, 1)
        scored = [(row, sign * float(row["score"])) for row in self.rows if row["score"]]
        # On a pair that does not overlap every estimate is wrong, whatever was said about it.
        wrong = [score for row, score in scored if row["truth"] == NEGATIVE or row["success"] == "no"]
        best_wrong = max(wrong, default=-float("inf"))
        return [row for row, score in scored
                if row["truth"] == "known" and row["success"] == "yes" and score > best_wrong]


def tallies(rows: list[Row], voxels: str = "igsp", threads: str = "1") -> dict[str, Tally]:
    """By method, in the order of TITLES."""
    found: dict[str, Tally] = {}
    for row in rows:
        if (row["voxels"], row["threads"]) == (voxels, threads):
            found.setdefault(row["preset"], Tally(row["preset"])).rows.append(row)
    order = list(TITLES)
    return dict(sorted(found.items(), key=lambda item: (order.index(item[0].split("+")[0]), item[0])))


def groups_of(rows: list[Row]) -> list[str]:
    """Those with a truth, the largest first."""
    pairs: dict[str, set[str]] = {}
    for row in rows:
        if row["truth"] == "known":
            pairs.setdefault(row["group"], set()).add(row["name"])
    return sorted(pairs, key=lambda group: (-len(pairs[group]), group))
