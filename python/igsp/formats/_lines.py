"""Numbers in text files, read in blocks of lines, with the line of every fault."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import NoReturn, TextIO

import numpy as np

from ._cloud import FormatError, PathLike, Points

LONGEST_LINE = 65536  # characters; bounds the memory that a file without line ends can take
BYTE_ORDER_MARK = "\xef\xbb\xbf"  # of UTF-8, as it looks in Latin-1


@dataclass(frozen=True)
class Block:
    """Consecutive lines with their ends, blank ones too; `first` is the number of the first, from 1."""

    first: int
    lines: list[str]
    filled: int  # lines that are not blank

    def columns(self) -> int:
        """How many values the first line has that is not blank."""
        return len(next(self.numbered())[1].split())

    def numbered(self) -> Iterator[tuple[int, str]]:
        """The lines that are not blank, with their numbers."""
        return ((n, line) for n, line in enumerate(self.lines, self.first) if not line.isspace())


def as_count(text: str) -> int | None:
    """A number of points below 10^18; None if it is anything else."""
    digits = text.strip()
    return int(digits) if digits.isascii() and digits.isdigit() and len(digits) <= 18 else None


class LineReader:
    """Every byte of the file comes back as one character (Latin-1), line ends unchanged, so it can be copied."""

    def __init__(self, path: PathLike) -> None:
        self.path = path
        self.lines_read = 0
        self._file: TextIO = open(path, encoding="latin-1", newline="")
        self._lines = iter(partial(self._file.readline, LONGEST_LINE), "")
        self.mark = self._file.read(3)
        if self.mark != BYTE_ORDER_MARK:
            self._file.seek(0)
            self.mark = ""

    def __enter__(self) -> LineReader:
        return self

    def __exit__(self, *exception: object) -> None:
        self._file.close()

    def take(self, count: int) -> Block:
        """The next `count` lines that are not blank, with the blank ones among them; fewer at the end of the file."""
        lines: list[str] = []
        filled = 0
        while filled < count and (more := list(islice(self._lines, count - filled))):
            lines += more
            filled += len(more) - sum(map(str.isspace, more))
        block = Block(self.lines_read + 1, lines, filled)
        self.lines_read += len(lines)
        return block

    def fail(self, fault: str, line: int | None = None) -> NoReturn:
        raise FormatError(self.path, f"line {self.lines_read if line is None else line}: {fault}")

    def coordinates(self, block: Block) -> Points:
        """The first three numbers of every line that is not blank, (N, 3). Fails at the first line without them."""
        if not block.filled:
            return np.empty((0, 3))
        try:
            rows: Points = np.loadtxt(block.lines, dtype=np.float64, comments=None, usecols=(0, 1, 2), ndmin=2)
        except ValueError:
            self._fail_at_first_bad(block)
        return rows

    def require_columns(self, block: Block, columns: int) -> None:
        """The last line is where a file cut short shows: it must have as many values as the first had."""
        last = len(block.lines) - 1
        while block.lines[last].isspace():
            last -= 1
        if (found := len(block.lines[last].split())) != columns:
            fault = f"{found} values where {columns} are expected: the file may have been cut short"
            self.fail(fault, block.first + last)

    def _fail_at_first_bad(self, block: Block) -> NoReturn:
        for number, line in block.numbered():
            values = line.split()[:3]
            if len(values) < 3:
                self.fail(f"{len(values)} values where x, y and z are expected", number)
            for value in values:
                try:
                    float(value)
                except ValueError:
                    self.fail(f"not a number: {value[:40]!a}", number)
        self.fail("a number that cannot be read in this line or shortly before")
