"""Exceptions and signals that meet compiled code on their way: they go past it."""

import os
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import birdmb
from birdmb.models.compiled_calls import Carrier, behind, calls_compiled_code
from tests.conftest import TOPOLOGIES

SIGNAL = signal.SIGINT


class Stop(BaseException):
    """Neither an `Exception` nor one of the package's."""


@pytest.fixture
def handled():
    """A handler that raises `Stop`, put before the signal's own for the test."""

    def stop(*_):
        raise Stop

    before = signal.signal(SIGNAL, stop)
    yield stop
    signal.signal(SIGNAL, before)


@pytest.fixture(scope="module")
def bird():
    bird = birdmb.load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml")
    return bird.with_values({"wing.discretisation": 4})


def test_a_signal_that_arrives_in_compiled_code_is_raised_after_it(handled):
    """At the entry of a callback Python would run the handler before any `try` of it."""
    returned = []

    def compiled():
        signal.raise_signal(SIGNAL)
        returned.append("compiled")
        return 1.0

    with pytest.raises(Stop):
        Carrier().call(compiled)
    assert returned == ["compiled"]
    assert signal.getsignal(SIGNAL) is handled


@pytest.mark.parametrize("inside", [True, False])
def test_a_callback_never_raises(handled, inside):
    carrier, calls, got = Carrier(), [], []

    def forces():
        calls.append("forces")
        if inside and len(calls) == 1:
            signal.raise_signal(SIGNAL)
        return np.zeros(2)

    callback = carrier.callback(forces, (2,))

    def compiled():
        if not inside:
            signal.raise_signal(SIGNAL)
        got.extend([callback(None), callback(None)])

    with pytest.raises(Stop):
        carrier.call(compiled)
    assert np.isnan(got).all()
    assert calls == (["forces"] if inside else [])
    assert carrier.call(lambda: callback(None).shape) == (2,)  # nothing is left of it
    assert signal.getsignal(SIGNAL) is handled


def test_a_handler_that_returns_changes_nothing():
    seen = []
    before = signal.signal(SIGNAL, lambda number, _: seen.append(number))
    try:
        carrier = Carrier()
        callback = carrier.callback(lambda: signal.raise_signal(SIGNAL) or np.ones(3), (3,))
        np.testing.assert_array_equal(carrier.call(lambda: callback(None)), np.ones(3))
    finally:
        signal.signal(SIGNAL, before)
    assert seen == [SIGNAL]


def test_what_numba_makes_of_an_interruption_is_undone():
    interrupted = SystemError("returned a result with an exception set")
    interrupted.__cause__ = Stop()
    assert behind(interrupted) is interrupted.__cause__
    bare = SystemError("of its own")
    assert behind(bare) is bare


def test_a_gust_that_raises_comes_out_of_the_search_as_it_is(bird, handled):
    """From Exudyn's user functions; the model is as good as new after it."""
    steady = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit")
    x = steady.driven_state()
    calls = 0

    def gust(_):
        nonlocal calls
        calls += 1
        if calls == 100:
            signal.raise_signal(SIGNAL)
        if calls == 300:
            raise OSError("no data of the gust")
        return 0.0, 0.0

    gusty = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit", gust=gust)
    with pytest.raises(Stop):
        birdmb.find_limit_cycle(gusty, x)
    with pytest.raises(OSError, match="no data of the gust"):
        gusty.flow(x, 0.0, 0.25)
    np.testing.assert_array_equal(gusty.flow(x, 0.0, 0.25), steady.flow(x, 0.0, 0.25))
    assert signal.getsignal(SIGNAL) is handled


INTERRUPTED_AT_RANDOM = """
import random, signal, sys, threading, time
import birdmb

bird = birdmb.load_bird(sys.argv[1]).with_values({"wing.discretisation": 4})
model = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit")
x = model.driven_state()
expected = model.flow(x, 0.0, 0.25)
signal.signal(signal.SIGINT, signal.default_int_handler)
caught, pauses, main = 0, random.Random(1), threading.main_thread().ident
for _ in range(15):
    go = threading.Event()
    def interrupt():
        go.wait()
        time.sleep(pauses.uniform(0.0, 0.02))
        signal.pthread_kill(main, signal.SIGINT)
    sender = threading.Thread(target=interrupt)
    sender.start()
    try:
        go.set()
        while True:
            model.flow(x, 0.0, 0.25)
    except KeyboardInterrupt:
        caught += 1
    sender.join()
assert (model.flow(x, 0.0, 0.25) == expected).all()
print(caught)
"""


@pytest.mark.skipif(os.name != "posix", reason="sends POSIX signals to a thread")
def test_interruptions_at_random_moments_are_keyboard_interrupts():
    run = subprocess.run(
        [
            sys.executable,
            "-c",
            INTERRUPTED_AT_RANDOM,
            str(TOPOLOGIES / "ibis_compliant_shoulder.toml"),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "15\n", "")


def test_one_model_in_several_threads_gives_what_it_gives_in_one(bird):
    alone = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit")
    starts = [alone.driven_state() + 0.01 * k * alone.state_scale for k in range(6)]
    expected = [alone.flow(x, 0.0, 0.25) for x in starts]
    shared = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit")
    together = threading.Barrier(3)

    def flow(k):
        if k < 3:
            together.wait()
        return shared.flow(starts[k], 0.0, 0.25)

    with ThreadPoolExecutor(3) as executor:
        np.testing.assert_array_equal(list(executor.map(flow, range(6))), expected)


def test_a_new_model_may_be_used_by_many_threads_at_once(bird):
    """Whose lazily made parts are then asked for at the same time, inside and outside of calls."""
    model = birdmb.MultibodyModel(bird)
    x, together = np.array([18.0, -2.0, 0.0, -0.1, 0.0, 20.0]), threading.Barrier(3)

    def used(k):
        together.wait()
        return model.steps_per_beat if k else model.rhs(0.0, x)

    with ThreadPoolExecutor(3) as executor:
        _, *steps = executor.map(used, range(3))
    assert steps == [model.steps_per_beat] * 2


def test_handlers_of_the_main_thread_do_not_run_in_others(handled):
    inside = []

    @calls_compiled_code
    def called():
        inside.append(signal.getsignal(SIGNAL))

    thread = threading.Thread(target=called)
    thread.start()
    thread.join()
    assert inside == [handled]


@pytest.mark.parametrize("call", [1, 7, 100])
def test_ctrl_c_while_exudyn_integrates_is_a_keyboard_interrupt(bird, call):
    """Nothing of Exudyn's comes out, nor is an error of its own told beside it."""
    calls = 0

    def gust(_):
        nonlocal calls
        calls += 1
        if calls == call:
            signal.raise_signal(signal.SIGINT)
        return 0.0, 0.0

    model = birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit", gust=gust)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt) as interrupted:
            model.flow(model.driven_state(), 0.0, 0.25)
    finally:
        signal.signal(signal.SIGINT, before)
    assert (interrupted.value.__cause__, interrupted.value.__context__) == (None, None)
