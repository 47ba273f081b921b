"""What the points of a sweep start from."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import birdmb
from birdmb.studies.sweeps import Study, point, sweep
from birdmb.studies.sweeps.point import compute
from birdmb.studies.sweeps.settings import Search, Trimming
from birdmb.studies.sweeps.tasks import Guess, Task

from .sweeping import MASS, QUICK, Inline, coarse_bird

FLAP = "shoulder.flap"


def test_warm_points_begin_with_what_the_store_keeps_of_their_neighbour(tmp_path, monkeypatch):
    """Without a flow, near the orbit that they find."""
    begun = []

    def searched(model, guess=None, **options):
        found = birdmb.find_limit_cycle(model, guess, **options)
        begun.append((guess, found))
        return found

    def refused(*_):
        raise AssertionError("a flow was asked for")

    monkeypatch.setattr(point, "find_limit_cycle", searched)
    monkeypatch.setattr(birdmb.RigidModel, "flow", refused)
    store = tmp_path / "s.db"
    sweep(coarse_bird(), {MASS: [1.2, 1.21]}, store=store, executor=Inline(), model=QUICK)
    (cold, _), (warm, found) = begun
    first, second = (outcome.result for outcome in Study.open(store).outcomes.values())
    assert cold is None
    change = (warm / first["state_scale"] - first["orbit"]) / (1.21 - 1.2)
    np.testing.assert_allclose(change, np.tile(first["sensitivity"][MASS], (len(warm), 1)))
    model = QUICK(coarse_bird().with_values({MASS: 1.21}))
    unmoved = birdmb.find_limit_cycle(model, np.array(first["orbit"]) * first["state_scale"])
    assert found.iterations[0].residual < 0.8 * unmoved.iterations[0].residual
    assert second["method"] == "collocation"
    assert second["nodes"] == found.nodes
    assert second["state_error"] < 1e-7
    kept = np.array(second["orbit"]) * second["state_scale"]
    times = found.period * np.arange(len(kept)) / len(kept)
    there = found.trajectory(times).states
    np.testing.assert_allclose(kept, there, atol=1e-6 * found.state_scale.max())


def test_a_neighbours_flight_is_moved_to_first_order():
    """What is left grows with the square of the step: of the first state and of what is trimmed."""
    trimming = Trimming({"forearm.roll.offset_deg": (-30.0, 30.0)})
    search = Search(1e-9, 1e-7, 50, None, "auto", "line-search")
    first = Task(coarse_bird(), QUICK, search, {MASS: 1.2}, {MASS: 1e-3}, None, trimming)
    flights = {
        mass: compute(replace(first, values={MASS: mass})).result for mass in (1.2, 1.21, 1.22)
    }
    guess = Guess("[0]", {MASS: 1.2}, flights[1.2])
    left = []
    for mass in (1.21, 1.22):
        orbit, trimmed = guess.moved_to({MASS: mass}, trimming.parameters)
        found = flights[mass]
        x0 = np.array(list(found["x0"].values()))
        apart = np.append((orbit[0] - x0) / found["state_scale"], 0.0)
        (apart[-1],) = (trimmed[name] - found["trimmed"][name] for name in trimmed)
        left.append(np.abs(apart))
    x0 = np.array(list(flights[1.22]["x0"].values())) - list(flights[1.2]["x0"].values())
    assert left[1][:-1].max() < 0.2 * np.abs(x0 / flights[1.2]["state_scale"]).max()
    assert left[1].max() / left[0].max() == pytest.approx(4.0, rel=0.2)


def test_a_flight_that_would_change_by_much_stays_the_neighbours():
    kept = {
        "x0": {"u": 10.0, "w": 1.0},
        "orbit": [[1.0, 0.5]],
        "state_scale": [10.0, 2.0],
        "sensitivity": {MASS: [1.0, 0.0, -0.5]},
        "trimmed": {"a": 3.0},
    }
    guess = Guess("[0]", {MASS: 1.0, "joint.mode": "compliant"}, kept)
    bounds = {"a": (-10.0, 3.5)}
    orbit, trimmed = guess.moved_to({MASS: 1.1, "joint.mode": "prescribed"}, bounds)
    np.testing.assert_allclose(orbit, [[11.0, 1.0]])
    assert trimmed == {"a": pytest.approx(3.0 - 0.05 * 13.5)}
    assert guess.moved_to({MASS: 0.9, "joint.mode": "compliant"}, bounds)[1] == {"a": 3.5}
    orbit, trimmed = guess.moved_to({MASS: 1.3, "joint.mode": "compliant"}, bounds)
    np.testing.assert_allclose(orbit, [[10.0, 1.0]])
    assert trimmed == {"a": 3.0}


def test_neighbours_of_a_flight_that_was_shot_are_shot():
    """Collocation, which was too much for it or was not to be taken, is not tried beside it."""
    bird = coarse_bird().with_values({f"{FLAP}.stiffness": 40.0, f"{FLAP}.damping": 0.2})
    task = Task(
        bird,
        partial(birdmb.MultibodyModel, steps_per_beat=60),
        Search(1e-9, 1e-7, 50, None, "auto", "line-search"),
        {f"{FLAP}.stiffness": 39.0},
        {},
        None,
        None,
    )
    shot = compute(replace(task, search=replace(task.search, method="shooting"))).result
    guess = Guess("[0]", {f"{FLAP}.stiffness": 40.0}, shot)
    near = compute(replace(task, guess=guess))
    assert near.start == "[0]"
    assert near.result["method"] == "shooting"
    assert near.result["method_reason"] == "so was the cycle it started from"
    assert near.result["orbit"] is None


def test_points_that_are_shot_over_segments_start_from_their_neighbour(tmp_path):
    """The store keeps one state of it, which fits no three segments."""
    options = {"store": tmp_path / "s.db", "executor": Inline(), "model": QUICK, "segments": 3}
    sweep(coarse_bird(), {MASS: [1.2, 1.21]}, **options)
    first, second = Study.open(tmp_path / "s.db").outcomes.values()
    assert (first.start, second.start) == ("cold", "[0]")
    assert second.result["method"] == "shooting"
