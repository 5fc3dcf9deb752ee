"""What the wheel carries."""

import importlib.metadata
import re
from pathlib import Path

import igsp


def test_the_version_has_one_home():
    project = (Path(__file__).parents[2] / "CMakeLists.txt").read_text()
    version = re.search(r"project\(igsp VERSION ([0-9.]+)", project)[1]
    assert igsp.__version__ == importlib.metadata.version("igsp") == version


def test_libraries_come_from_the_wheel():
    """Not from the machine that happens to have them."""
    mapped = {line.split()[-1] for line in Path("/proc/self/maps").read_text().splitlines() if ".so" in line}
    for name in ["libtbb.so", "libfmt.so", "liblzf.so"]:
        (path,) = [path for path in mapped if name in path]
        assert Path(path).parent == Path(igsp.__file__).parent / "lib"
