"""The igsp command: the same as the C++ one."""

from __future__ import annotations

import signal
import sys

from igsp import _core, survey_formats


def main() -> int:
    """Runs the command line of this process; returns the exit code."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # as in any command: `igsp options | head` ends quietly
    sys.unraisablehook = _all_but_interrupts
    return _core.run_command_line(["igsp", *sys.argv[1:]], survey_formats)


def _all_but_interrupts(unraisable: sys.UnraisableHookArgs) -> None:
    """Ctrl-C within a destructor raises where nobody can catch: the command knows of it by itself and says so."""
    if not issubclass(unraisable.exc_type, KeyboardInterrupt):
        sys.__unraisablehook__(unraisable)


if __name__ == "__main__":
    sys.exit(main())
