"""Sweeps that keep to one sheet of flights, on a made-up family of them that folds back."""

from dataclasses import replace

import numpy as np
import pytest

import birdmb
from birdmb.errors import OrbitError
from birdmb.studies.sweeps import point, sweep
from birdmb.studies.sweeps.sheets import SheetEndError, on_sheet
from birdmb.studies.sweeps.tasks import Guess, Task

from .sweeping import MASS, QUICK, Inline, coarse_bird
from .test_sweep_jumps import FALLING, MASSES

SCALE = [10.0, 2.0, 1.0, 0.2]


def flight(u, slope):
    """A flight with this u, in units of its scale, and its derivative by the mass."""
    x0 = {"u": 10.0 * u, "w": 0.0, "q": 0.0, "theta": 0.0}
    sensitivity = {MASS: [slope, 0.0, 0.0, 0.0]}
    return {"x0": x0, "state_scale": SCALE, "sensitivity": sensitivity, "trimmed": {}}


def task(mass, before, kept):
    guess = None if before is None else Guess("[0]", {MASS: before}, kept)
    return Task(None, None, None, {MASS: mass}, {MASS: 0.01}, guess, None, keep_to_sheet=True)


def folding(asked):
    """Flights on the parabola mass = u^2, of which a search over a wide step misses the upper side.

    None are below mass 0.
    """
    mass, guess = asked.values[MASS], asked.guess
    if mass < 0.0:
        raise OrbitError("there is none.")
    upper = guess is None or (guess.flight["x0"]["u"] > 0 and abs(guess.values[MASS] - mass) < 0.4)
    u = np.sqrt(mass) * (1.0 if upper else -1.0)
    tried.append(mass)
    return flight(u, 0.5 / u), "[0]"


tried = []


def test_a_flight_on_another_sheet_is_searched_again_by_smaller_steps():
    tried.clear()
    kept, _ = folding(task(1.0, None, None))
    lost, _ = folding(task(0.36, 1.0, kept))
    assert lost["x0"]["u"] == pytest.approx(-6.0)
    found, start = on_sheet(task(0.36, 1.0, kept), folding)
    assert found["x0"]["u"] == pytest.approx(6.0)
    assert start == "[0]"
    # At once, then half of the way to the neighbour and the rest.
    assert tried[2:] == pytest.approx([0.36, 0.68, 0.36])


def test_a_sheet_that_ends_is_the_points_failure():
    kept, _ = folding(task(0.3, None, None))
    with pytest.raises(SheetEndError, match=r"that \[0\] is on ends between body.mass ="):
        on_sheet(task(-0.1, 0.3, kept), folding)


def test_flights_that_the_step_explains_are_taken_as_they_are():
    tried.clear()
    kept, _ = folding(task(1.0, None, None))
    on_sheet(task(0.9, 1.0, kept), folding)
    assert tried == [1.0, 0.9]


def test_texts_have_no_values_in_between():
    kept, _ = folding(task(1.0, None, None))
    there = replace(task(0.25, 1.0, kept), values={MASS: 0.25, "shoulder.flap.mode": "compliant"})
    guess = replace(there.guess, values={MASS: 1.0, "shoulder.flap.mode": "prescribed"})
    assert on_sheet(replace(there, guess=guess), folding)[0]["x0"]["u"] == pytest.approx(-5.0)


def test_a_sweep_that_keeps_to_the_sheet_leaves_no_jump(tmp_path, monkeypatch):
    """Its first search at 1.3 kg is led to a fall tail first; the neighbour's sheet goes on."""
    derailed = []

    def searched(model, guess=None, **options):
        if model.bird.body.mass == 1.3 and not derailed:
            derailed.append(guess)
            return birdmb.find_limit_cycle(model, list(FALLING.values()))
        return birdmb.find_limit_cycle(model, guess, **options)

    monkeypatch.setattr(point, "find_limit_cycle", searched)
    studies = []
    for keep in (False, True):
        derailed.clear()
        store, vary = tmp_path / f"{keep}.db", {MASS: MASSES}
        given = {"store": store, "executor": Inline(), "model": QUICK, "keep_to_sheet": keep}
        studies.append(sweep(coarse_bird(), vary, **given).to_xarray())
    jumping, kept = studies
    assert jumping.sheet_jump.any()
    assert (kept.status == "found").all()
    assert not kept.sheet_jump.any()
    assert (kept.mean_speed > 17).all()
