"""Loads in the tunnel and in free flight."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from birdmb.figures.style import DRIVER, LINE, beat_axis, label_beat, title_of
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
    figure = Figure(figsize=(10, 6), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    panels[0, 1].axhline(data.attrs["weight"], color="0.35", ls=":", lw=1.2)
    for axes, (name, (label, unit)) in zip(panels.ravel(), _PANELS.items(), strict=True):
        beat_axis(axes, cycle)
        axes.axhline(0, color="0.7", lw=0.8)
        for mount, style in _STYLES.items():
            values = data[name].sel(mount=mount).values
            mean = round(float(values[:-1].mean()), 3) + 0.0  # no minus zero
            text = f"{mount}, mean {mean:.3g} {unit}".replace("-", "−")
            axes.plot(data["time"], values, label=text, **style)
        axes.set_ylabel(f"{label} ({unit})")
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.25 * (high - low))  # room for the legend
        axes.legend(frameon=False, fontsize="small", loc="upper center", ncols=2)
    for axes in panels[-1]:
        label_beat(axes, cycle)
    figure.align_ylabels()
    figure.suptitle(
        f"{title_of(cycle)}: body held at its mean state, and free (weight dotted)",
        fontsize="medium",
    )
    return figure
