"""What figures share: colours, dashes and markers, and the axis of the beat."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.colors import to_hex

from birdmb._typing import FloatArray
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

# Colours that the colour-blind tell apart (Okabe & Ito 2008), of different greys where lines meet.
BLACK, BLUE, VERMILION, GREEN = "k", "#0072B2", "#D55E00", "#009E73"
PURPLE, ORANGE, SKY = "#CC79A7", "#E69F00", "#56B4E9"
# Lines of one panel that are alike in kind: told apart without their colours, too.
_DASHES: tuple[Any, ...] = (
    *("-", (0, (5, 2)), (0, (1, 1.2)), (0, (7, 1.5, 1, 1.5))),
    *((0, (7, 1.5, 1, 1.5, 1, 1.5)), (0, (10, 3)), (0, (3, 1, 3, 3))),
)
SERIES = cycler(color=(BLUE, VERMILION, GREEN, BLACK, PURPLE, ORANGE, SKY), linestyle=_DASHES)
_MARKERS = ("o", "^", "s", "D", "v", "P", "X")

LINE: Any = BLUE
DRIVER = "0.35"
MEAN = VERMILION
STABLE_COLOUR, UNSTABLE_COLOUR = BLUE, VERMILION
# As in bifurcation diagrams: what is stable is drawn through, what is not is dashed.
VERDICT_LINES: Mapping[str, dict[str, Any]] = {
    "stable": {"color": STABLE_COLOUR, "ls": "-"},
    "unstable": {"color": UNSTABLE_COLOUR, "ls": (0, (4, 1.5))},
    "undecided": {"color": "0.45", "ls": (0, (1, 1.2))},
}
VERDICT_MARKERS: Mapping[str, dict[str, Any]] = {
    "stable": {"color": STABLE_COLOUR, "marker": "o", "ls": ""},
    "unstable": {"color": UNSTABLE_COLOUR, "marker": "^", "ls": ""},
    "undecided": {"color": "0.45", "marker": "s", "ls": ""},
}
BIFURCATION_MARKERS = {
    "fold": "o",
    "period doubling": "s",
    "Neimark-Sacker": "D",
    "branch point": "x",
    "multiple": "*",
}
# A level to compare with: zero, the unit circle, a limit.
LEVEL: Mapping[str, Any] = {"color": "0.7", "lw": 0.8, "zorder": 0}
_SHADE = "0.92"
# Of the typical size of what is drawn; an axis over less shows the round-off of what is steady.
_LEAST_RANGE = 1e-3
_STILL = 1e-6  # rad in a beat


def title_of(cycle: FlightCycle) -> str:
    """Name of the bird as it is written in a figure."""
    return in_figure(cycle.model.bird.name)


def families(count: int, *, markers: bool = False) -> list[dict[str, Any]]:
    """Styles of lines over the values of a parameter, dark to bright, no two of one dash."""
    shades = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.8, max(count, 1)))
    styles: list[dict[str, Any]] = [{"color": to_hex(shade)} for shade in shades]
    for i, style in enumerate(styles):
        style["marker" if markers else "ls"] = (_MARKERS if markers else _DASHES)[i % len(_DASHES)]
    return styles


def stroke_speed(cycle: FlightCycle) -> FloatArray:
    """Speed (K,) m/s at which the wings go down relative to the body, averaged over their area."""
    beat = cycle.beat
    loads = beat.loads_along.stack.right
    areas = loads.chord * loads.width
    downwards = loads.velocity[:, :, 2]
    return np.asarray((areas * downwards).sum(axis=1) / areas.sum(axis=1))


def downstrokes(cycle: FlightCycle) -> list[tuple[float, float]]:
    """Times (start, end) s in the beat between which the wings go down."""
    if holds_still(cycle):
        return []
    times, speed = cycle.beat.times, stroke_speed(cycle)
    down = speed > 0
    turns = np.flatnonzero(down[1:] != down[:-1])
    share = speed[turns] / (speed[turns] - speed[turns + 1])
    turning = times[turns] + share * (times[turns + 1] - times[turns])
    borders = [*times[:1][down[:1]], *turning, *times[-1:][down[-1:]]]
    return [(float(a), float(b)) for a, b in zip(borders[::2], borders[1::2], strict=True)]


def beat_axis(axes: Axes, cycle: FlightCycle) -> None:
    """Let the x axis run over the beat, the downstroke shaded."""
    for start, end in downstrokes(cycle):
        axes.axvspan(start, end, color=_SHADE, linewidth=0, zorder=0)
    axes.set_xlim(cycle.beat.times[0], cycle.beat.times[-1])
    axes.spines[["top", "right"]].set_visible(False)
    axes.margins(y=0.08)


def beat_label(cycle: FlightCycle) -> str:
    """Label of an axis over the beat, with the meaning of its shade."""
    return "time (s)" if holds_still(cycle) else "time (s), downstroke shaded"


def holds_still(cycle: FlightCycle) -> bool:
    """Whether the wings keep their shape over the whole beat, as in gliding."""
    # Springs that settled move by the round-off of the orbit.
    fastest = float(np.abs(cycle.beat.joint_rates).max(initial=0.0))
    return fastest * cycle.period < _STILL


def show_no_round_off(axes: Axes, size: float) -> None:
    """Widen the y axis where its data vary by next to nothing of a typical size."""
    low, high = axes.get_ylim()
    missing = _LEAST_RANGE * size - (high - low)
    if missing > 0.0:
        axes.set_ylim(low - 0.5 * missing, high + 0.5 * missing)
        axes.ticklabel_format(axis="y", useOffset=False)
