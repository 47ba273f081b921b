"""What a figure must keep: lines that all can tell apart, units, text that can be read."""

import itertools
import re
from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure, FigureBase
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from birdmb.quantities import BY_NAME

# Machado, Oliveira & Fernandes 2009, deuteranopia (severity 1), on linear RGB.
DEUTERANOPIA = np.array(
    [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ]
)
_TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_WHITE = np.array([0.9505, 1.0, 1.089])

# Numbers, and states of systems that have no units.
DIMENSIONLESS = {
    *(each.axis_label for each in BY_NAME.values() if each.unit == "1"),
    r"$|\Lambda|$", r"$|\Lambda|_\mathrm{max}$", r"Re $\Lambda$", r"Im $\Lambda$",
    "phase of the beat", "iteration", "flight", "way of differentiation",
    "force / weight", "Δ lift / weight",
    "thrust / weight", "lift / weight", "evaluations of the right-hand side in a beat",
    "largest gap of multibody and rigid", "span position (part of the half-span)",
    *("D1", "D2", "R", "A"),
    *("x", "y", "z", "v", "r", "q", "a", "δx", "δy", "δz"),
}  # fmt: skip


def as_seen(colour: object) -> np.ndarray:
    """CIE L*a*b* of a colour as deuteranopes see it."""
    rgb = np.array(to_rgb(colour))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    xyz = _TO_XYZ @ np.clip(DEUTERANOPIA @ linear, 0.0, 1.0) / _WHITE
    f = np.where(xyz > 216 / 24389, np.cbrt(xyz), (24389 / 27 * xyz + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def alike(first: Line2D, second: Line2D) -> bool:
    """Whether two lines that are drawn differently cannot be told apart."""
    if _form(first) != _form(second):
        return False
    apart = np.linalg.norm(as_seen(first.get_color()) - as_seen(second.get_color()))
    return bool(apart <= 15)


def _form(line: Line2D) -> tuple:
    """Dashes in multiples of the width, marker and whether it is filled."""
    offset, dashes = line._unscaled_dash_pattern
    dashed = line.get_linestyle() not in ("None", "")
    marker = line.get_marker() not in ("None", "", None)
    return (
        (offset, dashes and tuple(dashes)) if dashed else None,
        (line.get_marker(), to_rgb(line.get_markerfacecolor()) == (1, 1, 1)) if marker else None,
    )


def _drawn(line: Line2D) -> tuple:
    return (*_form(line), to_rgb(line.get_color()))


def confusable(figure: Figure) -> list[str]:
    """Pairs of lines of one panel that differ in colour too little, or not in what they mean."""
    found = []
    for axes in figure.axes:
        lines = [line for line in axes.get_lines() if len(line.get_xdata())]
        for a, b in itertools.combinations(lines, 2):
            labels = [str(a.get_label()), str(b.get_label())]
            named = not any(label.startswith("_") for label in labels) and labels[0] != labels[1]
            if (_drawn(a) != _drawn(b) or named) and alike(a, b):
                found.append(f"{axes.get_ylabel()!r}: {labels}, {a.get_color()}, {b.get_color()}")
    return sorted(set(found))


def unlabelled(figure: Figure) -> list[str]:
    """Axes with numbers whose label is missing, or has no unit where it must have one."""
    found = []
    for axes in figure.axes:
        if not axes.axison or not axes.get_visible():
            continue
        for name in axes._axis_names:
            axis = getattr(axes, f"{name}axis")
            label = axis.label.get_text().replace("\n", " ")
            ticks = axis.get_ticklabels()
            shown = any(tick.get_visible() and tick.get_text() for tick in ticks)
            with_unit = re.search(r"\([^)]+\)|°", label)
            if shown and not with_unit and label not in DIMENSIONLESS:
                found.append(f"{name} of {axes.get_title() or axes.get_ylabel()!r}: {label!r}")
    return found


def texts(figure: Figure) -> Iterator[Text]:
    """Texts that are seen."""
    for text in figure.findobj(Text):
        axis_off = isinstance(text.axes, Axes) and not text.axes.get_visible()
        if text.get_visible() and text.get_text().strip() and not axis_off:
            yield text


def unreadable(figure: Figure) -> list[str]:
    """Texts smaller than 6 pt, beyond the figure's edge, or over another title, label or legend."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    renderer = canvas.get_renderer()
    width, height = figure.bbox.size
    found = [f"{t.get_fontsize():.1f} pt: {t.get_text()}" for t in texts(figure) if _small(t)]
    boxes = []
    for text in itertools.chain(_fixed(figure), _in_space(figure)):
        box = text.get_window_extent(renderer)
        if box.x0 < -1 or box.y0 < -1 or box.x1 > width + 1 or box.y1 > height + 1:
            found.append(f"beyond the edge: {text.get_text()!r}")
        boxes.append((text.get_text(), box))
    for (one, a), (other, b) in itertools.combinations(boxes, 2):
        if a.padded(-1).overlaps(b.padded(-1)):
            found.append(f"{one!r} over {other!r}")
    return found


def _small(text: Text) -> bool:
    return text.get_fontsize() < 6.0


def _fixed(figure: Figure) -> Iterator[Text]:
    """Titles, labels of axes and texts of figure legends: what no data move."""
    for part in figure.findobj(FigureBase):
        if part._suptitle is not None and part._suptitle.get_text():
            yield part._suptitle
        for legend in part.legends:
            yield from legend.get_texts()
    for axes in figure.axes:
        if axes.axison and axes.get_visible() and "z" not in axes._axis_names:
            candidates = (axes.title, axes.xaxis.label, axes.yaxis.label)
            yield from (each for each in candidates if each.get_text() and each.get_visible())


def _in_space(figure: Figure) -> Iterator[Text]:
    """Labels of axes of three dimensions."""
    for axes in figure.axes:
        if "z" in axes._axis_names:
            labels = (getattr(axes, f"{name}axis").label for name in axes._axis_names)
            yield from (each for each in labels if each.get_text())


def covered(figure: Figure) -> list[str]:
    """Legends that lie over lines or markers."""
    FigureCanvasAgg(figure).draw()
    found = []
    for legend in figure.findobj(Legend):
        box = legend.get_window_extent().padded(-1)
        for axes in figure.axes:
            seen = Bbox.intersection(box, axes.get_window_extent())
            if seen is None or not axes.get_visible():
                continue
            names = [str(line.get_label()) for line in axes.get_lines() if _crosses(line, seen)]
            if names:
                entries = [text.get_text() for text in legend.get_texts()]
                found.append(f"{entries} in {axes.get_ylabel()!r} over {names}")
    return found


def _crosses(line: Line2D, box: Bbox) -> bool:
    if not line.get_visible() or not len(line.get_xdata()):
        return False
    path = line.get_transform().transform_path(line.get_path())
    if line.get_linestyle() not in ("None", "") and path.intersects_bbox(box, filled=False):
        return True
    points = path.vertices[np.isfinite(path.vertices).all(axis=1)]
    return bool(box.count_contains(points))
