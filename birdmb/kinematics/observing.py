"""From a recording to columns in body axes, with what is plainly wrong refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from birdmb._typing import FloatArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.frames import to_body_axes, without_body_motion
from birdmb.kinematics.markers import SHOULDER, Markers, Places, place_markers, places_along
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.reading import UNITS, Recording
from birdmb.topology import Bird
from birdmb.wing.arrays import WingArrays, wing_arrays

_FEWEST_FRAMES = 8
_MOST_FRAMES = 20_000
_OTHER_SIZE = 8.0  # times the wing's, and the points are in another unit
_OTHER_LENGTH = 0.1  # of a bone's, beside which a fit is suspect
_MIRRORED = 1.5  # times better in a mirror, and the axes are left-handed
_OFF_THE_BODY = 0.1  # of the extent of the markers on the body


def observe(
    recording: Recording, bird: Bird, places: Places, frame: str | None
) -> tuple[Observations, tuple[str, ...]]:
    """The columns that a bird's joints are solved from, and remarks on them.

    Raises:
        KinematicsError: markers, unit or axes cannot be those of the bird.
    """
    origin, wing = recording.origin, wing_arrays(bird)
    markers = place_markers(recording.points, bird, places, origin)
    points = _stacked(recording)
    remarks = list(recording.remarks)
    bodily = 0
    if markers.names:
        _refuse_other_unit(origin, points, markers, wing)
        remarks += _other_lengths(points, markers, bird)
        points, bodily, more = _in_body_axes(origin, points, markers, frame)
        remarks += more
    names = (*markers.names, *recording.angles)
    joints = np.array([bird.joint_names.index(name) for name in recording.angles], dtype=np.int64)
    angles = [each[:, None] for each in recording.angles.values()]
    columns = [points.reshape(len(recording.times), -1), *angles]
    values = np.concatenate(columns, axis=1)
    seen = Observations(
        origin, recording.times, values, wing, markers, joints, tuple(names), bodily
    )
    return _frames_that_tell(seen), tuple(remarks)


def measured_lengths(recording: Recording, bird: Bird, places: Places) -> dict[str, float]:
    """Lengths (m) of the segments that have markers at both ends, the medians over the frames."""
    markers = place_markers(recording.points, bird, places, recording.origin)
    return _lengths(_stacked(recording), markers, bird)


def _lengths(points: FloatArray, markers: Markers, bird: Bird) -> dict[str, float]:
    found = {}
    for bone, name in enumerate(bird.segments.names):
        root, end = _marker_at(markers, bone, 0.0), _marker_at(markers, bone, 1.0)
        if root is not None and end is not None:
            apart = np.linalg.norm(points[:, end] - points[:, root], axis=1)
            if np.isfinite(apart).any():
                found[name] = float(np.nanmedian(apart))
    return found


def _marker_at(markers: Markers, bone: int, position: float) -> int | None:
    """A marker at a bone's end, or at its root (0), which is the end of the bone before."""
    places = [(bone, position), *([(bone - 1, 1.0)] if position == 0.0 else [])]
    for i, (on, at) in enumerate(zip(markers.bone, markers.position, strict=True)):
        if on >= 0 and (int(on), float(at)) in places:
            return i
    return None


def _stacked(recording: Recording) -> FloatArray:
    points = [*recording.points.values()]
    if not points:
        return np.empty((len(recording.times), 0, 3))
    return np.stack(points, axis=1)


def _refuse_other_unit(origin: str, points: FloatArray, markers: Markers, wing: WingArrays) -> None:
    on_wing = ~markers.on_body
    own = places_along(
        wing, markers.bone, markers.position, markers.feather, markers.fixed, wing.offset[None]
    )
    expected, found = _spread(own[:, on_wing]), _spread(points[:, on_wing])
    if not np.isfinite(found) or expected == 0.0:
        return
    ratio = found / expected
    if 1.0 / _OTHER_SIZE < ratio < _OTHER_SIZE:
        return
    likely = min(UNITS, key=lambda unit: abs(np.log(ratio * UNITS[unit])))
    hint = f" if they are in {likely}, say so (--unit {likely})" if ratio > 1.0 else (
        " say the unit that they are in (--unit)"
    )  # fmt: skip
    raise KinematicsError(
        f"{origin}: the markers are {found:.3g} m about their centre, those of the topology's "
        f"wing {expected:.3g} m;{hint}."
    )


