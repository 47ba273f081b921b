"""Kills a sweep ten times: `python killed_sweep.py STORE LOG SEED`; run by test_sweeps_killed.py.

A process of its own, so that it can fork: importing the package anew takes seconds. The sweep and
its workers are killed together, as by the end of a machine. Prints a line for every kill: how many
points were stored, and how many computations had begun.
"""

import multiprocessing
import os
import random
import signal
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import suppress
from functools import partial

from birdmb.studies.sweeps import Study, SweepError, sweep
from birdmb.studies.sweeps.point import prepare
from tests.studies.sweeping import GRID, QUICK, coarse_bird, logged_model, read_log

KILLS = 10


def fill(store, log):
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("fork")) as pool:
        model = partial(logged_model, log=log)
        sweep(coarse_bird(), GRID, store=store, executor=pool, model=model)


def finished(store):
    try:
        study = Study.open(store)
    except SweepError:
        return {}
    names = tuple(study.parameters)
    return {
        tuple(study.parameters[n][i] for n, i in zip(names, place, strict=True)): outcome
        for place, outcome in study.outcomes.items()
    }


def main(store, log, seed):
    moments = random.Random(seed)
    prepare(coarse_bird(), QUICK)
    open(log, "w").close()  # noqa: PTH123
    for _ in range(KILLS):
        before, computed = finished(store), len(read_log(log))
        child = os.fork()
        if child == 0:
            os.setsid()
            fill(store, log)
            os._exit(0)
        until = len(read_log(log)) + moments.randrange(6)
        while len(read_log(log)) < until and os.waitpid(child, os.WNOHANG) == (0, 0):
            time.sleep(0.002)
        time.sleep(moments.uniform(0.0, 0.3))
        with suppress(ProcessLookupError, ChildProcessError):  # it had nothing left to do
            os.killpg(child, signal.SIGKILL)
            os.waitpid(child, 0)
        after = finished(store)
        assert before.items() <= after.items(), "a finished point is lost or changed"
        again = set(read_log(log)[computed:]) & set(before)
        assert not again, f"computed although finished: {again}"
        print(len(after), len(read_log(log)))
    fill(store, log)


if __name__ == "__main__":
    main(*sys.argv[1:])
