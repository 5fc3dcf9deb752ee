"""Builds the wheel in an environment that holds the build requirements alone and installs it into another one, as a
user would. Both environments are kept for the next time.

usage: install.py SOURCE_ROOT WORK_FOLDER CXX_COMPILER
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import tomllib


def environment(folder):
    """A virtual environment of the interpreter that runs this script: its path to pip."""
    if not (folder / "bin/pip").exists():
        subprocess.run([sys.executable, "-m", "venv", "--clear", folder], check=True)
    return folder / "bin/pip"


def run(*command, **options):
    print("$", *command, flush=True)
    subprocess.run(list(map(str, command)), check=True, stdin=subprocess.DEVNULL, **options)


def main():
    source, work, compiler = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
    requirements = tomllib.loads((source / "pyproject.toml").read_text())["build-system"]["requires"]
    pip = environment(work / "build-environment")
    run(pip, "install", "--quiet", *requirements)
    wheels = work / "wheel"
    shutil.rmtree(wheels, ignore_errors=True)
    # The compiler of the C++ build: the answers are compared bit by bit.
    run(
        pip,
        "wheel",
        source,
        "--no-build-isolation",
        "--no-deps",
        "--wheel-dir",
        wheels,
        env=dict(os.environ, CXX=compiler),
    )
    (wheel,) = wheels.glob("igsp-*.whl")
    pip = environment(work / "environment")
    run(pip, "install", "--quiet", f"{wheel}[las,e57,mesh,test]")
    try:
        run(pip, "install", "--quiet", f"{wheel}[dask]")
    except subprocess.CalledProcessError:
        print("LEFT OUT: the package distributed cannot be installed, the engine dask will not be tested", flush=True)
    run(pip, "install", "--quiet", "--force-reinstall", "--no-deps", wheel)


if __name__ == "__main__":
    main()
