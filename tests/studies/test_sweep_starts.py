"""What the points of a sweep start from."""

from dataclasses import replace
from functools import partial

import numpy as np

import birdmb
from birdmb.studies.sweeps import Study, point, sweep
from birdmb.studies.sweeps.point import compute
from birdmb.studies.sweeps.settings import Search
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
    assert (warm == np.array(first["orbit"]) * first["state_scale"]).all()
    assert found.iterations[0].residual < 0.1
    assert second["method"] == "collocation"
    assert second["nodes"] == found.nodes
    assert second["state_error"] < 1e-7
    kept = np.array(second["orbit"]) * second["state_scale"]
    times = found.period * np.arange(len(kept)) / len(kept)
    there = found.trajectory(times).states
    np.testing.assert_allclose(kept, there, atol=1e-6 * found.state_scale.max())


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
