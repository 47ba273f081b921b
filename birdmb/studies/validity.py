"""Whether a flight stays where the quasi-steady lifting line means anything.

The model takes every section as a thin airfoil in steady attached flow. That needs small angles of
attack, for there is no stall in it, and a wingbeat that is slow against the time the air takes to
pass the chord.

**Which angle of attack counts.** The geometric angle is that of the undisturbed wind; the effective
one also counts the downwash of the wake, and is what the section itself meets: its lift coefficient
is 2 pi times the effective angle. Whether a section stalls is decided by its pressure distribution,
that is by its lift coefficient, so that the effective angle is judged and warned about. Under a
strong downwash the geometric angle may be far larger without harm; it is reported beside it.

**The outermost hundredth of the wing is not judged.** Towards a pointed tip the effective angle of
any lifting line grows without bound as elements are refined (for the ibis 22, 26 and 32 deg at the
last of 16, 32 and 64 elements), where chord and load vanish. The tip that holds the last 1 % of the
wing's area is therefore left out of the verdict, but not of the data.

**What a model holds is no excess.** Air that remembers has no limit of the reduced frequency, and
where flow may separate from the sections no angle of attack is too large: `Validity.stalled` tells
which of them are stalled when.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from birdmb._typing import BoolArray, FloatArray
from birdmb.arguments import checked
from birdmb.models import FlightCycle
from birdmb.models.loads_kernel import StackedWing
from birdmb.quantities import VALIDITIES
from birdmb.studies.stalled_sections import StalledSection, stall_sentence, stalled_sections
from birdmb.summary import Fact, Summarised, facts_of
from birdmb.wing.outline import areas_across

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TIP_AREA = 0.01
LARGEST_ANGLE = float(np.radians(15.0))
LARGEST_REDUCED_FREQUENCY = 0.2
LARGEST_OVERLAP = 0.01
_ALIKE = 1e-6  # rad
LARGEST_TAIL_ANGLE = float(np.radians(5.0))


@dataclass(frozen=True, repr=False)
class ValidityViolation(Summarised):
    """One way in which a flight leaves the model's validity, and where and when it does so most.

    `str()` of it is a sentence.
    """

    quantity: str
    """"effective angle of attack" or "reduced frequency"."""
    value: float
    """The worst value; rad or 1."""
    limit: float
    """The limit it exceeds; rad or 1."""
    element: int
    """Element of the wing, from 0 at the root, where it is worst."""
    span_position: float
    """Distance along the lifting line from the plane of symmetry, m."""
    span_fraction: float
    """The same as a part of the line's length to the wing tip."""
    time: float
    """Time when it is worst, s."""
    phase: float
    """The same as a part of the beat, in [0, 1); 0 is where the drivers' time is 0."""
    share: float
    """Part of the wing's area, averaged over the beat, that is beyond the limit."""
    side: str = ""
    """"right" or "left" where both wings do not do the same, else empty."""

    def __str__(self) -> str:
        """Say what, how much, where and when."""
        of_wing = f" of the {self.side} wing" if self.side else ""
        where = (
            f"at element {self.element}{of_wing}, {self.span_position:.3g} m along the span "
            f"({self.span_fraction:.0%} of the half-span), at t = {self.time:.4g} s "
            f"(phase {self.phase:.2f} of the beat)"
        )
        if self.quantity == "reduced frequency":
            return (
                f"The reduced frequency is {self.value:.3g}, beyond {self.limit:.3g}; locally it "
                f"is largest {where}. The unsteady wake, which the model leaves out, matters "
                "there: fly it with --set air.wake=unsteady, or see what --memory says it changes."
            )
        return (
            f"The {self.quantity} reaches {np.degrees(self.value):.1f} deg, beyond "
            f"{np.degrees(self.limit):.3g} deg, {where}; {self.share:.1%} of wing area and beat "
            f"are beyond it. The model has no stall: a real section would lose lift there."
        )


