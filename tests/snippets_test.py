"""What the README and the documentation show works as printed. A page's blocks run in their order, in a folder of the
page's own, where the simulated scans source.ply and target.ply stand for those of the reader:
- console: lines "$ igsp ..." must end with exit code 0, or N where the line says "# exit code N". Output that is shown
  below a line must be what comes out, "..." standing for anything and numbers being near. Of "$ make NAME" the target
  must exist. Other lines are not run.
- cpp: compiled against the installed package and run. A block without main() gets one, with two clouds `source` and
  `target`.
- csv: written to the file that the text before it names last, in backticks, as in `cases.csv`. If `igsp benchmark` ran,
  its answers must all have been right.
- python: run by the interpreter that --python names. Without --python these blocks are left to the run that has it.
A block whose title ends in "(not run)" shows another program's interface; Python is checked for its syntax, C++ is not.
"""
import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FENCE = re.compile(r'^```(\w+)(?: title="([^"]*)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
NUMBER = r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
RUN = ("console", "cpp", "csv", "python")

CMAKE = """cmake_minimum_required(VERSION 3.25)
project(snippets LANGUAGES CXX)
find_package(igsp REQUIRED)
foreach(name {names})
  add_executable(${{name}} ${{name}}.cpp)
  target_link_libraries(${{name}} PRIVATE igsp::igsp)
endforeach()
"""

MAIN = """#include <igsp/igsp.hpp>
#include <iostream>
int main() {{
  const auto scans = igsp::simulate("park", {{.points = 50000}});
  const std::vector<Eigen::Vector3d> &source = scans[1].points, &target = scans[0].points;
  {{
{text}
  }}
}}
"""


@dataclass
class Block:
    page: Path
    language: str
    title: str
    text: str
    line: int  # of the page, where the block begins

    @property
    def is_run(self) -> bool:
        return not self.title.endswith("(not run)")

    @property
    def name(self) -> str:
        return f"{self.page.stem}_{self.line}"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", type=Path, nargs="+")
    for name in ("prefix", "work"):
        parser.add_argument("--" + name, type=Path, required=True)
    for name in ("cmake", "compiler"):
        parser.add_argument("--" + name, required=True)
    parser.add_argument("--flags", default="")
    parser.add_argument("--python", help="run only pages with Python, with this interpreter")
    return parser.parse_args()


def blocks_of(page: Path) -> list[Block]:
    text = page.read_text()
    found = [Block(page, match[1], match[2] or "", match[3], text.count("\n", 0, match.start()) + 1)
             for match in FENCE.finditer(text)]
    if text.count("\n```") + text.startswith("```") != 2 * len(found):
        sys.exit(f"{page}: a code block without a language, or indented")
    return [block for block in found if block.language in RUN]


def fail(block: Block, message: str) -> None:
    sys.exit(f"{block.page}:{block.line}: {message}")


def run(command, **keywords) -> None:
    print("$", " ".join(map(str, command)), flush=True)
    subprocess.run(command, check=True, stdin=subprocess.DEVNULL, **keywords)


def matches(shown: str, printed: str) -> bool:
    """Words as they are, "..." for anything, numbers within a fifth: better constants do not make the page wrong."""
    parts = re.split(rf"(\.\.\.|{NUMBER})", shown)
    pattern = "".join(".*" if part == "..." else f"({NUMBER})" if re.fullmatch(NUMBER, part) else re.escape(part)
                      for part in parts)
    match = re.fullmatch(pattern, printed, re.DOTALL)
    numbers = [float(number) for number in re.findall(rf"\.\.\.|({NUMBER})", shown) if number]
    return match is not None and all(abs(float(found) - number) <= max(0.2 * abs(number), 0.01)
                                     for found, number in zip(match.groups(), numbers, strict=True))


def check_make_target(block: Block, name: str) -> None:
    if not re.search(rf"^[\w -]*\b{re.escape(name)}\b[\w -]*:", (ROOT / "Makefile").read_text(), re.MULTILINE):
        fail(block, f"the Makefile has no target {name}")


def run_console(block: Block, folder: Path, environment: dict[str, str]) -> None:
    """Every command of a console block, its exit code and, if shown, its output."""
    for entry in re.split(r"^\$ ", block.text, flags=re.MULTILINE)[1:]:
        line, _, shown = entry.partition("\n")
        if make := re.match(r"make (\w+)", line):
            check_make_target(block, make[1])
        if not line.startswith("igsp "):
            continue
        command, _, comment = line.partition("  #")
        code = int(match[1]) if (match := re.search(r"exit code (\d+)", comment)) else 0
        print("$", command, flush=True)
        done = subprocess.run(command, shell=True, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != code:
            fail(block, f"{command}: exit code {done.returncode} instead of {code}\n{done.stdout}")
        if shown.strip() and not matches(shown.strip(), done.stdout.strip()):
            fail(block, f"{command} printed\n{done.stdout}\nand the page shows\n{shown}")


def write_list(block: Block, folder: Path) -> None:
    before = "".join(block.page.read_text().splitlines(keepends=True)[:block.line - 1])
    names = re.findall(r"`(\w+\.csv)`", before)
    if not names:
        fail(block, "the text before does not name the file, as in `cases.csv`")
    (folder / names[-1]).write_text(block.text)


def check_benchmark(page: Path, results: Path) -> None:
    """All answers of `igsp benchmark` on the page are right."""
    with open(results, newline="") as file:
        if any(row["success"] != "yes" for row in csv.DictReader(file)):
            sys.exit(f"{page}: a wrong answer in {results}:\n{results.read_text()}")


def build_programs(programs: list[Block], args: argparse.Namespace) -> Path:
    """Compiles the C++ blocks of all pages; returns the folder that holds a program per block."""
    folder = args.work / "programs"
    folder.mkdir()
    for block in programs:
        text = block.text if "int main(" in block.text else MAIN.format(text=block.text)
        (folder / f"{block.name}.cpp").write_text(text)
    (folder / "CMakeLists.txt").write_text(CMAKE.format(names=" ".join(block.name for block in programs)))
    run([args.cmake, "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={args.prefix}",
         "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_CXX_COMPILER={args.compiler}", f"-DCMAKE_CXX_FLAGS={args.flags}"])
    run([args.cmake, "--build", folder / "build", "--parallel", "2"])
    return folder / "build"


def main() -> None:
    args = arguments()
    shutil.rmtree(args.work, ignore_errors=True)
    args.work.mkdir(parents=True)
    pages = {page: blocks_of(page) for page in args.pages}
    if args.python:
        pages = {page: blocks for page, blocks in pages.items() if any(block.language == "python" for block in blocks)}
    todo = [block for blocks in pages.values() for block in blocks if block.is_run]
    wanted = "python" if args.python else "cpp"
    if not [block for block in todo if block.language == wanted]:
        sys.exit(f"no {wanted} block found")
    if not args.python:
        programs = build_programs([block for block in todo if block.language == "cpp"], args)

    environment = dict(os.environ, PATH=f"{args.prefix / 'bin'}:{os.environ['PATH']}")
    run(["igsp", "simulate", "park", "--out", args.work / "scans", "--points", "50000"], env=environment)
    for page, blocks in pages.items():
        folder = args.work / page.stem
        folder.mkdir()
        for name, station in (("source.ply", "station_1.ply"), ("target.ply", "station_0.ply")):
            shutil.copy(args.work / "scans" / station, folder / name)
        for block in blocks:
            if not block.is_run:
                if block.language == "python":
                    compile(block.text, f"{page}:{block.line}", "exec")
            elif block.language == "console":
                run_console(block, folder, environment)
            elif block.language == "csv":
                write_list(block, folder)
            elif block.language == "cpp" and not args.python:
                run([programs / block.name], cwd=folder)
            elif block.language == "python" and args.python:
                run([args.python, "-c", block.text], cwd=folder, env=environment)
        if (folder / "results.csv").exists():
            check_benchmark(page, folder / "results.csv")


if __name__ == "__main__":
    main()
