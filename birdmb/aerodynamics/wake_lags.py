"""How the air remembers: what of the wing's past is kept, and how fast it fades.

Two things lag behind the motion of a section of chord c at speed V.

Its bound circulation, as the vortices that it sheds move away: the response to a step grows like
Wagner's function, here 1 - 0.165 exp(-0.0455 s) - 0.335 exp(-0.3 s) after s half chords (R. T.
Jones, NACA Report 681, 1940), which is within 0.014 of it in the frequency domain.

The circulation of the trailing vortices that act on it, as these grow in length: what horseshoe
vortices of finite length induce, less what the two-dimensional shed vortex at their ends does
(which Wagner's function holds), reaches on an elliptic wing, in the mean that its circulation
weighs, the share 1 - 0.5 exp(-0.378 x) - 0.5 exp(-4.6 x) of its final value after x half spans,
within 0.04.

With w the normal velocity at the three-quarter-chord point, the downwash of the trailing vortices
taken off, y_1 and y_2 (m/s) the section's bound lags and g_1, g_2 (m2/s) its trailing ones,

    y_j' = b_j (2 V/c) (w - y_j),    g_j' = d_j (V/B) (Gamma - g_j),    B the half span,
    Gamma = 1/2 c a (w/2 + 0.165 y_1 + 0.335 y_2),    trailing circulation (g_1 + g_2)/2,

the steady state of which is the steady lifting line.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.separation_curves import SeparationCurves, attached_flow

BOUND_SHARES, BOUND_RATES = (0.165, 0.335), (0.0455, 0.3)  # rates per half chord travelled
TRAILING_SHARES, TRAILING_RATES = (0.5, 0.5), (0.378, 4.6)  # per half span travelled
AT_ONCE = 0.5  # share of the normal velocity that acts without a lag
KINDS = ("bound_slow", "bound_fast", "trailing_slow", "trailing_fast")
UNITS = ("m/s", "m/s", "m2/s", "m2/s")


class WakeLags(NamedTuple):
    """Where along a wing of N elements lags are kept, and how the others follow from these.

    Where flow separates, so does the attached share of the chord; see
    `birdmb.aerodynamics.separation`.

    Along the span lags are smooth: they are kept at K of the elements. What of the motion the curve
    through these misses acts without a lag, so that steady loads are those of all elements.
    """

    kept: IntArray  # (K,) elements
    spread: FloatArray  # (N, K), of values at these to all elements
    separation: SeparationCurves


# Arrays without elements cannot change: models share them.
@lru_cache(maxsize=64)
def no_wake_lags(elements: int) -> WakeLags:
    """The lags about a wing of so many elements in air without a memory: none."""
    return WakeLags(np.empty(0, np.int64), np.empty((elements, 0)), attached_flow(elements))


def wake_lags(elements: int, points: int) -> WakeLags:
    """Lags at so many `points` of a wing of N `elements`, at all of them at most.

    They are spread evenly along the elements, which crowd towards root and tip, and lie within
    their range: at a pointed tip, where nothing lifts, lags would be boundlessly fast. A cubic
    spline leads through them.
    """
    kept = np.unique(((np.arange(points) + 0.5) / points * elements).astype(np.int64))
    if kept.size < 4:
        raise ValueError("fewer than four points leave no cubic spline")
    spline = CubicSpline(kept, np.eye(kept.size), bc_type="not-a-knot")
    everywhere = np.ascontiguousarray(spline(np.arange(elements)))
    return WakeLags(kept, everywhere, attached_flow(elements))
