"""Disturbed flight: what the multipliers say for small disturbances, and where the body goes."""

import numpy as np
import pytest

import birdmb
from birdmb.figures import plot_perturbed_flight
from birdmb.studies import flight_path, perturbed_flight


@pytest.fixture(scope="module")
def shot_cycle(coarse, quick):
    """The orbit of the very steps that disturbed flights are integrated with."""
    return birdmb.find_limit_cycle(quick(coarse), method="shooting")


def at_beats(data, cycle):
    """Deviations (mode, beat, state) in units of the state scale."""
    return data.deviation.values[:, :: data.sizes["time"] // 5] / cycle.state_scale


def test_unstable_disturbance_grows_by_its_multiplier_each_beat(shot_cycle):
    sizes = np.linalg.norm(
        at_beats(perturbed_flight(shot_cycle, amplitude=1e-4), shot_cycle)[0], axis=1
    )
    np.testing.assert_allclose(sizes[1:] / sizes[:-1], shot_cycle.multipliers[0].real, rtol=1e-3)


def test_error_of_the_linear_prediction_is_of_second_order(shot_cycle):
    errors = []
    for amplitude in (4e-3, 2e-3, 1e-3):
        data = perturbed_flight(shot_cycle, amplitude=amplitude)
        linear = data.linear.values / shot_cycle.state_scale
        errors.append(np.abs(at_beats(data, shot_cycle) - linear).max(axis=(1, 2)))
    order = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    np.testing.assert_allclose(order, 2.0, atol=0.1)


def test_one_disturbance_for_each_mode_and_pair(coarse_cycle):
    data = perturbed_flight(coarse_cycle, periods=2)
    imag = data.multiplier_imag.values
    assert data.sizes["mode"] == 3
    assert sorted(imag > 0) == [False, False, True]
    assert (data.failure == "").all()


def test_paths_start_together_and_the_cycle_travels_at_its_mean_speed(coarse_cycle):
    data = perturbed_flight(coarse_cycle, periods=3)
    assert (data.X[:, 0] == 0).all()
    assert (data.h[:, 0] == 0).all()
    way = coarse_cycle.mean_velocity * 3 * coarse_cycle.period
    assert [data.orbit_X[-1], data.orbit_h[-1]] == pytest.approx(way, abs=1e-4)


def test_path_of_a_circle():
    """At a steady pitch rate with the wind along the body's axis."""
    t = np.linspace(0.0, 2.0, 201)
    still = np.zeros_like(t)
    states = np.column_stack([3.0 + still, still, 0.5 + still, 0.5 * t])
    expected = 6.0 * np.column_stack([np.sin(0.5 * t), 1 - np.cos(0.5 * t)])
    np.testing.assert_allclose(flight_path(t, states), expected, atol=1e-8)
    np.testing.assert_array_equal(flight_path(t[:1], states[:1]), [[0.0, 0.0]])


def test_positive_w_sinks():
    t = np.linspace(0.0, 1.0, 5)
    states = np.tile([0.0, 2.0, 0.0, 0.0], (5, 1))
    np.testing.assert_allclose(flight_path(t, states)[-1], [0.0, -2.0], atol=1e-12)


def test_flight_that_cannot_go_on_is_kept_as_far_as_it_got(coarse_cycle):
    data = perturbed_flight(coarse_cycle, amplitude=1e6, periods=2)
    failed = data.failure.values != ""
    assert failed.any()
    assert np.isnan(data.states.values[failed][:, -1]).all()
    assert np.isfinite(data.states.values[:, 0]).all()


def test_figure_shows_every_mode_beside_the_cycle(coarse_cycle):
    figure = plot_perturbed_flight(perturbed_flight(coarse_cycle, periods=2))
    *states, path = figure.axes
    assert [len(axes.lines) for axes in states] == [4, 4, 4, 4]
    assert len(path.get_legend().get_texts()) == 4
