"""The page that figures are drawn for: its width, its fonts, and how panels are arranged on it."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from birdmb.errors import ArgumentError
from birdmb.figures.showing import shown_figure

_INCHES = {"mm": 1 / 25.4, "cm": 1 / 2.54, "in": 1.0, "pt": 1 / 72}
_NARROWEST, _WIDEST = 1.9, 40.0  # in
_PANEL = 1.75  # in, the least width of one
_LOWEST, _TALLEST = 0.95, 9.6  # in: the height of a panel at least, that of a page
_LETTER = 0.5  # width of a letter on average, of its height

# Journals ask for at least 6 pt at print size, and for fonts that can be edited.
_STYLE: Any = {
    "font.size": 8.0,
    "axes.titlesize": "medium",
    "figure.titlesize": "medium",
    "xtick.labelsize": "small",
    "ytick.labelsize": "small",
    "legend.fontsize": "small",
    "legend.title_fontsize": "small",
    "legend.handlelength": 2.6,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "lines.markersize": 4.0,
    "pdf.fonttype": 42,
}
# Dashes must be seen whole in a legend.
_FULL_SIZE: Any = {"legend.handlelength": 2.6}
_width: ContextVar[float | None] = ContextVar("width", default=None)


@contextmanager
def paper(width: str | None = None) -> Iterator[None]:
    """Style of the figures drawn within: as wide as the page or the column of a paper.

    Text is 6 pt or larger at this width; panels that do not fit beside one another stand below one
    another. A figure keeps its style after the context.

    Example::

        with birdmb.figures.paper(width="90mm"):
            cycle.plot().savefig("cycle.pdf")

    Args:
        width: a number and mm, cm, in or pt; `None` for the screen.

    Raises:
        ArgumentError: not such a width, or narrower than 49 mm or wider than 1 m.
    """
    if width is None:
        yield
        return
    token = _width.set(inches(width))
    try:
        with mpl.rc_context(_STYLE):
            yield
    finally:
        _width.reset(token)


def inches(width: str) -> float:
    """A width such as "90mm" in inches; raises `ArgumentError` for what is none."""
    found = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(mm|cm|in|pt)\s*", width)
    if found is None:
        raise ArgumentError(f"width: {width!r} is no width; it must be as 90mm, 9cm or 3.5in.")
    value = float(found[1]) * _INCHES[found[2]]
    if not _NARROWEST <= value <= _WIDEST:
        raise ArgumentError(
            f"width: {width} is not 49mm to 1000mm: no page has such columns; 90mm is usual."
        )
    return value


def is_narrow() -> bool:
    """Whether figures are drawn for a column, too narrow for two panels with long labels."""
    width = _width.get()
    return width is not None and width < 2.5 * _PANEL


def new_figure(width: float, height: float, rows: int = 1, columns: int = 1) -> Figure:
    """An empty figure for so many panels: of this size (in) on a screen, else of the paper's."""
    to = _width.get()
    if to is None:
        return shown_figure(_FULL_SIZE, figsize=(width, height), layout="constrained")
    beside = _beside(columns, to)
    below = rows * columns // beside
    full = height / rows
    panel = max(full * min(1.0, (to / beside) / (width / columns)), min(full, _LOWEST))
    tall = min(below * panel, max(_TALLEST, below * _LOWEST))
    return shown_figure(_STYLE, figsize=(to, tall), layout="constrained")


def _beside(columns: int, width: float) -> int:
    """How many of the columns stand beside one another, so that all rows are full."""
    most = max(1, int(width / _PANEL)) if width >= 2.5 * _PANEL else 1
    return max(n for n in range(1, columns + 1) if columns % n == 0 and n <= most)


