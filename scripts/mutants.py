"""Breaks the method's formulas one at a time and says which test notices.

Works on a copy of the sources in the folder of --build; a mutant that no test notices is a survivor, and one whose text is not in
the source any more is stale: both end with exit code 1. The list is scripts/mutant_list.py. The tests that lie beside the
broken source are asked first, then the other unit tests, then the end-to-end tests. What each mutant was noticed by is kept
in docs/data/mutants.csv; --unrecorded leaves out what stands there.

usage: mutants.py [--build build/mutants] [--only REGEX] [--jobs N] [--every N] [--quick] [--tests FILTER] [--unrecorded] [--list]
"""
import argparse
import csv
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from mutant_list import MUTANTS

ROOT = Path(__file__).resolve().parent.parent
RECORD = ROOT / "docs/data/mutants.csv"
# The quick one first, and how much processor time it may take, which a busy machine does not stretch: a loop that a
# mistake makes endless is noticed, too. The tests beside a source take ten seconds at most.
PROGRAMS = {"igsp_tests": 300, "igsp_end_to_end_tests": 1800}
SECONDS_BESIDE = 60


def run(*command, **options):
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)


def copy_sources(source):
    shutil.rmtree(source, ignore_errors=True)
    for name in run("git", "-C", ROOT, "ls-files").stdout.splitlines():
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, source / name)


def tests_beside(source):
    """Names of the test suites in the folder of a source."""
    texts = [path.read_text() for path in sorted(source.parent.glob("*_test.cpp"))]
    return sorted({name for text in texts for name in re.findall(r"^(?:TEST\w*|RC_GTEST_PROP)\((\w+),", text, re.MULTILINE)})


def filter_of(suites):
    return ":".join(f"{suite}.*:*/{suite}.*" for suite in suites)


def recorded():
    """(file, mistake) to the test that noticed it."""
    if not RECORD.exists():
        return {}
    with RECORD.open(newline="") as file:
        return {(row["source"], row["mistake"]): row["noticed by"] for row in csv.DictReader(file)}


def record(noticed):
    """In the order of the list; what the list does not hold any more is dropped."""
    with RECORD.open("w", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["source", "mistake", "noticed by"])
        rows.writerows([m[0], m[3], noticed[m[0], m[3]]] for m in MUTANTS if (m[0], m[3]) in noticed)


class Workshop:
    def __init__(self, build, jobs, programs, tests):
        self.tests = tests
        # Laid out as the project itself, so that the compiler cache knows most of the objects.
        self.source, self.build, self.jobs, self.programs = build, build / "build/release", jobs, programs
        copy_sources(self.source)
        # Every source by itself: a mutant then compiles only its own.
        configured = run("cmake", "--preset", "release", "-DIGSP_BUILD_APPS=OFF", "-DIGSP_TEST_PYTHON=OFF",
                         "-DCMAKE_UNITY_BUILD=OFF", cwd=build)
        if configured.returncode:
            sys.exit(configured.stdout + configured.stderr)

    def make(self, program):
        return run("cmake", "--build", self.build, "-j", self.jobs, "--target", program)

    def noticed_by(self, program, tests="*", limit=None):
        """The first test that fails, or nothing."""
        limit = limit or PROGRAMS[program]
        done = run(self.build / "bin" / program, "--gtest_fail_fast", "--gtest_brief=1", f"--gtest_filter={tests}",
                   preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5)))
        if done.returncode == 0:
            return None
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return f"{program} does not end"
        failed = re.search(r"\[  FAILED  \] (?:\w+/)?(\w+\.\w+)", done.stdout)
        return failed.group(1) if failed else f"{program} ends with {done.returncode}"

    def judge(self, mutant):
        name, original, mutated, _ = mutant
        path = self.source / "src" / name
        text = path.read_text()
        if text.count(original) != 1:
            return f"STALE: stands there {text.count(original)} times"
        path.write_text(text.replace(original, mutated))
        try:
            near = filter_of(tests_beside(path))
            for program in self.programs:
                if self.make(program).returncode:
                    return "does not build"
                rounds = [(self.tests, None)]
                if self.tests == "*" and program == "igsp_tests" and near:
                    rounds = [(near, SECONDS_BESIDE), (f"-{near}", None)]
                for tests, limit in rounds:
                    if test := self.noticed_by(program, tests, limit):
                        return test
            return "SURVIVES"
        finally:
            path.write_text(text)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--build", type=Path, default=ROOT / "build/mutants")
    parser.add_argument("--only", default="", help="of files and what is broken")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--quick", action="store_true", help="unit tests only: a survivor may be noticed by the others")
    parser.add_argument("--tests", default="*", metavar="FILTER",
                        help="those alone that are asked (--gtest_filter): a survivor may be noticed by the others")
    parser.add_argument("--unrecorded", action="store_true", help="those alone that the record does not hold")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    chosen = [m for m in MUTANTS if re.search(arguments.only, f"{m[0]}: {m[3]}")][:: arguments.every]
    if arguments.unrecorded:
        chosen = [m for m in chosen if (m[0], m[3]) not in recorded()]
    if arguments.list:
        noticed = recorded()
        for name, original, _, what in chosen:
            count = (ROOT / "src" / name).read_text().count(original)
            known = noticed.get((name, what), "not run yet") if count == 1 else f"STALE: stands there {count} times"
            print(f"{name:<40} {what:<50} {known}")
        print(f"{len(chosen)} mutants")
        return any((ROOT / "src" / m[0]).read_text().count(m[1]) != 1 for m in chosen)
    programs = list(PROGRAMS)[:1] if arguments.quick else list(PROGRAMS)
    workshop = Workshop(arguments.build, arguments.jobs, programs, arguments.tests)
    for program in workshop.programs:
        built = workshop.make(program)
        if built.returncode:
            sys.exit(built.stdout)
        if test := workshop.noticed_by(program, arguments.tests):
            sys.exit(f"the unbroken sources do not pass {test}")
    bad = 0
    for mutant in chosen:
        start = time.monotonic()
        verdict = workshop.judge(mutant)
        is_bad = verdict.startswith(("STALE", "SURVIVES", "does not build"))
        bad += is_bad
        record({**{key: test for key, test in recorded().items() if key != (mutant[0], mutant[3])},
                **({} if is_bad else {(mutant[0], mutant[3]): verdict})})
        print(f"{mutant[0]:<40} {mutant[3]:<45} {verdict}  ({time.monotonic() - start:.0f} s)", flush=True)
    print(f"{len(chosen) - bad} of {len(chosen)} noticed")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
