"""A periodic orbit that a search found."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from os import PathLike
from pathlib import Path
from typing import Literal, Self

import numpy as np
import numpy.typing as npt
import xarray as xr

from birdmb.datafiles import family_attributes
from birdmb.files import netcdf_bytes, write_whole
from birdmb.orbits.cycle_dataset import stored_search
from birdmb.orbits.iteration import Iteration
from birdmb.orbits.ode import Trajectory
from birdmb.orbits.piecewise import PiecewisePath
from birdmb.orbits.problem import HasLimitCycleType, Model
from birdmb.orbits.result import FloquetResult
from birdmb.orbits.trigonometric import interpolated
from birdmb.provenance import software
from birdmb.seal import sealed
from birdmb.summary import Fact

CYCLE_FORMAT = 1
OrbitMethod = Literal["collocation", "shooting"]


@dataclass(frozen=True, repr=False)
class LimitCycle(FloquetResult):
    """A periodic orbit found by `find_limit_cycle`, with its Floquet multipliers.

    A model may name its own subclass as `limit_cycle_type`, to add what it knows of its orbits. Of
    a collocated orbit, `points` are the states at its nodes, or at more instants where the
    multipliers need them, `segment_jacobians` lead from one of them to the next, and `residual` is
    the largest mismatch of slopes at a node, in the units of the states per period.

    Attributes:
        iterations: the accepted iterations of the search, the guess first.
        method_reason: why shooting was taken, or a mesh; empty for Fourier collocation.
        nodes: number of collocation nodes; `None` for shooting.
        state_error: largest error of the states of a collocated orbit, in units of the state scale:
            what half as many nodes again make of it, or a mesh with all intervals halved; 0 for
            shooting.
        pieces: the orbit's polynomials on the intervals of a mesh; `None` where it has none.
        search: settings of the search that were asked for, by name.
    """

    iterations: tuple[Iteration, ...]
    method_reason: str = ""
    nodes: int | None = None
    state_error: float = 0.0
    pieces: PiecewisePath | None = None
    search: Mapping[str, str | float | None] = field(default_factory=dict)

    def _summary_of_search(self) -> Iterator[Fact]:
        yield Fact("method", self.method)
        if self.nodes is not None:
            yield Fact("nodes", str(self.nodes))

    @classmethod
    def of(
        cls,
        orbit: FloquetResult,
        iterations: tuple[Iteration, ...],
        method_reason: str = "",
        nodes: int | None = None,
        state_error: float = 0.0,
        pieces: PiecewisePath | None = None,
    ) -> Self:
        """The cycle of a linearised orbit and of the search that led to it."""
        known = {field.name: getattr(orbit, field.name) for field in fields(FloquetResult)}
        return cls(
            **known,
            iterations=iterations,
            method_reason=method_reason,
            nodes=nodes,
            state_error=state_error,
            pieces=pieces,
        )

    @property
    def intervals(self) -> int | None:
        """Number of the mesh's intervals; `None` where there is no mesh."""
        return None if self.pieces is None else len(self.pieces.values)

    @property
    def method(self) -> OrbitMethod:
        """By which method it was found."""
        return "shooting" if self.nodes is None else "collocation"

    @property
    def sort_key(self) -> tuple[float, ...]:
        """What `find_limit_cycles` sorts by: the period, then the size in state scales."""
        return self.period, float(np.linalg.norm(self.trajectory().states / self.state_scale))

    def trajectory(self, times: npt.ArrayLike | None = None) -> Trajectory:
        """States at `times` (k,) in s, any times: the orbit is continued periodically.

        By default 201 times over the period from the start time. A collocated orbit is its
        trigonometric interpolant or its polynomials, a shot one is flown from the starts of its
        segments.
        """
        if self.method == "shooting":
            return super().trajectory(times)
        if times is None:
            at = self.start_time + np.linspace(0, self.period, 201)
        else:
            at = np.asarray(times, float)
        phases = (at - self.start_time) / self.period
        if self.pieces is not None:
            return Trajectory(at, self.pieces.states(phases))
        return Trajectory(at, interpolated(self.points, phases))

    def to_xarray(self) -> xr.Dataset:
        """Return the orbit as `FloquetResult.to_xarray` does, with all that the search found.

        Further dimensions: segment (or node), iteration, and those of a mesh.
        """
        variables, attributes = stored_search(
            {each.name: getattr(self, each.name) for each in fields(self)}
        )
        return (
            super()
            .to_xarray()
            .assign(variables)
            .assign_attrs(
                attributes,
                **family_attributes(
                    "limit cycle",
                    "limit cycle and its Floquet multipliers",
                    self._history,
                    software(),
                ),
                format=CYCLE_FORMAT,
                software=json.dumps(software()),
                method=self.method,
                intervals=self.intervals or 0,
            )
        )

    @property
    def _history(self) -> str:
        return f"found by {self.method} in {len(self.iterations) - 1} iterations"

    def save(self, path: str | PathLike[str]) -> Path:
        """Write the cycle to a NetCDF file; that of a bird `birdmb.load_cycle` reads.

        A file of that name is replaced only once the new one is whole on the disk.

        Returns:
            The path.

        Raises:
            OutputError: the file cannot be written.
        """
        return write_whole(path, sealed(netcdf_bytes(self.to_xarray())))


def cycle_type(model: Model) -> type[LimitCycle]:
    """The kind of limit cycles that a model names, or the plain one."""
    if isinstance(model, HasLimitCycleType):
        named: type[LimitCycle] = model.limit_cycle_type
        return named
    return LimitCycle
