"""Writes igsp/option_keywords.py: the options of the C++ library's one list as typed keywords.

usage: option_keywords.py FOLDER_OF_THE_EXTENSION OUTPUT
"""

import sys
import textwrap
from pathlib import Path

HEADER = '''"""Generated from the library's list of options: the keywords of `align` and `extract_features`."""
from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    import os


class OptionKeywords(TypedDict, total=False):
    """All options; one that is left out keeps its value of the preset."""
'''


def field(name, type_name, help_text):
    quoted = textwrap.fill(f'"""{help_text}"""', 116, initial_indent="    ", subsequent_indent="    ")
    return f"\n    {name}: {type_name}\n{quoted}\n"


def type_of(option):
    if option["choices"]:
        return "Literal[" + ", ".join(f'"{choice}"' for choice in option["choices"]) + "]"
    return {"boolean": "bool", "integer": "int", "real": "float"}[option["kind"]]


def help_of(option):
    unit = f" [{option['unit']}]" if option["unit"] else ""
    return f"{option['help']}{unit}; {option['admissible']}; default {option['default']}"


def main():
    folder, output = sys.argv[1:]
    sys.path.insert(0, folder)
    import _core

    presets = "Literal[" + ", ".join(f'"{name}"' for name in _core.preset_names()) + "]"
    text = HEADER
    text += field("preset", presets, "where the options start")
    text += field(
        "config", "str | os.PathLike[str]", "where they start instead: a TOML file, see `igsp options`"
    )
    for option in _core.option_list():
        text += field(option["keyword"], type_of(option), help_of(option))
    Path(output).write_text(text)


if __name__ == "__main__":
    main()
