"""One point never ends a study: whatever it raises, and if it ends the process that computes it."""

import os
import signal
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import contextmanager
from functools import partial

import pytest

import birdmb
from birdmb.studies.sweeps import Study, SweepError, dispatch, sweep
from birdmb.studies.sweeps.dispatch import DIED

from .sweeping import MASS, QUICK, Inline, coarse_bird

DEADLY = 1.2  # what the bird itself weighs
MASSES = [1.1, DEADLY, 1.3]


def raising_model(bird, kind):
    if bird.body.mass == DEADLY:
        raise kind("no flight\nhere")
    return QUICK(bird)


def deep_model(bird):
    return deep_model(bird) if bird.body.mass == DEADLY else QUICK(bird)


def killing_model(bird):
    """A model that ends its process as the kernel does where memory is short."""
    if bird.body.mass == DEADLY:
        os.kill(os.getpid(), signal.SIGKILL)
    return QUICK(bird)


@pytest.mark.parametrize(
    ("model", "reason"),
    [
        (partial(raising_model, kind=kind), f"{kind.__name__}: no flight here")
        for kind in (ValueError, MemoryError, SystemExit)
    ]
    + [
        (partial(raising_model, kind=birdmb.OrbitError), "no flight here"),
        (deep_model, "RecursionError: maximum recursion depth exceeded"),
    ],
    ids=["ValueError", "MemoryError", "SystemExit", "a sentence", "RecursionError"],
)
def test_whatever_a_point_raises_is_its_outcome(tmp_path, model, reason):
    options = {"store": tmp_path / "s.db", "executor": Inline(), "model": model}
    study = sweep(coarse_bird(), {MASS: MASSES}, **options)
    assert [values for values, _ in study.failures] == [{MASS: DEADLY}]
    assert study.failures[0][1].startswith(reason)
    assert "\n" not in study.failures[0][1]
    again = []
    sweep(coarse_bird(), {MASS: MASSES}, **options, on_point=again.append)
    assert again == []


def test_interrupts_are_no_outcome(tmp_path):
    model = partial(raising_model, kind=KeyboardInterrupt)
    with pytest.raises(KeyboardInterrupt):
        sweep(
            coarse_bird(), {MASS: MASSES}, store=tmp_path / "s.db", executor=Inline(), model=model
        )
    assert len(Study.open(tmp_path / "s.db").outcomes) == 1


@pytest.mark.long
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="kills its worker")
def test_a_point_that_ends_its_process_is_found_and_the_others_go_on(tmp_path):
    options = {"store": tmp_path / "s.db", "workers": 1, "model": killing_model}
    bird = coarse_bird().with_values({MASS: 1.15})
    study = sweep(bird, {MASS: MASSES}, **options)
    ((values, reason),) = study.failures
    assert values == {MASS: DEADLY}
    assert reason.startswith(DIED)
    inline = sweep(
        coarse_bird(),
        {MASS: MASSES},
        store=tmp_path / "inline.db",
        executor=Inline(),
        model=partial(raising_model, kind=ValueError),
    )
    for place in ((0,), (2,)):
        assert study.outcomes[place].result == inline.outcomes[place].result
    again = []
    sweep(bird, {MASS: MASSES}, **options, on_point=again.append)
    assert again == []


class Processes:
    """Stands for pools of processes that die under one point, so often, or before all points."""

    def __init__(self, *, deaths=1_000, stillborn=False):
        self.sizes, self.tries, self.stillborn = [], 0, stillborn
        self._deaths = deaths

    @contextmanager
    def pool(self, workers, _bird, _model):
        self.sizes.append(workers)
        yield _Mortal(self)

    def dies(self, task):
        self.tries += task.values[MASS] == DEADLY
        return task.values[MASS] == DEADLY and self.tries <= self._deaths


class _Mortal(Executor):
    def __init__(self, processes):
        self._processes, self._broken = processes, processes.stillborn

    def submit(self, function, /, *arguments):
        future = Future()
        self._broken |= function is not int and self._processes.dies(arguments[0])
        if self._broken:
            future.set_exception(BrokenExecutor("died"))
        else:
            future.set_result(function(*arguments))
        return future


@pytest.fixture
def mortal(monkeypatch, tmp_path):
    """Sweep in processes like these; returns the study."""

    def swept(processes, workers=2, masses=MASSES):
        monkeypatch.setattr(dispatch, "process_pool", processes.pool)
        return sweep(
            coarse_bird(), {MASS: masses}, store=tmp_path / "s.db", workers=workers, model=QUICK
        )

    return swept


def test_no_more_processes_than_points(mortal):
    processes = Processes(deaths=0)
    mortal(processes, workers=12, masses=MASSES[:2])
    mortal(processes, workers=12)
    assert processes.sizes == [2, 1]


def test_whoever_is_under_way_beside_the_culprit_is_computed(mortal):
    processes = Processes()
    assert [values for values, _ in mortal(processes).failures] == [{MASS: DEADLY}]
    assert processes.tries == 2
    assert processes.sizes[:2] == [2, 1]


def test_a_process_that_dies_once_by_chance_costs_no_point(mortal):
    assert mortal(Processes(deaths=1)).failures == []


def test_processes_that_never_start_are_no_outcome_of_a_point(mortal, tmp_path):
    with pytest.raises(SweepError, match="die before they compute anything"):
        mortal(Processes(stillborn=True))
    assert Study.open(tmp_path / "s.db").outcomes == {}
