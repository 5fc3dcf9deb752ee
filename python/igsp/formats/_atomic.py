"""Files that are there completely or not at all, as src/io/atomic_file.hpp has it."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

from ._cloud import FormatError, PathLike


@contextmanager
def atomic_output(path: PathLike) -> Iterator[BinaryIO]:
    """A binary file beside `path` that gets its name once the block has ended well and its content is on the disk, and
    is removed otherwise. A file that it replaces passes on its permissions and, where that is allowed, its owner."""
    target = Path(os.path.realpath(path))
    replaced = os.stat(target) if target.exists() else None
    if replaced is not None:
        if not target.is_file():  # renaming over a folder, a device or a pipe would replace it
            raise FormatError(path, "cannot write: not a regular file")
        if not os.access(target, os.W_OK):  # whom renaming would not stop
            raise FormatError(path, "cannot write: Permission denied")
    temporary, file = _create_beside(target, 0o666 if replaced is None else 0o600)
    try:
        with file:
            if replaced is not None:
                _keep_permissions(file.fileno(), replaced)
            yield file
            file.flush()
            os.fsync(file.fileno())  # a name without content would be an empty file after a power cut
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    _sync_folder(target.parent)


def _create_beside(target: Path, mode: int) -> tuple[Path, BinaryIO]:
    attempts = 1000  # the others may be in use, or left by a process that was killed
    for attempt in range(attempts):
        # Short, so that every name that the file may have leaves room for it.
        candidate = target.with_name(f".igsp.{os.getpid()}.{attempt}.tmp")
        try:
            return candidate, open(candidate, "x+b", opener=lambda name, flags: os.open(name, flags, mode))
        except FileExistsError:
            continue
    raise FormatError(target, "cannot create a temporary file beside it")


def _keep_permissions(descriptor: int, replaced: os.stat_result) -> None:
    mode = stat.S_IMODE(replaced.st_mode)
    try:
        os.fchown(descriptor, replaced.st_uid, replaced.st_gid)
    except OSError:  # the group may be kept alone; what was meant for a group is not for another
        mode &= 0o777
        try:
            os.fchown(descriptor, -1, replaced.st_gid)
        except OSError:
            mode &= ~stat.S_IRWXG
    with suppress(OSError):  # where the file system has no permissions
        os.fchmod(descriptor, mode)


def _sync_folder(folder: Path) -> None:
    with suppress(OSError):  # not every file system can; the file is there in any case
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
