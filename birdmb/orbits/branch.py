"""A branch of periodic orbits in one parameter: what a continuation returns, saves and resumes."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal, cast

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from birdmb._typing import BoolArray, ComplexArray, FloatArray
from birdmb.orbits import plots
from birdmb.orbits.errors import BranchStopped
from birdmb.orbits.multipliers import Stability

BifurcationKind = Literal[
    "fold", "period doubling", "Neimark-Sacker", "branch point", "multiple"
]

_SETTING = "setting_"


@dataclass(frozen=True)
class BranchPoint:
    """One orbit of a branch: `floquet(family(parameter), points, period, ...)` has all of it.

    Attributes:
        parameter: value of the parameter.
        period: period in s.
        points: states (M, n) at the starts of the shooting segments.
        residual: closure error in the units of the states.
        multipliers: (n,), largest modulus first.
        multiplier_errors: bound (n,) of the error of each.
        trivial_index: position of the trivial multiplier, `None` for a forced system.
        stability: verdict of the multipliers.
        tangent: unit tangent of the branch in scaled unknowns, in the direction of travel.
        next_step: length of the step that was to follow, from which a continuation resumes.
        observables: what the caller asked to be recorded of the orbit, by name.
    """

    parameter: float
    period: float
    points: FloatArray
    residual: float
    multipliers: ComplexArray
    multiplier_errors: FloatArray
    trivial_index: int | None
    stability: Stability
    tangent: FloatArray
    next_step: float
    observables: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Bifurcation:
    """A located crossing of the unit circle by one or more multipliers.

    Attributes:
        kind: "fold" (the branch turns, multiplier 1), "period doubling" (multiplier -1),
            "Neimark-Sacker" (complex pair on the unit circle), "branch point" (multiplier 1, the
            branch does not turn) or "multiple": more multipliers cross at once than these kinds
            have, as in several copies of one system, in symmetric systems, and where a pair crosses
            at 1 or -1 (the strong resonances 1:1 and 1:2). `multipliers` says which.
        point: the orbit there.
        parameter_error: bound of the error of the parameter that comes from the location and from
            the error bounds of the multipliers.
        after: index of the branch point before it.
        crossing: mask (n,) of the multipliers that cross.
        outside: numbers of multipliers outside the unit circle before and after, in the direction
            of travel; those that stay on the circle all along the branch are not counted.
    """

    kind: BifurcationKind
    point: BranchPoint
    parameter_error: float
    after: int
    crossing: BoolArray
    outside: tuple[int, int]

    @property
    def parameter(self) -> float:
        """Value of the parameter."""
        return self.point.parameter

    @property
    def multipliers(self) -> ComplexArray:
        """Multipliers (k,) that cross the unit circle."""
        return np.asarray(self.point.multipliers[self.crossing])

    @property
    def changes_stability(self) -> bool:
        """Whether orbits are stable, or not known to be unstable, on one of its two sides alone."""
        return (self.outside[0] == 0) != (self.outside[1] == 0)


@dataclass(frozen=True)
class Branch:
    """Periodic orbits along one parameter, in the order of travel.

    Attributes:
        parameter_name: name of the parameter.
        state_names: names of the n states.
        state_scale: typical sizes (n,) of the states that measured the arclength.
        start_time: time of the first state of each orbit in s.
        points: the orbits.
        bifurcations: what was located between them.
        stopped: why the branch ended early; `None` if it reached an end of its parameter range.
        settings: what the caller wants kept with the branch, by name: how the orbits were computed,
            of which system.
    """

    parameter_name: str
    state_names: tuple[str, ...]
    state_scale: FloatArray
    start_time: float
    points: tuple[BranchPoint, ...]
    bifurcations: tuple[Bifurcation, ...]
    stopped: BranchStopped | None
    settings: Mapping[str, str | float] = field(default_factory=dict)

    @property
    def parameters(self) -> FloatArray:
        """Values (k,) of the parameter."""
        return np.array([point.parameter for point in self.points])

    def to_xarray(self) -> xr.Dataset:
        """Return the branch as a labelled dataset with real variables, fit for NetCDF.

        Dimensions: point, state, segment, multiplier, unknown, bifurcation; variables of
        bifurcations begin with `bifurcation_`.
        """
        located = [bifurcation.point for bifurcation in self.bifurcations]
        kinds = [bifurcation.kind for bifurcation in self.bifurcations]
        data = _stack(self.points, "point")
        if located:
            data |= {f"bifurcation_{k}": v for k, v in _stack(located, "bifurcation").items()}
        data["bifurcation_kind"] = xr.DataArray(np.array(kinds, dtype="U16"), dims="bifurcation")
        for name in ("parameter_error", "after"):
            values = [getattr(bifurcation, name) for bifurcation in self.bifurcations]
            data[f"bifurcation_{name}"] = xr.DataArray(np.array(values), dims="bifurcation")
        if located:
            crossing = [bifurcation.crossing for bifurcation in self.bifurcations]
            outside = [bifurcation.outside for bifurcation in self.bifurcations]
            data["bifurcation_crossing"] = (("bifurcation", "multiplier"), np.array(crossing))
            data["bifurcation_outside"] = (("bifurcation", "side"), np.array(outside))
        data["state_scale"] = xr.DataArray(self.state_scale, dims="state")
        attrs: dict[str, str | float] = {
            "parameter_name": self.parameter_name,
            "start_time": self.start_time,
        }
        attrs |= {f"{_SETTING}{name}": value for name, value in self.settings.items()}
        if self.stopped is not None:
            attrs |= {
                "stop_reason": self.stopped.reason,
                "stop_parameter": self.stopped.parameter,
                "stop_detail": self.stopped.detail,
            }
        return xr.Dataset(data, coords={"state": list(self.state_names)}, attrs=attrs)

    def save(self, path: str | Path) -> None:
        """Write the branch to a NetCDF file, from which `load_branch` and a continuation resume.

        A file of that name is replaced only once the new one is whole.
        """
        path = Path(path)
        draft = path.with_name(f".{path.stem}.{os.getpid()}{path.suffix}")
        try:
            self.to_xarray().to_netcdf(draft, engine="h5netcdf")
            draft.replace(path)
        finally:
            draft.unlink(missing_ok=True)

    def plot(self, quantity: str | None = None) -> Figure:
        """Draw a quantity (a state's name, "period" or an observable) and the multipliers' moduli.

        By default the first state at the start of the orbits. Stable parts are drawn in one colour,
        unstable ones in another, undecided ones in grey; bifurcations are marked.
        """
        name = quantity or self.state_names[0]
        return plots.plot_branch(self, name)

    def values(self, quantity: str) -> FloatArray:
        """Values (k,) of a state at the start of the orbits, of "period" or of an observable."""
        return np.array([self.value_of(point, quantity) for point in self.points])

    def value_of(self, point: BranchPoint, quantity: str) -> float:
        """Value of one point: of a state at the start, of "period" or of an observable."""
        if quantity == "period":
            return point.period
        if quantity in self.state_names:
            return float(point.points[0, self.state_names.index(quantity)])
        return point.observables[quantity]


def load_branch(path: str | Path) -> Branch:
    """Read a branch that `Branch.save` wrote."""
    with xr.open_dataset(path, engine="h5netcdf") as stored:
        data = stored.load()
    bifurcations = []
    if data.sizes["bifurcation"]:
        for i, point in enumerate(_unstack(data, "bifurcation_", "bifurcation")):
            row = data.isel(bifurcation=i)
            bifurcations.append(
                Bifurcation(
                    kind=cast("BifurcationKind", str(row["bifurcation_kind"].values)),
                    point=point,
                    parameter_error=float(row["bifurcation_parameter_error"]),
                    after=int(row["bifurcation_after"]),
                    crossing=row["bifurcation_crossing"].values.astype(bool),
                    outside=tuple(map(int, row["bifurcation_outside"].values)),
                )
            )
    stopped = None
    if "stop_reason" in data.attrs:
        stopped = BranchStopped(
            data.attrs["stop_reason"],
            float(data.attrs["stop_parameter"]),
            data.attrs["stop_detail"],
        )
    return Branch(
        parameter_name=data.attrs["parameter_name"],
        state_names=tuple(str(name) for name in data["state"].values),
        state_scale=data["state_scale"].values,
        start_time=float(data.attrs["start_time"]),
        points=tuple(_unstack(data, "", "point")),
        bifurcations=tuple(bifurcations),
        stopped=stopped,
        settings={
            str(key).removeprefix(_SETTING): value.item()
            if isinstance(value, np.generic)
            else value
            for key, value in data.attrs.items()
            if str(key).startswith(_SETTING)
        },
    )


def _stack(points: Sequence[BranchPoint], dim: str) -> dict[str, xr.DataArray]:
    def array(values: list[object], *dims: str) -> xr.DataArray:
        return xr.DataArray(np.array(values), dims=(dim, *dims))

    data = {
        "parameter": array([p.parameter for p in points]),
        "period": array([p.period for p in points]),
        "states": array([p.points for p in points], "segment", "state"),
        "residual": array([p.residual for p in points]),
        "multiplier_real": array([p.multipliers.real for p in points], "multiplier"),
        "multiplier_imag": array([p.multipliers.imag for p in points], "multiplier"),
        "multiplier_error": array([p.multiplier_errors for p in points], "multiplier"),
        # NetCDF has no missing integers.
        "trivial_index": array(
            [np.nan if p.trivial_index is None else p.trivial_index for p in points]
        ),
        "stability": array([p.stability for p in points]),
        "tangent": array([p.tangent for p in points], "unknown"),
        "next_step": array([p.next_step for p in points]),
    }
    for name in points[0].observables:
        data[f"observable_{name}"] = array([p.observables[name] for p in points])
    return data


def _unstack(data: xr.Dataset, prefix: str, dim: str) -> list[BranchPoint]:
    start = f"{prefix}observable_"
    observables = [str(key) for key in data.data_vars if str(key).startswith(start)]
    points = []
    for i in range(data.sizes[dim]):
        row = data.isel({dim: i})
        real, imag = row[f"{prefix}multiplier_real"], row[f"{prefix}multiplier_imag"]
        trivial = float(row[f"{prefix}trivial_index"])
        points.append(
            BranchPoint(
                parameter=float(row[f"{prefix}parameter"]),
                period=float(row[f"{prefix}period"]),
                points=row[f"{prefix}states"].values,
                residual=float(row[f"{prefix}residual"]),
                multipliers=real.values + 1j * imag.values,
                multiplier_errors=row[f"{prefix}multiplier_error"].values,
                trivial_index=None if np.isnan(trivial) else int(trivial),
                stability=cast("Stability", str(row[f"{prefix}stability"].values)),
                tangent=row[f"{prefix}tangent"].values,
                next_step=float(row[f"{prefix}next_step"]),
                observables={key.removeprefix(start): float(row[key]) for key in observables},
            )
        )
    return points
