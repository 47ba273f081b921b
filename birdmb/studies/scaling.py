"""Birds of another size by allometric laws, as a starting point."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import root

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, BirdmbError
from birdmb.summary import Fact, Summarised, shortened
from birdmb.topology import Bird
from birdmb.topology.attachments import BODY
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
class _Size:
    """What a bird is scaled to."""

    mass: float
    span: float
    area: float
    frequency: float
    notes: tuple[str, str]  # on span and area, and on the frequency


@dataclass(frozen=True, repr=False)
class ScaledBird(Summarised):
    """A bird scaled to another size.

    Attributes:
        bird: the bird.
        assumptions: what was assumed, in sentences.
    """

    bird: Bird
    assumptions: tuple[str, ...]

    def _title(self) -> str:
        return self.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield from self.bird._summary()
        yield from (Fact("", shortened(sentence)) for sentence in self.assumptions)


@checked
def scale_bird(
    like: Bird,
    mass: float | None = None,
    *,
    span: float | None = None,
    frequency: float | None = None,
) -> ScaledBird:
    """Make a bird of another mass, span or wingbeat frequency, or of several of them.

    What is not given follows `allometric_span` and its like from the mass; the mass itself, if it
    is not given, from the span, or else from the frequency. A span that is given keeps the aspect
    ratio that a bird of this mass has by the laws. Bones follow the span, and feathers or the
    chords of sections the area, each by one factor. The rest is scaled as the assumptions say.

    Args:
        like: the bird that is scaled.
        mass: mass of the whole bird, kg.
        span: span with the wings stretched out, m.
        frequency: wingbeats per second, Hz.

    Raises:
        ArgumentError: none of them is given, or one is not positive, or no chords of that shape
            give the area.
    """
    size = _size(mass, span, frequency)
    mass, span, area = size.mass, size.span, size.area
    own_span, own_area = span_and_area(like)
    heavier, wider = mass / like.total_mass, span / own_span
    bones, feathers = _fitted(like, span, area)
    chord = (area / span) / (own_area / own_span)
    longer = heavier ** (1.0 / 3.0)
    torque = heavier * wider
    values: dict[str, Any] = {
        "name": f"{like.name}_{mass:.3g}kg",
        "gait.frequency": size.frequency,
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
    values |= _attachments(like, heavier, longer, bones)
    slower = like.gait.frequency / size.frequency
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
    return ScaledBird(bird, _assumptions(like, bird, size, bones, feathers))


def _size(mass: float | None, span: float | None, frequency: float | None) -> _Size:
    """The whole size of a bird of which some is given."""
    given = {"mass, in kg": mass, "span, in m": span, "frequency, in Hz": frequency}
    if not any(value is not None for value in given.values()):
        raise ArgumentError("give the mass, the span or the frequency of the bird to be made.")
    for what, value in given.items():
        if value is not None and not 0.0 < value < np.inf:
            raise ArgumentError(
                f"the {what.replace(', in', ' must be positive, in')}, not {value}."
            )
    if mass is None and span is not None:
        mass = (span / 1.17) ** (1.0 / 0.39)
    elif mass is None and frequency is not None:
        mass = (frequency / 3.87) ** (-1.0 / 0.33)
    assert mass is not None
    by_law = allometric_span(mass)
    wanted, beat = span or by_law, frequency or allometric_frequency(mass)
    area = allometric_area(mass) * (wanted / by_law) ** 2
    notes = (
        "Span as asked for, and the aspect ratio that the laws give this mass"
        if span
        else "Span 1.17 m^0.39, wing area 0.16 m^0.72",
        "wingbeat frequency as asked for" if frequency else "wingbeat frequency 3.87 m^-0.33",
    )
    return _Size(mass, wanted, area, beat, notes)


def _attachments(like: Bird, heavier: float, longer: float, bones: float) -> dict[str, Any]:
    """Values of the attached bodies, by dotted name."""
    values: dict[str, Any] = {}
    for one in like.attachments:
        name, factor = f"attachments.{one.name}", longer if one.on == BODY else bones
        values[f"{name}.mass"] = one.mass * heavier
        values[f"{name}.position"] = [x * factor for x in one.position]
        values[f"{name}.inertia"] = (np.array(one.inertia) * heavier * factor**2).tolist()
    return values


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
    for section in like.sections:
        rachides[f"sections.{section.name}.chord"] = section.chord * feathers
        rachides[f"sections.{section.name}.offset"] = section.offset * feathers
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
            f"{like.name}: no scaling of its bones and chords gives a span of {span:.4g} m and "
            f"an area of {area:.4g} m2."
        )
    bones, feathers = np.exp(found.x).tolist()
    return bones, feathers


def _assumptions(
    like: Bird, bird: Bird, size: _Size, bones: float, feathers: float
) -> tuple[str, ...]:
    span, area = span_and_area(bird)
    of_wing, of_beat = size.notes
    own_span, own_area = span_and_area(like)
    springs = ["Springs grow as weight times span, dampers besides as the duration of a beat."]
    tail = ["The tail keeps its angles; its lengths follow the mass to the power of 1/3."]
    return (
        f"A bird of {size.mass:.4g} kg scaled from {like.name} ({like.total_mass:g} kg); a "
        "starting point to be checked.",
        f"{of_wing}: {span:.4g} m ({like.name}: {own_span:.4g}) and {area:.4g} m2 "
        f"({own_area:.4g}),",
        f"{of_beat}: {bird.gait.frequency:.4g} Hz ({like.gait.frequency:.4g}); m is the mass in "
        "kg, joints at zero.",
        f"Bones, gap and half-thickness are {bones:.4g} times those of {like.name}, feathers or "
        f"chords {feathers:.4g} times.",
        "Body and segments have the same shares of the mass; the body's pitch inertia follows mass "
        "times length squared,",
        "its lengths the mass to the power of 1/3; segments' inertias mass times bone length "
        "squared.",
        "The shoulder keeps its distance from the centre of mass in mean chords.",
        "Joint angles, phases and amplitudes are the same.",
        *(springs if like.compliant_joints or any(f.hinge for f in like.feathers) else []),
        *(tail if like.tail is not None else []),
    )
