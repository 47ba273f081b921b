"""Loads in the tunnel and in free flight."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from birdmb.figures.page import label_x, new_figure, panels, title
from birdmb.figures.style import DRIVER, LEVEL, LINE, beat_axis, beat_label, title_of
from birdmb.models import FlightCycle
from birdmb.studies.tunnel import tunnel_and_free_flight

_PANELS = {
    "thrust": ("thrust", "N"),
    "lift": ("lift", "N"),
    "pitching_moment": ("pitching moment", "N m"),
    "wing_power": ("wing power", "W"),
}
_STYLES: dict[str, dict[str, Any]] = {
    "tunnel": {"color": DRIVER, "ls": "--", "lw": 1.4},
    "free": {"color": LINE},
}


def plot_tunnel_and_free_flight(cycle: FlightCycle) -> Figure:
    """Draw thrust, lift, pitching moment and power over a beat, held and free, with their means."""
    data = tunnel_and_free_flight(cycle)
    figure = new_figure(10, 6, rows=2, columns=2)
    rows = panels(figure, 2, 2, sharex=True)
    rows[0, 1].axhline(data.attrs["weight"], color="0.35", ls=":", lw=1.2)
    for axes, (name, (label, unit)) in zip(rows.ravel(), _PANELS.items(), strict=True):
        beat_axis(axes, cycle)
        axes.axhline(0, **LEVEL)
        for mount, style in _STYLES.items():
            values = data[name].sel(mount=mount).values
            mean = round(float(values[:-1].mean()), 3) + 0.0  # no minus zero
            text = f"{mount}, mean {mean:.3g} {unit}".replace("-", "−")
            axes.plot(data["time"], values, label=text, **style)
        axes.set_ylabel(f"{label} ({unit})")
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.25 * (high - low))  # room for the legend
        axes.legend(frameon=False, fontsize="small", loc="upper center", ncols=2)
    label_x(rows, beat_label(cycle))
    figure.align_ylabels()
    title(figure, f"{title_of(cycle)}: body held at its mean state, and free (weight dotted)")
    return figure
