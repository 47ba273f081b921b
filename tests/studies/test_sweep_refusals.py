"""Sweeps that are refused, each with one sentence that says why."""

import sqlite3
from concurrent.futures import BrokenExecutor, Executor, Future
from functools import partial

import pytest

import birdmb
from birdmb.errors import ArgumentError
from birdmb.studies.sweeps import Study, SweepError, Trimming, sweep

from .sweeping import AMPLITUDE, MASS, QUICK, SMALL, Inline, coarse_bird, small_sweep


def refusal(store, bird=None, grid=SMALL, **options):
    options = {"executor": Inline(), "model": QUICK} | options
    with pytest.raises(SweepError) as caught:
        sweep(bird or coarse_bird(), grid, store=store, **options)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_stores_of_other_studies_are_refused(tmp_path):
    store = tmp_path / "study.db"
    before = small_sweep(store).to_xarray()
    heavier = coarse_bird().with_values({"body.inertia_yy": 0.2})
    assert "body.inertia_yy is 0.1 there and 0.2 here" in refusal(store, heavier)
    finer = coarse_bird().with_values({"wing.discretisation.elements": 9})
    assert "wing.discretisation.elements is 8 there and 9 here" in refusal(store, finer)
    assert "the model is RigidModel(steps_per_beat=30) there and RigidModel here" in refusal(
        store, model=birdmb.RigidModel
    )
    assert "tolerance of the search is 1e-09 there and 1e-08 here" in refusal(store, tolerance=1e-8)
    assert "it varies shoulder.flap.amplitude_deg, body.mass, in this order" in refusal(
        store, grid={MASS: [1.2]}
    )
    assert "the values of body.mass there are 1.2, 1.3" in refusal(
        store, grid=SMALL | {MASS: [1.2, 1.4]}
    )
    assert Study.open(store).to_xarray().identical(before)
    assert [path.name for path in tmp_path.iterdir()] == ["study.db"]


def test_files_that_are_no_studies_are_refused_and_left_alone(tmp_path):
    text, other = tmp_path / "notes.txt", tmp_path / "other.db"
    text.write_text("mine, and longer than the header of a database is, to be sure of it " * 3)
    with sqlite3.connect(other) as connection:
        connection.execute("create table mine (x)")
    connection.close()
    kept = [path.read_bytes() for path in (text, other)]
    assert "not a database" in refusal(text)
    assert "is no study" in refusal(other)
    assert [path.read_bytes() for path in (text, other)] == kept
    assert "unable to open" in refusal(tmp_path / "nowhere" / "study.db")
    with pytest.raises(SweepError, match="no such study"):
        Study.open(tmp_path / "nothing.db")


def test_two_sweeps_do_not_fill_one_store(tmp_path):
    store = tmp_path / "study.db"

    def other_comes_first(point):
        if point.done == 0:
            small_sweep(store)

    with pytest.raises(SweepError, match="another sweep is filling this store"):
        small_sweep(store, on_point=other_comes_first)
    assert len(Study.open(store).outcomes) == 4


class _Unsendable:
    def __repr__(self):
        return "calm"

    def __reduce__(self):
        raise TypeError("stays here")


@pytest.mark.parametrize(
    "options",
    [
        {"parameters": {}},
        {"parameters": {MASS: (2.0, 1.0)}},
        {"parameters": {MASS: (1.0, float("inf"))}},
        {"parameters": {MASS: (1.0, 2.0)}, "climb_rate": float("nan")},
        {"parameters": {MASS: (1.0, 2.0)}, "speed": 10.0},
        *(
            {"parameters": {MASS: (1.0, 2.0), AMPLITUDE: (20.0, 50.0)}, "speed": speed}
            for speed in (0.0, -1.0, float("nan"), float("inf"))
        ),
        {
            "parameters": {MASS: (1.0, 2.0), AMPLITUDE: (20.0, 50.0)},
            "speed": 10.0,
            "climb_rate": -11.0,
        },
        {"parameters": {MASS: (1.0, 2.0)}, "tolerance": 0.0},
    ],
)
def test_trims_that_no_flight_has_are_told_before_the_points(options):
    with pytest.raises(ArgumentError):
        Trimming(**options)


def test_what_cannot_be_meant_is_said_at_once(tmp_path):
    store = tmp_path / "study.db"
    assert "at least one parameter" in refusal(store, grid={})
    assert "body.mass has no values" in refusal(store, grid={MASS: []})
    assert "body.mass is to be 1.2 twice" in refusal(store, grid={MASS: [1.2, 1.3, 1.2]})
    assert "cannot be nan" in refusal(store, grid={MASS: [float("nan")]})
    assert "<lambda> is not" in refusal(
        store, model=lambda bird: birdmb.RigidModel(bird, steps_per_beat=30)
    )
    assert "options that are the same in every run" in refusal(
        store, model=partial(birdmb.RigidModel, gust=lambda _: (0.0, 0.0))
    )
    for workers in (0, -1, 1_000_000):
        assert f"{workers} workers are asked for" in refusal(store, executor=None, workers=workers)
    assert "cannot be sent to other processes" in refusal(
        store, executor=None, model=partial(birdmb.RigidModel, gust=_Unsendable())
    )
    trim = Trimming({MASS: (1.0, 2.0)})
    assert "body.mass cannot be both varied and trimmed" in refusal(store, trim=trim)
    with pytest.raises(birdmb.TopologyError, match="nearest"):
        sweep(coarse_bird(), {"body.mas": [1.0]}, store=store)
    assert not store.exists()
    with pytest.raises(ArgumentError, match="method"):
        small_sweep(store, method="guessing")


def test_workers_that_die_end_the_sweep_with_a_sentence(tmp_path):
    class Dying(Executor):
        def submit(self, *_arguments, **_options):
            future = Future()
            future.set_exception(BrokenExecutor("died"))
            return future

    sentence = refusal(tmp_path / "s.db", executor=Dying())
    assert "A worker process died" in sentence
    assert f"under way or next were {AMPLITUDE} = 42.0, {MASS} = 1.2. Finished" in sentence
