"""The command `birdmb gust`."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import typer
import xarray as xr

from birdmb.cli.console import messages, output
from birdmb.cli.drawing import Pictures
from birdmb.cli.files import prepare, write_dataset
from birdmb.cli.outcome import NO_CYCLE, InputError, ResultUnwrittenError
from birdmb.cli.progress import Progress, at_work
from birdmb.cli.results import finite, verdict_sentence
from birdmb.cli.searching import TRIM, Search, announce, found_flight, model_of
from birdmb.cli.tables import table_of
from birdmb.errors import OutputError
from birdmb.figures import plot_gust_response, plot_gust_states
from birdmb.models import CosineGust, GaussianGust, StepGust
from birdmb.quantities import IN_DEGREES
from birdmb.studies.gust import gust_response

if TYPE_CHECKING:
    from birdmb.models import FlightCycle
    from birdmb.models.motion import FlightMotionName
    from birdmb.studies.body_gust import GustAxes
    from birdmb.topology import Bird

_DIRECTIONS = ("vertical", "horizontal", "lateral")


@dataclass(frozen=True)
class GustOptions:
    """What the options say about the gust and the flight through it; `None` is the default."""

    kind: str
    vertical: float
    horizontal: float
    lateral: float
    at: float | None
    length: float | None
    axes: GustAxes
    beats: int

    def made(self) -> GaussianGust | CosineGust | StepGust:
        """The gust.

        Raises:
            InputError: it blows in no direction, or has a length that its kind has not.
        """
        strength = {name: getattr(self, name) for name in _DIRECTIONS}
        if not any(strength.values()):
            raise InputError("give the gust a strength: --vertical, --horizontal or --lateral.")
        at, length = self.at, self.length
        if self.kind == "gaussian":
            usual = GaussianGust()
            return GaussianGust(
                **strength,
                time=usual.time if at is None else at,
                width=usual.width if length is None else length,
            )
        if self.kind == "cosine":
            wave = CosineGust()
            return CosineGust(
                **strength,
                start=wave.start if at is None else at,
                duration=wave.duration if length is None else length,
            )
        if length is not None:
            raise InputError("--length has no effect on a step, which does not end.")
        return StepGust(**strength, start=0.0 if at is None else at)


def run(
    bird: Bird,
    model_name: str,
    motion: FlightMotionName,
    options: GustOptions,
    *,
    out: Path | None,
    pictures: Pictures,
    as_json: bool,
) -> None:
    """Fly a bird from its limit cycle through a gust, say what it does, and write it into `out`."""
    gust = options.made()
    if out is not None:
        prepare(out)
    progress = Progress(messages())
    with at_work(progress, out):
        model = model_of(bird, model_name, motion, None)
        announce(model, model_name, progress)
        search = Search(
            model_name, motion, None, 1e-9, 50, method="auto", damping="line-search",
            steps_per_beat=None,
        )  # fmt: skip
        cycle = found_flight(model, search, None, progress)
        progress.doing("flying through the gust")
        flight = gust_response(cycle, gust, axes=options.axes, periods=options.beats)
    found = _object(cycle, model_name, options, gust, flight)
    if not as_json:
        _report(cycle, flight)
    if out is not None:
        try:
            with at_work(progress, out), pictures.style():
                written = [
                    write_dataset(out / "gust.nc", flight),
                    *pictures.write(out, "gust", plot_gust_response(flight)),
                    *pictures.write(out, "gust_states", plot_gust_states(flight)),
                ]
        except OutputError as error:
            raise ResultUnwrittenError(str(error), found) from error
        found["files"] = [str(path) for path in written]
        if not as_json:
            for path in written:
                progress.line(f"wrote {path}")
    if as_json:
        json.dump(found, sys.stdout, allow_nan=False, indent=2)
        sys.stdout.write("\n")
    if cycle.why_no_flight is not None:
        progress.line(f"No flight found. What to do next: {TRIM}.")
        raise typer.Exit(NO_CYCLE)
    if flight.attrs["failure"]:
        progress.line(f"The flight ended early: {flight.attrs['failure']}")
        raise typer.Exit(NO_CYCLE)


def _object(
    cycle: FlightCycle,
    model_name: str,
    options: GustOptions,
    gust: GaussianGust | CosineGust | StepGust,
    flight: xr.Dataset,
) -> dict[str, object]:
    """What `birdmb gust --json` prints, in SI units and rad."""
    strongest, from_linear = _largest(flight)
    height, at_end = _height(flight)
    return {
        "bird": cycle.model.bird.name,
        "model": model_name,
        "motion": cycle.model.motion.name,
        "gust": {"kind": options.kind, "axes": options.axes, **vars(gust)},
        "beats": options.beats,
        "verdict": verdict_sentence(cycle),
        "why_no_flight": cycle.why_no_flight,
        "largest_deviation": strongest,
        "largest_difference_from_linear": from_linear,
        "largest_height_gained": finite(height),
        "height_gained_at_end": finite(at_end),
        "modes": [_mode(flight.isel(mode=i)) for i in range(flight.sizes["mode"])],
        "failure": flight.attrs["failure"],
        "files": [],
    }


def _mode(mode: xr.Dataset) -> dict[str, object]:
    """Multiplier of a mode, how long its oscillation takes, and how much of it the gust excites."""
    multiplier = complex(float(mode["multiplier_real"]), float(mode["multiplier_imag"]))
    turned = abs(math.atan2(multiplier.imag, multiplier.real))
    period = mode.attrs["period"] * 2.0 * math.pi / turned if turned else math.inf
    largest = abs(mode["mode_deviation"]).max("time").values
    return {
        "multiplier": [multiplier.real, multiplier.imag],
        "period": finite(period),
        "largest_deviation": dict(zip(_states(mode), map(float, largest), strict=True)),
    }


def _states(flight: xr.Dataset) -> list[str]:
    return [str(name) for name in flight["state"].values]


def _largest(flight: xr.Dataset) -> tuple[dict[str, float | None], dict[str, float | None]]:
    """Largest deviation of each state from the cycle, and from the linear response."""
    found = []
    for values in (flight["deviation"], flight["deviation"] - flight["linear"]):
        largest = abs(values).max("time").values
        found.append(dict(zip(_states(flight), map(finite, largest), strict=True)))
    return found[0], found[1]


def _height(flight: xr.Dataset) -> tuple[float, float]:
    """Height (m) gained against the flight without the gust: the most, and at the end."""
    gained = (flight["h"] - flight["orbit_h"]).values
    return float(np.nanmax(gained)), float(gained[-1])


def _report(cycle: FlightCycle, flight: xr.Dataset) -> None:
    console = output()
    columns = ("state", "largest deviation", "unit", "of that, not linear", "in degrees")
    table = table_of("Flight through the gust", *columns, numbers=(1, 3, 4))
    strongest, from_linear = _largest(flight)
    for name, unit in zip(_states(flight), cycle.model.state_units, strict=True):
        value, apart = strongest[name], from_linear[name]
        if value is None or apart is None:
            continue
        degrees = f"{math.degrees(value):.2f} {IN_DEGREES[unit]}" if unit in IN_DEGREES else ""
        table.add_row(name, f"{value:.6f}", unit, f"{apart:.6f}", degrees)
    console.print()
    console.print(table)
    height, at_end = _height(flight)
    console.print(
        f"gains at most {height:.3f} m of height, {at_end:+.3f} m at the end", highlight=False
    )
    console.print(verdict_sentence(cycle), highlight=False)
