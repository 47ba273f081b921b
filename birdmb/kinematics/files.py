"""The columns of files of measured motions: CSV, NetCDF and C3D."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from os import PathLike
from pathlib import Path

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray, IntArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.topology.messages import shown

_AXES = ("x", "y", "z")
_DELIMITERS = (",", ";", "\t")
_NOTHING = {"", "nan", "na", "n/a", "null", "-"}
_LARGEST = 500_000_000  # bytes
_DEGREES = {"deg", "degree", "degrees", "°"}


@dataclass(frozen=True)
class Columns:
    """Columns of numbers by name, NaN where a cell is empty, each (N,).

    Attributes:
        origin: the file, or what stands for it in sentences.
        values: the columns.
        lines: lines (N,) of the file that they are from, if it has any.
        rate: frames per second, if the file says so.
        unit: of points, if the file says so.
    """

    origin: str
    values: Mapping[str, FloatArray]
    lines: IntArray | None = None
    rate: float | None = None
    unit: str | None = None

    def place(self, frame: int) -> str:
        """Where a frame is found, for people."""
        return f"frame {frame + 1}" if self.lines is None else f"line {self.lines[frame]}"


def read_columns(source: str | PathLike[str] | xr.Dataset) -> Columns:
    """The columns of a CSV, NetCDF or C3D file, told by its name, or of a dataset.

    Raises:
        KinematicsError: the file cannot be read, with the place.
    """
    if isinstance(source, xr.Dataset):
        return _of_dataset(source, "the dataset")
    path = Path(source)
    try:
        if path.stat().st_size > _LARGEST:
            raise KinematicsError(f"{path}: is larger than 500 MB; cut out some beats.")
        suffix = path.suffix.lower()
        if suffix in (".nc", ".h5", ".netcdf"):
            with xr.open_dataset(path, engine="h5netcdf") as dataset:
                return _of_dataset(dataset.load(), str(path))
        return _of_c3d(path) if suffix == ".c3d" else _of_csv(path)
    except (OSError, ValueError) as error:
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise KinematicsError(f"{path}: cannot be read ({reason.lower()}).") from error


def _of_csv(path: Path) -> Columns:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise KinematicsError(f"{path}: is no text in UTF-8; a table (CSV) must be.") from error
    numbered = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not numbered:
        raise KinematicsError(f"{path}: is empty; its first line must name the columns.")
    header = numbered[0][1]
    delimiter = max(_DELIMITERS, key=header.count)
    rows = list(csv.reader((line for _, line in numbered), delimiter=delimiter))
    names = [name.strip() for name in rows[0]]
    if twice := next((name for name in names if names.count(name) > 1), None):
        raise KinematicsError(f"{path}: two columns are called {shown(twice)}.")
    if all(_number(name) is not None for name in names):
        raise KinematicsError(f"{path}: its first line must name the columns, not hold numbers.")
    table = np.empty((len(rows) - 1, len(names)))
    lines = np.array([number for number, _ in numbered[1:]], dtype=np.int64)
    for i, row in enumerate(rows[1:]):
        if len(row) != len(names):
            raise KinematicsError(
                f"{path}: line {lines[i]} has {len(row)} cells, the header {len(names)}."
            )
        for j, cell in enumerate(row):
            value = _number(cell)
            if value is None:
                raise KinematicsError(
                    f"{path}: line {lines[i]}, column {names[j]}: {shown(cell.strip())} is no "
                    "number; leave a cell empty where nothing was measured."
                )
            table[i, j] = value
    return Columns(str(path), {name: table[:, j] for j, name in enumerate(names)}, lines)


def _number(cell: str) -> float | None:
    text = cell.strip()
    if text.lower() in _NOTHING:
        return math.nan
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _of_dataset(dataset: xr.Dataset, origin: str) -> Columns:
    """Variables over `time`, or over `time` and an axis of three: x, y, z."""
    if "time" not in dataset.dims:
        raise KinematicsError(f'{origin}: has no dimension "time".')
    values: dict[str, FloatArray] = {}
    if "time" in dataset.coords:
        values["time"] = np.asarray(dataset["time"].values, dtype=float)
    units = set()
    for key, variable in dataset.data_vars.items():
        name = str(key)
        if "time" not in variable.dims:
            continue
        array = np.asarray(variable.transpose("time", ...).values, dtype=float)
        unit = str(variable.attrs.get("units", ""))
        if array.ndim == 2 and array.shape[1] == 3:
            values |= {f"{name}_{axis}": array[:, i] for i, axis in enumerate(_AXES)}
            units.add(unit)
        elif array.ndim == 1:
            in_degrees = unit in _DEGREES and not name.endswith("_deg")
            values[f"{name}_deg" if in_degrees else name] = array
            units |= {unit} if name[-2:] in ("_x", "_y", "_z") else set()
        else:
            raise KinematicsError(
                f"{origin}: {name} must go over time, or over time and an axis of three."
            )
    told = units - {""}
    if len(told) > 1:
        raise KinematicsError(f"{origin}: points are in different units ({', '.join(told)}).")
    return Columns(origin, values, unit=next(iter(told), None))


def _of_c3d(path: Path) -> Columns:
    try:
        ezc3d = import_module("ezc3d")
    except ImportError as error:
        raise KinematicsError(
            f"{path}: reading C3D needs ezc3d; install it by pip install 'birdmb[c3d]'."
        ) from error
    content = ezc3d.c3d(str(path))
    about = content["parameters"]["POINT"]
    labels = [str(label).strip() for label in about["LABELS"]["value"]]
    points = np.asarray(content["data"]["points"], dtype=float)  # (4, markers, frames)
    values = {
        f"{label}_{axis}": points[i, m] for m, label in enumerate(labels)
        for i, axis in enumerate(_AXES)
    }  # fmt: skip
    unit = str(next(iter(about.get("UNITS", {}).get("value", [])), "mm")).strip()
    return Columns(str(path), values, rate=float(about["RATE"]["value"][0]), unit=unit)
