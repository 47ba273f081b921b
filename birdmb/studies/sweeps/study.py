"""What a sweep has found so far."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb.arguments import checked
from birdmb.datafiles import family_attributes
from birdmb.quantities import BY_NAME, Quantity
from birdmb.studies.sweeps.contents import FORMAT, Contents
from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Grid, Place, Value
from birdmb.studies.sweeps.jumps import sheet_jumps
from birdmb.studies.sweeps.store import read
from birdmb.studies.sweeps.tasks import Outcome
from birdmb.summary import Fact, Summarised, brief, shortened
from birdmb.topology import Bird

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _long_name(quantity: Quantity) -> str:
    return f"{quantity.label}, {quantity.about}" if quantity.about else quantity.label


_NUMBERS = {each.name: (each.unit, _long_name(each)) for each in BY_NAME.values()} | {
    "iterations": ("1", "steps of the search"),
    "nodes": ("1", "nodes of a collocated orbit"),
    "steps_per_beat": ("1", "integration steps per wingbeat of a shot orbit"),
}
_FURTHER = {
    "multiplier_real": ("1", "Floquet multiplier, real part"),
    "multiplier_imag": ("1", "Floquet multiplier, imaginary part"),
    "multiplier_error": ("1", "error of the Floquet multiplier that the verdict counts"),
    "x0": ("SI, rad", "state at the start time"),
    "monodromy": ("SI, rad", "state after a period by that before"),
    "seconds": ("s", "time that the point took"),
    "sheet_jump": ("1", "whether the step to the next value does not explain the change"),
}
_BY_MULTIPLIER = ("multiplier_real", "multiplier_imag", "multiplier_error")
_OTHERS = (
    *("x0", "monodromy", "multiplier_mode", "stability", "flight", "integrator", "trimmed"),
    *("warning", "sensitivity", "state_scale", "orbit", "method", "method_reason"),
)


@dataclass(frozen=True, repr=False)
class Study(Summarised):
    """A sweep as its store held it when it was opened.

    Attributes:
        path: the store.
        bird: the bird that is varied.
        identity: what else the results depend on: version, model, search.
        parameters: values by dotted name.
        outcomes: of the finished points, by their values' positions in `parameters`.
    """

    path: Path
    bird: Bird
    identity: Mapping[str, Any]
    parameters: Mapping[str, tuple[Value, ...]]
    outcomes: Mapping[Place, Outcome]

    def _title(self) -> str:
        return self.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield Fact("finished points", f"{len(self.outcomes)} of {self.total}")
        yield Fact("without a cycle", str(len(self.failures)))
        for verdict, count in Counter(
            outcome.result["stability"] for outcome in self.outcomes.values() if outcome.result
        ).items():
            yield Fact(verdict, str(count))
        for name, values in self.parameters.items():
            yield Fact(name, f"{brief(values[0])} to {brief(values[-1])}, {len(values)} values")
        yield Fact("model", shortened(str(self.identity["model"])))
        yield Fact("store", shortened(self.path.name))

    @classmethod
    @checked
    def open(cls, store: str | PathLike[str]) -> Study:
        """Read a store, also one that a sweep is filling at the same time.

        Raises:
            SweepError: there is no such file, it is no study, damaged, or of a version of birdmb
                that kept something else.
        """
        held = read(store)
        bird = _bird(store, held)
        _require_results(store, held)
        points = {place: held.points[place] for place in sorted(held.points)}
        return cls(Path(store), bird, held.identity, held.grid.parameters, points)

    @property
    def total(self) -> int:
        """Points of the grid, finished or not."""
        return int(np.prod(Grid(self.parameters).shape))

    @property
    def failures(self) -> list[tuple[dict[str, Value], str]]:
        """Values and reason of every point that has no limit cycle."""
        grid = Grid(self.parameters)
        return [(grid.values(p), o.reason) for p, o in self.outcomes.items() if o.result is None]

    def to_xarray(self, *, timings: bool = False) -> xr.Dataset:
        """The study as a labelled dataset with real variables, fit for NetCDF.

        Dimensions: the parameters, `state`, `state_at_start`, `multiplier` (largest modulus first),
        `along` (the parameters' names).
        Where there is no cycle, or none yet, numbers are NaN and texts empty; states that only some
        points have are NaN at the others. `status` is "found", "failed" or "missing", `failure` the
        reason, `flight` "forwards", or "backwards" for a bird that flies so, on its tail or on its
        back, `warning` how a cycle leaves the model's validity, `method` "collocation" or
        "shooting", `method_reason` why the latter, `integrator` explicit or implicit if so,
        `multiplier_error` what the verdict counts (NaN: no bound), `multiplier_mode` what its mode
        is called, or else its plane, `start` the neighbour that the
        search started from. `sheet_jump` is true where the step to the next larger value of the
        parameter `along` does not explain how the flights at both differ
        (`birdmb.studies.sweeps.jumps`). The same study gives the same dataset to the last bit,
        however it was computed; but for `seconds`, which `timings` adds.
        """
        found = {place: o.result for place, o in self.outcomes.items() if o.result is not None}
        states = list(dict.fromkeys(name for result in found.values() for name in result["x0"]))
        data = self._texts(found)
        for name, (units, about) in _NUMBERS.items():
            data[name] = self._filled({p: r[name] for p, r in found.items()})
            data[name].attrs = {"units": units, "long_name": about}
        for name in (self.identity["trim"] or {}).get("parameters", ()):
            data[name] = self._filled({p: r["trimmed"][name] for p, r in found.items()})
            in_degrees = {"units": "deg"} if name.endswith("_deg") else {}
            data[name].attrs = {**in_degrees, "long_name": f"{name}, as trimmed"}
        for name in _BY_MULTIPLIER:
            rows = {p: _padded(r[name], len(states)) for p, r in found.items()}
            data[name] = self._filled(rows, multiplier=len(states))
        data["x0"] = self._filled(
            {p: [r["x0"].get(name, np.nan) for name in states] for p, r in found.items()},
            state=len(states),
        )
        data["multiplier_mode"] = self._modes(found, len(states))
        data["monodromy"] = self._filled(
            {p: _placed(r, states) for p, r in found.items()},
            state=len(states),
            state_at_start=len(states),
        )
        if timings:
            data["seconds"] = self._filled({p: o.seconds for p, o in self.outcomes.items()})
        bounds = (self.identity["trim"] or {}).get("parameters", {})
        data["sheet_jump"] = sheet_jumps(Grid(self.parameters), found, bounds)
        data |= _derived(data)
        for name, values in data.items():
            if values.dtype.kind in "fib":
                units, about = _FURTHER.get(name, ("1", name))
                values.attrs = {"units": units, "long_name": about} | values.attrs
        coordinates: dict[str, Any] = {
            name: (name, list(values), {"units": "deg"} if name.endswith("_deg") else {})
            for name, values in self.parameters.items()
        }
        coordinates |= {"state": states, "state_at_start": states, "along": [*self.parameters]}
        return xr.Dataset(
            data,
            coords=coordinates
            | {"multiplier": ("multiplier", np.arange(len(states)), {"units": "1"})},
            attrs={
                **family_attributes(
                    "sweep",
                    f"sweep of {self.bird.name} over {', '.join(self.parameters)}",
                    f"{len(self.outcomes)} of {self.total} points",
                    {"birdmb": self.identity["birdmb"]},
                ),
                "format": FORMAT,
                "bird": self.bird.name,
                "fingerprint": self.identity["fingerprint"],
                "model": self.identity["model"],
                "birdmb_version": self.identity["birdmb"],
                "parameters": list(self.parameters),
            },
        )

    def _filled(self, rows: Mapping[Place, Any], **axes: int) -> xr.DataArray:
        """Values by place, NaN elsewhere, over the parameters and further `axes` (name: length)."""
        values = np.full((*Grid(self.parameters).shape, *axes.values()), np.nan)
        for place, row in rows.items():
            values[place] = row  # None becomes NaN
        return xr.DataArray(values, dims=[*self.parameters, *axes])

    def _texts(self, found: Mapping[Place, Mapping[str, Any]]) -> dict[str, xr.DataArray]:
        columns = {
            "status": {p: "found" if p in found else "failed" for p in self.outcomes},
            "failure": {p: o.reason for p, o in self.outcomes.items()},
            "start": {p: o.start for p, o in self.outcomes.items()},
            "stability": {p: r["stability"] for p, r in found.items()},
            "flight": {p: r["flight"] for p, r in found.items()},
            "warning": {p: r["warning"] for p, r in found.items()},
            "integrator": {p: r["integrator"] for p, r in found.items()},
            "method": {p: r["method"] for p, r in found.items()},
            "method_reason": {p: r["method_reason"] for p, r in found.items()},
        }
        shape = Grid(self.parameters).shape
        texts = {}
        for name, column in columns.items():
            values = np.full(shape, "missing" if name == "status" else "", dtype=object)
            for place, text in column.items():
                values[place] = text
            texts[name] = xr.DataArray(values.astype(str), dims=list(self.parameters))
        return texts

    def _modes(self, found: Mapping[Place, Mapping[str, Any]], count: int) -> xr.DataArray:
        values = np.full((*Grid(self.parameters).shape, count), "", dtype=object)
        for place, result in found.items():
            values[place][: len(result["multiplier_mode"])] = result["multiplier_mode"]
        return xr.DataArray(values.astype(str), dims=[*self.parameters, "multiplier"])

    def plot(self, quantity: str | None = None, *, at: Mapping[str, Value] | None = None) -> Figure:
        """Draw the study: lines over one parameter, maps over two, with the stability boundary.

        Args:
            quantity: `largest_modulus`, `time_constant`, `power`, `mean_climb_rate` or any other
                variable of the dataset with one number a point; by default those four.
            at: fixed values of parameters, by name, until no more than two are left.

        Raises:
            SweepError: no such quantity or value, or more than two parameters left.
        """
        from birdmb.figures import plot_sweep  # noqa: PLC0415 - it draws

        return plot_sweep(self.to_xarray(timings=True), quantity, at or {})


def _bird(store: str | PathLike[str], held: Contents) -> Bird:
    try:
        return Bird.model_validate(held.identity["bird"])
    except ValueError as error:  # pydantic's
        raise SweepError(
            f"{Path(store)} holds a bird of birdmb {held.identity['birdmb']} that this one, "
            f"{version('birdmb')}, cannot read; read the study with that version."
        ) from error


def _require_results(store: str | PathLike[str], held: Contents) -> None:
    needed = {*_NUMBERS, *_BY_MULTIPLIER, *_OTHERS}
    for outcome in held.points.values():
        lacking = needed - (outcome.result or dict.fromkeys(needed)).keys()
        if lacking:
            raise SweepError(
                f"{Path(store)} holds points of birdmb {held.identity['birdmb']} without "
                f"{', '.join(sorted(lacking))}, which this one, {version('birdmb')}, keeps; read "
                f"the study with that version."
            )


def _derived(data: Mapping[str, xr.DataArray]) -> dict[str, xr.DataArray]:
    """|Lambda|max, and how fast its mode grows or decays."""
    parts = data["multiplier_real"], data["multiplier_imag"]
    moduli = np.hypot(*(part.values for part in parts))
    # Largest first; in a forced system none is trivial. No point found, no multipliers.
    largest = moduli[..., 0] if moduli.shape[-1] else np.full(moduli.shape[:-1], np.nan)
    with np.errstate(divide="ignore"):
        constant = data["period"].values / np.abs(np.log(largest))
    about = "time in which the leading disturbance grows or decays by the factor e"
    return {
        name: data["period"].copy(data=values).assign_attrs(units=units, long_name=text)
        for name, values, units, text in (
            ("largest_modulus", largest, "1", "largest modulus of a multiplier"),
            ("time_constant", constant, "s", about),
        )
    }


def _padded(values: list[float | None], size: int) -> npt.NDArray[np.float64]:
    return np.array(values + [None] * (size - len(values)), dtype=float)


def _placed(result: Mapping[str, Any], states: list[str]) -> npt.NDArray[np.float64]:
    """The monodromy (n, n) among all states of the study, NaN where the point lacks them."""
    matrix = np.full((len(states), len(states)), np.nan)
    own = [states.index(name) for name in result["x0"]]
    matrix[np.ix_(own, own)] = result["monodromy"]
    return matrix
