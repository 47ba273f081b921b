"""The command `birdmb cycle`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

import typer

from birdmb.cli.console import messages, output
from birdmb.cli.drawing import plain_style
from birdmb.cli.files import prepare, write_results
from birdmb.cli.interrupt import tidied
from birdmb.cli.outcome import NO_CYCLE, ResultUnwrittenError, SearchFailed
from birdmb.cli.progress import Progress
from birdmb.cli.report import print_report
from birdmb.cli.results import finite, result_object, taken_as_prescribed
from birdmb.errors import OutputError
from birdmb.files import remove_drafts
from birdmb.orbits import ConvergenceError, find_limit_cycle
from birdmb.studies import assess_validity

if TYPE_CHECKING:
    from birdmb.models import FlightCycle
    from birdmb.models.multibody import MultibodyModel
    from birdmb.models.rigid import RigidModel
    from birdmb.orbits.newton import Damping
    from birdmb.orbits.search import SearchMethod
    from birdmb.topology import Bird


@dataclass(frozen=True)
class Search:
    """What the options say about model and search; see `find_limit_cycle`."""

    model: str
    segments: int | None
    tolerance: float
    max_iterations: int
    method: SearchMethod
    damping: Damping
    steps_per_beat: int | None


def run(bird: Bird, search: Search, *, out: Path | None, as_json: bool) -> None:
    """Find the limit cycle, report it on standard output and write it into `out`."""
    if out is not None:
        prepare(out)
    progress = Progress(messages())

    def tidy() -> None:
        progress.stop()
        if out is not None:
            remove_drafts(out)

    with tidied(tidy), _only_results_on_stdout(), progress.shown():
        cycle = _found(bird, search, progress)
        progress.doing("loads and power over the beat")
        validity = assess_validity(cycle)
        found = result_object(cycle, validity, search.model)
    if not as_json:
        print_report(output(), cycle, validity)
    written: list[Path] = []
    if out is not None:
        try:
            with tidied(tidy), _only_results_on_stdout(), progress.shown(), plain_style():
                written = write_results(cycle, out, progress)
        except OutputError as error:
            raise ResultUnwrittenError(str(error), found) from error
    if as_json:
        json.dump(
            {**found, "files": list(map(str, written))}, sys.stdout, allow_nan=False, indent=2
        )
        sys.stdout.write("\n")
    else:
        for path in written:
            progress.line(f"wrote {path}")
    if cycle.why_no_flight is not None:
        raise typer.Exit(NO_CYCLE)


def _found(bird: Bird, search: Search, progress: Progress) -> FlightCycle:
    model = _model(bird, search)
    progress.line(
        f"{bird.name}, {search.model} model: {len(model.state_names)} states, "
        f"wingbeat of {bird.period:.4g} s"
    )
    if held := taken_as_prescribed(model):
        progress.line(
            f"The {search.model} model takes {', '.join(held)} as prescribed: springs and dampers "
            "are not used."
        )
    progress.doing("looking for a first guess")
    try:
        cycle = find_limit_cycle(
            model,
            segments=search.segments,
            tolerance=search.tolerance,
            max_iterations=search.max_iterations,
            # Steps are of the time integration: who gives them wants it.
            method="shooting"
            if search.steps_per_beat is not None and search.method == "auto"
            else search.method,
            damping=search.damping,
            callback=progress.iteration,
        )
    except ConvergenceError as error:
        raise SearchFailed(
            str(error),
            {
                "bird": bird.name,
                "model": search.model,
                "x": {n: finite(v) for n, v in zip(model.state_names, error.best_x, strict=True)},
                "residual": finite(error.residual),
                "iterations": max(len(error.history) - 1, 0),
            },
        ) from error
    return cast("FlightCycle", cycle)


def _model(bird: Bird, search: Search) -> RigidModel | MultibodyModel:
    if search.model == "rigid":
        from birdmb.models.rigid import RigidModel  # noqa: PLC0415

        return RigidModel(bird, steps_per_beat=search.steps_per_beat)
    from birdmb.models.multibody import MultibodyModel  # noqa: PLC0415

    return MultibodyModel(bird, steps_per_beat=search.steps_per_beat)


@contextmanager
def _only_results_on_stdout() -> Iterator[None]:
    """Send what libraries print on the way, as Exudyn does, to standard error."""
    with redirect_stdout(sys.stderr):
        yield
