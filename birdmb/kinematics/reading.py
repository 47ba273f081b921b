"""Measured motions as they are given: a file, a dataset or arrays, as points and angles."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.kinematics.files import Columns, read_columns
from birdmb.text import nearest
from birdmb.topology.messages import shown

Measured: TypeAlias = str | PathLike[str] | xr.Dataset | Mapping[str, npt.ArrayLike]

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3}
_TIME = "time"
_AXES = ("_x", "_y", "_z")
_IN_DEGREES = "_deg"
_FEWEST_FRAMES = 8
_LARGEST_AMPLITUDE = math.radians(110.0)  # no joint of a bird swings further to either side


@dataclass(frozen=True)
class Recording:
    """Points and joint angles over time; NaN where they were not measured.

    Attributes:
        origin: the file, or what stands for it in sentences.
        times: N times, ascending, s.
        points: markers' places (N, 3), m, in the axes of the file.
        angles: joints' angles (N,), rad.
        remarks: what is odd about them, in sentences.
    """

    origin: str
    times: FloatArray
    points: Mapping[str, FloatArray]
    angles: Mapping[str, FloatArray]
    remarks: tuple[str, ...] = ()


def read_recording(
    data: Measured, joints: Collection[str], rate: float | None, unit: str | None
) -> Recording:
    """A measured motion as points and angles of these `joints`.

    Args:
        data: path of a CSV, NetCDF or C3D file, a dataset, or arrays by name.
        joints: names of the joints that there are.
        rate: frames per second, where there is no column `time`.
        unit: of the points, "m", "cm" or "mm"; by default what the file says, or else "m".

    Raises:
        KinematicsError: it cannot be read so.
    """
    if unit is not None and unit not in UNITS:
        raise KinematicsError(f"the unit must be one of {', '.join(UNITS)}, not {shown(unit)}.")
    columns = _columns(data)
    times = _times(columns, rate)
    told = unit or columns.unit or "m"
    if told not in UNITS:
        raise KinematicsError(
            f"{columns.origin}: says that its points are in {shown(told)}; say --unit m, cm or mm."
        )
    scale = UNITS[told]
    values = {name: each for name, each in columns.values.items() if name != _TIME}
    points = {name: scale * each for name, each in _points(columns.origin, values).items()}
    angles, remarks = _angles(columns.origin, values, joints)
    if not (points or angles):
        raise KinematicsError(
            f"{columns.origin}: has no markers (elbow_x, elbow_y, elbow_z) and no joint angles "
            f"({next(iter(joints), 'shoulder.flap')}_deg)."
        )
    return Recording(columns.origin, times, points, angles, remarks)


def _columns(data: Measured) -> Columns:
    if isinstance(data, str | PathLike | xr.Dataset):
        return read_columns(data)
    values: dict[str, FloatArray] = {}
    for name, given in data.items():
        try:
            array = np.asarray(given, dtype=float)
        except (TypeError, ValueError) as error:
            raise KinematicsError(f"the data: {shown(name)} is no array of numbers.") from error
        if array.ndim == 2 and array.shape[1] == 3:
            values |= {f"{name}{axis}": array[:, i] for i, axis in enumerate(_AXES)}
        elif array.ndim == 1:
            values[name] = array
        else:
            raise KinematicsError(
                f"the data: {shown(name)} must have the shape (frames,) or (frames, 3), not "
                f"{array.shape}."
            )
    if len({len(each) for each in values.values()}) > 1:
        raise KinematicsError("the data: all arrays must have the same number of frames.")
    return Columns("the data", values)


def _times(columns: Columns, rate: float | None) -> FloatArray:
    count = len(next(iter(columns.values.values()), ()))
    if count < _FEWEST_FRAMES:
        raise KinematicsError(
            f"{columns.origin}: has {count} frames; a beat needs {_FEWEST_FRAMES} or more."
        )
    times = columns.values.get(_TIME)
    given = rate if rate is not None else columns.rate
    if times is None and given is None:
        raise KinematicsError(
            f'{columns.origin}: has no column "time" (s); add it, or say how many frames a second '
            "has (--rate)."
        )
    if times is not None and rate is not None:
        raise KinematicsError(
            f'{columns.origin}: has a column "time", and the rate is given besides; keep one.'
        )
    if times is None:
        if not (given is not None and math.isfinite(given) and given > 0.0):
            raise KinematicsError(f"the rate must be a positive number of frames, not {given}.")
        return np.arange(count) / given
    bad = np.flatnonzero(~np.isfinite(times))
    if not bad.size:
        bad = 1 + np.flatnonzero(np.diff(times) <= 0.0)
    if bad.size:
        what = "is missing" if not np.isfinite(times[bad[0]]) else "is not after the one before"
        raise KinematicsError(f"{columns.origin}: time of {columns.place(int(bad[0]))} {what}.")
    return times


def _points(origin: str, values: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    points = {}
    markers = dict.fromkeys(n[:-2] for n in values if n.endswith(_AXES) and len(n) > 2)
    for marker in markers:
        missing = [f"{marker}{axis}" for axis in _AXES if f"{marker}{axis}" not in values]
        if missing:
            raise KinematicsError(
                f"{origin}: the marker {marker} has no column {' and no '.join(missing)}."
            )
        point = np.column_stack([values[f"{marker}{axis}"] for axis in _AXES])
        point[~np.isfinite(point).all(axis=1)] = np.nan
        points[marker] = point
    return points


def _angles(
    origin: str, values: Mapping[str, FloatArray], joints: Collection[str]
) -> tuple[dict[str, FloatArray], tuple[str, ...]]:
    angles: dict[str, FloatArray] = {}
    small = []
    for column, given in values.items():
        if column.endswith(_AXES) and len(column) > 2:
            continue
        joint = column.removesuffix(_IN_DEGREES)
        if joint not in joints:
            raise KinematicsError(
                f"{origin}: column {shown(column)} is neither time, nor a marker's _x, _y or _z, "
                f"nor a joint's angle; the nearest joints: {nearest(joint, joints)}."
            )
        if joint in angles:
            raise KinematicsError(f"{origin}: {joint} is given twice, in rad and in degrees.")
        if not np.isfinite(given).any():
            raise KinematicsError(f"{origin}: column {column} is empty.")
        if column == joint:
            _refuse_degrees(origin, joint, given)
        small.append(column != joint and np.nanmax(np.abs(given)) < math.pi)
        angles[joint] = np.radians(given) if column != joint else given
    if small and all(small):
        return angles, (
            "all angles are within 3.2 degrees of zero; if they are in radians, leave the _deg "
            "off the names of their columns",
        )
    return angles, ()


def _refuse_degrees(origin: str, joint: str, given: FloatArray) -> None:
    largest = float(np.nanmax(np.abs(given)))
    if largest > 2.0 * math.pi or np.nanmax(given) - np.nanmin(given) > 2.0 * _LARGEST_AMPLITUDE:
        raise KinematicsError(
            f"{origin}: column {joint} is read in radians and goes to {largest:.4g}, which no "
            f"joint does; if it is in degrees, call it {joint}{_IN_DEGREES}."
        )
