"""Variables of the wings over a beat, for the files of limit cycles."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.loads_kernel import StackedWing
from birdmb.models.wing_model import BirdModel
from birdmb.orbits.cycle_dataset import Variable, described
from birdmb.topology import SIDES
from birdmb.wing.outline import wing_outline

# Instants of a beat, and points of an edge, at which files hold the wings' outlines, about.
_OUTLINES, _POINTS_OF_EDGE = 20, 40
_OF_ELEMENTS = {
    "position": ("m", "control points from G"),
    "force": ("N", "force on each element"),
    "circulation": ("m2/s", "bound circulation"),
    "angle_of_attack": ("rad", "geometric angle of attack"),
    "speed": ("m/s", "wind in the section's plane"),
    "chord": ("m", "chord"),
    "width": ("m", "width of the element"),
}


def variables_of_wing(wing: StackedWing, prefix: str, which: str) -> dict[str, Variable]:
    """Variables of a dataset, by name, of one wing's elements over the beat."""
    found: dict[str, Variable] = {}
    for name, (units, about) in _OF_ELEMENTS.items():
        values = getattr(wing, name)
        dims = ("beat_time", "element", "axis")[: values.ndim]
        key = prefix + ("element_force" if name == "force" else name)
        found[key] = (dims, values, described(units, about + which))
    return found


def outlines(model: BirdModel, times: FloatArray, states: FloatArray) -> dict[str, Variable]:
    """Edges and bones of both wings over the beat, in body axes.

    At about twenty of `times` (K,) s, in states (K, n); those of the left wing on its side.
    """
    step = max(1, times.size // _OUTLINES)
    times, states = times[::step], states[::step]
    angles, _ = model.motion_of_both(times, states)
    numbers = model.bird.wing.resolved_discretisation
    both_wings = [
        [wing_outline(wing, at, numbers) for wing, at in zip(wings, of_both, strict=True)]
        for of_both in angles
        for wings in [(model.wing, model.left_wing)]
    ]
    found: dict[str, Variable] = {}
    for name in ("leading", "trailing", "bones"):
        places = np.array([[getattr(outline, name) for outline in both] for both in both_wings])
        places[:, 1, :, 1] *= -1.0
        if name != "bones":
            last = places.shape[2] - 1
            places = places[:, :, np.linspace(0, last, min(last + 1, _POINTS_OF_EDGE)).astype(int)]
        # The edges have as many points as vertices where they are not rounded.
        point = "joint_end" if name == "bones" else f"{name}_edge_point"
        dims = ("outline_time", "side", point, "axis")
        about = "shoulder and ends of the bones" if name == "bones" else f"{name} edge"
        key = "outline_bones" if name == "bones" else f"outline_{name}_edge"
        found[key] = (dims, places, described("m", f"{about}, from the body's centre of mass"))
    return {
        **found,
        "side": (("side",), np.array(SIDES), {"long_name": "side of the wing"}),
        "outline_time": (("outline_time",), times, described("s", "time over a beat")),
    }
