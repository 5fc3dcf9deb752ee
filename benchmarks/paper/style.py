"""One look for all figures: readable in black and white, the same bytes on every run."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "igsp", "svg.fonttype": "none", "font.size": 9, "lines.linewidth": 1.2,
                            "lines.markersize": 4, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False})
import matplotlib.pyplot as plt

# Told apart by marker and dash, not by colour alone.
LINES = {"Stanford": {"color": "black", "marker": "o", "linestyle": "-"},
         "Stanford 80 %": {"color": "black", "marker": "v", "linestyle": "--"},
         "Facade": {"color": "0.45", "marker": "s", "linestyle": "--"},
         "Park": {"color": "tab:green", "marker": "^", "linestyle": "-."},
         "Indoor": {"color": "tab:blue", "marker": "D", "linestyle": ":"}}


def save(figure: plt.Figure, path: Path) -> None:
    """As SVG and PNG."""
    figure.savefig(path.with_suffix(".svg"), metadata={"Date": None}, dpi=90)
    figure.savefig(path.with_suffix(".png"), dpi=110)
    plt.close(figure)
