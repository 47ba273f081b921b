"""The command `birdmb sweep`."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, SpinnerColumn, TextColumn

from birdmb.cli.console import messages
from birdmb.models import MultibodyModel, RigidModel
from birdmb.studies.sweeps import Finished, Study, Trimming, sweep
from birdmb.topology import Bird

_LISTED = 5


def run(
    bird: Bird,
    variations: Mapping[str, Sequence[Any]],
    store: Path,
    *,
    workers: int | None,
    model: str,
    steps_per_beat: int | None,
    trim: Trimming | None,
    search: Mapping[str, Any],
) -> None:
    """Fill the store, with progress on standard error, and say what it holds."""
    kind = RigidModel if model == "rigid" else MultibodyModel
    bound = kind if steps_per_beat is None else partial(kind, steps_per_beat=steps_per_beat)
    with SweepProgress(messages()) as progress:
        study = sweep(
            bird,
            variations,
            store=store,
            workers=workers,
            model=bound,
            trim=trim,
            on_point=progress.update,
            **search,
        )
    typer.echo(_summary(study))


class SweepProgress:
    """A bar with rate, failures and time left on a terminal; elsewhere a line for each point."""

    def __init__(self, console: Console) -> None:
        self._console = console
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
        else:
            self._failures += point.outcome.result is None
            if point.outcome.result is None or not self._console.is_terminal:
                self._console.print(_line(point), highlight=False, markup=False, soft_wrap=True)
        told = self._told(point) if point.outcome else "starting the workers"
        self._bar.update(self._task, completed=point.done, total=point.total, told=told)

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
    values = " ".join(f"{name}={_short(value)}" for name, value in point.values.items())
    return f"{point.done}/{point.total}  {values}  {_became(outcome)}  {outcome.seconds:.2f} s"


def _became(outcome: Any) -> str:
    if outcome.result is None:
        return f"failed: {outcome.reason}"
    real, imaginary = (outcome.result[f"multiplier_{part}"][0] for part in ("real", "imag"))
    return f"{outcome.result['stability']}, |Λ|max {np.hypot(real, imaginary):.4f}"


def _short(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _summary(study: Study) -> str:
    stabilities = [o.result["stability"] for o in study.outcomes.values() if o.result is not None]
    counted = [f"{stabilities.count(kind)} {kind}" for kind in sorted(set(stabilities))]
    failures = study.failures
    lines = [
        f"{study.path}: {study.total} points, {len(stabilities)} with a limit cycle"
        f"{' (' + ', '.join(counted) + ')' if counted else ''}, {len(failures)} without."
    ]
    for values, reason in failures[:_LISTED]:
        listed = ", ".join(f"{name} = {_short(value)}" for name, value in values.items())
        lines.append(f"  {listed}: {reason}")
    if len(failures) > _LISTED:
        lines.append(f"  ... and {len(failures) - _LISTED} more: Study.open(...).failures")
    return "\n".join(lines)