def panels(
    figure: Figure | SubFigure,
    rows: int,
    columns: int,
    *,
    width_ratios: Sequence[float] | None = None,
    height_ratios: Sequence[float] | None = None,
    sharex: bool = False,
    sharey: bool | str = False,
) -> np.ndarray:
    """Axes (rows, columns), row by row below one another where the paper is too narrow.

    `sharey` may be "row".
    """
    beside = columns if _width.get() is None else _beside(columns, _inches_wide(figure))
    if beside == columns:
        return figure.subplots(
            rows, columns, squeeze=False, width_ratios=width_ratios, height_ratios=height_ratios,
            sharex=sharex, sharey=sharey,  # type: ignore[arg-type]
        )  # fmt: skip
    ratios = None if height_ratios is None else np.repeat(height_ratios, columns // beside).tolist()
    stacked: np.ndarray = figure.subplots(
        rows * columns // beside, beside, squeeze=False, height_ratios=ratios, sharex=sharex,
        sharey=sharey is True,
    ).reshape(rows, columns)  # fmt: skip
    if sharey == "row":
        for first, *others in stacked:
            for axes in others:
                axes.sharey(first)
    return stacked


def parts(
    figure: Figure | SubFigure, ratios: Sequence[float], stacked_ratios: Sequence[float]
) -> list[SubFigure]:
    """Parts of a figure beside one another, or below one another on narrow paper.

    Args:
        figure: to divide.
        ratios: of the widths.
        stacked_ratios: of the heights, where they stand below one another.
    """
    many: Any
    if is_narrow():
        many = figure.subfigures(len(ratios), 1, height_ratios=stacked_ratios)
    else:
        many = figure.subfigures(1, len(ratios), width_ratios=ratios)
    return list(many)


def label_x(axes: np.ndarray, label: str) -> None:
    """Label the x axes of the lowest panels."""
    for each in axes.ravel():
        if each.get_subplotspec().is_last_row():
            each.set_xlabel(label)


def label_y(axes: np.ndarray, label: str) -> None:
    """Label the y axes of the first of the panels that share it, or of all that stand alone."""
    for each in axes.ravel():
        if each.get_subplotspec().is_first_col():
            each.set_ylabel(label if "$" in label else wrapped(label, 0.3))


def title(where: Figure | SubFigure | Axes, text: str, **options: Any) -> None:
    """Write a title, on as many lines as the paper's width asks for."""
    text, options = wrapped(text), {"fontsize": "medium"} | options
    if isinstance(where, Axes):
        where.set_title(text, **options)
    else:
        where.suptitle(text, **options)


def wrapped(text: str, part: float = 1.0) -> str:
    """A text, broken into lines that fill at most this part of the paper's width."""
    width = _width.get()
    if width is None:
        return text
    letters = int(part * width * 72 / (_LETTER * mpl.rcParams["font.size"]))
    lines = [textwrap.wrap(line, letters, break_long_words=False) for line in text.split("\n")]
    return "\n".join("\n".join(line) for line in lines)


def legend_below(
    figure: Figure | SubFigure,
    handles: Sequence[Artist] | None = None,
    *,
    most: int = 3,
    about: str | None = None,
) -> None:
    """Write one legend for all panels below them, where it covers none of their lines.

    Args:
        figure: with the panels.
        handles: what it explains; all that has a label if `None`, each label once.
        most: columns, if so many fit beside one another.
        about: title of the legend.
    """
    shown = _labelled(figure) if handles is None else handles
    entries: dict[str, Artist] = {}
    for handle in shown:
        entries.setdefault(str(handle.get_label()), handle)
    if not entries:
        return
    for columns in range(min(most, len(entries)), 0, -1):
        legend = figure.legend(
            [*entries.values()], [*entries], loc="outside lower center", frameon=False,
            fontsize="small", title=about, title_fontsize="small", ncols=columns,
        )  # fmt: skip
        size = legend.get_window_extent()
        if columns == 1 or size.width <= figure.bbox.width:
            break
        legend.remove()
    if isinstance(figure, Figure):  # the panels keep their height, as far as the page is tall
        tall, more = figure.get_figheight(), float(size.height) / figure.dpi
        figure.set_figheight(max(tall, min(tall + more, _TALLEST)))


def axes_in_space(figure: Figure) -> Any:
    """Axes of three dimensions, whose labels have room beside them."""
    axes: Any = figure.add_subplot(projection="3d")
    # The layout does not count these labels.
    axes.set_box_aspect(None, zoom=0.85)
    return axes


def _labelled(figure: Figure | SubFigure) -> list[Artist]:
    return [handle for axes in figure.axes for handle in axes.get_legend_handles_labels()[0]]


def _inches_wide(figure: Figure | SubFigure) -> float:
    return float(figure.bbox.width / figure.dpi)
