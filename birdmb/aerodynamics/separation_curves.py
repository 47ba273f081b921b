"""Steady loads of a section whose flow separates, as curves over its incidence.

A section whose flow is attached over the share f of its chord, from the leading edge, has the loads

    f (attached) + (1 - f) (separated):

attached, the lift a (alpha - alpha_0) across the wind, drag by friction alone, and the moment of
its profile; separated, a force normal to the chord, for suction at the leading edge is lost. The
curve f_st(alpha) of steady flow is given by

- a polar: of its lift by Kirchhoff's theory of the flow with a free streamline,
  C_L = a (alpha - alpha_0) ((1 + sqrt(f))/2)^2, and the lift of the separated section follows from
  that the sum must be the polar's (M. H. Hansen, M. Gaunaa & H. A. Madsen, Riso-R-1354, 2004).
  Steady loads are those of the polar;
- or a stall angle: f_st = (1 - tanh((|alpha - alpha_0| - stall angle)/width))/2, the separated
  section having the normal force C_90 |sin(alpha)|, as plates have (S. F. Hoerner, Fluid-Dynamic
  Drag, 1965: C_90 = 1.98).

The centre of pressure of the separated section is that of Rayleigh's plate, 3/4 cos(alpha)/(4 + pi
sin(alpha)) of the chord ahead of its middle (H. Lamb, Hydrodynamics, section 77).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from birdmb._typing import FloatArray, IntArray
from birdmb.topology import Polar, Profile, Stall

COUNT = 720  # angles of a curve, of once around: those of polars mostly are among them
STEP = 2.0 * np.pi / COUNT
# Nearer to zero lift no ratio of lifts is told, and flow is attached; between, ever more as told.
_ATTACHED, _TOLD = np.radians(1.0), np.radians(4.0)
_PLATE_STEP = np.radians(15.0)  # of the plate's angles beyond those of a polar
_USUAL = Stall()


class SeparationCurves(NamedTuple):
    """Curves of T sections, periodic, at `COUNT` incidences from that of zero lift minus pi.

    Of which there are six: f_st; lift of the separated section; drag and moment that the polar has
    beyond those of attached flow; and what the separated section has of both beyond the attached.
    """

    of: IntArray  # (K,) which of the curves each section has; empty where no flow separates
    between: FloatArray  # (N, K), of values at the K sections to all elements, without overshoot
    values: FloatArray  # (T, COUNT, 6)
    slopes: FloatArray  # (T, COUNT, 6) 1/rad
    time_constant: FloatArray  # (T,) chords travelled


def attached_flow(elements: int) -> SeparationCurves:
    """The curves of a wing of so many elements whose flow never separates: none."""
    none = np.empty((0, COUNT, 6))
    return SeparationCurves(
        np.empty(0, np.int64), np.empty((elements, 0)), none, none.copy(), np.empty(0)
    )


def separation_curves(
    profiles: Sequence[Profile], places: FloatArray, kept: IntArray, elements: int
) -> SeparationCurves:
    """Curves of the sections at the elements `kept` (K,), of a wing of so many `elements`.

    The sections' `places` (K,) are among the `profiles`, 1.3 after a third of the way from the
    second one to the third.
    """
    each = np.array([_curves_of(profile) for profile in profiles])
    lags = np.array([(profile.stall or _USUAL).time_constant for profile in profiles])
    distinct, of = np.unique(places, return_inverse=True)
    before = np.clip(distinct.astype(np.int64), 0, len(profiles) - 1)
    after = np.minimum(before + 1, len(profiles) - 1)
    share = (distinct - before)[:, None, None]
    values = (1.0 - share) * each[before] + share * each[after]
    # One more row closes the curve.
    around = np.concatenate([values, values[:, :1]], axis=1)
    spline = CubicSpline(STEP * np.arange(COUNT + 1), around, axis=1, bc_type="periodic")
    between = [np.interp(np.arange(elements), kept, row) for row in np.eye(kept.size)]
    return SeparationCurves(
        of.astype(np.int64),
        np.ascontiguousarray(np.transpose(between)),
        np.ascontiguousarray(values),
        np.ascontiguousarray(spline(STEP * np.arange(COUNT), 1)),
        np.interp(distinct, np.arange(len(profiles)), lags),
    )


def _curves_of(profile: Profile) -> FloatArray:
    """The six curves (COUNT, 6) of a profile, by the incidence from zero lift."""
    incidence = np.linspace(-np.pi, np.pi, COUNT, endpoint=False)
    angle: FloatArray = incidence + profile.zero_lift_angle
    stall = profile.stall or _USUAL
    lift: FloatArray = profile.lift_slope * incidence
    found = np.zeros((COUNT, 6))
    if profile.polar is not None:
        around = _around(profile.polar, stall)
        of_polar, friction = around(_wrapped(angle)), around(profile.zero_lift_angle)[1]
        found[:, 0] = _attached_share(incidence, of_polar[:, 0], lift)
        root = np.sqrt(found[:, 0])
        by_kirchhoff = lift * (1.0 + 3.0 * root) / (4.0 * (1.0 + root))
        found[:, 1] = np.where(root > 0.0, by_kirchhoff, of_polar[:, 0])
        beyond = of_polar[:, 1] - friction
        normal = found[:, 1] * np.cos(angle) + beyond * np.sin(angle)
    else:
        normal = _plate(angle, stall)
        found[:, 0] = 1.0
        if stall.angle is not None:
            found[:, 0] = 0.5 * (1.0 - np.tanh((np.abs(incidence) - stall.angle) / stall.width))
        found[:, 1] = normal * np.cos(angle)
    found[:, 3] = np.maximum(normal * np.sin(angle), 0.0)
    found[:, 5] = -normal * _lever(angle) - profile.moment_coefficient
    found[:, 2] = (1.0 - found[:, 0]) * found[:, 3]
    found[:, 4] = (1.0 - found[:, 0]) * found[:, 5]
    if profile.polar is not None:
        found[:, 2] = of_polar[:, 1]
        if profile.polar.moment:
            found[:, 4] = of_polar[:, 2] - profile.moment_coefficient
    return found


def _attached_share(incidence: FloatArray, lift: FloatArray, attached: FloatArray) -> FloatArray:
    """Kirchhoff's f of lifts (G,) that in attached flow would be `attached` (G,)."""
    told = np.clip((np.abs(incidence) - _ATTACHED) / (_TOLD - _ATTACHED), 0.0, 1.0)
    told *= told * (3.0 - 2.0 * told)
    ratio = np.divide(lift, attached, out=np.ones_like(lift), where=np.abs(incidence) > _ATTACHED)
    ratio = 1.0 + told * (ratio - 1.0)
    return np.clip(2.0 * np.sqrt(np.maximum(ratio, 0.25)) - 1.0, 0.0, 1.0) ** 2


