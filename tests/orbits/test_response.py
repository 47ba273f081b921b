import numpy as np
import pytest
from orbit_systems import ForcedLinear, mathieu, roessler, van_der_pol

from birdmb.orbits import (
    ArgumentError,
    OdeModel,
    find_limit_cycle,
    floquet,
    largest_lyapunov_exponent,
    mode_disturbance,
    perturbed_response,
)


@pytest.mark.parametrize("method", ["variational", "neighbours"])
def test_lyapunov_exponent_of_a_periodic_solution(method):
    # on the zero solution the exponent is the largest Floquet exponent, ln(2.14655649)/pi
    estimate = largest_lyapunov_exponent(
        mathieu(1, 0.5), [0.0, 0.0], np.pi, 20, transient=15, method=method
    )
    assert estimate.exponent == pytest.approx(np.log(2.14655649) / np.pi, abs=1e-7)
    # The bar of neighbours holds what a flow good to 1e-10 leaves of a separation of 1e-6.
    assert estimate.error < {"variational": 1e-7, "neighbours": 1e-4}[method]
    assert estimate.running[-1] == estimate.exponent
    assert estimate.times[-1] == pytest.approx(35 * np.pi)


def test_lyapunov_exponent_of_a_stable_cycle_is_zero():
    estimate = largest_lyapunov_exponent(
        van_der_pol(1, rtol=1e-9, atol=1e-9), [2, 0], 6.6632869, 20
    )
    assert abs(estimate.exponent) < 1e-6


@pytest.mark.long
@pytest.mark.parametrize("method", ["variational", "neighbours"])
def test_lyapunov_exponent_of_chaos(method):
    # Roessler's standard parameters; 0.0714 in the literature (Sprott 2003)
    model = roessler(5.7, a=0.2, rtol=1e-9, atol=1e-9)
    estimate = largest_lyapunov_exponent(model, [1, 1, 0], 6.0, 300, method=method, separation=1e-4)
    assert estimate.exponent == pytest.approx(0.0714, abs=4 * estimate.error)
    # The scatter of 300 intervals, and what the accuracy of the flow leaves of neighbours.
    assert estimate.error < 0.02


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"interval": -1.0}, "interval must be positive"),
        ({"interval": 1.0, "method": "guess"}, "neighbours"),
        ({"interval": 1.0, "method": "variational"}, "flow_jacobian"),
    ],
)
def test_lyapunov_arguments(options, words):
    with pytest.raises(ArgumentError, match=words):
        largest_lyapunov_exponent(ForcedLinear(), [0, 0, 0], **options)


def test_response_along_a_mode_follows_its_multiplier():
    cycle = find_limit_cycle(van_der_pol(0.3), period_guess=6.3)
    amplitude = 1e-5
    shift = mode_disturbance(cycle, 1, amplitude)
    assert np.abs(shift / cycle.state_scale).max() == pytest.approx(amplitude)
    response = perturbed_response(cycle, shift, periods=3, samples=10)
    assert response.deviation[10] == pytest.approx(
        cycle.multipliers[1].real * shift, abs=1e-3 * amplitude
    )
    assert response.deviation[::10] == pytest.approx(response.linear, abs=1e-3 * amplitude)
    assert response.failure is None
    assert response.to_xarray()["states"].sizes == {"time": 31, "state": 2}
    assert len(response.plot().axes) == 2


def test_phase_turns_a_complex_mode():
    orbit = floquet(mathieu(3, 2), [0, 0])
    ahead = mode_disturbance(orbit, 0, 1.0, phase=np.pi / 2)
    assert ahead == pytest.approx(-orbit.modes[:, 0].imag)


def test_a_runaway_keeps_what_was_reached():
    model = OdeModel(lambda _t, x: x * (x - 1), ("x",), period=1.0)
    response = perturbed_response(floquet(model, [1.0]), [0.1], periods=5)
    assert "failed after" in response.failure
    assert response.times[-1] == pytest.approx(2.0)
    assert response.states[-1, 0] > 2


def test_response_arguments():
    orbit = floquet(mathieu(1, 0.5), [0, 0])
    with pytest.raises(ArgumentError, match="shape"):
        perturbed_response(orbit, [1.0])
    with pytest.raises(ArgumentError, match="from 0 to 1"):
        mode_disturbance(orbit, 2, 0.1)
    with pytest.raises(ArgumentError, match="at least 1"):
        perturbed_response(orbit, [0.1, 0.0], periods=0)


@pytest.mark.parametrize("method", ["variational", "neighbours"])
@pytest.mark.parametrize("rate", [-5.0, 4.0])
def test_lyapunov_exponent_over_intervals_that_the_flow_does_not_resolve(method, rate):
    # exp(-25) is below the accuracy of the flow, exp(20) far above what a neighbour bears
    model = OdeModel(lambda _t, x: rate * x, ("x",), jacobian=lambda _t, _x: [[rate]], rtol=1e-9)
    estimate = largest_lyapunov_exponent(model, [0.0], 5.0, 10, transient=0, method=method)
    assert abs(estimate.exponent - rate) < max(estimate.error, 1e-8 * abs(rate))
    assert estimate.error < 0.05 * abs(rate)
