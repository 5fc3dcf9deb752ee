"""The notebook does what it says: its cells run one after the other, as Jupyter runs them."""

from __future__ import annotations

import ast
import json
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

NOTEBOOK = Path(__file__).parents[2] / "examples/python/igsp_in_ten_cells.ipynb"


def run_cell(source: str, names: dict[str, Any]) -> object:
    """What stands in its last line, as Jupyter shows it."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, NOTEBOOK.name, "exec"), names)
    return eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names) if last else None


def test_every_cell_runs(capsys: pytest.CaptureFixture[str]) -> None:
    notebook = json.loads(NOTEBOOK.read_text())
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    names: dict[str, Any] = {}
    pictures = 0
    for cell in cells:
        shown = run_cell("".join(cell["source"]), names)
        if hasattr(shown, "_repr_svg_"):
            drawn = ElementTree.fromstring(shown._repr_svg_())
            assert all(len(path.attrib["d"]) > 1000 for path in drawn)
            pictures += 1
    assert pictures == 3
    printed = capsys.readouterr().out
    assert printed.startswith("registered (confidence") and "not registered" in printed
    assert names["result"].registered and not names["refused"].registered


def test_it_carries_no_output() -> None:
    """Pictures and numbers of another machine would be in every difference."""
    for cell in json.loads(NOTEBOOK.read_text())["cells"]:
        assert not cell.get("outputs") and not cell.get("execution_count")
