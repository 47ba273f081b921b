"""The fields of a limit cycle as labelled real arrays, and back, to the last bit.

What `LimitCycle.to_xarray` adds to them (trajectory, exponents, participation ...) follows from
these and is there for other programs.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from birdmb._typing import ComplexArray, FloatArray
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.piecewise import PiecewisePath

# SI units of each state, by the coordinate `state_unit` where a file has it.
OF_STATE = "as state_unit"
BY_START = "as state_unit, per that of state_at_start"
_BOTH = ("state", "multiplier")
_ALONG = ("segment", "state", "multiplier")
_NONE = -1

# Fields that are arrays: dimensions, units, description. Complex ones in two variables.
_REAL = {
    "x0": (("state",), OF_STATE, "state at the start time"),
    "points": (("segment", "state"), OF_STATE, "states at the starts of the segments or nodes"),
    "state_scale": (("state",), OF_STATE, "typical sizes of the states"),
    "monodromy": (("state", "state_at_start"), BY_START, "state after a period by that before"),
    "segment_jacobians": (
        ("segment", "state", "state_at_start"),
        BY_START,
        "state at the end of each segment by that at its start",
    ),
    "multiplier_error": (("multiplier",), "1", "bound of the error of the Floquet multiplier"),
}
_COMPLEX = {
    "multiplier": ("multipliers", ("multiplier",), "1", "Floquet multiplier"),
    "mode": ("modes", _BOTH, OF_STATE, "mode at the start time"),
    "left_mode": ("left_modes", _BOTH, "1 / state_unit", "left eigenvector of the monodromy"),
    "mode_along": ("modes_along", _ALONG, OF_STATE, "periodic part of the mode at `points`"),
}
_ITERATION: dict[str, tuple[str, str, type]] = {
    "number": ("1", "steps taken so far", int),
    "residual": ("1", "norm of the closure errors, in state scales", float),
    "step_length": ("1", "length of the step, in state scales", float),
    "damping": ("1", "part of Newton's step taken, or Levenberg-Marquardt parameter", float),
    "period": ("s", "period", float),
}
_NUMBERS = ("period", "start_time", "residual", "jacobian_gap", "state_error")
_TEXTS = ("jacobian_method", "method_reason")

Variable = tuple[tuple[str, ...], Any, dict[str, str]]


def described(units: str, about: str) -> dict[str, str]:
    """Attributes of a variable."""
    return {"units": units, "long_name": about}


def stored_orbit(fields: Mapping[str, Any]) -> dict[str, Variable]:
    """Variables, by name, of the arrays of a `FloquetResult`."""
    variables: dict[str, Variable] = {}
    for name, (dims, units, about) in _REAL.items():
        field = "multiplier_errors" if name == "multiplier_error" else name
        variables[name] = (dims, fields[field], described(units, about))
    for name, (field, dims, units, about) in _COMPLEX.items():
        whole: ComplexArray = fields[field]
        variables[f"{name}_real"] = (dims, whole.real, described(units, f"{about}, real part"))
        variables[f"{name}_imag"] = (
            dims,
            whole.imag,
            described(units, f"{about}, imaginary part"),
        )
    return variables


def stored_search(fields: Mapping[str, Any]) -> tuple[dict[str, Variable], dict[str, Any]]:
    """Variables and attributes, each by name, of what a `LimitCycle` has besides these arrays."""
    variables = _of_iterations(fields["iterations"])
    if fields["pieces"] is not None:
        variables["mesh"] = (
            ("mesh_point",),
            fields["pieces"].mesh,
            described("1", "phases between the intervals of the mesh"),
        )
        variables["piece_values"] = (
            ("interval", "stage", "state"),
            fields["pieces"].values,
            described(OF_STATE, "states at the start and the Gauss points of each interval"),
        )
    index = fields["trivial_index"]
    attributes: dict[str, Any] = {name: float(fields[name]) for name in _NUMBERS}
    attributes |= {name: fields[name] for name in _TEXTS}
    attributes |= {
        "trivial_index": _NONE if index is None else int(index),
        "nodes": fields["nodes"] or 0,
        "search": json.dumps(dict(fields["search"])),
    }
    return variables, attributes


def restored(data: xr.Dataset) -> dict[str, Any]:
    """The fields, but for the model, of a dataset with all that the two above return.

    Raises `KeyError`, `ValueError` or `TypeError` where it does not hold them.
    """
    found: dict[str, Any] = {
        "multiplier_errors" if name == "multiplier_error" else name: _values(data, name, dims)
        for name, (dims, _, _) in _REAL.items()
    }
    for name, (field, dims, _, _) in _COMPLEX.items():
        real = _values(data, f"{name}_real", dims)
        whole: ComplexArray = np.empty(real.shape, complex)
        whole.real, whole.imag = real, _values(data, f"{name}_imag", dims)
        found[field] = whole
    found |= {name: float(data.attrs[name]) for name in _NUMBERS}
    found |= {name: str(data.attrs[name]) for name in _TEXTS}
    index = int(data.attrs["trivial_index"])
    pieces = None
    if "piece_values" in data:
        pieces = PiecewisePath(
            _values(data, "mesh", ("mesh_point",)),
            _values(data, "piece_values", ("interval", "stage", "state")),
        )
    return found | {
        "state_names": tuple(str(name) for name in data["state"].values),
        "trivial_index": None if index == _NONE else index,
        "nodes": int(data.attrs["nodes"]) or None,
        "search": json.loads(data.attrs["search"]),
        "pieces": pieces,
        "iterations": _iterations(data),
    }


def _values(data: xr.Dataset, name: str, dims: tuple[str, ...]) -> FloatArray:
    return np.ascontiguousarray(data[name].transpose(*dims).values, dtype=float)


def _of_iterations(iterations: tuple[Iteration, ...]) -> dict[str, Variable]:
    found: dict[str, Variable] = {}
    for name, (units, about, kind) in _ITERATION.items():
        values: Any = np.array([getattr(each, name) for each in iterations], kind)
        found[f"iteration_{name}"] = (("iteration",), values, described(units, about))
    states = np.array([each.x for each in iterations], float)
    found["iteration_x"] = (
        ("iteration", "state"),
        states.reshape(len(iterations), -1),
        described(OF_STATE, "state at the start of the orbit"),
    )
    reused = np.array([each.jacobian_reused for each in iterations], np.int8)
    found["iteration_jacobian_reused"] = (
        ("iteration",),
        reused,
        described("1", "1 where the step was made with an earlier Jacobian"),
    )
    nodes = np.array([each.nodes or 0 for each in iterations], int)
    found["iteration_nodes"] = (
        ("iteration",),
        nodes,
        described("1", "collocation nodes; 0 of shooting"),
    )
    return found


def _iterations(data: xr.Dataset) -> tuple[Iteration, ...]:
    columns = {
        name: data[f"iteration_{name}"].values
        for name in (*_ITERATION, "x", "jacobian_reused", "nodes")
    }
    return tuple(
        Iteration(
            number=int(columns["number"][i]),
            residual=float(columns["residual"][i]),
            step_length=float(columns["step_length"][i]),
            damping=float(columns["damping"][i]),
            x=np.array(columns["x"][i], float),
            period=float(columns["period"][i]),
            jacobian_reused=bool(columns["jacobian_reused"][i]),
            nodes=int(columns["nodes"][i]) or None,
        )
        for i in range(data.sizes["iteration"])
    )
