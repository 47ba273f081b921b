"""Trims that are known, that must hold both targets, and that do not exist."""

import json
import pickle
from functools import partial

import numpy as np
import pytest

import birdmb
from birdmb.errors import ArgumentError
from birdmb.studies import TrimError, trim_flight
from birdmb.studies.trim import TrimGuess
from tests.conftest import REFERENCE

AMPLITUDE, SHOULDER = "shoulder.flap.amplitude_deg", "wing.root.x"


def test_level_flight_of_the_reference_program(ibis_published):
    """Flap amplitude 43.3219 deg by the reference program; the thesis prints 43.47."""
    level = json.loads((REFERENCE / "limit_cycles.json").read_text())["level"]
    model = partial(birdmb.RigidModel, steps_per_beat=level["n_rk4"])
    trim = trim_flight(ibis_published, {AMPLITUDE: (40.0, 46.0)}, model=model)
    assert trim.values[AMPLITUDE] == pytest.approx(level["A_deg"], abs=1e-3)
    assert trim.cycle.mean_velocity == pytest.approx([level["mean_U"], 0.0], abs=1e-4)
    assert trim.values[AMPLITUDE] == pytest.approx(43.47, abs=0.3)


def test_result_is_the_cycle_of_the_bird_it_names(coarse, quick):
    trim = trim_flight(coarse, {AMPLITUDE: (30.0, 60.0)}, climb_rate=0.3, model=quick)
    again = birdmb.find_limit_cycle(quick(trim.bird))
    assert trim.bird.value(AMPLITUDE) == pytest.approx(trim.values[AMPLITUDE], rel=1e-14)
    assert trim.residual <= 1e-7
    assert again.mean_climb_rate == pytest.approx(0.3, abs=2e-7)
    assert trim.cycle.mean_climb_rate == pytest.approx(0.3, abs=2e-7)
    assert trim.cycles < 12


def test_where_the_climb_rate_turns_there_are_two_trims(coarse, quick):
    """Over these margins the climb rate rises, turns and falls: the one nearer to the start."""
    shoulder = {SHOULDER: (0.033, 0.06)}
    trim = trim_flight(coarse, shoulder, climb_rate=1.6, model=quick)
    assert trim.cycle.mean_climb_rate == pytest.approx(1.6, abs=1e-6)
    assert trim.bird.value(SHOULDER) > 0.036


@pytest.mark.parametrize("second", [SHOULDER, "gait.frequency", "forearm.roll.offset_deg"])
def test_two_parameters_meet_climb_rate_and_speed(coarse, quick, second):
    bounds = {SHOULDER: (0.04, 0.06), "gait.frequency": (3.0, 5.0)}.get(second, (-10.0, 10.0))
    trim = trim_flight(
        coarse, {AMPLITUDE: (30.0, 60.0), second: bounds}, climb_rate=0.1, speed=17.0, model=quick
    )
    assert trim.cycle.mean_climb_rate == pytest.approx(0.1, abs=1e-6)
    assert trim.cycle.mean_speed == pytest.approx(17.0, abs=1e-6)
    assert bounds[0] <= trim.values[second] <= bounds[1]


def test_no_trim_within_the_bounds_names_what_was_reached(coarse, quick):
    with pytest.raises(TrimError) as caught:
        trim_flight(coarse, {AMPLITUDE: (30.0, 40.0)}, model=quick)
    error = caught.value
    assert error.values == {AMPLITUDE: 40.0}
    assert error.reached["climb_rate"] < 0
    assert (
        "no trim to climb rate 0 m/s was found for shoulder.flap.amplitude_deg from 30 to 40"
        in (str(error))
    )
    assert f"closest is climb rate {error.reached['climb_rate']:.4g} m/s with" in str(error)
    copy = pickle.loads(pickle.dumps(error))
    assert (str(copy), copy.values, copy.reached) == (str(error), error.values, error.reached)


def test_no_trim_of_two_names_both_targets(coarse, quick):
    parameters = {AMPLITUDE: (40.0, 44.0), SHOULDER: (0.049, 0.051)}
    with pytest.raises(TrimError, match=r"climb rate 0 m/s and speed 25 m/s .* closest is climb"):
        trim_flight(coarse, parameters, speed=25.0, model=quick)


def test_parameter_without_effect_is_told(coarse, quick):
    with pytest.raises(TrimError, match="does not depend on it"):
        trim_flight(coarse, {"segments.hand.mass": (0.01, 0.02)}, model=quick)