@dataclass(frozen=True, repr=False)
class TailViolation(Summarised):
    """How a flight leaves the validity of the tail's slender-wing lift; `str()` is a sentence."""

    value: float
    """Largest modulus of the tail's angle of attack, rad."""
    limit: float
    """The limit it exceeds, rad."""
    time: float
    """Time when it is largest, s."""
    phase: float
    """The same as a part of the beat, in [0, 1)."""
    share: float
    """Part of the beat that is beyond the limit."""
    quantity: str = "tail angle of attack"

    def __str__(self) -> str:
        """Say what, how much and when."""
        return (
            f"The {self.quantity} reaches {np.degrees(self.value):.1f} deg, beyond "
            f"{np.degrees(self.limit):.3g} deg, at t = {self.time:.4g} s (phase {self.phase:.2f} "
            f"of the beat); {self.share:.0%} of the beat are beyond it. A real tail has vortex "
            f"lift there, which the slender-wing formula leaves out."
        )


@dataclass(frozen=True, repr=False)
class Overlap(Summarised):
    """How the wings reach into one another across the plane of symmetry; `str()` is a sentence."""

    value: float
    """Largest part of the wing's area that is across the plane."""
    limit: float
    """The limit it exceeds."""
    time: float
    """Time when it is largest, s."""
    phase: float
    """The same as a part of the beat, in [0, 1)."""
    share: float
    """Part of the beat that is beyond the limit."""
    quantity: str = "overlap of the wings"

    def __str__(self) -> str:
        """Say how much and when."""
        return (
            f"The wings reach into one another: {self.value:.1%} of the wing's area, beyond "
            f"{self.limit:.0%}, is across the plane of symmetry at t = {self.time:.4g} s (phase "
            f"{self.phase:.2f} of the beat); {self.share:.0%} of the beat are beyond it. The model "
            f"counts the loads of both wings there."
        )


@dataclass(frozen=True, repr=False)
class Validity(Summarised):
    """How far a flight is from the limits of the quasi-steady model.

    Attributes:
        data: of the right wing, or of the one that comes closer to the limits where both do not do
            the same, by `time` (s) and `element` (from the root): `angle_of_attack` (geometric),
            `effective_angle_of_attack` (rad), `reduced_frequency` (local, pi f c/|U|), `area`
            (m2, of one wing's elements), `judged` (False at the tip); coordinates `phase`,
            `span_position` (m along the lifting line from the plane of symmetry) and
            `span_fraction`.
        reduced_frequency: k = pi f c/U, with the mean chord (area by span, averaged over the beat)
            and the speed of the flight; that is omega c/(2 U), on half the chord.
        largest_tail_angle: largest modulus of the tail's angle of attack, rad; NaN without a tail.
        largest_overlap: largest part of the wing's area that is across the plane of symmetry.
        excesses: where the limits are exceeded; none if the flight is within them.
        stalled: the sections that are stalled in part of the beat, where the bird's profiles have a
            polar or stall; none of any other bird.
        cycle: the flight.
    """

    data: xr.Dataset
    reduced_frequency: float
    largest_tail_angle: float
    largest_overlap: float
    excesses: tuple[ValidityViolation | TailViolation | Overlap, ...]
    stalled: tuple[StalledSection, ...]
    cycle: FlightCycle

    def _title(self) -> str:
        return self.cycle.model.bird.name

    def _summary(self) -> Iterator[Fact]:
        within = "within the limits of the model"
        yield Fact("", f"{len(self.excesses)} limits exceeded" if self.excesses else within)
        yield from facts_of(self, *(quantity.name for quantity in VALIDITIES))
        for excess in self.excesses:
            yield Fact("beyond its limit", excess.quantity)

    @cached_property
    def strouhal_number(self) -> float:
        """f A/U, with A the distance between the highest and the lowest place of the wing tip.

        Relative to the body, along its z axis (Taylor, Nudds & Thomas 2003); of the wing that moves
        further.
        """
        model, stack = self.cycle.model, self.cycle.beat.loads_along.stack
        wings = [stack.right] if model.is_mirrored else [stack.right, stack.left]
        amplitude = max(float(np.ptp(wing.node[:, -1, 2])) for wing in wings)
        return model.bird.gait.frequency * amplitude / self.cycle.mean_speed

    @property
    def warnings(self) -> tuple[str, ...]:
        """A sentence for each excess."""
        return tuple(map(str, self.excesses))

    @property
    def stall(self) -> str:
        """Which sections are stalled when, a sentence; empty if flow may not separate."""
        return stall_sentence(self.stalled) if self.cycle.model.wake.separates else ""

    @property
    def largest_angle_of_attack(self) -> float:
        """Largest modulus of the effective angle, rad, without the tip."""
        return _largest_angle(self.data)

    def plot(self) -> Figure:
        """Draw both angles of attack over beat and span, with the limits of validity."""
        from birdmb.figures import plot_validity  # noqa: PLC0415 - it draws

        return plot_validity(self.data)


