"""What goes wrong: ValueError for a caller's mistake, OSError for a file, and the three below."""

from __future__ import annotations

from igsp._core import Cancelled, Result

__all__ = ["Cancelled", "EngineLost", "NotRegistered"]


class EngineLost(RuntimeError):
    """The workers that `network` ran on are gone for good: the connection to their scheduler is lost."""


class NotRegistered(RuntimeError):
    """`Result.raise_if_not_registered` was called on a pair that could not be registered."""

    result: Result

    def __init__(self, result: Result) -> None:
        super().__init__(result.reason)
        self.result = result

    def __reduce__(self) -> tuple[type[NotRegistered], tuple[Result]]:
        return type(self), (self.result,)  # so that it passes from one process to another
