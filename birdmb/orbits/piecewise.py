"""Collocation of a periodic orbit by polynomials on the intervals of a mesh.

On each of J intervals of the period the orbit is a polynomial through its state at the beginning
and at M Gauss points, where it satisfies the right-hand side; it is continuous from one interval to
the next. Sources: Ascher, Mattheij & Russell, Numerical Solution of Boundary Value Problems (1995),
chapter 5; Doedel, Keller & Kernevez (1991).
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.sparse as sp
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

from birdmb._typing import FloatArray, IntArray
from birdmb.errors import StateError
from birdmb.orbits.right_hand_side import RightHandSide

STAGES = 4
_EPS = float(np.finfo(float).eps)
_NOISE = 100.0
# By how much the defects of both halves of an interval differ where it holds a kink.
_KINK = 4.0
# Part of the largest rate that two neighbouring Gauss points on a fine mesh differ by at a jump.
_JUMP = 0.02
_MOST_PARTS, _FEWEST_PARTS = 16, 0.25


def _basis() -> tuple[FloatArray, FloatArray, list[Polynomial]]:
    """Gauss points and weights (M,) on [0, 1], and Lagrange's polynomials of 0 and these."""
    points, weights = leggauss(STAGES)
    places = np.append(0.0, 0.5 * (points + 1.0))
    lagrange = []
    for k, place in enumerate(places):
        others = np.delete(places, k)
        lagrange.append(Polynomial.fromroots(others) / np.prod(place - others))
    return places[1:], 0.5 * weights, lagrange


GAUSS, _WEIGHTS, _LAGRANGE = _basis()
# From values at 0 and the Gauss points: slopes (M, M + 1) there, and the value (M + 1,) at the end.
_SLOPES = np.column_stack([p.deriv()(GAUSS) for p in _LAGRANGE])
_END = np.array([p(1.0) for p in _LAGRANGE])
# The same to the slopes (M + 1,) at the beginning and at the end.
_FIRST_SLOPE, _LAST_SLOPE = (np.array([p.deriv()(at) for p in _LAGRANGE]) for at in (0.0, 1.0))


def _values_at(places: FloatArray) -> FloatArray:
    """Matrix (K, M + 1) from values at 0 and the Gauss points to those at `places` (K,)."""
    return np.column_stack([p(places) for p in _LAGRANGE])


@dataclass(frozen=True)
class PiecewisePath:
    """A closed path by a polynomial on each interval of a mesh.

    Attributes:
        mesh: phases (J + 1,) from 0 to 1 between which the intervals lie.
        values: states (J, M + 1, n) at the beginning and at the Gauss points of each interval.
    """

    mesh: FloatArray
    values: FloatArray

    def states(self, phases: FloatArray) -> FloatArray:
        """States (K, n) at `phases` (K,), any."""
        phase = np.mod(phases, 1.0)
        interval = np.clip(
            np.searchsorted(self.mesh, phase, side="right") - 1, 0, len(self.values) - 1
        )
        width = np.diff(self.mesh)[interval]
        weights = _values_at((phase - self.mesh[interval]) / width)
        return np.einsum("ks,ksn->kn", weights, self.values[interval])

    def on(self, mesh: FloatArray) -> PiecewisePath:
        """The path with its values on another mesh."""
        inside = np.append(0.0, GAUSS)
        phases = mesh[:-1, None] + np.diff(mesh)[:, None] * inside
        states = self.states(phases.ravel())
        return PiecewisePath(mesh, states.reshape(len(mesh) - 1, len(inside), -1))


@dataclass
class _Latest:
    """The rates that were evaluated last: a residual and a Jacobian at one point share them."""

    key: bytes = b""
    rates: FloatArray = field(default_factory=lambda: np.empty(0))