@checked
def assess_validity(
    cycle: FlightCycle,
    *,
    largest_angle: float = LARGEST_ANGLE,
    largest_reduced_frequency: float = LARGEST_REDUCED_FREQUENCY,
    largest_tail_angle: float = LARGEST_TAIL_ANGLE,
    largest_overlap: float = LARGEST_OVERLAP,
) -> Validity:
    """Compare a limit cycle with the limits of the quasi-steady model, element by element.

    Args:
        cycle: limit cycle of a bird.
        largest_angle: largest modulus of the effective angle of attack, rad.
        largest_reduced_frequency: largest k of the whole flight.
        largest_tail_angle: largest modulus of the tail's angle of attack, rad.
        largest_overlap: largest part of the wing's area across the plane of symmetry. (A lifting
            line that crosses it has no loads and no cycle: `BirdModel.loads`.)
    """
    model = cycle.model
    frequency = model.bird.gait.frequency
    stack = cycle.beat.loads_along.stack
    wings = [stack.right] if model.is_mirrored else [stack.right, stack.left]
    sides = [""] if model.is_mirrored else ["right", "left"]
    each = [
        _along_span_and_beat(cycle, frequency, wing).assign_attrs(
            bird=model.bird.name, side=side, largest_angle=largest_angle, tip_area=TIP_AREA
        )
        for wing, side in zip(wings, sides, strict=True)
    ]
    if len(each) > 1 and _alike(*each):
        each = [each[0].assign_attrs(side="")]
    data = max(each, key=_largest_angle)
    area = data["area"].values[:-1]
    span = stack.right.width[:-1].sum(axis=1)
    mean_chord = float((area.sum(axis=1) / span).mean())
    k = np.pi * frequency * mean_chord / cycle.mean_speed
    excesses: list[ValidityViolation | TailViolation | Overlap] = []
    stalled: tuple[StalledSection, ...] = ()
    if model.wake.separates:
        stalled = stalled_sections(cycle, each)
    else:
        excesses += [excess for of_wing in each for excess in _beyond_angle(of_wing, largest_angle)]
    if k > largest_reduced_frequency and not model.wake.count:
        local = data["reduced_frequency"].values
        beyond = local > largest_reduced_frequency
        where = np.where(data["judged"], local, 0.0)
        excesses.append(
            _excess(data, "reduced frequency", where, beyond, k, largest_reduced_frequency)
        )
    tail_angle = np.abs(cycle.beat.tail_angle[:-1])
    if (tail_angle > largest_tail_angle).any():
        excesses.append(TailViolation(*_worst_of_beat(cycle, tail_angle, largest_tail_angle)))
    angles, _ = model.motion_of_both(cycle.beat.times[:-1], cycle.beat.states[:-1])
    numbers = model.bird.wing.resolved_discretisation
    overlaps = [areas_across(model.wing, angles[:, i], numbers) for i in range(len(sides))]
    overlap = np.max(overlaps, axis=0)
    if (overlap > largest_overlap).any():
        excesses.append(Overlap(*_worst_of_beat(cycle, overlap, largest_overlap)))
    return Validity(
        data=data,
        reduced_frequency=float(k),
        largest_tail_angle=float(tail_angle.max()),
        largest_overlap=float(overlap.max()),
        excesses=tuple(excesses),
        stalled=stalled,
        cycle=cycle,
    )


