"""The command `birdmb branch`."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from birdmb.cli.console import messages, output
from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare
from birdmb.cli.models import model_class
from birdmb.cli.outcome import InputError, SearchFailed
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.results import finite
from birdmb.cli.tables import table_of
from birdmb.orbits import (
    Bifurcation,
    BranchFileError,
    BranchPoint,
    ConvergenceError,
    Steps,
    load_branch,
)
from birdmb.provenance import software
from birdmb.studies.branch import bird_branch

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from birdmb.orbits import Branch
    from birdmb.orbits.search import SearchMethod
    from birdmb.topology import Bird

_STYLES = {"stable": "green", "unstable": "red", "undecided": "yellow"}
_TURNS = {
    "fold": "the branch turns",
    "period doubling": "a flight of twice the beat branches off",
    "Neimark-Sacker": "an oscillation over many beats branches off",
    "branch point": "another branch crosses",
    "multiple": "more cross at once than one name says",
}


@dataclass(frozen=True)
class Following:
    """What the options say about the branch; see `bird_branch`."""

    parameter: str
    start: float
    stop: float
    model: str
    max_points: int
    method: SearchMethod
    segments: int | None
    tolerance: float
    steps_per_beat: int | None
    longest_step: float


def run(
    bird: Bird,
    wanted: Following,
    *,
    store: Path | None,
    resume: bool,
    out: Path | None,
    pictures: Pictures,
    as_json: bool,
) -> None:
    """Follow the branch, report it on standard output, keep it in `store`, draw it into `out`."""
    directories = _prepared(out, store)
    if store is None and out is not None:
        store = out / "branch.nc"
    progress = Progress(messages())
    kept = _kept(store, resume, progress)

    def farewell() -> None:
        if store is not None and store.exists():
            progress.line(f"{store} keeps what was found; --resume goes on with it.")

    with at_work(progress, *directories, farewell=farewell):
        branch = _followed(bird, wanted, kept, store, progress)
    if not as_json:
        _report(output(), branch)
    written = [] if store is None else [store]
    with at_work(progress, *directories, farewell=farewell), pictures.style():
        if out is not None:
            from birdmb.figures import plot_bird_branch  # noqa: PLC0415 - takes time

            progress.doing("drawing the branch")
            written += pictures.write(out, "branch", plot_bird_branch(branch))
    if as_json:
        found = {**_object(branch), "files": list(map(str, written))}
        json.dump(found, sys.stdout, allow_nan=False, indent=2)
        sys.stdout.write("\n")
        return
    for path in written:
        progress.line(f"wrote {path}")


def _prepared(out: Path | None, store: Path | None) -> list[Path]:
    """Make the directories that will be written into."""
    directories = []
    if out is not None:
        prepare(out)
        directories.append(out)
    if store is not None:
        prepare(store.parent, "--store")
        directories.append(store.parent)
    return directories


def _kept(store: Path | None, resume: bool, progress: Progress) -> Branch | None:
    if resume and store is None:
        raise InputError("--resume needs the file to go on with: --store FILE.nc or --out DIR.")
    if store is None or not store.exists():
        if resume:
            progress.line(f"{store} is not there yet: the branch begins at its start")
        return None
    if not resume:
        raise InputError(f"{store} exists: --resume goes on with it, or remove it.")
    try:
        kept = load_branch(store)
    except BranchFileError as error:
        raise InputError(f"--resume: {error}") from error
    others = {n: v for n, v in kept.software.items() if v != software().get(n)}
    if others:
        listed = ", ".join(f"{name} {version}" for name, version in others.items())
        progress.line(f"begun with {listed}: the last digits may differ from here on")
    return kept


def _followed(
    bird: Bird, wanted: Following, kept: Branch | None, store: Path | None, progress: Progress
) -> Branch:
    progress.line(
        f"{bird.name}, {wanted.model} model: {wanted.parameter} from {wanted.start:g} to "
        f"{wanted.stop:g}"
    )
    lines = _Lines(progress, wanted.parameter)
    if kept is not None:
        progress.line(
            f"going on after {len(kept.points)} points, from {kept.points[-1].parameter:.6g}"
        )
        lines.number = len(kept.points)
    progress.doing("looking for the first flight")
    try:
        return bird_branch(
            bird,
            wanted.parameter,
            (wanted.start, wanted.stop),
            model_class(wanted.model),
            method=wanted.method,
            steps_per_beat=wanted.steps_per_beat,
            segments=wanted.segments,
            steps=Steps(longest=wanted.longest_step),
            max_points=wanted.max_points,
            tolerance=wanted.tolerance,
            resume=kept,
            store=store,
            callback=lines,
        )
    except ConvergenceError as error:
        raise SearchFailed(
            f"No flight at {wanted.parameter} = {wanted.start:g} to start from: {error}",
            {"bird": bird.name, "model": wanted.model, "residual": finite(error.residual)},
        ) from error


# Of a narrow terminal's lines, what is left out first.
_LEAST_WANTED = ("nodes", "error", "climb, m/s", "speed, m/s", "point")


class _Lines:
    """Writes a line for every point and bifurcation."""

    def __init__(self, progress: Progress, parameter: str) -> None:
        self._progress, self._parameter = progress, parameter
        widths = {
            "point": 5,
            parameter: max(len(parameter), 12),
            "|Λ|max": 8,
            "error": 7,
            "stability": 9,
            "speed, m/s": 10,
            "climb, m/s": 10,
            "nodes": 5,
        }
        self._widths = {name: widths[name] for name in progress.fitting(widths, _LEAST_WANTED)}
        self._headed = False
        self.number = 0

    def __call__(self, item: BranchPoint | Bifurcation) -> None:
        if not self._headed:
            self._headed = True
            self._write({name: name for name in self._widths}, "bold")
        if isinstance(item, Bifurcation):
            self._progress.line(f"       {_sentence(item, self._parameter)}", style="bold")
            return
        self.number += 1
        modulus, error = _largest(item)
        seen = item.observables
        values = {
            "point": str(self.number),
            self._parameter: f"{item.parameter:.8g}",
            "|Λ|max": f"{modulus:.5f}",
            "error": f"{error:.0e}",
            "stability": item.stability,
            "speed, m/s": f"{seen['mean_speed']:.3f}",
            "climb, m/s": f"{seen['mean_climb_rate']:+.3f}",
            "nodes": str(item.nodes or "shot"),
        }
        self._write(values, _STYLES[item.stability])
        self._progress.doing("following the branch")

    def _write(self, values: Mapping[str, str], style: str) -> None:
        cells = (
            f"{values[name]:<{width}}" if name == "stability" else f"{values[name]:>{width}}"
            for name, width in self._widths.items()
        )
        self._progress.line("  ".join(cells).rstrip(), style=style)


def _largest(point: BranchPoint) -> tuple[float, float]:
    return float(np.abs(point.multipliers[0])), float(point.multiplier_errors[0])


def _sentence(found: Bifurcation, parameter: str) -> str:
    return (
        f"{found.kind} at {parameter} = {found.parameter:.7g} ± {found.parameter_error:.0e}: "
        f"{_TURNS[found.kind]}; {_crossing(found)}"
    )


def _crossing(found: Bifurcation) -> str:
    """What the multipliers do there."""
    before, after = found.outside
    where = ", ".join(_number(value) for value in found.multipliers)
    return f"Λ = {where}; outside the unit circle {before} before, {after} after"


def _number(value: complex) -> str:
    return f"{value.real:.4g}" if value.imag == 0 else f"{value.real:.4g}{value.imag:+.4g}i"


def ending(branch: Branch) -> str:
    """A sentence on why the branch ended."""
    if branch.stopped is not None:
        return str(branch.stopped)
    first, last = branch.points[0].parameter, branch.points[-1].parameter
    name = branch.parameter_name
    if abs(last - first) < 1e-9 * (1 + abs(first)):
        return f"The branch turned and came back to {name} = {last:g}, where it began."
    return f"The branch reached {name} = {last:g}, the end of the range."


def _report(console: Console, branch: Branch) -> None:
    table = table_of(
        f"{branch.settings['bird']} along {branch.parameter_name}",
        "",
        "value",
        "|Λ|max",
        "speed\nm/s",
        "climb\nm/s",
        "power\nW",
        "attack\n°",
        numbers=(1, 2, 3, 4, 5, 6),
    )
    for i, point in enumerate(branch.points):
        _add(table, point.stability, point)
        for found in branch.bifurcations:
            if found.after == i:
                _add(table, found.kind, found.point)
    console.print()
    console.print(table)
    console.print()
    for found in branch.bifurcations:
        console.print(_sentence(found, branch.parameter_name), highlight=False, soft_wrap=True)
    console.print(ending(branch), highlight=False, soft_wrap=True)


def _add(table: Table, name: str, point: BranchPoint) -> None:
    seen = point.observables
    table.add_row(
        name,
        f"{point.parameter:.6g}",
        f"{_largest(point)[0]:.5f}",
        f"{seen['mean_speed']:.3f}",
        f"{seen['mean_climb_rate']:+.3f}",
        f"{seen['power']:.2f}",
        f"{np.degrees(seen['largest_angle_of_attack']):.1f}",
        style=_STYLES.get(name, "bold"),
    )


def _object(branch: Branch) -> dict[str, object]:
    """What `birdmb branch --json` prints, in SI units and rad."""
    stopped = branch.stopped
    return {
        **branch.settings,
        "birdmb_version": branch.software["birdmb"],
        "state_names": list(branch.state_names),
        "points": [_point_object(point) for point in branch.points],
        "bifurcations": [
            {
                "kind": found.kind,
                "parameter_error": finite(found.parameter_error),
                "after": found.after,
                "crossing": [[float(m.real), float(m.imag)] for m in found.multipliers],
                "outside": list(found.outside),
                **_point_object(found.point),
            }
            for found in branch.bifurcations
        ],
        "stopped": None if stopped is None else stopped.reason,
        "ending": ending(branch),
    }


def _point_object(point: BranchPoint) -> dict[str, object]:
    return {
        "parameter": point.parameter,
        "period": point.period,
        "x0": [float(value) for value in point.points[0]],
        "residual": point.residual,
        "method": point.method,
        "nodes": point.nodes,
        "multipliers": [[float(m.real), float(m.imag)] for m in point.multipliers],
        "multiplier_errors": [finite(float(error)) for error in point.multiplier_errors],
        "stability": point.stability,
        **{name: finite(value) for name, value in point.observables.items()},
    }
