"""The Floquet multipliers in the complex plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from birdmb._typing import ComplexArray, FloatArray
from birdmb.figures.labels import IMAGINARY, REAL
from birdmb.figures.page import new_figure, title
from birdmb.figures.style import LEVEL, STABLE_COLOUR, UNSTABLE_COLOUR, VERDICT_MARKERS, title_of

if TYPE_CHECKING:
    from birdmb.models import FlightCycle

# Nearer than this to the origin, multipliers share one label: their discs would overlap it.
_CROWDED = 0.06


def plot_multipliers(cycle: FlightCycle) -> Figure:
    """Draw the multipliers in the unit circle, with error discs, moduli and doubling times."""
    figure = new_figure(6.4, 5.6)
    draw_labelled_multipliers(figure.subplots(), cycle)
    title(figure, f"{title_of(cycle)}: Floquet multipliers")
    return figure


def draw_multipliers(axes: Axes, multipliers: ComplexArray, errors: FloatArray) -> None:
    """Draw multipliers (n,) in the complex plane, with their error bounds as discs.

    Those outside the unit circle are triangles, those on it within their error grey squares.
    """
    axes.add_patch(Circle((0, 0), 1, fill=False, color="0.6"))
    outside, known = np.abs(multipliers) - 1.0, np.nan_to_num(errors, posinf=np.inf)
    for verdict, keep in (
        ("stable", outside < -known),
        ("unstable", outside > known),
        ("undecided", np.abs(outside) <= known),
    ):
        shown = multipliers[keep]
        axes.plot(shown.real, shown.imag, **VERDICT_MARKERS[verdict])
    for value, error in zip(multipliers, errors, strict=True):
        if np.isfinite(error):
            axes.add_patch(Circle((value.real, value.imag), error, color="0.5", alpha=0.3))
    reach = 1.1 * max(1.0, float(np.abs(multipliers).max()))
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axes.set(xlabel=REAL, ylabel=IMAGINARY, title="Floquet multipliers")


def draw_labelled_multipliers(axes: Axes, cycle: FlightCycle) -> None:
    """Draw the multipliers, each with its modulus and doubling or halving time beside it."""
    draw_multipliers(axes, cycle.multipliers, cycle.verdict_errors)
    axes.set_title("")
    axes.axhline(0, **LEVEL)
    axes.axvline(0, **LEVEL)
    axes.spines[["top", "right"]].set_visible(False)
    reach = max(1.0, float(np.abs(cycle.multipliers).max()))
    right = max(1.0, float(cycle.multipliers.real.max()))
    left = min(-1.0, float(cycle.multipliers.real.min()))
    height = max(1.0, float(np.abs(cycle.multipliers.imag).max()))
    axes.set_xlim(left - 0.1 * reach, right + (0.1 if right == 1.0 else 0.25) * reach)
    axes.set_ylim(-height - 0.1 * reach, height + 0.1 * reach)
    for text, place, unstable, below in _labels(cycle):
        beside = abs(place) < 1 and place.real > 0.5
        axes.annotate(
            text,
            (place.real, place.imag),
            (0, -9) if below else (0, 8),
            textcoords="offset points",
            ha="right" if beside else "center",
            va="top" if below else "bottom",
            fontsize="small",
            color=UNSTABLE_COLOUR if unstable else STABLE_COLOUR,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.75},
        )


def _labels(cycle: FlightCycle) -> list[tuple[str, complex, bool, bool]]:
    """Text, place, whether unstable and whether to stand below, of each label.

    One for a conjugate pair, one for all near zero; those on the real axis alternate. Modes of the
    wake have none.
    """
    labels = []
    below = True
    moduli = np.abs(cycle.multipliers)
    tiny = moduli[moduli < _CROWDED]
    for i, (value, modulus) in enumerate(zip(cycle.multipliers, moduli, strict=True)):
        if modulus < _CROWDED or value.imag < 0 or cycle.flight_modes[i].name == "wake":
            continue
        does = "doubles" if modulus > 1 else "halves"
        text = f"|Λ| = {modulus:.3f}\n{does} in {cycle.doubling_times[i]:.2g} s"
        labels.append((text, complex(value), bool(modulus > 1), below and value.imag == 0))
        if value.imag == 0:
            below = not below
    if tiny.size:
        many = "" if tiny.size == 1 else f"{tiny.size} × "
        labels.append((f"{many}|Λ| < {rounded_up(float(tiny.max()))}", 0j, False, below))
    return labels


def rounded_up(modulus: float) -> str:
    """The next power of ten, as text."""
    return f"$10^{{{int(np.floor(np.log10(max(modulus, 1e-16)))) + 1}}}$"
