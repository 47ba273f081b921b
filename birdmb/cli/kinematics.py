"""The command `birdmb kinematics`."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import TypedDict

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from birdmb._typing import FloatArray
from birdmb.cli.console import messages, output
from birdmb.cli.drawing import Pictures
from birdmb.cli.progress import Progress
from birdmb.cli.results import finite
from birdmb.cli.tables import table_of
from birdmb.kinematics import JointMotion, KinematicsFit, fit_kinematics

_FINEST = 4  # decimals


class Options(TypedDict):
    """Those of `fit_kinematics` that the command line has."""

    frame: str | None
    rate: float | None
    unit: str | None
    markers: Path | None
    frequency: float | None
    harmonics: int | None
    lengths: bool


def run(
    file: Path,
    like: str,
    *,
    options: Options,
    out: Path | None,
    figure: Path | None,
    pictures: Pictures,
    as_json: bool,
) -> None:
    """Fit a gait, say how sure it is, and write the bird and a figure."""
    progress = Progress(messages())
    with progress.shown():
        progress.doing("fitting the gait")
        fit = fit_kinematics(file, like, **options)
    written = []
    if out is not None:
        written.append(fit.write(out))
    if figure is not None:
        with pictures.style():
            written += pictures.write(figure.parent, figure.stem, fit.plot())
    if as_json:
        json.dump(_object(fit), sys.stdout, indent=2, allow_nan=False)
        typer.echo()
        return
    _print(output(), fit)
    for path in written:
        typer.echo(f"wrote {path}")


def _print(console: Console, fit: KinematicsFit) -> None:
    console.print()
    console.print(_joints(fit))
    console.print()
    console.print(_markers(fit))
    console.print()
    frequency = _with_error(fit.frequency, fit.frequency_error)
    given = "" if fit.frequency_error else ", as given"
    console.print(
        f"{fit.beats} whole beats in {fit.frames} frames at {frequency} Hz{given}; t = 0 of "
        f"the gait is {fit.start:.6g} s of the table, from the phase of {fit.reference}",
        highlight=False,
    )
    for name in fit.undetermined:
        console.print(
            f"The data do not tell {name}; it keeps the topology's own motion.",
            style="yellow",
            highlight=False,
        )
    for remark in fit.remarks:
        console.print(f"Warning: {remark}.", style="yellow", highlight=False)


def _joints(fit: KinematicsFit) -> Table:
    table = table_of(
        f"{fit.bird.name}: joints in degrees, with standard errors",
        "joint", "order", "offset", "amplitude", "phase", "scatter",
        numbers=(1, 2, 3, 4, 5),
    )  # fmt: skip
    for name, motion in fit.joints.items():
        for order in range(1, len(motion.amplitudes) + 1):
            known = name == fit.reference and order == 1
            phase = (motion.phases[order - 1], motion.phase_errors[order - 1])
            table.add_row(
                name if order == 1 else "",
                f"{order}",
                _sure(motion.offset, motion.offset_error) if order == 1 else "",
                _sure(motion.amplitudes[order - 1], motion.amplitude_errors[order - 1]),
                f"{math.degrees(phase[0]):.0f}, as before" if known else _sure(*phase),
                _scatter(motion) if order == 1 else "",
            )
    return table


def _sure(value: float, error: float) -> str:
    """An angle and its error in degrees."""
    return _with_error(math.degrees(value), math.degrees(error))


def _with_error(value: float, error: float) -> str:
    """A number to the first digit of its error, with that."""
    if error == 0.0:
        return f"{value:.6g}"
    places = min(_FINEST, max(0, -math.floor(math.log10(error))))
    return f"{value:.{places}f} ± {error:.{places}f}"


def _scatter(motion: JointMotion) -> str:
    return f"{math.degrees(motion.scatter):.2g}" if math.isfinite(motion.scatter) else "-"


def _markers(fit: KinematicsFit) -> Table:
    table = table_of(
        "Residuals, standard deviation",
        "marker", "residual", "unit", "frames", "missing",
        numbers=(1, 3, 4),
    )  # fmt: skip
    for name, marker in fit.markers.items():
        angle = name in fit.like.joint_names
        residual = math.degrees(marker.residual) if angle else 1e3 * marker.residual
        unit = "°" if angle else "mm"
        table.add_row(name, f"{residual:.3g}", unit, f"{marker.samples}", f"{marker.missing}")
    return table


def _object(fit: KinematicsFit) -> dict[str, object]:
    """The fit as one JSON object, in SI units and rad."""
    return {
        "bird": fit.bird.name,
        "source": fit.source,
        "frequency": fit.frequency,
        "frequency_error": fit.frequency_error,
        "beats": fit.beats,
        "frames": fit.frames,
        "start": fit.start,
        "reference": fit.reference,
        "joints": {name: _motion(motion) for name, motion in fit.joints.items()},
        "undetermined": list(fit.undetermined),
        "markers": {
            name: {"residual": m.residual, "samples": m.samples, "missing": m.missing}
            for name, m in fit.markers.items()
        },
        "remarks": list(fit.remarks),
    }


def _motion(motion: JointMotion) -> dict[str, object]:
    return {
        "offset": motion.offset,
        "offset_error": motion.offset_error,
        "amplitudes": _listed(motion.amplitudes),
        "amplitude_errors": _listed(motion.amplitude_errors),
        "phases": _listed(motion.phases),
        "phase_errors": _listed(motion.phase_errors),
        "scatter": finite(motion.scatter),
    }


def _listed(values: FloatArray) -> list[float]:
    return [float(value) for value in np.asarray(values)]
