"""The igsp command: the same as the C++ one."""

from __future__ import annotations

import signal
import sys

from igsp import _core, survey_formats


def main() -> int:
    """Runs the command line of this process; returns the exit code."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # as in any command: `igsp options | head` ends quietly
    return _core.run_command_line(["igsp", *sys.argv[1:]], survey_formats)


if __name__ == "__main__":
    sys.exit(main())
