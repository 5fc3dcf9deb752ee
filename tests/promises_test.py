"""Every test that docs/promises.md, SECURITY.md and docs/data/mutants.csv name exists, and every promise names one; every
dependency that ARCHITECTURE.md names is on the page of licences.

usage: promises_test.py SOURCE_ROOT
"""
import csv
import re
import sys
from pathlib import Path

ROOT = Path(sys.argv[1])
CPP = re.compile(r"^(?:TEST|TEST_F|TEST_P|RC_GTEST_PROP)\((\w+),\s*(\w+)", re.MULTILINE)
NAMED = re.compile(r"`(?:(\w+\.py): (test_\w+)|([A-Z]\w+)\.([A-Z]\w+))`")


def cpp_tests():
    for folder in ("src", "tests", "apps"):
        for path in (ROOT / folder).rglob("*_test.cpp"):
            yield from CPP.findall(path.read_text())


def python_tests():
    for path in (ROOT / "tests").rglob("*.py"):
        for name in re.findall(r"def (test_\w+)", path.read_text()):
            yield path.name, name


def faults_of(page, known):
    text = (ROOT / page).read_text()
    for script, function, suite, name in NAMED.findall(text):
        if (script, function) not in known and (suite, name) not in known:
            yield f"{page}: there is no test {script or suite}: {function or name}"
    for number, line in enumerate(text.splitlines(), 1):
        is_promise = line.startswith("|") and not re.match(r"\|[-|]+\|$|\| (?:what|promise|reader)", line)
        if is_promise and not NAMED.search(line):
            yield f"{page}:{number}: a promise without a test"


def unknown_to_mutants(known):
    with (ROOT / "docs/data/mutants.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            test = row["noticed by"]
            if " " not in test and tuple(test.split(".")) not in known:  # "igsp_tests does not end" names none
                yield f"docs/data/mutants.csv: there is no test {test}"


def without_licence():
    table = (ROOT / "ARCHITECTURE.md").read_text().split("| package | does for us |")[1]
    page = (ROOT / "docs/licences.md").read_text()
    for cell in re.findall(r"^\| ([^|]+) \|", table, re.MULTILINE):
        for name in re.sub(r"\(.*?\)", "", cell).replace(" from PyPI", "").replace("its ", "").split(","):
            bare = re.sub(r" [\d.]+$", "", name.strip())
            if bare not in page:
                yield f"docs/licences.md: {bare}, a dependency in ARCHITECTURE.md, is missing"


def main():
    known = {*cpp_tests(), *python_tests()}
    faults = [fault for page in ("docs/promises.md", "SECURITY.md") for fault in faults_of(page, known)]
    faults += [*unknown_to_mutants(known), *without_licence()]
    print("\n".join(faults) or f"{len(known)} tests are there")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
