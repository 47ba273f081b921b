"""The orbits and bifurcations of a branch as labelled real arrays, and back.

Orbits may have different numbers of states, which change with the nodes: `states` and `tangent` are
padded at their ends with NaN, and `segments` says how many there are. NetCDF's own ragged arrays
would need a dimension more that no program unfolds by itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.orbits.branch_points import Bifurcation, BifurcationKind, BranchPoint
from birdmb.orbits.cycle import OrbitMethod
from birdmb.orbits.cycle_dataset import OF_STATE, described
from birdmb.orbits.multipliers import Stability
from birdmb.quantities import BY_NAME

# Units, none of texts, and descriptions.
_DESCRIBED = {
    "parameter": ("as parameter_name", "parameter"),
    "parameter_error": ("as parameter_name", "error of the parameter of a bifurcation"),
    "period": ("s", "period"),
    "segments": ("1", "number of states along the orbit"),
    "states": (OF_STATE, "states along the orbit"),
    "residual": ("1", "closure error"),
    "multiplier_real": ("1", "Floquet multiplier, real part"),
    "multiplier_imag": ("1", "Floquet multiplier, imaginary part"),
    "multiplier_error": ("1", "bound of the error of the Floquet multiplier"),
    "trivial_index": ("1", "position of the trivial multiplier"),
    "stability": ("", "verdict"),
    "tangent": ("1", "direction of the branch, in state scales and parameter ranges"),
    "next_step": ("1", "length of the next step along the branch"),
    "method": ("", "method that found the orbit"),
    "state_error": ("1", "error of the states, in state scales"),
    "kind": ("", "kind of the bifurcation"),
    "after": ("1", "position of the point before the bifurcation"),
    "crossing": ("1", "whether the multiplier crosses the unit circle"),
    "outside": ("1", "multipliers outside the unit circle, before and after"),
}


def arrays_of(
    points: Sequence[BranchPoint], bifurcations: Sequence[Bifurcation]
) -> dict[str, xr.DataArray]:
    """Arrays by name; those of bifurcations begin with `bifurcation_`.

    Dimensions: point, state, segment (or node), multiplier, unknown, bifurcation, side (before and
    after).
    """

    def array(values: Sequence[object], *dims: str, kind: type | str | None = None) -> xr.DataArray:
        return xr.DataArray(np.array(values, dtype=kind), dims=("bifurcation", *dims))

    everything = [*points, *(found.point for found in bifurcations)]
    segments = max(len(point.points) for point in everything)
    unknowns = max(len(point.tangent) for point in everything)
    data = _stack(points, "point", segments, unknowns)
    data["bifurcation_kind"] = array([found.kind for found in bifurcations], kind="U16")
    data["bifurcation_after"] = array([found.after for found in bifurcations], kind=int)
    data["bifurcation_parameter_error"] = array(
        [found.parameter_error for found in bifurcations], kind=float
    )
    if bifurcations:
        located = _stack(everything[len(points) :], "bifurcation", segments, unknowns)
        data |= {f"bifurcation_{name}": values for name, values in located.items()}
        data["bifurcation_crossing"] = array([b.crossing for b in bifurcations], "multiplier")
        data["bifurcation_outside"] = array([b.outside for b in bifurcations], "side")
    for key, values in data.items():
        values.attrs = _attributes(key.removeprefix("bifurcation_"))
    return data


def _attributes(name: str) -> dict[str, str]:
    observed = name.removeprefix("observable_")
    if observed != name:
        known = BY_NAME.get(observed)
        return described(known.unit if known else "unknown", known.label if known else observed)
    units, about = _DESCRIBED[name]
    return described(units, about) if units else {"long_name": about}


def points_of(data: xr.Dataset) -> tuple[BranchPoint, ...]:
    """The points that `arrays_of` made the dataset of."""
    return tuple(_unstack(data, "", "point"))


def bifurcations_of(data: xr.Dataset) -> tuple[Bifurcation, ...]:
    """The bifurcations that `arrays_of` made the dataset of."""
    if not data.sizes["bifurcation"]:
        return ()
    located = _unstack(data, "bifurcation_", "bifurcation")
    return tuple(_bifurcation(point, data.isel(bifurcation=i)) for i, point in enumerate(located))


def _bifurcation(point: BranchPoint, row: xr.Dataset) -> Bifurcation:
    before, after = (int(number) for number in row["bifurcation_outside"].values)
    return Bifurcation(
        kind=cast("BifurcationKind", str(row["bifurcation_kind"].values)),
        point=point,
        parameter_error=float(row["bifurcation_parameter_error"]),
        after=int(row["bifurcation_after"]),
        crossing=row["bifurcation_crossing"].values.astype(bool),
        outside=(before, after),
    )


def _padded(values: FloatArray, length: int) -> FloatArray:
    """The array with rows of NaN up to a length."""
    rest = np.full((length - len(values), *values.shape[1:]), np.nan)
    return np.concatenate([values, rest])


def _stack(
    points: Sequence[BranchPoint], dim: str, segments: int, unknowns: int
) -> dict[str, xr.DataArray]:
    def array(values: list[object], *dims: str) -> xr.DataArray:
        return xr.DataArray(np.array(values), dims=(dim, *dims))

    data = {
        "parameter": array([p.parameter for p in points]),
        "period": array([p.period for p in points]),
        "segments": array([len(p.points) for p in points]),
        "states": array([_padded(p.points, segments) for p in points], "segment", "state"),
        "residual": array([p.residual for p in points]),
        "multiplier_real": array([p.multipliers.real for p in points], "multiplier"),
        "multiplier_imag": array([p.multipliers.imag for p in points], "multiplier"),
        "multiplier_error": array([p.multiplier_errors for p in points], "multiplier"),
        # NetCDF has no missing integers.
        "trivial_index": array(
            [np.nan if p.trivial_index is None else p.trivial_index for p in points]
        ),
        "stability": array([p.stability for p in points]),
        "tangent": array([_padded(p.tangent, unknowns) for p in points], "unknown"),
        "next_step": array([p.next_step for p in points]),
        "method": array([p.method for p in points]),
        "state_error": array([p.state_error for p in points]),
    }
    for name in points[0].observables:
        data[f"observable_{name}"] = array([p.observables[name] for p in points])
    return data


def _unstack(data: xr.Dataset, prefix: str, dim: str) -> list[BranchPoint]:
    start = f"{prefix}observable_"
    observables = [str(key) for key in data.data_vars if str(key).startswith(start)]
    # Of one branch all have the parameter and the period, if that is unknown, beside the states.
    widest = int(max(data[name].max() for name in data.data_vars if str(name).endswith("segments")))
    beside = data.sizes["unknown"] - widest * data.sizes["state"]
    points = []
    for i in range(data.sizes[dim]):
        row = data.isel({dim: i})
        real, imag = row[f"{prefix}multiplier_real"], row[f"{prefix}multiplier_imag"]
        trivial = float(row[f"{prefix}trivial_index"])
        segments = int(row[f"{prefix}segments"])
        unknowns = segments * data.sizes["state"] + beside
        points.append(
            BranchPoint(
                parameter=float(row[f"{prefix}parameter"]),
                period=float(row[f"{prefix}period"]),
                points=row[f"{prefix}states"].values[:segments],
                residual=float(row[f"{prefix}residual"]),
                multipliers=real.values + 1j * imag.values,
                multiplier_errors=row[f"{prefix}multiplier_error"].values,
                trivial_index=None if np.isnan(trivial) else int(trivial),
                stability=cast("Stability", str(row[f"{prefix}stability"].values)),
                tangent=row[f"{prefix}tangent"].values[:unknowns],
                next_step=float(row[f"{prefix}next_step"]),
                observables={key.removeprefix(start): float(row[key]) for key in observables},
                method=cast("OrbitMethod", str(row[f"{prefix}method"].values)),
                state_error=float(row[f"{prefix}state_error"]),
            )
        )
    return points
