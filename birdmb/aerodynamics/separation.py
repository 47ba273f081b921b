"""Separated flow over the sections of a wing, with a memory of its own (compiled kernels).

One state a section, the share f of its chord over which flow is attached, follows that of steady
flow (S. Oye, Dynamic stall simulated as time lag of separation, 4th IEA Symposium on the
Aerodynamics of Wind Turbines, 1991),

    f' = (f_st(alpha_E) - f) V/(A c),    A = `time_constant`, about 4 chords,

and the section's lift, drag and moment are the sums of attached and separated flow of
`birdmb.aerodynamics.separation_curves`, weighted with f:

    C_L = f a (alpha_E - alpha_0) + (1 - f) C_L,sep(alpha_E),
    C_D = C_D,st(alpha_E) + (f_st - f) C_N,sep sin(alpha_E),   C_M likewise.

alpha_E is the effective angle of attack: alpha_0 + w_E/V, w_E the normal velocity that lifts once
the wake's lags and the downwash have acted on it. (M. Goman & A. Khrabrov, Journal of Aircraft 31,
1994, also shift alpha by its rate. That shift is what the lags of the wake make here, and would
need the accelerations.)

The lift that separation costs is circulation, Gamma = Gamma_attached - lost: the wing sheds and
trails what is left, so that the downwash is that of the lift there is, and lift stays normal to the
wind with all that the wake induces: what it dissipates, the wake has. Loss of suction is drag,
along the effective wind in the section's plane, and dissipates where f < 1. The circulation lost
follows along the span, like the wake's lags, the spline through the sections kept: what of the
circulation acts at once, which that spline misses, is then that of attached flow, and the equations
of the circulations stay linear. Where all sections are kept steady loads are those of the polar on
every section.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.elements import Elements
from birdmb.aerodynamics.separation_curves import COUNT, STEP, SeparationCurves


class Separation(NamedTuple):
    """What separated flow does to M elements of S sides, with derivatives."""

    lost: FloatArray  # (M, 1 + D) m2/s, bound circulation
    section: FloatArray  # (M, 3, 1 + D) drag, moment, effective angle from zero lift in rad
    rates: FloatArray  # (S K, 1 + D) 1/s, of the attached shares


@kernel
def no_separation() -> Separation:
    """What attached flow has of it: nothing, of no element."""
    return Separation(np.empty((0, 0)), np.empty((0, 3, 0)), np.empty((0, 0)))


@kernel
def curves_at(
    curves: SeparationCurves, which: int, incidence: float, found: FloatArray, slopes: FloatArray
) -> None:
    """Write the six values of a section's curves at an incidence (rad), and their slopes."""
    if not np.isfinite(incidence):
        for c in range(found.size):
            found[c], slopes[c] = np.nan, np.nan
        return
    position = (incidence + np.pi) / STEP
    cell = np.floor(position)
    x = position - cell
    i = int(cell % COUNT)
    j = (i + 1) % COUNT
    for c in range(found.size):
        start, end = curves.values[which, i, c], curves.values[which, j, c]
        rise, last = STEP * curves.slopes[which, i, c], STEP * curves.slopes[which, j, c]
        square, cube = 3.0 * (end - start) - 2.0 * rise - last, 2.0 * (start - end) + rise + last
        found[c] = start + x * (rise + x * (square + x * cube))
        slopes[c] = (rise + x * (2.0 * square + x * 3.0 * cube)) / STEP