@dataclass(frozen=True)
class PiecewiseEquations:
    """The slopes of the polynomials are those of the right-hand side, and they meet.

    Unknowns: the scaled states (J, M + 1, n) of a `PiecewisePath` and, of an autonomous system, the
    period in units of `period`. Residual: the mismatch of slopes by phase at each Gauss point,
    weighed so that the sum of squares is its mean square over the period, then the gaps from one
    interval to the next. The phase of an autonomous orbit is fixed as in `CollocationEquations`.
    """

    rhs: RightHandSide
    start: float
    period: float
    autonomous: bool
    mesh: FloatArray
    latest: _Latest = field(default_factory=_Latest, repr=False, compare=False)

    expensive_jacobian = True

    @property
    def intervals(self) -> int:
        """Number J of intervals."""
        return len(self.mesh) - 1

    @property
    def widths(self) -> FloatArray:
        """Parts (J,) of the period that the intervals take."""
        return np.diff(self.mesh)

    def on_mesh(self, mesh: FloatArray, u: FloatArray) -> tuple[PiecewiseEquations, FloatArray]:
        """The same equations and unknowns on another mesh."""
        values, period = self.unpack(u)
        other = replace(self, mesh=mesh, latest=_Latest())
        return other, other.pack(PiecewisePath(self.mesh, values).on(mesh).values, period)

    def pack(self, values: FloatArray, period: float) -> FloatArray:
        """Unknowns of scaled states (J, M + 1, n)."""
        return (
            np.append(values.ravel(), period / self.period) if self.autonomous else values.ravel()
        )

    def unpack(self, u: FloatArray) -> tuple[FloatArray, float]:
        """Scaled states (J, M + 1, n) and period of the unknowns."""
        period = self.period
        if self.autonomous:
            u, period = u[:-1], float(u[-1]) * self.period
        return u.reshape(self.intervals, STAGES + 1, -1), period

    def times(self, period: float) -> FloatArray:
        """Times (J M,) of the Gauss points in s."""
        phases = self.mesh[:-1, None] + self.widths[:, None] * GAUSS
        return self.start + period * phases.ravel()

    def start_and_period(self, u: FloatArray) -> tuple[FloatArray, float]:
        """State (n,) at the start, in its own units, and the period."""
        values, period = self.unpack(u)
        return values[0, 0] * self.rhs.scale, period

    def rates(self, values: FloatArray, period: float) -> FloatArray:
        """Rates (J, M, n) of scaled states per second at the Gauss points; raises `StateError`."""
        at = np.ascontiguousarray(values[:, 1:])
        key = at.tobytes() + np.float64(period).tobytes()
        if self.latest.key != key:
            flat = at.reshape(-1, at.shape[-1])
            self.latest.rates = self.rhs.rates(self.times(period), flat).reshape(at.shape)
            self.latest.key = key
        return self.latest.rates

    def mismatch(self, u: FloatArray) -> FloatArray:
        """Slopes by phase at the Gauss points minus those of the right-hand side, (J, M, n)."""
        values, period = self.unpack(u)
        if not period > 0:
            raise StateError(f"The period {period:.6g} is not positive.")
        slopes = np.einsum("is,jsn->jin", _SLOPES, values) / self.widths[:, None, None]
        return np.asarray(slopes - period * self.rates(values, period))

    def unseen(self, u: FloatArray) -> FloatArray:
        """What jumps of the slopes from one interval to the next may hide, (J, n).

        A right-hand side that jumps beside a border, beyond the nearest Gauss points, looks as if
        it jumped there: the state may be off by the jump times the way between them.
        """
        values, _ = self.unpack(u)
        widths = self.widths[:, None]
        last = np.einsum("s,jsn->jn", _LAST_SLOPE, values) / widths
        first = np.einsum("s,jsn->jn", _FIRST_SLOPE, values) / widths
        jumps = np.roll(first, -1, axis=0) - last
        return np.asarray(jumps * GAUSS[0] * np.maximum(widths, np.roll(widths, -1, axis=0)))

    def jumps_by_state(self, u: FloatArray) -> float | None:
        """Time in s of a jump of the slopes that the states cause, not the time; `None` if none.

        Held at the state of a border, the right-hand side jumps there from the Gauss point before
        to the one after if time makes it jump.
        """
        values, period = self.unpack(u)
        widths = self.widths
        rates = period * self.rates(values, period)
        before, after = rates[:, -1], np.roll(rates[:, 0], -1, axis=0)
        jumps = np.abs(after - before).max(axis=1)
        size = float(np.abs(rates).max())
        found = np.flatnonzero(jumps > _JUMP * size)
        if not found.size:
            return None
        states = np.roll(values[:, 0], -1, axis=0)[found]
        border = self.mesh[1:][found]
        back, on = widths[found] * GAUSS[0], np.roll(widths, -1)[found] * GAUSS[0]
        times = [self.start + period * phases for phases in (border - back, border + on)]
        held = [period * self.rhs.rates(at, states) for at in times]
        by_time = np.abs(held[1] - held[0]).max(axis=1)
        guilty = np.flatnonzero(by_time < 0.5 * jumps[found])
        return None if not guilty.size else float(self.start + period * border[guilty[0]])

    def as_gaps(self, gaps: FloatArray) -> FloatArray:
        """A residual that consists of gaps (J, n) between the intervals."""
        found = np.zeros((self.intervals, STAGES + 1, gaps.shape[1]))
        found[:, -1] = gaps
        return np.append(found.ravel(), 0.0) if self.autonomous else found.ravel()

    def residual(self, u: FloatArray) -> FloatArray:
        """Weighed mismatch of slopes and gaps; StateError where the right-hand side fails."""
        values, _ = self.unpack(u)
        ends = np.einsum("s,jsn->jn", _END, values)
        gaps = ends - np.roll(values[:, 0], -1, axis=0)
        weighed = self._weights[:, :, None] * self.mismatch(u)
        found = np.concatenate([weighed, gaps[:, None]], axis=1).ravel()
        return np.append(found, 0.0) if self.autonomous else found

    @property
    def _weights(self) -> FloatArray:
        return np.sqrt(np.outer(self.widths, _WEIGHTS))

    def closure(self, residual: FloatArray) -> float:
        """Largest mismatch of slopes, in the units of the states per period."""
        gaps = residual[:-1] if self.autonomous else residual
        slopes = gaps.reshape(self.intervals, STAGES + 1, -1)[:, :-1] / self._weights[:, :, None]
        return float(np.abs(slopes * self.rhs.scale).max())

    def rate_jacobians(self, u: FloatArray) -> FloatArray:
        """Derivatives (J, M, n, n) of the rates by the scaled states at the Gauss points."""
        values, period = self.unpack(u)
        at = values[:, 1:]
        found = self.rhs.jacobians(self.times(period), at.reshape(-1, at.shape[-1]))
        return found.reshape(*at.shape, at.shape[-1])

    def derivative_gap(self, u: FloatArray) -> float:
        """By how much a derivative that the model gives contradicts differences; 0 if it agrees."""
        values, period = self.unpack(u)
        states = values[:, 1:].reshape(-1, values.shape[-1])
        return self.rhs.derivative_gap(self.times(period), states)

    def jacobian(self, u: FloatArray) -> sp.csc_array:
        """Derivative of the residual."""
        values, period = self.unpack(u)
        count, places, n = values.shape
        slopes = period * self.rate_jacobians(u)
        unit = np.eye(n)
        blocks = np.zeros((count, places, n, places, n))
        shape = _SLOPES[:, None, :, None] * unit[None, :, None, :]
        blocks[:, :-1] = shape / self.widths[:, None, None, None, None]
        for i in range(STAGES):
            blocks[:, i, :, i + 1] -= slopes[:, i]
        blocks[:, :-1] *= self._weights[:, :, None, None, None]
        blocks[:, -1] = (_END[None, :, None] * unit[:, None, :])[None]
        size = places * n
        first = np.arange(count)[:, None] * size
        own = first[:, :, None] + np.arange(size)
        rows = np.broadcast_to(np.swapaxes(own, 1, 2), (count, size, size))
        columns = np.broadcast_to(own, (count, size, size))
        end = (first + STAGES * n + np.arange(n)).ravel()
        beginning = (np.roll(first, -1, axis=0) + np.arange(n)).ravel()
        entries = [blocks.ravel(), -np.ones(end.size)]
        at_rows, at_columns = [rows.ravel(), end], [columns.ravel(), beginning]
        if self.autonomous:
            rates = self.rates(values, period)
            stretch, phase = np.zeros(values.shape), np.zeros(values.shape)
            stretch[:, :-1] = -self.period * self._weights[:, :, None] * rates
            phase[:, 1:] = rates / (np.linalg.norm(rates) or 1.0)
            last, every = np.full(values.size, values.size), np.arange(values.size)
            entries += [stretch.ravel(), phase.ravel()]
            at_rows += [every, last]
            at_columns += [last, every]
        total = values.size + int(self.autonomous)
        places_of = np.concatenate(at_rows), np.concatenate(at_columns)
        return sp.csc_array((np.concatenate(entries), places_of), shape=(total, total))

    def round_off(self, u: FloatArray) -> float:
        """Norm that round-off leaves of the residual."""
        values, period = self.unpack(u)
        rates = period * np.abs(self.rates(values, period)).max()
        largest = np.abs(values).max() / float(self.widths.min()) ** 0.5 + rates
        return float(_NOISE * _EPS * largest)

    def transfers(self, period: float, rate_jacobians: FloatArray) -> FloatArray:
        """Derivatives (J, n, n) of the state at each interval's end by that at its beginning."""
        count, _, n, _ = rate_jacobians.shape
        size = STAGES * n
        unit = np.eye(n)
        inner = np.zeros((count, STAGES, n, STAGES, n))
        inner += (_SLOPES[:, None, 1:, None] * unit[None, :, None, :])[None]
        for i in range(STAGES):
            inner[:, i, :, i] -= period * self.widths[:, None, None] * rate_jacobians[:, i]
        outer = np.broadcast_to(_SLOPES[:, 0, None, None] * unit, (count, STAGES, n, n))
        stages = -np.linalg.solve(
            inner.reshape(count, size, size), outer.reshape(count, size, n)
        ).reshape(count, STAGES, n, n)
        return np.asarray(_END[0] * unit + np.einsum("s,jsab->jab", _END[1:], stages))


