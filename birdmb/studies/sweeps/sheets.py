"""Keeping a point of a sweep to the sheet of flights that its neighbour is on.

Where the way to a neighbour does not explain how the flights differ (see
`birdmb.studies.sweeps.jumps`), the flight is searched again from the neighbour's by smaller steps
of the parameters.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from birdmb.errors import BirdmbError, OrbitError, StateError
from birdmb.studies.sweeps.grid import Value, is_number
from birdmb.studies.sweeps.jumps import unexplained
from birdmb.studies.sweeps.tasks import Guess, Task

# Of the way to the neighbour. A sheet that ends does so at a fold, where steps of any length fail.
_FIRST_STEP, _SHORTEST_STEP = 0.5, 1 / 64

Flight = dict[str, Any]
FlightOf = Callable[[Task], tuple[Flight, str]]
"""Finds the flight of a task, and where the search succeeded from; raises `BirdmbError`."""


class SheetEndError(OrbitError):
    """The sheet of a neighbour's flights ends before the point."""


def on_sheet(task: Task, flight_of: FlightOf) -> tuple[Flight, str]:
    """The flight of a task on the sheet that its neighbour is on, and where it started from.

    The first point of a study has no neighbour; texts have no values between them: there any
    flight will do.

    Raises:
        SheetEndError: the sheet ends on the way.
        BirdmbError: as `flight_of`, where there is no neighbour or nothing in between.
    """
    guess = task.guess
    if guess is None or not _numbers_differ(task, guess):
        return flight_of(task)
    try:
        flight, start = flight_of(task)
    except (OrbitError, StateError):
        return _walked(task, guess, flight_of), guess.place
    if unexplained(guess.flight, flight, _apart(guess.values, task.values), _bounds(task)):
        return _walked(task, guess, flight_of), guess.place
    return flight, start


def _walked(task: Task, guess: Guess, flight_of: FlightOf) -> Flight:
    at, step, last = 0.0, _FIRST_STEP, guess
    why = "the next flight is on another one"
    while at < 1.0:
        to = min(1.0, at + step)
        values = _between(guess.values, task.values, to)
        flight = None
        try:
            flight, _ = flight_of(replace(task, values=values, guess=last))
        except BirdmbError as error:
            why = str(error)
        if flight is None or unexplained(
            last.flight, flight, _apart(last.values, values), _bounds(task)
        ):
            step /= 2.0
            if step < _SHORTEST_STEP:
                raise SheetEndError(_ended(guess, last, values, why))
        else:
            at, step = to, 2.0 * step
            last = replace(guess, values=values, flight=flight)
    return dict(last.flight)


def _ended(guess: Guess, last: Guess, values: Mapping[str, Value], why: str) -> str:
    between = " and ".join(
        f"{name} = {last.values[name]:.6g} and {value:.6g}"
        for name, value in values.items()
        if value != last.values[name]
    )
    return f"The sheet of flights that {guess.place} is on ends between {between}: {why}"


def _between(first: Mapping[str, Value], last: Mapping[str, Value], share: float) -> dict[str, Any]:
    if share == 1.0:
        return dict(last)
    return {
        name: first[name] + share * (value - first[name])  # type: ignore[operator]
        if value != first[name]
        else value
        for name, value in last.items()
    }


def _apart(first: Mapping[str, Value], last: Mapping[str, Value]) -> dict[str, float]:
    return {
        name: float(value) - float(first[name])
        for name, value in last.items()
        if value != first[name]
    }


def _numbers_differ(task: Task, guess: Guess) -> bool:
    apart = [name for name, value in task.values.items() if value != guess.values[name]]
    return all(is_number(of[name]) for name in apart for of in (task.values, guess.values))


def _bounds(task: Task) -> Mapping[str, tuple[float, float]]:
    return {} if task.trimming is None else task.trimming.parameters
