"""The opening of the tail from which level flight is stable, in both kinds of air."""

from functools import partial

import numpy as np
from matplotlib.figure import Figure
from report import FEW, Report, largest
from scipy.optimize import brentq

import birdmb
from birdmb.studies.trim import TrimGuess

AMPLITUDES = (32.0, 36.0, 40.0, 42.0)  # deg
ROLL = {"forearm.roll.offset_deg": (-30.0, 30.0)}
OPENINGS = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0)  # of the tail, deg


def openings(report: Report) -> None:
    """The opening of the tail at which level flight becomes stable, over the flap's amplitude."""
    rows, found = [], []
    for amplitude in AMPLITUDES[-1:] if report.coarse else AMPLITUDES:
        values = {} if report.coarse else FEW
        bird = report.bird("ibis_tail", shoulder__flap__amplitude_deg=amplitude, **values)
        pair = [
            stable_opening(bird.with_values({"air.wake": wake}))
            for wake in ("quasi-steady", "unsteady")
        ]
        rows.append([f"{amplitude:g}", *(f"{opening:.2f}" for opening in pair)])
        found.append(pair)
    columns = ("flap amplitude, deg", "quasi-steady", "unsteady")
    report.table("openings", "Stable from this opening of the tail on, deg", columns, rows)
    figure = Figure(figsize=(5, 3.6), layout="constrained")
    axes = figure.subplots()
    amplitudes = AMPLITUDES[-len(found) :]
    axes.plot(amplitudes, np.array(found)[:, 0], "o-", mfc="none", label="quasi-steady")
    axes.plot(amplitudes, np.array(found)[:, 1], "D--", ms=4, label="with memory")
    axes.set(xlabel="amplitude of the flap (°)", ylabel="opening of the tail (°)")
    axes.set_title("Level flight is stable above the lines", fontsize=10)
    axes.legend(frameon=False)
    report.picture("openings", figure)


def stable_opening(bird: birdmb.Bird) -> float:
    """Opening (deg) of the tail from which level flight is stable; NaN if none is met."""
    before = None
    for opening in OPENINGS:
        try:
            after = growth_when_level(bird, opening)
            if before is not None and before > 0.0 > after:
                growth = partial(growth_when_level, bird)
                return float(brentq(growth, opening - OPENINGS[0], opening, xtol=1e-3))
            before = after
        except birdmb.BirdmbError:
            before = None
    return np.nan


def growth_when_level(bird: birdmb.Bird, opening: float) -> float:
    """ln |Λ|max of level flight with the tail open so far (deg)."""
    spread = bird.with_values({"tail.opening_deg": opening})
    # With a guess the trim does without its slow ways where there is no level flight.
    guess = TrimGuess({name: bird.value(name) for name in ROLL})
    trim = birdmb.trim_flight(spread, ROLL, tolerance=1e-6, guess=guess)
    return float(np.log(largest(trim.cycle.multipliers)))
