"""The gait of a measured motion, by the joints of a topology."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.kinematics.axes import check_axes
from birdmb.kinematics.beats import beat_frequency, most_harmonics
from birdmb.kinematics.described import described
from birdmb.kinematics.determinacy import told_joints
from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.markers import Places, read_places
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.observing import measured_lengths, observe
from birdmb.kinematics.orders import fit_orders
from birdmb.kinematics.poses import PHASES, MeanBeat, mean_beat, solve_poses
from birdmb.kinematics.reading import Measured, read_recording
from birdmb.kinematics.reference import lead_of
from birdmb.kinematics.result import KinematicsFit
from birdmb.kinematics.series import Gait, Solved
from birdmb.threads import one_thread
from birdmb.topology import Bird, load_bird
from birdmb.topology.samples import series_basis
from birdmb.topology.shipped import topology_file

_PASSES = 3
_FIRST_SCATTER = 1e-2  # of typical sizes, before the residuals tell it


@checked
def fit_kinematics(
    data: Measured,
    like: Bird | str | PathLike[str],
    *,
    frame: str | None = None,
    rate: float | None = None,
    unit: str | None = None,
    markers: Places | str | PathLike[str] | None = None,
    frequency: float | None = None,
    harmonics: int | None = None,
    lengths: bool = False,
) -> KinematicsFit:
    """Fit the gait of a bird to measured points or joint angles.

    Fourier series of the joints' angles are fitted to all samples of all beats at once, by
    nonlinear least squares with the bird's own joint chain (docs/kinematics.md).

    Args:
        data: path of a table (CSV, NetCDF, C3D), a dataset, or arrays by name: `time` (N,) in s,
            markers (N, 3) or joints' angles (N,).
        like: the bird whose joints are solved for, its topology file, or its name in the package.
        frame: where the x, y and z axes of points point to: "body", words such as
            "forward-left-up" or body axes such as "+x-y-z". Not needed beside markers on the body.
        rate: frames per second, where there is no `time`.
        unit: of the points, "m", "cm" or "mm"; by default what the file says, or else "m".
        markers: places of markers whose names do not tell it, as
            `{"p1": {"feather": "1"}, "back": {"body": [0, 0, -0.03]}}`, or a TOML file of these.
        frequency: wingbeat frequency, Hz, if it is known; by default it is found.
        harmonics: how many each joint gets; by default as many as are significant.
        lengths: whether segments get their measured lengths.

    Raises:
        KinematicsError: the data cannot be read or tell no gait; one sentence with file and column.
        TopologyError: `like` is no topology.
        ArgumentError: an argument that cannot be.
    """
    _check(frequency, harmonics)
    file = None if isinstance(like, Bird) else topology_file(like)
    given = like if isinstance(like, Bird) else load_bird(like)
    if not given.is_symmetric:
        raise ArgumentError(f"{given.name}: has joints of its own on a side; one wing is fitted.")
    places = read_places(markers)
    recording = read_recording(data, given.joint_names, rate, unit)
    with one_thread():
        seen, remarks = observe(recording, given.assembled, places, frame)
        if lengths:
            found = measured_lengths(recording, given.assembled, places)
            sizes = {f"segments.{name}.length": size for name, size in found.items()}
            given = given.with_values(sizes)
            seen, remarks = observe(recording, given.assembled, places, frame)
        hold = frequency is not None
        if frequency is None:
            frequency = beat_frequency(seen.times, seen.values / seen.typical, seen.origin)
        gait, beat, more = _start(seen, given, frequency, frame or "body")
        solved = _fit(seen, given, gait, beat, harmonics, hold_frequency=hold)
        missing = _missing(recording.points, recording.angles)
        return described(
            seen, given, solved, beat.noise,
            like_file=file, remarks=(*remarks, *more), missing=missing,
        )  # fmt: skip


def _check(frequency: float | None, harmonics: int | None) -> None:
    if frequency is not None and not 0.0 < frequency < np.inf:
        raise ArgumentError(f"the frequency must be positive, in Hz, not {frequency}.")
    if harmonics is not None and harmonics < 1:
        raise ArgumentError(f"a gait needs 1 harmonic or more, not {harmonics}.")


def _missing(*columns: Mapping[str, FloatArray]) -> dict[str, int]:
    missing = {}
    for group in columns:
        for name, values in group.items():
            gone = np.isnan(values) if values.ndim == 1 else np.isnan(values).any(axis=1)
            missing[name] = int(gone.sum())
    return missing


def _start(
    seen: Observations, bird: Bird, frequency: float, frame: str
) -> tuple[Gait, MeanBeat, tuple[str, ...]]:
    """A gait of one harmonic by poses at single phases, the mean beat, and remarks."""
    middle = 0.5 * float(seen.times[0] + seen.times[-1])
    phases = frequency * (seen.times - middle)
    most = most_harmonics(phases[np.isfinite(seen.values).any(axis=1)])
    if most < 1:
        raise KinematicsError(
            f"{seen.origin}: half of the beat or more is without frames; more beats, or more "
            "frames, are needed."
        )
    beat = mean_beat(seen, seen.values, phases)
    angles, _ = solve_poses(seen, beat.values)
    told = told_joints(seen, beat, angles)
    if not told:
        raise KinematicsError(f"{seen.origin}: tells none of the joints of {bird.name}.")
    remarks: tuple[str, ...] = ()
    if seen.markers.names:
        noise = float(np.max(beat.noise[seen.is_point])) / seen.reach
        remarks = check_axes(seen, frame, beat.values, noise, told)
    basis = series_basis(np.arange(PHASES) / PHASES, 1)
    solved = np.linalg.lstsq(basis, angles[:, list(told)], rcond=None)[0]
    gait = Gait(told, (1,) * len(told), np.asarray(solved.T), frequency, middle, 0.0)
    return replace(gait, lead=lead_of(bird, gait)), beat, remarks


def _fit(
    seen: Observations,
    bird: Bird,
    gait: Gait,
    beat: MeanBeat,
    harmonics: int | None,
    *,
    hold_frequency: bool,
) -> Solved:
    """Fit, with the drivers of joints that are not told in time with the others."""
    noise = np.zeros(len(seen.names))
    np.maximum.at(noise, seen.group, beat.noise)
    start = np.maximum(noise, _FIRST_SCATTER * seen.typical_of_names)
    solved = fit_orders(seen, gait, start, harmonics, hold_frequency=hold_frequency)
    others = [joint for j, joint in enumerate(bird.joints) if j not in solved.gait.joints]
    if all(joint.driver.is_still for joint in others):
        return solved
    for _ in range(_PASSES - 1):
        again = replace(solved.gait, lead=lead_of(bird, solved.gait))
        solved = fit_orders(seen, again, solved.scatter, harmonics, hold_frequency=hold_frequency)
    return solved
