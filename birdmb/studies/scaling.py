"""Birds of another mass by allometric laws, as a starting point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import root

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, BirdmbError
from birdmb.topology import Bird
from birdmb.wing.outline import span_and_area

_FIT = 1e-9


def allometric_span(mass: float) -> float:
    """Wing span (m) of a bird of this mass (kg): 1.17 m^0.39."""
    return 1.17 * mass**0.39


def allometric_area(mass: float) -> float:
    """Wing area (m2), body between the wings included: 0.16 m^0.72."""
    return 0.16 * mass**0.72


def allometric_frequency(mass: float) -> float:
    """Wingbeat frequency (Hz): 3.87 m^-0.33."""
    return 3.87 * mass**-0.33


@dataclass(frozen=True)
class ScaledBird:
    """A bird scaled to another mass.

    Attributes:
        bird: the bird.
        assumptions: what was assumed, in sentences.
    """

    bird: Bird
    assumptions: tuple[str, ...]


def scale_bird(like: Bird, mass: float) -> ScaledBird:
    """Make a bird of another mass with the span, wing area and frequency of its kind.

    Span, area and frequency follow `allometric_span` and its like; with them the bones and the
    feathers, each by one factor. The rest is scaled as the assumptions say.

    Args:
        like: the bird that is scaled.
        mass: mass of the whole bird, kg.

    Raises:
        ArgumentError: the mass is not positive.
        BirdmbError: no feathers of that shape give the area.
    """
    if not 0.0 < mass < np.inf:
        raise ArgumentError(f"the mass must be positive, in kg, not {mass}.")
    span, area = allometric_span(mass), allometric_area(mass)
    own_span, own_area = span_and_area(like)
    heavier, wider = mass / like.total_mass, span / own_span
    bones, feathers = _fitted(like, span, area)
    chord = (area / span) / (own_area / own_span)
    longer = heavier ** (1.0 / 3.0)
    torque = heavier * wider
    values: dict[str, Any] = {
        "name": f"{like.name}_{mass:g}kg",
        "gait.frequency": allometric_frequency(mass),
        **_body(like, heavier, longer),
        "wing.root.x": like.wing.root.x * chord,
        "wing.root.z": like.wing.root.z * chord,
        **_wings(like, bones, feathers),
    }
    for bone, segment in like.segments.items():
        name = f"segments.{bone}"
        values[f"{name}.mass"] = segment.mass * heavier
        inertia = np.array(segment.inertia) * heavier * bones**2
        values[f"{name}.inertia"] = inertia.tolist()
        values[f"{name}.centre_of_mass"] = [x * bones for x in segment.centre_of_mass]
    slower = like.gait.frequency / allometric_frequency(mass)
    for joint in like.joints:
        for key, factor in (
            ("stiffness", torque),
            ("stiffness_below", torque),
            ("cubic_stiffness", torque),
            ("damping", torque * slower),
        ):
            if joint.mode != "compliant":
                continue
            for place, part in (("", joint), (".right", joint.right), (".left", joint.left)):
                own = getattr(part, key, None)
                if own is not None:
                    values[f"{joint.name}{place}.{key}"] = own * factor
    for feather in like.feathers:
        if feather.hinge is not None:
            place, turning = f"feathers.{feather.name}.hinge", heavier * feathers
            values[f"{place}.mass"] = feather.hinge.mass * heavier
            values[f"{place}.stiffness"] = feather.hinge.stiffness * turning
            values[f"{place}.damping"] = feather.hinge.damping * turning * slower
    if like.tail is not None:
        values |= {
            "tail.chord": like.tail.chord * longer,
            "tail.apex.x": like.tail.apex.x * longer,
            "tail.apex.z": like.tail.apex.z * longer,
        }
    if like.drag.frontal_area is not None:
        values["drag.frontal_area"] = like.drag.frontal_area * longer**2
    bird = like.with_values(values)
    return ScaledBird(bird, _assumptions(like, bird, mass, bones, feathers))


def _body(like: Bird, heavier: float, longer: float) -> dict[str, float]:
    """Values of the body, by dotted name; those that are not given stay so."""
    factors = {"mass": heavier, "volume": heavier, "side_area": longer**2}
    for axes in ("xx", "yy", "zz", "xz"):
        factors[f"inertia_{axes}"] = heavier * longer**2
    sizes = {name: getattr(like.body, name) for name in factors}
    return {
        f"body.{name}": size * factors[name] for name, size in sizes.items() if size is not None
    }


def _wings(like: Bird, bones: float, feathers: float) -> dict[str, Any]:
    lengths = {f"segments.{b}.length": s.length * bones for b, s in like.segments.items()}
    rachides = {f"feathers.{f.name}.length": f.length * feathers for f in like.feathers}
    return {
        **lengths,
        **rachides,
        "wing.root.y": like.wing.root.y * bones,
        "wing.half_thickness": like.wing.half_thickness * bones,
    }


def _fitted(like: Bird, span: float, area: float) -> tuple[float, float]:
    """Factors of the bones and of the feathers that give span (m) and area (m2)."""

    def missed(factors: FloatArray) -> FloatArray:
        got = span_and_area(like.with_values(_wings(like, *np.exp(factors).tolist())))
        return np.log(np.array(got) / [span, area])

    guess = np.log(span / span_and_area(like)[0])
    try:
        found = root(missed, [guess, guess], tol=_FIT)
        fits = bool(found.success)
    except BirdmbError:
        fits = False
    if not fits:
        raise ArgumentError(
            f"{like.name}: no scaling of its bones and feathers gives a span of {span:.4g} m and "
            f"an area of {area:.4g} m2."
        )
    bones, feathers = np.exp(found.x).tolist()
    return bones, feathers


def _assumptions(
    like: Bird, bird: Bird, mass: float, bones: float, feathers: float
) -> tuple[str, ...]:
    span, area = span_and_area(bird)
    own_span, own_area = span_and_area(like)
    springs = ["Springs grow as weight times span, dampers besides as the duration of a beat."]
    tail = ["The tail keeps its angles; its lengths follow the mass to the power of 1/3."]
    return (
        f"A bird of {mass:g} kg scaled from {like.name} ({like.total_mass:g} kg); a starting point "
        "to be checked.",
        f"Span 1.17 m^0.39 = {span:.4g} m ({like.name}: {own_span:.4g}), wing area 0.16 m^0.72 = "
        f"{area:.4g} m2 ({own_area:.4g}),",
        f"wingbeat frequency 3.87 m^-0.33 = {bird.gait.frequency:.4g} Hz "
        f"({like.gait.frequency:.4g}); m in kg, joints at zero.",
        f"Bones, gap and half-thickness are {bones:.4g} times those of {like.name}, feathers "
        f"{feathers:.4g} times.",
        "Body and segments have the same shares of the mass; the body's pitch inertia follows mass "
        "times length squared,",
        "its lengths the mass to the power of 1/3; segments' inertias mass times bone length "
        "squared.",
        "The shoulder keeps its distance from the centre of mass in mean chords.",
        "Joint angles, phases and amplitudes are the same.",
        *(springs if like.compliant_joints or any(f.hinge for f in like.feathers) else []),
        *(tail if like.tail is not None else []),
    )
