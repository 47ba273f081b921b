"""The bird's tree with what acts on it, integrated by Exudyn's explicit steps.

Prescribed joints are held to their drivers by a driven inertia: a second object on the tree's node
whose mass matrix is B on them alone, with a force of B times the driver's acceleration. No
constraint is left, so Exudyn's explicit integrators apply, and a prescribed joint strays from its
driver by no more than its loads over B.

Where the air remembers, its lags are first-order states of the same system, and the mass matrix of
the air about the wings is added to that of the second object.
"""

from __future__ import annotations

import inspect
import weakref
from collections.abc import Callable, Sequence
from typing import Any, TypeVar, cast

import exudyn as exu
import numpy as np
from exudyn.itemInterface import NodeGenericODE1, ObjectGenericODE1, ObjectGenericODE2

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.errors import StateError
from birdmb.models.compiled_calls import Carrier, calls_compiled_code
from birdmb.models.exudyn_tree import add_tree, bird_links, typical_inertias
from birdmb.models.tree_forces import TreeLoads
from birdmb.topology import Bird

# Of the bird's own: a prescribed joint strays by one part of this, and round-off does not matter.
_DRIVEN_INERTIA = 1e13
_NO_LAGS = np.empty(0)

# (t, coordinates (n,), velocities (n,), lags (L,)) -> what acts on the tree
LoadFunction = Callable[[float, FloatArray, FloatArray, FloatArray], TreeLoads]
TimeFunction = Callable[[float], FloatArray]
Function = TypeVar("Function", bound=Callable[..., Any])


class ExudynBird:
    """The assembled bird, ready to be integrated.

    Args:
        bird: the bird.
        body_coordinates: as for `bird_links`.
        loads: what acts on the tree but gravity and its own inertia.
        prescribed: which coordinates follow an acceleration given in time.
        driver: their accelerations (n,) at a time; entries of free coordinates are not read.
        lag_count: how many lags the air has; 0 where it has no memory.
    """

    def __init__(
        self,
        bird: Bird,
        body_coordinates: IntArray,
        loads: LoadFunction,
        prescribed: BoolArray,
        driver: TimeFunction,
        lag_count: int = 0,
    ) -> None:
        self._carrier = Carrier()
        self._lag_count = lag_count
        self._latest: tuple[tuple[object, ...], TreeLoads] | None = None
        links = bird_links(bird, body_coordinates)
        n = len(links)
        self._container = exu.SystemContainer()
        self.mbs = self._container.AddSystem()

        # Exudyn keeps these functions out of the garbage collector's sight: what they held
        # strongly, this object or the model, would never be freed.
        self._call_loads, call_driver = _weakly(loads), _weakly(driver)
        call_loads_at, call_lag_rates = _weakly(self._loads_at), _weakly(self._lag_rates)

        inertia = np.where(
            prescribed, _DRIVEN_INERTIA * typical_inertias(bird, body_coordinates, n), 0.0
        )
        driven = np.diag(inertia)

        # The driven inertia's force acts on the same coordinates: one call instead of two.
        def tree_forces(t: float, _item: int, q: Sequence[float], v: Sequence[float]) -> FloatArray:
            driving = inertia * call_driver()(t)
            return call_loads_at()(t, np.array(q), np.array(v)).forces + driving

        def added_mass(t: float, _item: int, q: Sequence[float], v: Sequence[float]) -> FloatArray:
            return driven + call_loads_at()(t, np.array(q), np.array(v)).inertia

        def lag_rates(t: float, _item: int, _lags: Sequence[float]) -> FloatArray:
            return call_lag_rates()(t)

        callback = self._carrier.callback
        node, _ = add_tree(
            self.mbs, links, bird.gravity, forceUserFunction=callback(tree_forces, (n,))
        )
        if lag_count:
            added = {"massMatrixUserFunction": callback(added_mass, (n, n))}
            self.mbs.AddObject(ObjectGenericODE2(nodeNumbers=[node], **added))
            self._add_lags(callback(lag_rates, (lag_count,)))
        elif prescribed.any():
            self.mbs.AddObject(ObjectGenericODE2(nodeNumbers=[node], massMatrix=driven))
        self.mbs.Assemble()
        self._settings = _quiet_settings()

    def _add_lags(self, rates: Callable[..., FloatArray]) -> None:
        zeros = [0.0] * self._lag_count
        node = self.mbs.AddNode(
            NodeGenericODE1(
                referenceCoordinates=zeros,
                initialCoordinates=zeros,
                numberOfODE1Coordinates=self._lag_count,
            )
        )
        self.mbs.AddObject(ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rates))

    @calls_compiled_code
    def integrate(
        self,
        q: FloatArray,
        v: FloatArray,
        lags: FloatArray,
        t0: float,
        t1: float,
        steps: int,
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Coordinates and velocities (n,) and lags (L,) at t1 after `steps` steps from t0.

        Steps of RK67 (order 6). Not finite where the motion diverges. Raises what `loads` and
        `driver` raised.
        """
        data = self.mbs.systemData
        initial = exu.ConfigurationType.Initial
        data.SetODE2Coordinates(q, initial)
        data.SetODE2Coordinates_t(v, initial)
        if self._lag_count:
            data.SetODE1Coordinates(lags, initial)
        time = self._settings.timeIntegration
        time.startTime, time.endTime, time.numberOfSteps = t0, t1, steps
        self._call(
            self.mbs.SolveDynamic,
            self._settings,
            solverType=exu.DynamicSolverType.RK67,
            storeSolver=False,
        )
        return (
            np.array(data.GetODE2Coordinates()),
            np.array(data.GetODE2Coordinates_t()),
            np.array(data.GetODE1Coordinates()) if self._lag_count else lags,
        )

    def _loads_at(self, t: float, q: FloatArray, v: FloatArray) -> TreeLoads:
        """What acts on the tree where the integration stands, its lags included.

        Of a bird with lags each stage of a step asks for it three times in a row.
        """
        if not self._lag_count:
            return self._call_loads()(t, q, v, _NO_LAGS)
        lags = np.array(self.mbs.systemData.GetODE1Coordinates())
        stage = t, q.tobytes(), v.tobytes(), lags.tobytes()
        if self._latest is None or self._latest[0] != stage:
            self._latest = stage, self._call_loads()(t, q, v, lags)
        return self._latest[1]

    def _lag_rates(self, t: float) -> FloatArray:
        data = self.mbs.systemData
        q, v = np.array(data.GetODE2Coordinates()), np.array(data.GetODE2Coordinates_t())
        return self._loads_at(t, q, v).lag_rates

    def _call(self, compiled: Callable[..., Any], *args: Any, **options: Any) -> Any:
        try:
            return self._carrier.call(compiled, *args, **options)
        except exu.ExudynError as error:
            raise StateError(f"Exudyn stopped: {' '.join(str(error).split())}") from error


def _weakly(function: Function) -> Callable[[], Function]:
    """How to get at a function that is kept alive by its object, if it is a method of one."""
    if inspect.ismethod(function):
        return cast("Callable[[], Function]", weakref.WeakMethod(function))
    return lambda: function


def _quiet_settings() -> exu.SimulationSettings:
    settings = exu.SimulationSettings()
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.explicit.computeEndOfStepAccelerations = False
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.parallel.numberOfThreads = 1
    return settings
