"""A branch of periodic orbits in one parameter: what a continuation returns, saves and resumes."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.datafiles import family_attributes
from birdmb.files import netcdf_bytes, write_whole
from birdmb.orbits.branch_dataset import arrays_of, bifurcations_of, points_of
from birdmb.orbits.branch_points import Bifurcation, BranchPoint
from birdmb.orbits.cycle_dataset import OF_STATE, described
from birdmb.orbits.errors import BranchFileError, BranchStopped
from birdmb.provenance import software
from birdmb.seal import sealed, unsealed
from birdmb.summary import Fact, Summarised
from birdmb.text import on_one_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_FORMAT = 4
_SETTING = "setting_"


@dataclass(frozen=True, repr=False)
class Branch(Summarised):
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
        software: versions of the packages that computed the branch; several, in the order of
            travel, where it was resumed with another one.
    """

    parameter_name: str
    state_names: tuple[str, ...]
    state_scale: FloatArray
    start_time: float
    points: tuple[BranchPoint, ...]
    bifurcations: tuple[Bifurcation, ...]
    stopped: BranchStopped | None
    settings: Mapping[str, str | float] = field(default_factory=dict)
    software: Mapping[str, str] = field(default_factory=software)

    def _title(self) -> str:
        return f"in {self.parameter_name}"

    def _summary(self) -> Iterator[Fact]:
        yield Fact("points", str(len(self.points)))
        ends = [point.parameter for point in (*self.points[:1], *self.points[-1:])]
        if ends:
            yield Fact("from", f"{ends[0]:.6g}")
            yield Fact("to", f"{ends[-1]:.6g}")
        for verdict in dict.fromkeys(point.stability for point in self.points):
            count = sum(point.stability == verdict for point in self.points)
            yield Fact(verdict, str(count))
        for found in self.bifurcations:
            yield Fact(found.kind, f"{found.parameter:.6g}")
        if self.stopped is not None:
            yield Fact("stopped", self.stopped.reason)

    @property
    def parameters(self) -> FloatArray:
        """Values (k,) of the parameter."""
        return np.array([point.parameter for point in self.points])

    def to_xarray(self) -> xr.Dataset:
        """Return the branch as a labelled dataset with real variables, fit for NetCDF.

        Dimensions: point, state, segment (or node), multiplier, unknown, bifurcation, side;
        variables of bifurcations begin with `bifurcation_`. Of an orbit with fewer states than
        another (`segments` says how many), `states` and `tangent` end in NaN.
        """
        data = arrays_of(self.points, self.bifurcations)
        data["state_scale"] = xr.DataArray(
            self.state_scale,
            dims="state",
            attrs=described(OF_STATE, "typical sizes of the states"),
        )
        attrs: dict[str, str | float] = {
            **family_attributes(
                "branch",
                f"branch of limit cycles in {self.parameter_name}",
                f"continuation, {len(self.points)} orbits",
                self.software,
            ),
            "format": _FORMAT,
            "software": json.dumps(dict(self.software)),
            "parameter_name": self.parameter_name,
            "start_time": self.start_time,
        }
        attrs |= {f"{_SETTING}{name}": value for name, value in self.settings.items()}
        if self.stopped is not None:
            attrs |= {
                "stop_reason": self.stopped.reason,
                "stop_parameter": self.stopped.parameter,
                "stop_detail": on_one_line(self.stopped.detail),
            }
        return xr.Dataset(data, coords={"state": list(self.state_names)}, attrs=attrs)

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the branch to a NetCDF file, from which `load_branch` and a continuation resume.

        A file of that name is replaced only once the new one is whole on the disk.

        Returns:
            The path.

        Raises:
            OutputError: the file cannot be written.
        """
        return write_whole(path, sealed(netcdf_bytes(self.to_xarray())))

    def plot(self, quantity: str | None = None) -> Figure:
        """Draw a quantity (a state's name, "period" or an observable) and the multipliers' moduli.

        By default the first state at the start of the orbits. Stable parts are drawn through,
        unstable ones dashed, undecided ones dotted; bifurcations are marked.
        """
        from birdmb.figures import plot_branch  # noqa: PLC0415 - it draws

        return plot_branch(self, quantity or self.state_names[0])

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


@checked
def load_branch(path: str | PathLike[str]) -> Branch:
    """Read a branch that `Branch.save` wrote.

    Raises:
        BranchFileError: there is no such file, it holds no branch, is damaged or of another format.
    """
    path = Path(path)
    try:
        file = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise BranchFileError(f"{path} cannot be read ({reason.lower()}).") from error
    try:
        content = unsealed(file)
        if content is None:
            raise BranchFileError(
                f"{path} holds no branch, or only part of one; remove it to begin anew, or give "
                f"another file."
            )
        with xr.open_dataset(io.BytesIO(content), engine="h5netcdf") as stored:
            data = stored.load()
        if data.attrs.get("format") != _FORMAT:
            raise BranchFileError(
                f"{path} is of format {data.attrs.get('format')}; this birdmb reads branches of "
                f"format {_FORMAT}: remove it to begin anew, or give another file."
            )
        return _branch(data)
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError) as error:
        if isinstance(error, BranchFileError):
            raise
        reason = on_one_line(str(error)) or type(error).__name__
        raise BranchFileError(
            f"{path} is damaged ({reason}); restore it from a copy, or remove it to begin anew."
        ) from error


def _branch(data: xr.Dataset) -> Branch:
    if not data.sizes["point"] or "state" not in data.coords or not data.sizes["state"]:
        raise ValueError("it has no points or no states")
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
        points=points_of(data),
        bifurcations=bifurcations_of(data),
        stopped=stopped,
        settings={
            str(key).removeprefix(_SETTING): value.item()
            if isinstance(value, np.generic)
            else value
            for key, value in data.attrs.items()
            if str(key).startswith(_SETTING)
        },
        software=json.loads(data.attrs["software"]),
    )