def uniform(intervals: int) -> FloatArray:
    """Mesh (J + 1,) of equal intervals."""
    return np.arange(intervals + 1) / intervals


def split(mesh: FloatArray, parts: IntArray) -> FloatArray:
    """The mesh with its intervals cut into so many equal `parts` (J,) each."""
    pieces = [
        np.linspace(low, high, count, endpoint=False)
        for low, high, count in zip(mesh[:-1], mesh[1:], parts.tolist(), strict=True)
    ]
    return np.append(np.concatenate(pieces), 1.0)


def mesh_along(path: FloatArray, mesh: FloatArray) -> FloatArray:
    """The mesh cut where a closed path (K, n) at even instants goes further than elsewhere."""
    ways = np.linalg.norm(np.roll(path, -1, axis=0) - path, axis=1)
    covered = np.append(0.0, np.cumsum(ways))
    at_borders = np.interp(mesh, np.linspace(0.0, 1.0, covered.size), covered)
    mean = max(covered[-1] / (len(mesh) - 1), np.finfo(float).tiny)
    return split(mesh, np.clip(np.ceil(np.diff(at_borders) / mean), 1, _MOST_PARTS).astype(int))


def parts_for(halves: FloatArray, goal: float) -> FloatArray:
    """How many intervals (J,) it takes in place of each so that their defects come to a `goal`.

    Parts of one where an interval may be longer. `halves` (J, 2) are the defects of both halves of
    each. A defect falls with the width to the power of M + 1 where the orbit is smooth; where one
    half has far more of it than the other there is a kink or a jump, beside which it falls with the
    width itself.
    """
    largest, least = halves.max(axis=1), halves.min(axis=1)
    rough = largest > _KINK * least
    order = np.where(rough & (largest > goal), 1.0, STAGES + 1.0)
    return np.clip((largest / goal) ** (1.0 / order), _FEWEST_PARTS, _MOST_PARTS)


def redistributed(mesh: FloatArray, parts: FloatArray, borders: FloatArray) -> FloatArray:
    """A mesh with about so many intervals in place of each as `parts` (J,) says.

    The phases `borders` (P + 1,), which the mesh has, stay in it.
    """
    wanted = np.append(0.0, np.cumsum(parts))
    pieces = []
    for low, high in itertools.pairwise(np.interp(borders, mesh, wanted).tolist()):
        count = max(1, math.ceil(high - low))
        pieces.append(np.interp(np.linspace(low, high, count, endpoint=False), wanted, mesh))
    found = np.append(np.concatenate(pieces), 1.0)
    starts = np.cumsum([0, *(len(piece) for piece in pieces[:-1])])
    found[starts] = borders[:-1]
    return found
