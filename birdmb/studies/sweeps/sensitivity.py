"""How the flight at a point answers to the parameters: what a step to a neighbour should change."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import cast

import numpy as np

from birdmb._typing import FloatArray
from birdmb.models import FlightCycle
from birdmb.models.wing_model import WingModel
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.grid import Value
from birdmb.studies.sweeps.settings import Trimming
from birdmb.studies.trim_equations import TrimEquations
from birdmb.topology import Bird

_Residual = Callable[[Mapping[str, Value]], FloatArray]


def sensitivities(
    cycle: FlightCycle,
    bird: Bird,
    model: ModelFactory,
    values: Mapping[str, Value],
    steps: Mapping[str, float],
    trimming: Trimming | None,
    trimmed: Mapping[str, float],
) -> dict[str, list[float]]:
    """Derivatives of a flight by parameters: of its state at t = 0, then of what it is trimmed by.

    By the implicit function theorem: with F(z, p) = 0 for closure (and targets), dz/dp is
    -F_z^-1 F_p. F_z is the monodromy minus one or, trimmed, found by differences; F_p takes a
    flow for each parameter, with an error of first order in the step.

    Args:
        cycle: the flight.
        bird: the bird that is varied.
        model: makes the model of a bird.
        values: of all parameters at the point, by dotted name.
        steps: in those parameters for which the derivatives are wanted.
        trimming: how the flight was trimmed, if it was, to the values `trimmed`.

    Returns:
        By name of a parameter, (n + k,): in units of the state scale, and of the distance between
        the bounds, by the parameter's unit. Without those parameters whose step leads to no flight.
    """
    if trimming is None:
        size = cycle.x0.size
        matrix = (cycle.monodromy - np.eye(size)) * cycle.state_scale / cycle.state_scale[:, None]
        residual: _Residual = _closure(cycle, bird, model)
    else:
        residual, matrix = _trim_equations(cycle, bird, model, values, trimming, trimmed)
    found = {}
    for name, step in steps.items():
        # Whatever fails here, such as a step into what is no bird: the flight itself is found.
        with suppress(Exception):
            there = {**values, name: cast("float", values[name]) + step}
            response = -np.linalg.solve(matrix, residual(there) / step)
            if np.isfinite(response).all():
                found[name] = response.tolist()
    return found


def _closure(cycle: FlightCycle, bird: Bird, model: ModelFactory) -> _Residual:
    """Gap of the flight's state after a beat, with other values, in units of the state scale."""

    def gap(values: Mapping[str, Value]) -> FloatArray:
        flying = cast("WingModel", model(bird.with_values(values)))
        end = flying.flow(cycle.x0, 0.0, flying.bird.period)
        return np.asarray((end - cycle.x0) / cycle.state_scale)

    return gap


def _trim_equations(
    cycle: FlightCycle,
    bird: Bird,
    model: ModelFactory,
    values: Mapping[str, Value],
    trimming: Trimming,
    trimmed: Mapping[str, float],
) -> tuple[_Residual, FloatArray]:
    """Residual of closure and targets at the trimmed flight, with other values; its Jacobian."""
    low, high = np.array(list(trimming.parameters.values()), dtype=float).T
    point = np.array([trimmed[name] for name in trimming.parameters])
    at = np.concatenate([cycle.x0 / cycle.state_scale, (point - low) / (high - low)])
    targets = {"climb_rate": trimming.climb_rate}
    if trimming.speed is not None:
        targets["speed"] = trimming.speed

    def equations(values: Mapping[str, Value]) -> TrimEquations:
        varied = bird.with_values(values)

        def model_at(point: FloatArray) -> WingModel:
            by_name = dict(zip(trimming.parameters, point.tolist(), strict=True))
            return cast("WingModel", model(varied.with_values(by_name)))

        return TrimEquations(model_at, low, high, targets)

    jacobian = equations(values).jacobian(at).toarray()
    return (lambda there: equations(there).residual(at)), jacobian
