"""How the flight at a point answers to the parameters: what a step to a neighbour should change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TypeAlias, cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models import BirdModel, FlightCycle
from birdmb.orbits.enough_nodes import fewer_nodes
from birdmb.studies.cycles import KeptModels, ModelFactory, path_at_nodes
from birdmb.studies.sweeps.grid import Value
from birdmb.studies.sweeps.settings import Trimming
from birdmb.studies.trim_collocation import CollocatedTrim
from birdmb.studies.trim_equations import TrimEquations
from birdmb.topology import Bird

_FEWEST_NODES = 11

_Values: TypeAlias = Mapping[str, Value]
_Residual: TypeAlias = Callable[[_Values], FloatArray]


def sensitivities(
    cycle: FlightCycle,
    bird: Bird,
    model: ModelFactory,
    values: _Values,
    steps: Mapping[str, float],
    trimming: Trimming | None,
    trimmed: Mapping[str, float],
) -> dict[str, list[float]]:
    """Derivatives of a flight by parameters: of its state at t = 0, then of what it is trimmed by.

    By the implicit function theorem: with F(z, p) = 0 for the orbit (and targets), dz/dp is
    -F_z^-1 F_p. F is collocation's where the cycle is collocated, else the closure; F_p is a
    difference for each parameter, with an error of first order in the step.

    Args:
        cycle: the flight.
        bird: the bird that is varied.
        model: makes the model of a bird.
        values: of all parameters at the point, by dotted name.
        steps: in those parameters for which the derivatives are wanted.
        trimming: how the flight was trimmed, if it was, to the values `trimmed`.

    Returns:
        By name of a parameter, (n + k,): in units of the state scale, and of the distance between
        the bounds, by the parameter's unit. Without those parameters whose step leads to no flight;
        none of an orbit on a mesh.
    """
    if not steps or cycle.pieces is not None:
        return {}
    names = () if trimming is None else tuple(trimming.parameters)
    bounds = [] if trimming is None else [trimming.parameters[name] for name in names]
    low, high = np.array(bounds, dtype=float).reshape(-1, 2).T
    point = np.array([trimmed[name] for name in names])
    targets = {} if trimming is None else trimming.targets

    def models(there: _Values) -> KeptModels:
        def model_at(point: FloatArray) -> BirdModel:
            by_name = dict(zip(names, point.tolist(), strict=True))
            if there == values and by_name == trimmed:
                return cycle.model
            return model(bird.with_values({**there, **by_name}))

        return KeptModels(model_at)

    n = cycle.x0.size
    if cycle.method == "collocation":
        residual, matrix = _collocation(cycle, models, values, (low, high), targets, point)
    elif trimming is None:
        matrix = (cycle.monodromy - np.eye(n)) * cycle.state_scale / cycle.state_scale[:, None]
        residual = _closure(cycle, models)
    else:
        residual, matrix = _shooting(cycle, models, values, (low, high), targets, point)
    kept = np.r_[:n, len(matrix) - point.size : len(matrix)]
    left = residual(values) if cycle.method == "collocation" else 0.0
    found = {}
    for name, step in steps.items():
        # Whatever fails here, such as a step into what is no bird: the flight itself is found.
        with suppress(Exception):
            there = {**values, name: cast("float", values[name]) + step}
            response = -np.linalg.solve(matrix, (residual(there) - left) / step)[kept]
            if np.isfinite(response).all():
                found[name] = response.tolist()
    return found


def _collocation(
    cycle: FlightCycle,
    models: Callable[[_Values], KeptModels],
    values: _Values,
    bounds: tuple[FloatArray, FloatArray],
    targets: Mapping[str, float],
    point: FloatArray,
) -> tuple[_Residual, FloatArray]:
    """Residual of orbit and targets with other values, and its Jacobian.

    On few nodes: what the orbit errs by there is the same with other values.
    """
    path = path_at_nodes(cycle, max(_FEWEST_NODES, fewer_nodes(fewer_nodes(cycle.nodes or 1))))

    def equations(values: _Values) -> CollocatedTrim:
        return CollocatedTrim(models(values), *bounds, targets, len(path))

    at_point = equations(values)
    u = at_point.pack(path, point)
    matrix = at_point.jacobian(u)

    def residual(there: _Values) -> FloatArray:
        return (at_point if there is values else equations(there)).residual(u)

    return residual, matrix


def _closure(cycle: FlightCycle, models: Callable[[_Values], KeptModels]) -> _Residual:
    """Gap of the flight's state after a beat, with other values, in units of the state scale."""

    def gap(values: _Values) -> FloatArray:
        flying = models(values)(np.empty(0))
        end = flying.flow(cycle.x0, 0.0, flying.bird.period)
        return np.asarray((end - cycle.x0) / cycle.state_scale)

    return gap


def _shooting(
    cycle: FlightCycle,
    models: Callable[[_Values], KeptModels],
    values: _Values,
    bounds: tuple[FloatArray, FloatArray],
    targets: Mapping[str, float],
    point: FloatArray,
) -> tuple[_Residual, FloatArray]:
    """Residual of closure and targets at the trimmed flight, with other values; its Jacobian."""
    low, high = bounds
    at = np.concatenate([cycle.x0 / cycle.state_scale, (point - low) / (high - low)])

    def equations(values: _Values) -> TrimEquations:
        return TrimEquations(models(values), low, high, targets)

    return (lambda there: equations(there).residual(at)), equations(values).jacobian(at).toarray()