def test_bird_that_cannot_fly_at_all(coarse, quick):
    folded = {"elbow.sweep.offset_deg": (150.0, 160.0)}
    with pytest.raises(TrimError, match=r"9 of 9 values tried|10 of 10 values tried"):
        trim_flight(coarse, folded, model=quick)


def test_arguments_are_checked(coarse):
    with pytest.raises(ArgumentError, match="as many parameters"):
        trim_flight(coarse, {AMPLITUDE: (30.0, 60.0)}, speed=17.0)
    with pytest.raises(ArgumentError, match="ascending"):
        trim_flight(coarse, {AMPLITUDE: (60.0, 30.0)})
    with pytest.raises(birdmb.TopologyError, match="nearest"):
        trim_flight(coarse, {"shoulder.flapp.amplitude_deg": (30.0, 60.0)})
    with pytest.raises(birdmb.TopologyError):
        trim_flight(coarse, {"body.mass": (-1.0, 2.0)})


@pytest.fixture(scope="module")
def near_neutral(ibis_tail):
    """A tail so far open that a multiplier is close to +1: cycles at given values fold."""
    return ibis_tail.with_values({"wing.discretisation.elements": 8, "tail.opening_deg": 18.5})


def test_trim_where_the_cycle_folds(near_neutral, quick):
    trim = birdmb.trim_flight(near_neutral, model=quick)
    assert trim.cycle.mean_climb_rate == pytest.approx(0.0, abs=1e-7)
    assert np.abs(np.abs(trim.cycle.multipliers) - 1).min() < 0.05
    assert list(trim.values) == ["forearm.roll.offset_deg"]


def test_a_guess_changes_the_way_and_not_the_end(near_neutral, quick):
    neighbour = birdmb.trim_flight(
        near_neutral.with_values({"shoulder.flap.amplitude_deg": 41.0}), model=quick
    )
    guess = TrimGuess(neighbour.values, neighbour.cycle)
    from_guess = birdmb.trim_flight(near_neutral, model=quick, guess=guess)
    alone = birdmb.trim_flight(near_neutral, model=quick)
    assert from_guess.values == pytest.approx(alone.values, abs=1e-5)
    assert (from_guess.from_guess, alone.from_guess) == (True, False)


def test_a_guess_that_leads_nowhere_is_not_named(near_neutral, quick):
    lost = TrimGuess({"forearm.roll.offset_deg": -29.0}, [2.0, 30.0, 5.0, 3.0])
    trim = birdmb.trim_flight(near_neutral, model=quick, guess=lost)
    assert not trim.from_guess
    assert trim.residual <= 1e-7


def test_without_any_flight_the_reason_is_told(near_neutral, quick):
    """From a guess there is no search over the bounds, whose failures tell otherwise."""
    weak = near_neutral.with_values({"shoulder.flap.amplitude_deg": 5.0})
    with pytest.raises(TrimError, match=r"no trim for .*; .*(creeps|No orbit found)"):
        birdmb.trim_flight(weak, model=quick, guess=TrimGuess({"forearm.roll.offset_deg": 0.0}))


def test_multibody_bird_at_a_speed(near_neutral):
    """Massive wings, both default parameters."""
    trim = birdmb.trim_flight(near_neutral, speed=14.5, model=birdmb.MultibodyModel)
    assert trim.cycle.mean_speed == pytest.approx(14.5, abs=1e-7)
    assert trim.cycle.mean_climb_rate == pytest.approx(0.0, abs=1e-7)
    assert len(trim.values) == 2
    assert trim.cycle.model.bird.total_mass == pytest.approx(1.26)


def test_a_flap_given_by_samples_is_trimmed_by_its_gain(coarse, quick):
    """The default parameters: the same flight as by the amplitude."""
    angles = coarse.joint("shoulder.flap").driver.at(np.arange(12) / 12)
    sampled = coarse.with_joint("shoulder.flap", amplitude=0.0, phase=0.0, samples=angles, gain=0.9)
    by_amplitude = trim_flight(coarse, speed=17.5, model=quick).values
    by_gain = trim_flight(sampled, speed=17.5, model=quick).values
    roll = "forearm.roll.offset_deg"
    assert by_gain[roll] == pytest.approx(by_amplitude[roll], abs=1e-4)
    assert 42.0 * by_gain["shoulder.flap.gain"] == pytest.approx(by_amplitude[AMPLITUDE], abs=1e-4)