@kernel
def separated_flow(
    curves: SeparationCurves,
    kept: IntArray,
    spread: FloatArray,
    per_velocity: FloatArray,
    chord: FloatArray,
    lifting: FloatArray,
    speed: FloatArray,
    attached: FloatArray,
    first: int,
    stride: int,
) -> Separation:
    """Circulation and coefficients of M elements with `attached` shares (S K,) at those `kept`.

    `lifting` (M, 1 + D) m/s are the normal velocities that lift, `speed` (M, 1 + d) m/s those along
    the stream; the columns of the shares of each side begin at the `first`, and `stride` later.
    """
    n, points = spread.shape
    m, columns = lifting.shape
    given = speed.shape[1]
    lost, section = np.empty((m, columns)), np.empty((m, 3, columns))
    rates = np.empty((attached.size, columns))
    lost_there, drag, moment = (
        np.empty((points, columns)),
        np.empty((points, columns)),
        np.empty((points, columns)),
    )
    found, slopes = np.empty(6), np.empty(6)
    along = np.zeros(columns)
    for side in range(m // n):
        for k in range(points):
            i, which, own = side * n + kept[k], curves.of[k], side * points + k
            along[:given] = speed[i]
            velocity, lift = along[0], lifting[i, 0]
            incidence, share = lift / velocity, attached[own]
            curves_at(curves, which, incidence, found, slopes)
            ahead = found[0] - share
            per_distance = 1.0 / (curves.time_constant[which] * chord[i])
            half = 0.5 * chord[i]
            apart = per_velocity[i] * lift - half * velocity * found[1]
            lost_there[k, 0] = (1.0 - share) * apart
            drag[k, 0] = found[2] + ahead * found[3]
            moment[k, 0] = found[4] + ahead * found[5]
            rates[own, 0] = per_distance * velocity * ahead
            drag_slope = slopes[2] + slopes[0] * found[3] + ahead * slopes[3]
            moment_slope = slopes[4] + slopes[0] * found[5] + ahead * slopes[5]
            for c in range(1, columns):
                turn = (lifting[i, c] - incidence * along[c]) / velocity
                change = per_velocity[i] * lifting[i, c]
                change -= half * (along[c] * found[1] + velocity * slopes[1] * turn)
                lost_there[k, c] = (1.0 - share) * change
                drag[k, c] = drag_slope * turn
                moment[k, c] = moment_slope * turn
                rates[own, c] = per_distance * (along[c] * ahead + velocity * slopes[0] * turn)
            if columns > given:
                c = first + side * stride + k
                lost_there[k, c] -= apart
                drag[k, c] -= found[3]
                moment[k, c] -= found[5]
                rates[own, c] -= per_distance * velocity
        rows = slice(side * n, (side + 1) * n)
        lost[rows] = spread @ lost_there
        section[rows, 0], section[rows, 1] = curves.between @ drag, curves.between @ moment
    for i in range(m):
        along[:given] = speed[i]
        for c in range(columns):
            change = lifting[i, c]
            if c > 0:
                change -= section[i, 2, 0] * along[c]
            section[i, 2, c] = change / along[0]
    return Separation(lost, section, rates)


@kernel
def section_wrenches(
    elements: Elements, speed: FloatArray, section: FloatArray, density: float
) -> FloatArray:
    """Forces (N) and moments (N m), (N, 6, 1 + D), of drag and moment of N sections.

    `speed` (N, 1 + d) m/s is that of the air along them, `section` (N, 3, 1 + D) as `Separation`
    has it. Drag is along the effective wind in the section's plane.
    """
    n, _, columns = section.shape
    loads = np.empty((n, 6, columns))
    for e in range(n):
        velocity, angle = speed[e, 0], section[e, 2, 0] + elements.profile[e, 1]
        scale = 0.5 * density * elements.chord[e] * elements.width[e]
        back, rising = np.cos(angle), np.sin(angle)
        drag, moment = section[e, 0, 0], elements.chord[e] * section[e, 1, 0]
        for c in range(columns):
            pressure = scale * velocity * velocity
            force, turning, across = pressure * drag, pressure * moment, 0.0
            if c > 0:
                push = 2.0 * scale * velocity * (speed[e, c] if c < speed.shape[1] else 0.0)
                across = pressure * drag * section[e, 2, c]
                force = push * drag + pressure * section[e, 0, c]
                turning = push * moment + pressure * elements.chord[e] * section[e, 1, c]
            for i in range(3):
                chord, normal = elements.chord_direction[e, i], elements.normal[e, i]
                loads[e, i, c] = force * (back * chord + rising * normal)
                loads[e, i, c] += across * (back * normal - rising * chord)
                loads[e, 3 + i, c] = turning * elements.span_direction[e, i]
    return loads
