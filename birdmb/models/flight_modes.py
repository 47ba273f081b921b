"""The modes of a flight, told apart by plane and named as flight dynamics names them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models.motion import Mirror, Motion
from birdmb.orbits import LimitCycle
from birdmb.summary import Summarised

Plane = Literal["longitudinal", "lateral", "coupled"]

# Of a symmetric flight the shares are 0 and 1 to round-off.
_COUPLED = 0.01
_MOST = 0.5
_PHUGOID = ("u", "theta")


@dataclass(frozen=True, repr=False)
class FlightMode(Summarised):
    """A mode in which disturbances of a flight grow or decay.

    Attributes:
        plane: "longitudinal", "lateral", or "coupled" where neither has 99 % of it.
        name: "roll", "spiral", "Dutch roll", "lateral phugoid", "phugoid" or "short period" where
            it is what these words mean, "wake" where it is mostly the air's memory that fades, else
            empty.
        multiplier: Floquet multiplier.
        error: bound of its error.
        doubling_time: time in s in which it doubles or halves.
        participation: share of each state, by name; the sum is 1.
    """

    plane: Plane
    name: str
    multiplier: complex
    error: float
    doubling_time: float
    participation: dict[str, float]


def flight_modes(
    cycle: LimitCycle, motion: Motion, mirror: Mirror, lags: int
) -> tuple[FlightMode, ...]:
    """The modes of a limit cycle, in the order of its multipliers.

    The first states of the cycle are those of the body in `motion`, the last `lags` those of the
    air's memory; `mirror` makes a state its mirror image. What a mode shares with its mirror image
    is longitudinal, what changes sign is lateral. Lateral modes: of complex pairs the one that
    oscillates fastest is the Dutch roll, another one the lateral phugoid; of two or more real
    multipliers the largest one is the spiral mode, that of the others in which p has the largest
    share the roll mode. Longitudinal modes: of complex pairs the one in which speed and pitch angle
    have the larger share is the phugoid, the other one the short period. Real longitudinal modes,
    those of joints and coupled ones have no names.
    """
    shares, count = cycle.participation, len(motion.states)
    lateral = _lateral_shares(cycle, mirror)
    planes = [_plane(float(share)) for share in lateral]
    of_body = shares[:count].sum(axis=0) > _MOST
    of_wake = shares[len(shares) - lags :].sum(axis=0) > _MOST
    names = ["wake" if wake else "" for wake in of_wake]
    for plane, named in (("lateral", _lateral), ("longitudinal", _longitudinal)):
        chosen = [k for k, each in enumerate(planes) if each == plane and of_body[k]]
        for k, name in named(cycle, motion, chosen).items():
            names[k] = name
    return tuple(
        FlightMode(
            plane=planes[k],
            name=names[k],
            multiplier=complex(cycle.multipliers[k]),
            error=float(cycle.verdict_errors[k]),
            doubling_time=float(cycle.doubling_times[k]),
            participation=dict(zip(cycle.state_names, shares[:, k].tolist(), strict=True)),
        )
        for k in range(len(planes))
    )


def _lateral_shares(cycle: LimitCycle, mirror: Mirror) -> FloatArray:
    """Part (n,) of each mode that changes sign in the mirror, by participation."""
    image = np.eye(len(cycle.state_names))[mirror.order] * mirror.signs[:, None]
    # Its eigenvectors are the sums and the differences of what it exchanges.
    values, vectors = np.linalg.eigh(image)
    share = np.abs((vectors.T @ cycle.left_modes) * (vectors.T @ cycle.modes))
    return np.asarray(share[values < 0.0].sum(axis=0) / share.sum(axis=0))


def _plane(lateral: float) -> Plane:
    if lateral < _COUPLED:
        return "longitudinal"
    return "lateral" if lateral > 1.0 - _COUPLED else "coupled"


def _frequency(cycle: LimitCycle, k: int) -> float:
    """Angular frequency of a mode, rad per period, up to half a turn."""
    return float(np.abs(np.angle(cycle.multipliers[k])))


def _pairs(cycle: LimitCycle, chosen: list[int]) -> list[int]:
    """Those of complex pairs."""
    return [k for k in chosen if cycle.multipliers[k].imag != 0.0]


def _lateral(cycle: LimitCycle, motion: Motion, chosen: list[int]) -> dict[int, str]:
    oscillating = _pairs(cycle, chosen)
    real = [k for k in chosen if k not in oscillating]
    names = {}
    if oscillating:
        fastest = max(_frequency(cycle, k) for k in oscillating)
        for k in oscillating:
            slower = _frequency(cycle, k) < fastest * (1.0 - 1e-9)
            names[k] = "lateral phugoid" if slower else "Dutch roll"
    if len(real) > 1:
        slow, *fast = real
        rolling = cycle.participation[motion.states.index("p")]
        names |= {slow: "spiral", max(fast, key=lambda k: float(rolling[k])): "roll"}
    return names


def _longitudinal(cycle: LimitCycle, motion: Motion, chosen: list[int]) -> dict[int, str]:
    oscillating = _pairs(cycle, chosen)
    slow = _slow_share(cycle, motion)
    if len(oscillating) == 2:
        name = "phugoid" if slow[oscillating[0]] > 0.5 else "short period"
        return dict.fromkeys(oscillating, name)
    if len(oscillating) == 4:
        middle = float(np.mean([slow[k] for k in oscillating]))
        return {k: "phugoid" if slow[k] > middle else "short period" for k in oscillating}
    return {}


def _slow_share(cycle: LimitCycle, motion: Motion) -> FloatArray:
    """Share (n,) of speed and pitch angle in the longitudinal part of each mode."""
    body = cycle.participation[: len(motion.states)]
    slow = np.array([name in _PHUGOID for name in motion.states])
    return np.asarray(body[slow].sum(axis=0) / body[~motion.lateral].sum(axis=0))
