"""What the README shows works as printed: its igsp command lines run, its C++ snippets compile against the installed
package and run, in the order of the page and in one folder. Every one must end with exit code 0. A CSV block is the
file that the text before it names last; `igsp benchmark` must be right about every pair in it.
"""
import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FENCE = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

CMAKE = """cmake_minimum_required(VERSION 3.25)
project(readme LANGUAGES CXX)
find_package(igsp REQUIRED)
foreach(name {names})
  add_executable(${{name}} ${{name}}.cpp)
  target_link_libraries(${{name}} PRIVATE igsp::igsp)
endforeach()
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("readme", "prefix", "work"):
        parser.add_argument("--" + name, type=Path, required=True)
    for name in ("cmake", "compiler"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--flags", default="")
    return parser.parse_args()


def run(command, **keywords):
    print("$", command if isinstance(command, str) else " ".join(map(str, command)), flush=True)
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL, **keywords)


def commands(block):
    """The lines a reader would type that call igsp; installation lines are not ours to run here."""
    lines = [line[2:] for line in block.splitlines() if line.startswith("$ ")]
    return [re.sub(r"\s+#.*", "", line) for line in lines if line.startswith("igsp ")]


def write_lists(text, folder):
    """Writes the CSV blocks under the names that the page gives them. Rows of all."""
    rows = 0
    for match in FENCE.finditer(text):
        if match[1] == "csv":
            name = re.findall(r"`(\w+\.csv)`", text[:match.start()])[-1]
            (folder / name).write_text(match[2])
            rows += len(match[2].splitlines()) - 1
    return rows


def check_results(path, expected):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if len(rows) != expected or any(row["success"] != "yes" for row in rows):
        sys.exit(f"{path}: {expected} right answers expected:\n{path.read_text()}")


def main():
    args = arguments()
    shutil.rmtree(args.work, ignore_errors=True)
    args.work.mkdir(parents=True)
    text = args.readme.read_text()
    blocks = FENCE.findall(text)
    pairs = write_lists(text, args.work)
    programs = [text for language, text in blocks if language == "cpp"]
    lines = [line for language, text in blocks if language == "console" for line in commands(text)]
    if not programs or not lines:
        sys.exit(f"{args.readme}: no C++ snippet or no igsp command line found")

    names = [f"snippet_{number}" for number in range(1, len(programs) + 1)]
    for name, text in zip(names, programs):
        (args.work / f"{name}.cpp").write_text(text)
    (args.work / "CMakeLists.txt").write_text(CMAKE.format(names=" ".join(names)))
    build = args.work / "build"
    run([args.cmake, "-S", args.work, "-B", build, f"-DCMAKE_PREFIX_PATH={args.prefix}", "-DCMAKE_BUILD_TYPE=Release",
         f"-DCMAKE_CXX_COMPILER={args.compiler}", f"-DCMAKE_CXX_FLAGS={args.flags}"])
    run([args.cmake, "--build", build, "--parallel", "2"])

    environment = dict(os.environ, PATH=f"{args.prefix / 'bin'}:{os.environ['PATH']}")
    for line in lines:
        run(line, shell=True, cwd=args.work, env=environment)
    check_results(args.work / "results.csv", pairs)
    for name in names:
        run([build / name], cwd=args.work)


if __name__ == "__main__":
    main()
