"""Whether the points would fit the wing better if their axes pointed elsewhere."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.frames import all_frames, to_body_axes
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.poses import PHASES, solve_poses

_MISFIT = 0.01  # of the wing's reach
_HOPELESS = 0.08
_NOISES = 5.0
_MUCH_BETTER = 1.0 / 3.0
_ALIKE = 1.5
_STRANGE = math.radians(60.0)  # rms distance of a gait from the topology's own
_UNUSUAL = math.radians(15.0)
_EVERY = 3  # of the phases, to try axes


class _Tried(NamedTuple):
    frame: str
    misfit: float  # of the points, in wing's reaches
    distance: float  # rms of the joints' angles from the topology's own gait, rad


def check_axes(
    seen: Observations, frame: str, mean: FloatArray, noise: float, told: tuple[int, ...]
) -> tuple[str, ...]:
    """Refuse axes in which the points do not fit the wing, or bend it as no bird does.

    Args:
        seen: the columns, in body axes by `frame`.
        frame: where the axes of the file are said to point to.
        mean: the columns over a mean beat (PHASES, R).
        noise: rms distance of the samples from it, in wing's reaches.
        told: the joints whose angles count.

    Returns:
        A remark if the gait is nearer to the topology's own in other axes.

    Raises:
        KinematicsError: the points do not fit, with the axes in which they do, if there are any.
    """
    allowed, some = max(_MISFIT, _NOISES * noise), mean[::_EVERY]
    (given,) = _tried(seen, frame, [frame], some, told)
    if given.misfit <= allowed and given.distance <= _UNUSUAL:
        return ()
    own = to_body_axes(frame)
    frames = [one for one in all_frames() if (to_body_axes(one) != own).any()]
    # Markers on the body turn with the axes: these cannot be told from the wing.
    others = _tried(seen, frame, frames, some, told) if seen.body_motions < 6 else []
    fitting = [
        one for one in others
        if one.misfit < max(_MUCH_BETTER * given.misfit, allowed) and one.distance < _STRANGE
    ]  # fmt: skip
    best = min(fitting, key=lambda one: one.distance, default=None)
    if given.misfit > allowed:
        much_better = [one for one in fitting if one.misfit < _MUCH_BETTER * given.misfit]
        best = min(much_better, key=lambda one: one.distance, default=None)
        _refuse_misfit(seen, given, best)
    if best is None or best.misfit > _ALIKE * given.misfit + noise + 1e-3:
        return ()
    if given.distance > _STRANGE and best.distance < 0.5 * given.distance:
        raise KinematicsError(
            f"{seen.origin}: with axes {frame} the joints are {math.degrees(given.distance):.0f} "
            f"degrees (rms) from the topology's own gait, with {best.frame} "
            f"{math.degrees(best.distance):.0f}; check --frame."
        )
    if given.distance > _UNUSUAL and best.distance < 0.5 * given.distance:
        return (
            f"with axes {best.frame} the joints would be {math.degrees(best.distance):.0f} degrees "
            f"(rms) from the topology's own gait, not {math.degrees(given.distance):.0f}; is "
            "--frame right?",
        )
    return ()


def _refuse_misfit(seen: Observations, given: _Tried, best: _Tried | None) -> None:
    if best is not None:
        raise KinematicsError(
            f"{seen.origin}: with axes {given.frame} the points are "
            f"{1e3 * given.misfit * seen.reach:.3g} mm (rms) off the wing, with {best.frame} "
            f"{1e3 * best.misfit * seen.reach:.3g} mm; an axis is swapped, check --frame."
        )
    if given.misfit > _HOPELESS:
        raise KinematicsError(
            f"{seen.origin}: the points are {1e3 * given.misfit * seen.reach:.3g} mm (rms) off the "
            "wing whatever the axes; check which marker is which, and the topology's lengths."
        )


def _tried(
    seen: Observations,
    given: str,
    frames: list[str],
    mean: FloatArray,
    told: tuple[int, ...],
) -> list[_Tried]:
    own = to_body_axes(given)
    count = 3 * len(seen.markers.names)
    wanted = np.tile(mean, (len(frames), 1, 1))
    for i, other in enumerate(frames):
        turn = to_body_axes(other) @ own.T
        points = mean[:, :count].reshape(len(mean), -1, 3) @ turn.T
        wanted[i, :, :count] = points.reshape(len(mean), -1)
    angles, misfit = solve_poses(seen, wanted.reshape(-1, wanted.shape[2]))
    angles = angles.reshape(len(frames), len(mean), -1)[:, :, list(told)]
    misfit = np.sqrt(np.mean(misfit.reshape(len(frames), -1) ** 2, axis=1))
    return [
        _Tried(name, float(off), _distance(seen, pose, told))
        for name, off, pose in zip(frames, misfit, angles, strict=True)
    ]


def _distance(seen: Observations, angles: FloatArray, told: tuple[int, ...]) -> float:
    """Rms distance of angles over a beat from the topology's own, where in the beat it may be."""
    if not told:
        return 0.0
    beat = 2.0 * np.pi / seen.wing.angular_frequency
    own = driver_motion_along(seen.wing, np.arange(PHASES) / PHASES * beat)[0][:, list(told)]
    lead: IntArray = np.arange(PHASES)[:, None] + np.arange(0, PHASES, _EVERY)
    apart = angles - own[np.mod(lead, PHASES)]
    return float(np.sqrt(np.mean(apart**2, axis=(1, 2)).min()))
