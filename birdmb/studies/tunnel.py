"""The same wingbeat in a wind tunnel and in free flight."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.models import FlightCycle, Loads
from birdmb.models.wing_model import BODY_STATES

_Q, _THETA = 2, 3
_VARIABLES = {
    "thrust": ((), {"units": "N"}),
    "lift": ((), {"units": "N"}),
    "pitching_moment": ((), {"units": "N m"}),
    "wing_power": ((), {"units": "W"}),
    "force": (("axis",), {"units": "N"}),
    "body_state": (("state",), {}),
}


@checked
def tunnel_and_free_flight(cycle: FlightCycle) -> xr.Dataset:
    """Loads over a beat of the body held at its mean state, and along the limit cycle.

    In the tunnel, u, w and theta are held at their means over the beat and q is zero; the joints
    move as they do in the limit cycle (compliant ones too), so that nothing but the motion of the
    body makes the difference (thesis, chapter 3).

    Returns:
        By `mount` ("tunnel", "free") and `time` (s): `thrust` (horizontally forward) and `lift`
        (upwards), N, in world axes at the pitch angle of the moment; `pitching_moment` (N m about
        the body's centre of mass, nose up); `wing_power` (W); `force` (N, body axes, by `axis`);
        `body_state` (by `state`).
    """
    model, beat = cycle.model, cycle.beat
    held = beat.states.copy()
    held[:, : _THETA + 1] = beat.states[:-1, : _THETA + 1].mean(axis=0)
    held[:, _Q] = 0.0
    in_tunnel = [model.loads(t, x) for t, x in zip(beat.times, held, strict=True)]
    mounts = [_components(in_tunnel, held), _components(beat.loads, beat.states)]
    return xr.Dataset(
        {
            key: (("mount", "time", *axes), np.stack([each[key] for each in mounts]), about)
            for key, (axes, about) in _VARIABLES.items()
        },
        coords={
            "mount": ["tunnel", "free"],
            "time": ("time", beat.times, {"units": "s"}),
            "axis": ["x", "y", "z"],
            "state": list(BODY_STATES),
        },
        attrs={"bird": model.bird.name, "weight": model.mass * model.bird.gravity},
    )


def _components(loads: Sequence[Loads], states: FloatArray) -> dict[str, FloatArray]:
    force = np.array([at.force for at in loads])
    c, s = np.cos(states[:, _THETA]), np.sin(states[:, _THETA])
    return {
        "thrust": c * force[:, 0] + s * force[:, 2],
        "lift": s * force[:, 0] - c * force[:, 2],
        "pitching_moment": np.array([at.moment[1] for at in loads]),
        "wing_power": np.array([at.power for at in loads]),
        "force": force,
        "body_state": states[:, : _THETA + 1],
    }