def _spread(points: FloatArray) -> float:
    """Root mean square distance of points (N, M, 3) from their centres, the median over frames."""
    there = np.isfinite(points).all(axis=2)
    frames = there.sum(axis=1) >= min(2, points.shape[1])
    if points.shape[1] < 2 or not frames.any():
        return np.nan
    kept = points[frames]
    off = kept - np.nanmean(kept, axis=1, keepdims=True)
    return float(np.median(np.sqrt(np.nanmean(np.sum(off**2, axis=2), axis=1))))


def _other_lengths(points: FloatArray, markers: Markers, bird: Bird) -> list[str]:
    remarks = []
    for name, length in _lengths(points, markers, bird).items():
        own = bird.segments[name].length
        if abs(length / own - 1.0) > _OTHER_LENGTH:
            remarks.append(
                f"the {name} measures {1e3 * length:.3g} mm, that of the topology "
                f"{1e3 * own:.3g} mm; --lengths takes the measured lengths"
            )
    return remarks


def _in_body_axes(
    origin: str, points: FloatArray, markers: Markers, frame: str | None
) -> tuple[FloatArray, int, list[str]]:
    """Points from the shoulder, how many motions of the body are left in them, and remarks."""
    if frame is None and not markers.on_body.any():
        raise KinematicsError(
            f"{origin}: say where the axes of the points point to (--frame): body, or words such "
            "as forward-left-up."
        )
    points = points @ to_body_axes(frame or "body").T
    if markers.on_body.any():
        moved, off = without_body_motion(points, markers.on_body, markers.fixed, origin)
        _, mirrored = without_body_motion(-points, markers.on_body, markers.fixed, origin)
        extent = float(np.ptp(markers.fixed[markers.on_body], axis=0).max())
        if off > _MIRRORED * mirrored or off > _OFF_THE_BODY * extent:
            raise KinematicsError(
                f"{origin}: the markers on the body are {1e3 * off:.3g} mm (rms) off the places "
                f"that they should have on it, and {1e3 * mirrored:.3g} mm if the axes of the file "
                "are left-handed; check the places, or say the axes (--frame)."
            )
        return moved, 6, []
    if SHOULDER not in markers.names:
        raise KinematicsError(
            f"{origin}: has no marker shoulder and none on the body; one of the two is needed, and "
            "may be zero throughout where points are given from the shoulder."
        )
    shoulder = points[:, markers.names.index(SHOULDER)]
    seen = np.asarray(np.isfinite(shoulder).all(axis=1))
    if not seen.any():
        raise KinematicsError(f"{origin}: the marker shoulder was never seen.")
    # The fit lets the body move from frame to frame: where the shoulder is hidden, a guess will do.
    known = np.flatnonzero(seen)
    guess = [np.interp(np.arange(len(seen)), known, shoulder[known, axis]) for axis in range(3)]
    points = points - np.column_stack(guess)[:, None]
    fixed = not np.ptp(shoulder[seen], axis=0).any()
    remark = "the body's attitude is taken to be constant: no markers on the body tell it"
    return points, 0 if fixed else 3, [] if frame == "body" else [remark]


def _frames_that_tell(seen: Observations) -> Observations:
    count = np.isfinite(seen.values).sum(axis=1)
    told = count > (seen.body_motions if seen.markers.names else 0)
    if told.sum() < _FEWEST_FRAMES:
        raise KinematicsError(
            f"{seen.origin}: {int(told.sum())} of {told.size} frames have enough markers; "
            f"{_FEWEST_FRAMES} are needed."
        )
    if told.sum() > _MOST_FRAMES:
        raise KinematicsError(
            f"{seen.origin}: has {int(told.sum())} frames; cut out some beats of {_MOST_FRAMES} "
            "frames or less."
        )
    return replace(seen, times=seen.times[told], values=seen.values[told])
