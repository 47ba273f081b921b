"""Locating the bifurcations between two neighbouring points of a branch.

Sign changes of test functions show a single multiplier that crosses the unit circle at 1 or -1.
Everything else shows in the number of multipliers outside the circle: what the located events leave
unexplained of its change is located as the zero of the modulus at one place in the order of moduli.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from birdmb._typing import BoolArray, FloatArray
from birdmb.errors import OrbitError, StateError
from birdmb.orbits.bifurcations import (
    TESTS,
    Neutral,
    counts_outside,
    numbers_outside,
    sign_changes,
    sorted_excess,
)
from birdmb.orbits.branch_points import Bifurcation, BifurcationKind, BranchPoint

LOCATION_TOLERANCE = 1e-7  # in arclength
# Events nearer than this in arclength are one; so are multipliers this near to the circle at it.
_TOGETHER = 1e-6
_ON_CIRCLE = 1e-5
# Of a pair on the circle, a smaller imaginary part may be round-off of a double real multiplier.
_REAL = 1e-5

Test = Callable[[BranchPoint], float]
FAILURES = (OrbitError, StateError, np.linalg.LinAlgError)


class Chord:
    """Orbits of a branch between two neighbouring points, by the distance along their chord."""

    def __init__(
        self,
        before: BranchPoint,
        after: BranchPoint,
        length: float,
        unit: float,
        orbit_at: Callable[[float], BranchPoint],
    ) -> None:
        """Take the points, their distance, the width of the parameter range, and how to go on."""
        self.before, self.after, self.length, self.unit = before, after, length, unit
        self._orbit_at = orbit_at
        self._seen = {0.0: before, length: after}

    def at(self, distance: float) -> BranchPoint:
        """The orbit at a distance; raises one of `FAILURES` where none is found."""
        if distance not in self._seen:
            self._seen[distance] = self._orbit_at(distance)
        return self._seen[distance]

    def root(self, test: Test, low: float, high: float) -> tuple[float, float]:
        """Where a test function vanishes, and the width in the parameter that it is known to.

        Without a change of sign, which happens if an end is at the root within its errors, it is
        that end. Where an orbit is not found on the way, it lies between the nearest ones seen.
        """
        at_low, at_high = test(self.at(low)), test(self.at(high))
        width = LOCATION_TOLERANCE * self.unit
        if at_low * at_high > 0:
            return (low if abs(at_low) <= abs(at_high) else high), width
        try:
            found = brentq(lambda s: test(self.at(s)), low, high, xtol=LOCATION_TOLERANCE)
        except FAILURES:
            inside = [s for s in self._seen if low <= s <= high]
            left = max((s for s in inside if test(self._seen[s]) * at_low > 0), default=low)
            right = min(s for s in inside if s > left)
            gap = self._seen[right].parameter - self._seen[left].parameter
            return left, width + abs(gap)
        return float(found), width


@dataclass(frozen=True)
class _Event:
    """A located crossing.

    Attributes:
        distance: along the chord.
        point: the orbit there.
        kind: of the test function that changes its sign, `None` if none does.
        order: multipliers by how near they are to where they cross; those that stay on the
            circle and the trivial one come last.
        size: how many of these cross.
        parameter_error: bound.
    """

    distance: float
    point: BranchPoint
    kind: BifurcationKind | None
    order: tuple[int, ...]
    size: int
    parameter_error: float

    @property
    def crossing(self) -> BoolArray:
        """Mask (n,) of the multipliers that cross."""
        mask = np.zeros(len(self.point.multipliers), bool)
        mask[list(self.order[: self.size])] = True
        return mask

    def across(self, outside: frozenset[int], neutral: Neutral) -> frozenset[int]:
        """Numbers of multipliers outside the circle on one side, from those on the other."""
        rest = ~self.crossing
        if self.point.trivial_index is not None:
            rest[self.point.trivial_index] = False
        excess = np.abs(self.point.multipliers[rest]) - 1
        errors = self.point.multiplier_errors[rest] + _ON_CIRCLE
        found = set()
        for others in numbers_outside(excess, errors, neutral):
            for number in outside:
                if not 0 <= number - others <= self.size:
                    continue
                if self.kind is not None and self.size == 1:
                    found.add(2 * others + 1 - number)
                else:
                    found |= set(range(others, others + self.size + 1))
        return frozenset(found)


def locate(
    chord: Chord, index: int, outside: frozenset[int], neutral: Neutral, earlier: Neutral
) -> list[Bifurcation]:
    """The bifurcations on a chord in the order of travel.

    Args:
        chord: from point `index` of the branch to the next one.
        index: position of the point in the branch.
        outside: possible numbers of multipliers outside the unit circle before.
        neutral: how many multipliers stay at their places up to the end of the chord.
        earlier: how many did so up to its beginning.
    """
    before, after = chord.before, chord.after
    events = [
        _at_sign_change(chord, kind, neutral) for kind in sign_changes(before, after, neutral)
    ]
    # Every round explains one more multiplier.
    for _ in range(2 * len(before.multipliers)):
        events.sort(key=lambda event: event.distance)
        gap = _unexplained(chord, events, outside, neutral)
        if gap is None:
            break
        low, high, place = gap
        leaving = earlier.circle > neutral.circle
        _join(events, _at_modulus(chord, place, low, high, neutral, leaving=leaving))
    counts = _counts_between(chord, events, outside, neutral)
    return [
        Bifurcation(
            kind=_kind(event),
            point=event.point,
            parameter_error=event.parameter_error,
            after=index,
            crossing=event.crossing,
            outside=(min(ahead), min(behind)),
        )
        for event, (ahead, behind) in zip(events, itertools.pairwise(counts), strict=True)
    ]


def outside_after(
    outside: frozenset[int],
    bifurcations: list[Bifurcation],
    after: BranchPoint,
    neutral: Neutral,
) -> frozenset[int]:
    """Possible numbers of multipliers outside the circle at the next point of a branch.

    Args:
        outside: the numbers at the point before.
        bifurcations: what was located between the two.
        after: the next point.
        neutral: how many multipliers stay at their places up to there.
    """
    possible = counts_outside(after, neutral)
    if bifurcations:
        return possible
    return outside & possible or possible


def _at_sign_change(chord: Chord, kind: BifurcationKind, neutral: Neutral) -> _Event:
    distance, width = chord.root(lambda point: TESTS[kind](point, neutral), 0.0, chord.length)
    point = chord.at(distance)
    centre = -1.0 if kind == "period doubling" else 1.0
    order = _order(point, np.abs(point.multipliers - centre), chord, neutral)
    error = width + _by_nodes(point, chord)
    if kind != "fold":
        ends = (_nearest(end, centre) for end in (chord.before, chord.after))
        error += _spread(chord, float(point.multiplier_errors[order[0]]), *ends)
    return _Event(distance, point, kind, order, 1, error)


def _at_modulus(
    chord: Chord, place: int, low: float, high: float, neutral: Neutral, *, leaving: bool
) -> _Event:
    """Where the modulus at a place in the order of moduli becomes 1.

    One that leaves the circle after it has lain on it all the way does so where its error bound no
    longer reaches back.
    """

    def excess(point: BranchPoint) -> float:
        value, error = _excess_at(place, point, neutral)
        return value - min(error, 1.0) if leaving else value

    distance, width = chord.root(excess, low, high)
    point = chord.at(distance)
    away = np.abs(np.abs(point.multipliers) - 1)
    order = _order(point, away, chord, neutral)
    near = away[list(order)] <= point.multiplier_errors[list(order)] + _ON_CIRCLE
    staying = neutral.circle + (point.trivial_index is not None)
    size = max(1, int(near[: len(near) - staying].sum()))
    ends = (_excess_at(place, end, neutral)[0] for end in (chord.before, chord.after))
    error = width + _by_nodes(point, chord)
    error += _spread(chord, _excess_at(place, point, neutral)[1], *ends)
    return _Event(distance, point, None, order, size, error)


def _excess_at(place: int, point: BranchPoint, neutral: Neutral) -> tuple[float, float]:
    """Modulus less 1 at a place in the order of moduli, and its error bound.

    Where the orbit all but stands still, one multiplier more or less is the trivial one.
    """
    values, errors = sorted_excess(point, neutral)
    if not len(values):
        return 0.0, 0.0
    place = min(place, len(values) - 1)
    return float(values[place]), float(errors[place])


def _nearest(point: BranchPoint, centre: float) -> float:
    """Modulus less 1 of the multiplier nearest a place on the circle."""
    keep = np.arange(len(point.multipliers)) != point.trivial_index
    values = point.multipliers[keep]
    return float(np.abs(values[np.abs(values - centre).argmin()]) - 1)


def _by_nodes(point: BranchPoint, chord: Chord) -> float:
    """Error of the parameter of a collocated orbit: it is one of the unknowns of the correction."""
    return point.state_error * chord.unit


def _spread(chord: Chord, error: float, at_start: float, at_end: float) -> float:
    """Error of the parameter that the error of a modulus makes, by its slope over the chord."""
    change = abs(at_end - at_start)
    if change == 0.0:
        return float("inf")
    return error * abs(chord.after.parameter - chord.before.parameter) / change


def _order(
    point: BranchPoint, distances: FloatArray, chord: Chord, neutral: Neutral
) -> tuple[int, ...]:
    """Multipliers by distance from where they cross; those that do not move, last."""
    order = [int(i) for i in np.argsort(distances, kind="stable")]
    last = _staying(point, chord.before, neutral)
    if point.trivial_index is not None:
        last.append(point.trivial_index)
    return (*(i for i in order if i not in last), *last)


def _staying(point: BranchPoint, before: BranchPoint, neutral: Neutral) -> list[int]:
    """The multipliers that stay on the circle: those nearest to where they were before.

    At a crossing their moduli do not tell them from those that cross.
    """
    then = np.abs(np.abs(before.multipliers) - 1)
    now = np.abs(np.abs(point.multipliers) - 1) <= point.multiplier_errors + _ON_CIRCLE
    if before.trivial_index is not None:
        then[before.trivial_index] = np.inf
    if point.trivial_index is not None:
        now[point.trivial_index] = False
    found: list[int] = []
    for place in before.multipliers[np.argsort(then, kind="stable")[: neutral.circle]]:
        left = [int(i) for i in np.flatnonzero(now) if int(i) not in found]
        if left:
            found.append(min(left, key=lambda i: float(abs(point.multipliers[i] - place))))
    return found


def _counts_between(
    chord: Chord, events: list[_Event], outside: frozenset[int], neutral: Neutral
) -> list[frozenset[int]]:
    """Possible numbers outside before, between and after the events.

    Where nothing fits, as with error bounds that are too small, the numbers at the chord's end.
    """
    last = counts_outside(chord.after, neutral)
    counts = [outside]
    for event in events:
        counts.append(event.across(counts[-1], neutral) or last)
    counts[-1] = counts[-1] & last or last
    for i in range(len(events) - 1, -1, -1):
        counts[i] = counts[i] & events[i].across(counts[i + 1], neutral) or counts[i]
    return counts


def _unexplained(
    chord: Chord, events: list[_Event], outside: frozenset[int], neutral: Neutral
) -> tuple[float, float, int] | None:
    """The first piece of the chord over which the number outside changes without an event.

    Returns:
        Where it begins and ends, and the place in the order of moduli that crosses in it.
    """
    now, low = outside, 0.0
    for event in events:
        ahead = event.across(now, neutral)
        if not ahead:
            whole = frozenset(range(len(event.point.multipliers) + 1))
            return low, event.distance, _place(now, event.across(whole, neutral))
        now, low = ahead, event.distance
    possible = counts_outside(chord.after, neutral)
    return None if now & possible else (low, chord.length, _place(now, possible))


def _place(one: frozenset[int], other: frozenset[int]) -> int:
    return min(min(pair) for pair in _closest(one, other))


def _closest(one: frozenset[int], other: frozenset[int]) -> list[tuple[int, int]]:
    pairs = list(itertools.product(one, other))
    least = min(abs(a - b) for a, b in pairs)
    return [(a, b) for a, b in pairs if abs(a - b) == least]


def _join(events: list[_Event], new: _Event) -> None:
    """Add an event, or count its multiplier to the event that is there already."""
    for i, event in enumerate(events):
        if abs(event.distance - new.distance) <= _TOGETHER:
            size = min(max(event.size + 1, new.size), len(event.order))
            error = max(event.parameter_error, new.parameter_error)
            events[i] = replace(event, size=size, parameter_error=error)
            return
    events.append(new)


def _kind(event: _Event) -> BifurcationKind:
    """The name of what crosses, "multiple" if it is more than a name says."""
    values = event.point.multipliers[list(event.order[: event.size])]
    errors = event.point.multiplier_errors[list(event.order[: event.size])]
    real = np.abs(values.imag) <= errors + _REAL
    if event.kind == "fold":
        return "fold"
    if event.size == 1 and real[0]:
        return event.kind or ("branch point" if values[0].real > 0 else "period doubling")
    pair = event.size == 2 and abs(values[0] - values[1].conjugate()) <= errors.sum() + _REAL
    return "Neimark-Sacker" if pair and not real.any() else "multiple"
