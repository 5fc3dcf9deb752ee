"""All that the build compiles is what Clang accepts, too, with its warnings as errors: nothing is generated, so it takes
seconds a file. What the build compiles eight sources at a time is compiled as one, so that no two sources of a target define
the same, whichever eight come together. Reported as skipped where Clang is not installed.

usage: clang_test.py BUILD_FOLDER, with its compile_commands.json
"""
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

COMPILERS = ["clang++-14", "clang++"]
# A loop that Clang does not vectorise though the source asks for it is no mistake; nor is an option that only g++ knows.
FLAGS = ["-fsyntax-only", "-Werror", "-Wno-pass-failed", "-Wno-unknown-warning-option"]


def as_wholes(entries, folder):
    """The entries, but one a target for all its files of several sources; written into `folder`."""
    kept, together = [], defaultdict(list)
    for entry in entries:
        folder_of_file = Path(entry["file"]).parent
        group = together[folder_of_file] if folder_of_file.name == "Unity" else kept
        group.append(entry)
    for number, parts in enumerate(together.values()):
        source = Path(folder) / f"{number}.cxx"
        source.write_text("".join(f'#include "{part["file"]}"\n' for part in parts))
        first = parts[0]
        kept.append({**first, "file": str(source), "command": first["command"].replace(first["file"], str(source))})
    return kept


def syntax_check(compiler, entry):
    """Command line of the same translation unit, for `compiler` and without output."""
    words = iter(shlex.split(entry["command"]))
    next(words)  # the compiler of the build
    kept = []
    for word in words:
        if word == "-o":
            next(words)
        elif word != "-c":
            kept.append(word)
    return [compiler, *FLAGS, *kept]


def main():
    build = Path(sys.argv[1])
    compiler = next(filter(shutil.which, COMPILERS), None)
    if compiler is None:
        print(f"left out: none of {', '.join(COMPILERS)} is installed")
        return 77
    def check(entry):
        return subprocess.run(syntax_check(compiler, entry), cwd=entry["directory"], capture_output=True, text=True, check=False)

    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        entries = as_wholes(json.loads((build / "compile_commands.json").read_text()), folder)
        failed = [run for run in pool.map(check, entries) if run.returncode != 0]
    assert entries
    for run in failed:
        print(run.stderr)
    print(f"{compiler}: {len(entries) - len(failed)} of {len(entries)} files accepted")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
