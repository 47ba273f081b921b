"""Figures of examples that pyplot does not know of: those that a cell's last line gives."""

from __future__ import annotations

from typing import Any
from weakref import WeakSet

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

_SHOWN: WeakSet[Figure] = WeakSet()  # a cell without a last value still has that of the one before


def unmanaged_figures(
    block: tuple[str, str, int],  # noqa: ARG001 - the gallery calls it so
    block_vars: dict[str, Any],
    gallery_conf: dict[str, Any],
) -> str:
    """Save the figure that a cell ends with, and show it."""
    figure = block_vars["example_globals"].get("___")
    if not isinstance(figure, Figure) or figure.canvas.manager is not None:
        return ""
    if figure in _SHOWN:
        return ""
    _SHOWN.add(figure)
    path = next(block_vars["image_path_iterator"])
    figure.savefig(path, dpi=150)
    return figure_rst([path], gallery_conf["src_dir"])
