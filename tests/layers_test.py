"""The layers hold: a source includes only the layers below its own, and the library never prints, exits or rolls dice.
What is compiled for several processors is compiled without fused multiply-add.

usage: layers_test.py SOURCE_ROOT
"""
import re
import sys
from pathlib import Path

CORE = {"core"}
SPATIAL = CORE | {"spatial"}
FEATURES = SPATIAL | {"features"}
REGISTRATION = FEATURES | {"matching", "estimation", "registration"}

# What the sources of a layer may include from src/; public igsp/ headers are open to all.
ALLOWED = {
    "core": CORE,
    "spatial": SPATIAL,
    "features": FEATURES,
    "matching": FEATURES | {"matching"},
    "estimation": FEATURES | {"estimation"},
    "registration": REGISTRATION,
    "diagnosis": REGISTRATION | {"diagnosis"},
    "network": REGISTRATION | {"network"},
    "io": SPATIAL | {"io"},
    "config": SPATIAL | {"io", "config"},
    "archive": SPATIAL | {"io", "config", "archive"},
    "simulation": SPATIAL | {"simulation"},
}
APPS_ALLOWED = REGISTRATION | {"diagnosis", "network", "io", "config", "archive", "simulation"}
# The rooms of the command, in apps/igsp/: a command's room may use these below it and itself; command_line.cpp, all.
SHARED_ROOMS = {"shell": set(), "files": {"shell"}, "report": {"shell", "files"}}
COMMAND_ROOMS = {"align", "benchmark", "completion", "convert", "downsample", "evaluate", "network", "options",
                 "simulate", "transform"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
FORBIDDEN = re.compile(
    r"std::(cout|cerr|clog)\b|\b(printf|fprintf|puts|random_device)\b|(?<![\w.>])s?rand\s*\(|(?<![\w.>])_?exit\s*\(|(?<![\w.>])(abort|terminate)\s*\("
)


def without_comments_and_strings(text):
    """The code alone, with its line breaks."""
    token = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.DOTALL)
    return token.sub(lambda found: "\n" * found.group().count("\n"), text)


def includes(path):
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found.group(1), found.group(2)


def sources(folder):
    return sorted(path for kind in ("*.hpp", "*.cpp") for path in folder.rglob(kind))


def check_layer_includes(root, path, allowed):
    for number, _, name in includes(path):
        if (path.parent / name).exists() and "/" not in name:
            continue  # a neighbour in the same folder
        layer = name.split("/")[0]
        if layer in ALLOWED and layer not in allowed:
            yield f"{path.relative_to(root)}:{number}: includes {name}, and {layer} is not below {path.parent.name}"
        if name.startswith(".."):
            yield f"{path.relative_to(root)}:{number}: relative include {name}; write it from src/ on"


def check_rooms(root, command):
    for room in sorted(path for path in command.iterdir() if path.is_dir()):
        if room.name not in SHARED_ROOMS and room.name not in COMMAND_ROOMS:
            yield f"{room.relative_to(root)}: a room without a place; give it one in {Path(__file__).name}"
            continue
        allowed = SHARED_ROOMS.get(room.name, set(SHARED_ROOMS)) | {room.name}
        for path in sources(room):
            for number, _, name in includes(path):
                other = name.split("/")[0]
                if other in SHARED_ROOMS.keys() | COMMAND_ROOMS and other not in allowed:
                    yield f"{path.relative_to(root)}:{number}: includes {name}, and {other} is not below {room.name}"


def check_public_includes(root, path):
    for number, quote, name in includes(path):
        if quote == '"' and not name.startswith("igsp/"):
            yield f"{path.relative_to(root)}:{number}: a public header includes the private {name}"
        if quote == "<" and "/" in name and not name.startswith("Eigen/"):
            yield f"{path.relative_to(root)}:{number}: a public header asks its users for <{name}>"


def check_quiet(root, path):
    for number, line in enumerate(without_comments_and_strings(path.read_text()).splitlines(), 1):
        found = FORBIDDEN.search(line)
        if found:
            yield f"{path.relative_to(root)}:{number}: the library must not use {found.group().strip(' (')}"


def check_rounding(root):
    build = (root / "CMakeLists.txt").read_text()
    unfused = re.findall(r"set_source_files_properties\(([^)]*?)PROPERTIES COMPILE_OPTIONS -ffp-contract=off\)", build)
    for path in sources(root / "src"):
        name = str(path.relative_to(root))
        if re.search(r"^IGSP_MULTIVERSION ", path.read_text(), re.MULTILINE) and name not in " ".join(unfused).split():
            yield f"{name}: IGSP_MULTIVERSION without -ffp-contract=off; add it to CMakeLists.txt"


def faults(root):
    for folder in sorted(path for path in (root / "src").iterdir() if path.is_dir()):
        if folder.name not in ALLOWED:
            yield f"src/{folder.name}: a folder without a layer; give it its place in {Path(__file__).name}"
            continue
        for path in sources(folder):
            if not path.stem.endswith("_test"):  # tests may look down from anywhere
                yield from check_layer_includes(root, path, ALLOWED[folder.name])
                yield from check_quiet(root, path)
    for path in sources(root / "apps") + sources(root / "python"):
        yield from check_layer_includes(root, path, APPS_ALLOWED)
    yield from check_rooms(root, root / "apps" / "igsp")
    for path in sources(root / "include"):
        yield from check_public_includes(root, path)
        yield from check_quiet(root, path)
    yield from check_rounding(root)


def main():
    root = Path(sys.argv[1])
    if not sources(root / "src") or not sources(root / "include"):
        sys.exit(f"no sources below {root}: nothing was checked")
    found = list(faults(root))
    print("\n".join(found) or "layers hold")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
