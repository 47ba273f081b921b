"""What the tests of sweeps share: a coarse bird over a grid, and executors without processes."""

from concurrent.futures import Executor, Future
from functools import partial
from pathlib import Path

import birdmb
from birdmb.studies.sweeps import sweep

TOPOLOGIES = Path(__file__).parents[2] / "topologies"
AMPLITUDE, MASS = "shoulder.flap.amplitude_deg", "body.mass"
SMALL = {AMPLITUDE: [42.0, 40.0], MASS: [1.2, 1.3]}
GRID = {AMPLITUDE: [42.0, 40.0, -400.0, 38.0], MASS: [1.1, 1.15, 1.2, 1.25, 1.3, 1.35]}
POINTS = 24
IMPOSSIBLE = -400.0


def coarse_bird():
    ibis = birdmb.load_bird(TOPOLOGIES / "ibis.toml")
    return ibis.with_values({"wing.discretisation.elements": 8})


def logged_model(bird, log):
    """A coarse rigid model; writes what it was asked for on a line of `log`.

    But for values beside those of the grid, which sensitivities ask for.
    """
    values = [float(f"{bird.value(name):.6g}") for name in GRID]
    if all(value in listed for value, listed in zip(values, GRID.values(), strict=True)):
        with Path(log).open("a") as file:
            file.write(f"{values[0]} {values[1]}\n")
    return birdmb.RigidModel(bird, steps_per_beat=30)


def read_log(log):
    return [tuple(map(float, line.split())) for line in Path(log).read_text().splitlines()]


QUICK = partial(birdmb.RigidModel, steps_per_beat=30)


class Inline(Executor):
    """Computes what is submitted at once, in this process."""

    def submit(self, function, /, *arguments, **options):
        future = Future()
        try:
            future.set_result(function(*arguments, **options))
        except birdmb.BirdmbError as error:
            future.set_exception(error)
        return future


def small_sweep(store, **options):
    options = {"executor": Inline(), "model": QUICK} | options
    return sweep(coarse_bird(), SMALL, store=store, **options)
