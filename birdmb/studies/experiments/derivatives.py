"""Derivatives and span loading of a plane wing, against a vortex lattice.

A flat, tapered wing twisted by 2 degrees, at 1 degree of incidence, in stability axes: M. Drela and
H. Youngren's AVL with 12 equal strips a half wing and one panel along the chord, its wake along the
body's x axis. One panel has no camber by the rate of pitch, which thin-airfoil theory has.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.apparent_mass import apparent_inertia, body_twists, inertia_matrix
from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_loads, pair_system, pair_wrench
from birdmb.aerodynamics.section_motion import section_motion
from birdmb.aerodynamics.twist_loads import wing_wrench
from birdmb.aerodynamics.unsteady_circulation import lag_system, unsteady_circulations
from birdmb.aerodynamics.unsteady_loads import side_flow, side_wrenches
from birdmb.aerodynamics.wake_lags import wake_lags
from birdmb.studies.experiments.comparison import QUASI_STEADY, UNSTEADY, Comparison, Experiment
from birdmb.studies.moving_wing.plane_wing import PlaneWing, lifting_line
from birdmb.wing.shape import WingShape

Wrench = Callable[[FloatArray], FloatArray]

WING = PlaneWing(
    (0.0, 7.5), (2.2, 1.8), leading_edges=(0.0, 0.4), twists=(np.radians(2.0), np.radians(2.0))
)
AREA, CHORD, SPAN, MOMENTS_AT = 30.0, 2.0, 15.0, 0.5
ALPHA = np.radians(1.0)
AVL = {
    "CL_alpha": 4.638, "Cm_alpha": -0.4292, "Cm_q": -0.5171, "Cl_beta": -0.02575,
    "Cn_beta": 0.00047, "Cl_p": -0.5187, "Cn_p": -0.01985, "Cl_r": 0.06424, "Cn_r": -0.00090,
}  # fmt: skip
# From the root, at the middle of each strip.
AVL_SECTION_LIFT = (
    0.2618, 0.2646, 0.2661, 0.2664, 0.2654, 0.2628, 0.2584, 0.2513, 0.2404, 0.2233, 0.1952, 0.1434,
)  # fmt: skip
_WAKE_POINTS = 6
_STEP = 1e-4
_MIRROR = np.diag([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
LINE = lifting_line(WING, 48, MOMENTS_AT / WING.chords[0])
_NO_DIRECTIONS = np.empty(0, np.int64)


def quasi_steady_wrench(line: WingShape) -> Wrench:
    """Wrench by twist (6,) of a wing with the wind at its quarter chords; air of density 1."""
    placed = place_elements(line, np.zeros(3))

    def wrench(twist: FloatArray) -> FloatArray:
        both = pair_loads(placed, placed, False, 1.0, 0.0, twist)
        right, left = (wing_wrench(placed.position, one.wrench[:, :, None]) for one in both)
        return np.asarray(pair_wrench(right, left)[:, 0])

    return wrench


def settled_wrench(line: WingShape) -> Wrench:
    """Wrench by twist (6,) of a wing whose lags have settled; air of density 1."""
    placed, count = place_elements(line, np.zeros(3)), len(line.chord)
    lags = wake_lags(count, _WAKE_POINTS)
    pair = pair_system(placed, placed, False)
    system = lag_system(placed, placed, pair.induced_y, pair.induced_z, lags)
    still = section_motion(line, line, line, 1.0)
    air = apparent_inertia(placed, 1.0)
    of_right = inertia_matrix(placed, air, body_twists(placed, np.arange(6)))
    inertia = of_right + _MIRROR @ of_right @ _MIRROR

    def wrench(twist: FloatArray) -> FloatArray:
        sides = [
            side_flow(placed, line.velocity, still, air, twist, _NO_DIRECTIONS, is_left)
            for is_left in (False, True)
        ]
        driving = np.concatenate([side.driving for side in sides])
        speed = np.concatenate([side.speed for side in sides])
        none = np.zeros(8 * lags.kept.size)
        rates = unsteady_circulations(system, lags, driving, speed, none, True).lag_rates
        settled = np.asarray(np.linalg.solve(rates[:, 1:], -rates[:, 0]))
        unsteady = unsteady_circulations(system, lags, driving, speed, settled, False)
        y, z = pair.induced_y @ unsteady.trailing, pair.induced_z @ unsteady.trailing
        right, left = (
            wing_wrench(
                placed.position,
                side_wrenches(placed, side, unsteady, y, z, i * count, 1.0, 0.0),
            )
            for i, side in enumerate(sides)
        )
        turning = np.append(np.cross(twist[3:], twist[:3]), np.zeros(3))
        return np.asarray(pair_wrench(right, left)[:, 0] - inertia @ turning)

    return wrench


def derivatives(wrench: Wrench) -> dict[str, float]:
    """The derivatives in stability axes; rates by span/(2 U), in pitch by chord/(2 U)."""
    c, s = np.cos(ALPHA), np.sin(ALPHA)
    axes = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])

    def found(alpha: float, beta: float, rates: FloatArray) -> FloatArray:
        velocity = [np.cos(beta) * np.cos(alpha), np.sin(beta), np.cos(beta) * np.sin(alpha)]
        spin = axes.T @ (rates * 2.0 / np.array([SPAN, CHORD, SPAN]))
        force, moment = np.split(wrench(np.append(velocity, spin)), 2)
        lift = force[0] * np.sin(alpha) - force[2] * np.cos(alpha)
        roll, pitch, yaw = axes @ moment / np.array([SPAN, CHORD, SPAN])
        return np.array([lift, roll, pitch, yaw]) / (0.5 * AREA)

    def slope(alpha: float = 0.0, beta: float = 0.0, rate: int | None = None) -> FloatArray:
        rates = np.zeros(3) if rate is None else np.eye(3)[rate]
        ends = [found(ALPHA + h * alpha, h * beta, h * rates) for h in (_STEP, -_STEP)]
        return np.asarray((ends[0] - ends[1]) / (2.0 * _STEP))

    a, b, p, q, r = slope(alpha=1), slope(beta=1), slope(rate=0), slope(rate=1), slope(rate=2)
    values = (a[0], a[2], q[2], b[1], b[3], p[1], p[3], r[1], r[3])
    return dict(zip(AVL, map(float, values), strict=True))


def section_lift() -> FloatArray:
    """Lift coefficients (12,) of the sections at the middle of AVL's strips."""
    placed = place_elements(LINE, np.zeros(3))
    twist = np.array([np.cos(ALPHA), 0.0, np.sin(ALPHA), 0.0, 0.0, 0.0])
    right, _ = pair_loads(placed, placed, True, 1.0, 0.0, twist)
    strips = 0.5 * WING.span * (np.arange(len(AVL_SECTION_LIFT)) + 0.5) / len(AVL_SECTION_LIFT)
    circulation = np.interp(strips, placed.position[:, 1], right.circulation)
    return np.asarray(2.0 * circulation / np.interp(strips, WING.positions, WING.chords))


def _compare() -> Iterator[Comparison]:
    found = {
        QUASI_STEADY: derivatives(quasi_steady_wrench(LINE)),
        UNSTEADY: derivatives(settled_wrench(LINE)),
    }
    for name, value in AVL.items():
        yield Comparison("E", name, "", value, {model: of[name] for model, of in found.items()})
    steady = section_lift()
    for i, (value, lift) in enumerate(zip(AVL_SECTION_LIFT, steady, strict=True)):
        both = dict.fromkeys((QUASI_STEADY, UNSTEADY), float(lift))
        yield Comparison("E", f"lift coefficient of strip {i + 1}", "", value, both)


EXPERIMENT = Experiment(
    "E",
    "derivatives of a plane wing",
    "AVL, a vortex lattice by M. Drela and H. Youngren",
    _compare,
)
