"""Names as figures write them: symbols where there are any, else words, with units."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.quantities import BY_NAME, IN_DEGREES, Quantity
from birdmb.text import in_figure

LARGEST_MODULUS = r"$|\Lambda|_\mathrm{max}$"
MODULUS = r"$|\Lambda|$"
REAL, IMAGINARY = r"Re $\Lambda$", r"Im $\Lambda$"

_STATES = {"theta": "θ", "phi": "φ", "psi": "ψ"}
# By the last part of a dotted name: the symbol, which the joint's motion is the index of.
_SYMBOLS = {
    "stiffness": "k",
    "stiffness_below": "k^-",
    "cubic_stiffness": "k_3",
    "damping": "C",
    "amplitude_deg": "A",
    "offset_deg": r"\theta_0",
    "phase_deg": r"\varphi",
}
_UNITS = {
    **dict.fromkeys(("stiffness", "stiffness_below"), "N m/rad"),
    "cubic_stiffness": "N m/rad³",
    "damping": "N m s/rad",
    "mass": "kg",
    "inertia": "kg m²",
    "added moment of inertia": "kg m²",
    "frequency": "Hz",
    "density": "kg/m³",
    "gravity": "m/s²",
    **dict.fromkeys(("x", "y", "z", "length", "chord", "span", "position", "width"), "m"),
    **dict.fromkeys(("largest_angle_of_attack", "largest_tail_angle"), "°"),
}
_USUAL_PLACE = "shoulder"  # whose joints need no index of their place


def state_symbol(name: str) -> str:
    """Name of a state: a Greek letter, or the name itself."""
    return _STATES.get(name, in_figure(name))


def in_words(name: str) -> str:
    """A dotted name as words: "tail opening" of tail.opening_deg."""
    return in_figure(name.removesuffix("_deg").replace(".", " ").replace("_", " "))


def parameter(name: str) -> str:
    """Symbol of a parameter by its dotted name, or its name in words."""
    *joint, attribute = name.split(".")
    if attribute not in _SYMBOLS or len(joint) != 2:
        return in_words(name)
    place, motion = (part.replace("_", r"\,") for part in joint)
    index = motion if place == _USUAL_PLACE else rf"{place}\,{motion}"
    base, _, own = _SYMBOLS[attribute].partition("_")
    inner = rf"\mathrm{{{index}}}" if not own else rf"{own},\,\mathrm{{{index}}}"
    return f"${base}_{{{inner}}}$"


def parameter_unit(name: str) -> str:
    """Unit of a parameter as figures show it; empty where none is known."""
    if name.endswith("_deg"):
        return "°"
    return _UNITS.get(name.rpartition(".")[2], "")


def parameter_label(name: str) -> str:
    """Label of an axis over a parameter."""
    return _with_unit(parameter(name), parameter_unit(name))


def setting(name: str, value: object) -> str:
    """Name, value and unit of a parameter, as in a title."""
    text = f"{value:.4g}" if isinstance(value, float) else in_figure(str(value))
    unit = parameter_unit(name)
    space = "" if unit in ("", "°") else " "
    return f"{parameter(name)} = {text.replace('-', '−')}{space}{unit}"


def quantity_label(name: str, unit: str = "1") -> str:
    """Label of an axis of a quantity, in the unit that is shown.

    Args:
        name: of the quantity, in datasets.
        unit: of what is in no table.
    """
    if name == "largest_modulus":
        return LARGEST_MODULUS
    if name in BY_NAME:
        return BY_NAME[name].axis_label
    return Quantity(name, unit, in_words(name), "", "", float).axis_label


def as_shown(name: str, values: FloatArray) -> FloatArray:
    """Values of a quantity in the unit of its label: degrees for rad."""
    in_rad = name in BY_NAME and BY_NAME[name].unit in IN_DEGREES
    return np.degrees(values) if in_rad else values


def _with_unit(label: str, unit: str) -> str:
    return f"{label} ({unit})" if unit else label
