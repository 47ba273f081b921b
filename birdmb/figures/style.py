"""What figures share: colours and markers, the axis of the beat, and which part is downstroke."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from birdmb._typing import FloatArray
from birdmb.text import in_figure

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

LINE = "tab:blue"
DRIVER = "0.35"
MEAN = "tab:orange"
STABLE_COLOUR, UNSTABLE_COLOUR = "tab:blue", "tab:red"
VERDICT_COLOURS = {"stable": STABLE_COLOUR, "unstable": UNSTABLE_COLOUR, "undecided": "0.5"}
BIFURCATION_MARKERS = {
    "fold": "o",
    "period doubling": "s",
    "Neimark-Sacker": "D",
    "branch point": "x",
    "multiple": "*",
}
_SHADE = "0.92"
# Of the typical size of what is drawn; an axis over less shows the round-off of what is steady.
_LEAST_RANGE = 1e-3
_STILL = 1e-6  # rad in a beat

# In place of "theta", say, as the text in a picture.
_SYMBOLS = {"theta": "θ", "phi": "φ"}


def title_of(cycle: FlightCycle) -> str:
    """Name of the bird as it is written in a figure."""
    return in_figure(cycle.model.bird.name)


def symbol(name: str) -> str:
    """Name of a state as it is written in a figure."""
    return _SYMBOLS.get(name, in_figure(name))


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


def label_beat(axes: Axes, cycle: FlightCycle) -> None:
    """Write under an axis over the beat what it shows."""
    glides = holds_still(cycle)
    axes.set_xlabel("time (s)" if glides else "time (s), downstroke shaded")


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
