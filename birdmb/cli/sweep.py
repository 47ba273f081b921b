"""The command `birdmb sweep`."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn

from birdmb.cli.console import messages
from birdmb.cli.models import bound_model
from birdmb.models.motion import FlightMotionName
from birdmb.studies.cycles import ModelFactory
from birdmb.studies.relevance import ignored_values
from birdmb.studies.sweeps import Finished, Study, Trimming, sweep
from birdmb.studies.sweeps.executors import named_executor
from birdmb.studies.sweeps.verdicts import jump_lines, short, verdict_lines
from birdmb.topology import Bird

_LISTED = 5


def run(
    bird: Bird,
    variations: Mapping[str, Sequence[Any]],
    store: Path,
    *,
    workers: int | None,
    executor: str,
    model: str,
    motion: FlightMotionName,
    steps_per_beat: int | None,
    trim: Trimming | None,
    search: Mapping[str, Any],
) -> None:
    """Fill the store, with progress on standard error, and say what it holds."""
    bound = bound_model(model, motion, steps_per_beat)
    with (
        named_executor(executor, workers) as pool,
        SweepProgress(messages(), ignored_springs(bird, bound)) as progress,
    ):
        study = sweep(
            bird,
            variations,
            store=store,
            executor=pool,
            workers=workers,
            model=bound,
            trim=trim,
            on_point=progress.update,
            **search,
        )
    typer.echo(_summary(study))


def ignored_springs(bird: Bird, model: ModelFactory) -> str:
    """Which springs of the bird its model has not, as a sentence; empty if there are none."""
    ignored = ignored_values(bird, model)
    sprung = [joint.name for joint in bird.compliant_joints]
    sprung += [feather.hinge_name for feather in bird.hinged_feathers]
    sprung = [name for name in sprung if f"{name}.stiffness" in ignored]
    return f"The rigid model ignores the springs of {', '.join(sprung)}." if sprung else ""


class SweepProgress:
    """A bar with rate, failures and time left on a terminal; elsewhere a line for each point.

    A note is written before the first of them.
    """

    def __init__(self, console: Console, note: str = "") -> None:
        self._console, self._note = console, note
        self._began = time.monotonic()
        self._found_before = self._failures = 0
        self._bar = Progress(
            SpinnerColumn(),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[told]}"),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task("", total=None, told="starting the workers")

    def __enter__(self) -> SweepProgress:
        """Show the bar."""
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        """Leave the terminal as it was."""
        self._bar.stop()

    def update(self, point: Finished) -> None:
        """Show a finished point."""
        if point.outcome is None:
            self._found_before = point.done
            if self._note:
                self._line(self._note)
        else:
            self._failures += point.outcome.result is None
            if point.outcome.result is None or not self._console.is_terminal:
                self._line(_line(point))
        told = self._told(point) if point.outcome else "starting the workers"
        self._bar.update(self._task, completed=point.done, total=point.total, told=told)

    def _line(self, text: str) -> None:
        self._console.print(text, highlight=False, markup=False, soft_wrap=True)

    def _told(self, point: Finished) -> str:
        computed = point.done - self._found_before
        each = (time.monotonic() - self._began) / computed
        minutes, seconds = divmod(round(each * (point.total - point.done)), 60)
        return (
            f"{1 / each:.2g} points/s, {self._failures} failed, "
            f"{minutes // 60}:{minutes % 60:02}:{seconds:02} left"
        )


def _line(point: Finished) -> str:
    outcome = point.outcome
    assert outcome is not None
    values = " ".join(f"{name}={short(value)}" for name, value in point.values.items())
    return f"{point.done}/{point.total}  {values}  {_became(outcome)}  {outcome.seconds:.2f} s"


def _became(outcome: Any) -> str:
    if outcome.result is None:
        return f"failed: {outcome.reason}"
    result = outcome.result
    real, imaginary = (result[f"multiplier_{part}"][0] for part in ("real", "imag"))
    return (
        f"{result['stability']}, |Λ|max {np.hypot(real, imaginary):.4f}, "
        f"{result['mean_speed']:.2f} m/s, climb {result['mean_climb_rate']:+.2f} m/s"
        f"{', backwards' if result['flight'] == 'backwards' else ''}"
    )


def _summary(study: Study) -> str:
    data, failures = study.to_xarray(), study.failures
    found = len(study.outcomes) - len(failures)
    lines = [
        f"{study.path}: {study.total} points, {found} with a limit cycle, {len(failures)} without."
    ]
    lines += [f"  {line}" for line in verdict_lines(data)]
    for values, reason in failures[:_LISTED]:
        listed = ", ".join(f"{name} = {short(value)}" for name, value in values.items())
        lines.append(f"  {listed}: {reason}")
    if len(failures) > _LISTED:
        lines.append(f"  ... and {len(failures) - _LISTED} more: Study.open(...).failures")
    return "\n".join(lines + jump_lines(data))