def _worst_of_beat(
    cycle: FlightCycle, values: FloatArray, limit: float
) -> tuple[float, float, float, float, float]:
    """Of `values` (K,), one an instant: the largest, `limit`, time, phase and share beyond it."""
    time = float(cycle.beat.times[np.argmax(values)])
    phase = float(np.mod(time / cycle.period, 1.0))
    return float(values.max()), limit, time, phase, float(np.mean(values > limit))


def _alike(right: xr.Dataset, left: xr.Dataset) -> bool:
    """Whether both wings do the same but for what a search leaves."""
    apart = right["effective_angle_of_attack"] - left["effective_angle_of_attack"]
    return bool(np.abs(apart).max() < _ALIKE)


def _largest_angle(data: xr.Dataset) -> float:
    angle = data["effective_angle_of_attack"].values
    return float(np.abs(angle[data["judged"].values]).max())


def _along_span_and_beat(cycle: FlightCycle, frequency: float, loads: StackedWing) -> xr.Dataset:
    beat = cycle.beat
    chord, width, speed, circulation = loads.chord, loads.width, loads.speed, loads.circulation
    along, length = _span_positions(loads.position, width)
    area = chord * width
    # The tip: elements of which the middle lies in the last of the area.
    outside = np.cumsum(area[:, ::-1], axis=1)[:, ::-1] - 0.5 * area
    both = ("time", "element")
    return xr.Dataset(
        {
            "angle_of_attack": (both, loads.angle_of_attack, {"units": "rad"}),
            "effective_angle_of_attack": (
                both,
                circulation / (np.pi * chord * speed),
                {"units": "rad", "long_name": "lift coefficient of the section over 2 pi"},
            ),
            "reduced_frequency": (both, np.pi * frequency * chord / speed, {"units": "1"}),
            "area": (both, area, {"units": "m2"}),
            "judged": (both, outside > TIP_AREA * area.sum(axis=1, keepdims=True)),
        },
        coords={
            "time": ("time", beat.times, {"units": "s"}),
            "phase": ("time", np.mod(beat.times * frequency, 1.0)),
            "element": np.arange(chord.shape[1]),
            "span_position": (both, along, {"units": "m"}),
            "span_fraction": (both, along / length[:, None]),
        },
    )


def _span_positions(position: FloatArray, width: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Distance (K, N) m of the control points along the line from its centre; its length (K,)."""
    steps = np.linalg.norm(np.diff(position, axis=1), axis=2)
    first = np.abs(position[:, :1, 1])
    along = np.concatenate([first, first + np.cumsum(steps, axis=1)], axis=1)
    # Chords of a curved line taken in other places may differ by a little.
    return along, np.maximum(width.sum(axis=1), along[:, -1])


def _beyond_angle(data: xr.Dataset, limit: float) -> Iterator[ValidityViolation]:
    """The worst place of either sign: too large upwards and downwards are two matters."""
    angle = np.where(data["judged"], data["effective_angle_of_attack"], 0.0)
    for sign in (1.0, -1.0):
        if (sign * angle).max() > limit:
            beyond = sign * angle > limit
            worst = float(sign * (sign * angle).max())
            yield _excess(data, "effective angle of attack", sign * angle, beyond, worst, limit)


def _excess(
    data: xr.Dataset,
    quantity: str,
    badness: FloatArray,
    beyond: BoolArray,
    value: float,
    limit: float,
) -> ValidityViolation:
    # The end of the beat is its beginning: it counts once.
    area = data["area"].values[:-1]
    row, element = np.unravel_index(np.argmax(badness[:-1]), badness[:-1].shape)
    return ValidityViolation(
        quantity=quantity,
        value=float(value),
        limit=limit,
        element=int(element),
        span_position=float(data["span_position"].values[row, element]),
        span_fraction=float(data["span_fraction"].values[row, element]),
        time=float(data["time"].values[row]),
        phase=float(data["phase"].values[row]),
        share=float((area * beyond[:-1]).sum() / area.sum()),
        side=data.attrs["side"],
    )
