"""What is said of a multiplier and of a spectrum."""

from types import SimpleNamespace

import numpy as np
import pytest

from birdmb.cli.results import finite, growth, verdict_sentence
from birdmb.orbits.multipliers import verdict


def spectrum(*pairs, failed_checks=(), why_no_flight=None):
    """Something like a cycle of period 0.25 s with multipliers and their errors."""
    multipliers, errors = (np.array(part) for part in zip(*pairs, strict=True))
    with np.errstate(divide="ignore"):
        times = 0.25 * np.log(2) / np.abs(np.log(np.abs(multipliers)))
    return SimpleNamespace(
        period=0.25,
        multipliers=multipliers,
        verdict_errors=errors,
        failed_checks=failed_checks,
        why_no_flight=why_no_flight,
        mean_speed=17.96,
        mean_climb_rate=-0.06,
        doubling_times=times,
        stability=verdict(multipliers, errors),
    )


@pytest.mark.parametrize(
    ("multiplier", "error", "says"),
    [
        (2.0, 1e-9, "doubles in 0.25 s (1 beats)"),
        (-0.5, 1e-9, "halves in 0.25 s (1 beats)"),
        (0.6 + 0.8j, 1e-9, "undecided within its error"),
        (0.999, 0.01, "undecided within its error"),
        (1e-11, 0.125, "halves in < 0.083 s (0.33 beats)"),
    ],
)
def test_growth(multiplier, error, says):
    assert growth(spectrum((multiplier, error)), 0) == says


def test_verdicts():
    rest = (0.5, 1e-9)
    assert verdict_sentence(spectrum((1.5, 1e-9), rest)) == (
        "unstable at 17.96 m/s, climbing -0.06 m/s: the fastest-growing disturbance doubles in "
        "0.43 s (1.7 beats)"
    )
    assert verdict_sentence(spectrum((0.9, 1e-9), rest)) == (
        "stable at 17.96 m/s, climbing -0.06 m/s: the slowest-decaying disturbance halves in 1.6 s "
        "(6.6 beats)"
    )
    assert verdict_sentence(spectrum((1.0, 1e-9), rest)).startswith("undecided at 17.96 m/s")


def test_what_speaks_against_a_flight_comes_before_its_verdict():
    found = spectrum((0.9, 1e-9), failed_checks=("the energy is off",), why_no_flight="it falls")
    assert verdict_sentence(found).startswith(
        "not to be trusted: the energy is off; not a flight: it falls; stable at 17.96 m/s"
    )


def test_json_has_no_infinity():
    assert [finite(value) for value in (1.5, np.inf, np.nan)] == [1.5, None, None]
