"""Files that are there completely or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from ._cloud import FormatError, PathLike


@contextmanager
def atomic_output(path: PathLike) -> Iterator[BinaryIO]:
    """A binary file beside `path` that gets its name once the block has ended well, and is removed otherwise."""
    target = Path(path)
    if target.exists():
        if not target.is_file():  # renaming over a folder, a device or a pipe would replace it
            raise FormatError(path, "cannot write: not a regular file")
        target = target.resolve()
    temporary, file = _create_beside(target)
    try:
        with file:
            yield file
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _create_beside(target: Path) -> tuple[Path, BinaryIO]:
    attempts = 1000  # the others may be in use, or left by a process that was killed
    for attempt in range(attempts):
        candidate = target.with_name(f".{target.name}.{attempt}.tmp")
        try:
            return candidate, open(candidate, "x+b")
        except FileExistsError:
            continue
    raise FormatError(target, "cannot create a temporary file beside it")
