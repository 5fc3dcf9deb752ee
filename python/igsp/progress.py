"""Progress of a run on standard error."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from types import TracebackType

ProgressFunction = Callable[[str, float], object]
"""Called with a stage's name and the share of it that is done, [0, 1]. Returning False stops: igsp.Cancelled."""

_WIDTH = 40


class ProgressBar:
    """One line per stage, drawn anew as it fills."""

    def __init__(self) -> None:
        self._stage = ""
        self._percent = -1
        self._start = 0.0

    def __enter__(self) -> ProgressBar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._stage:
            sys.stderr.write("\n")

    def __call__(self, stage: str, fraction: float) -> None:
        if stage != self._stage:
            if self._stage:
                sys.stderr.write("\n")
            self._stage, self._percent, self._start = stage, -1, time.monotonic()
        percent = int(100 * fraction)
        if percent != self._percent:
            self._percent = percent
            bar = "#" * (percent * _WIDTH // 100)
            sys.stderr.write(f"\r{stage:<22} [{bar:<{_WIDTH}}] {percent:3}% {time.monotonic() - self._start:6.1f} s")
            sys.stderr.flush()
