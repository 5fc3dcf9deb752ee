"""Installs a wheel where there is no compiler and no library of the build, and runs the package's tests there.

usage: check_wheel.py WHEEL PROGRAMS COMMAND

PROGRAMS is the folder bin of a new virtual environment, the only one on the PATH; COMMAND the igsp of the C++ build.
"""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent / "tests/python"
OF_THE_SOURCES = ["test_style.py", "test_types.py"]  # nothing that a wheel could change


def main():
    wheel, programs, command = Path(sys.argv[1]), Path(sys.argv[2]), Path(sys.argv[3])
    unwanted = ("CC", "CXX", "CPATH", "LIBRARY_PATH", "LD_LIBRARY_PATH", "PYTHONPATH")
    clean = {name: value for name, value in os.environ.items() if name not in unwanted}
    clean.update(PATH=str(programs), IGSP_COMMAND=str(command))

    def run(*arguments):
        print("$", *arguments, flush=True)
        subprocess.run(list(map(str, arguments)), check=True, stdin=subprocess.DEVNULL, env=clean)

    names = zipfile.ZipFile(wheel).namelist()
    for library in ("libtbb", "libfmt", "liblzf"):
        assert any(name.startswith(f"igsp.libs/{library}") for name in names), f"{wheel} has no {library}"
    python = programs / "python"
    run(python, "-m", "pip", "install", "--quiet", "--only-binary", ":all:", f"{wheel}[las,e57,mesh,dask,test]")
    compilers = "import shutil, sys; sys.exit(any(map(shutil.which, ['cc', 'gcc', 'c++', 'g++', 'clang++', 'cmake'])))"
    run(python, "-c", compilers)
    for tool in ("bash", "head"):  # of the tests of pipes
        (programs / tool).unlink(missing_ok=True)
        (programs / tool).symlink_to(shutil.which(tool))
    ignored = [f"--ignore={TESTS / name}" for name in OF_THE_SOURCES]
    run(python, "-m", "pytest", "-q", "-p", "no:cacheprovider", *ignored, TESTS)


if __name__ == "__main__":
    main()