def _plate(angle: FloatArray, stall: Stall) -> FloatArray:
    """Normal force coefficients (G,) of a separated section."""
    return stall.normal_coefficient * np.sin(angle)


def _lever(angle: FloatArray) -> FloatArray:
    """Distances (G,) of the separated section's centre of pressure behind the quarter chord."""
    ahead = 0.75 * np.cos(angle) / (4.0 + np.pi * np.abs(np.sin(angle)))
    return np.asarray(0.25 - ahead)


def _wrapped(angle: FloatArray) -> FloatArray:
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _around(polar: Polar, stall: Stall) -> PchipInterpolator:
    """Lift, drag and moment (.., 3) of a polar at any angle from -pi to pi.

    Far beyond its ends those of a separated plate.
    """
    angle = np.array(polar.angle)
    rows = np.column_stack([polar.lift, polar.drag, polar.moment or np.zeros(angle.size)])
    plate = _PLATE_STEP * np.arange(-12, 12)
    above, below = (plate - angle[-1]) % (2.0 * np.pi), (angle[0] - plate) % (2.0 * np.pi)
    within = (plate >= angle[0]) & (plate <= angle[-1])
    plate = plate[~within & (np.minimum(above, below) > _PLATE_STEP)]
    normal = _plate(plate, stall)
    of_plate = np.column_stack(
        [
            normal * np.cos(plate),
            normal * np.sin(plate) + rows[:, 1].min(),
            -normal * _lever(plate),
        ]
    )
    angle = np.concatenate([angle, plate])
    order = np.argsort(angle)
    angle, rows = angle[order], np.concatenate([rows, of_plate])[order]
    if angle[-1] - angle[0] > 2.0 * np.pi - 1e-9:  # both ends are the same direction
        angle, rows = angle[:-1], rows[:-1]
    turns = 2.0 * np.pi * np.arange(-1, 2)
    return PchipInterpolator(
        np.concatenate([angle + turn for turn in turns]), np.tile(rows, (3, 1))
    )
