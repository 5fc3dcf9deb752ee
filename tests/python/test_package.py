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
    package = Path(igsp.__file__).parent
    for name in ["libtbb", "libfmt", "liblzf"]:
        (path,) = [path for path in mapped if re.match(rf"{name}[.-]", Path(path).name)]
        assert Path(path).parent in (package / "lib", package.with_name("igsp.libs"))  # built here; repaired by auditwheel
