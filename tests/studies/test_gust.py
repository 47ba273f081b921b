"""Flight through gusts: against exact cases, and the linear response against the full one."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import birdmb
from birdmb.figures import plot_gust_states
from birdmb.models import CosineGust, GaussianGust, StepGust


@pytest.fixture(scope="module")
def cycles(ibis_tail):
    """Of the rigid bird and of one with a sprung shoulder, coarse."""
    coarse = ibis_tail.with_values({"wing.discretisation.elements": 8})
    sprung = coarse.with_joint("shoulder.flap", stiffness=20.0, damping=0.2)
    models = {
        "rigid": birdmb.RigidModel(coarse, steps_per_beat=60),
        "multibody": birdmb.MultibodyModel(sprung),
    }
    return {name: birdmb.find_limit_cycle(model) for name, model in models.items()}


def test_gusts_have_the_shapes_they_are_named_after():
    gauss = GaussianGust(vertical=2.0)
    assert gauss(0.25) == pytest.approx((0.0, 2.0, 0.0))
    assert gauss(0.30)[1] == pytest.approx(2.0 * np.exp(-0.5))
    cosine = CosineGust(horizontal=1.0, start=0.1, duration=0.4)
    assert [cosine(t)[0] for t in (0.0, 0.1, 0.2, 0.3, 0.5, 0.6)] == pytest.approx(
        [0, 0, 0.5, 1, 0, 0], abs=1e-15
    )
    step = StepGust(vertical=-1.0, start=0.1)
    assert (step(0.0999)[1], step(0.1)[1]) == (0.0, -1.0)


@pytest.mark.long
@pytest.mark.parametrize("name", ["rigid", "multibody"])
@pytest.mark.parametrize("gust", [GaussianGust, CosineGust, StepGust])
def test_linear_response_is_the_full_one_to_second_order(cycles, name, gust):
    cycle = cycles[name]
    apart = []
    for strength in (0.2, 0.1, 0.05):
        flight = birdmb.gust_response(cycle, gust(vertical=strength), periods=2, samples=20)
        apart.append(float(np.abs((flight.deviation - flight.linear) / cycle.state_scale).max()))
    assert apart[0] / apart[1] == pytest.approx(4, rel=0.1)
    assert apart[1] / apart[2] == pytest.approx(4, rel=0.1)


@pytest.mark.parametrize("name", ["rigid", "multibody"])
def test_the_modes_make_up_the_linear_response(cycles, name):
    cycle = cycles[name]
    flight = birdmb.gust_response(cycle, GaussianGust(vertical=1.0, time=0.1), periods=3)
    total = flight.mode_deviation.sum("mode")
    np.testing.assert_allclose(total, flight.linear, atol=1e-9)
    slowest = complex(flight.multiplier_real[0], flight.multiplier_imag[0])
    assert slowest == pytest.approx(cycle.multipliers[0], abs=1e-5)


def test_modes_are_free_after_the_gust(cycles):
    """With the gust over within the first beat, mode by mode as the multipliers say."""
    cycle = cycles["multibody"]
    gust = CosineGust(vertical=1.0, start=0.0, duration=0.2)
    flight = birdmb.gust_response(cycle, gust, periods=3, samples=30)
    for i in range(flight.sizes["mode"]):
        one = flight.isel(mode=i)
        multiplier = complex(one.multiplier_real, one.multiplier_imag)
        if abs(multiplier) < 1e-3:
            continue  # gone within the beat
        x1, x2, x3 = (one.mode_deviation.values[k * 30] for k in (1, 2, 3))
        predicted = 2 * multiplier.real * x2 - abs(multiplier) ** 2 * x1
        if multiplier.imag == 0:
            predicted = multiplier.real * x2
        np.testing.assert_allclose(x3, predicted, atol=1e-6 * np.abs(x1).max())


@pytest.mark.parametrize("name", ["rigid", "multibody"])
def test_a_steady_wind_carries_the_flight_along(cycles, name):
    """Galileo: in air that moves steadily the same flight goes on, seen from the air."""
    cycle = cycles[name]
    wind = cycle.model.in_gust(StepGust(horizontal=2.0, vertical=0.5, start=-1e9))
    theta = cycle.x0[3]
    c, s = np.cos(theta), np.sin(theta)
    carried = cycle.x0.copy()
    carried[:2] += [2.0 * c + 0.5 * s, 2.0 * s - 0.5 * c]
    end = wind.flow(carried, 0.0, cycle.period)
    expected = cycle.x0.copy()
    expected[:2] = carried[:2]
    np.testing.assert_allclose(end, expected, atol=2e-6)
    assert wind.loads(0.0, carried).force == pytest.approx(cycle.model.loads(0.0, cycle.x0).force)


def test_the_jacobian_of_a_flow_in_a_gust(cycles):
    """Against central differences."""
    cycle = cycles["rigid"]
    model = cycle.model.in_gust(GaussianGust(vertical=2.0, horizontal=1.0, time=0.1))
    _, exact = model.flow_jacobian(cycle.x0, 0.0, 0.25)
    steps = 1e-5 * np.diag(cycle.state_scale)
    columns = [
        (model.flow(cycle.x0 + h, 0.0, 0.25) - model.flow(cycle.x0 - h, 0.0, 0.25)) / (2 * h.sum())
        for h in steps
    ]
    np.testing.assert_allclose(exact, np.column_stack(columns), atol=1e-7)


def test_a_flight_that_fails_keeps_what_it_reached(cycles):
    flight = birdmb.gust_response(cycles["rigid"], GaussianGust(vertical=1e6), periods=2)
    assert flight.attrs["failure"]
    assert np.isfinite(flight.states[0]).all()
    assert np.isnan(flight.states[-1]).all()
    assert np.isfinite(flight.linear).all()


def test_a_side_gust_rolls_and_turns_a_bird_in_space(ibis_tail):
    coarse = ibis_tail.with_values({"wing.discretisation.elements": 8})
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(coarse, motion="free"))
    apart = []
    for strength in (0.4, 0.2, 0.1):
        gust = CosineGust(lateral=strength)
        flight = birdmb.gust_response(cycle, gust, periods=2, samples=20)
        apart.append(float(np.abs((flight.deviation - flight.linear) / cycle.state_scale).max()))
    assert apart[0] / apart[1] == pytest.approx(4, rel=0.1)
    assert apart[1] / apart[2] == pytest.approx(4, rel=0.1)
    lateral = flight.linear.sel(state=["v", "p", "r", "phi"])
    assert np.abs(lateral).max() > 1e3 * np.abs(flight.linear.sel(state=["u", "w", "q"])).max()
    # Coming from the left, it turns the bird's nose to the left, into the wind.
    assert flight.linear.sel(state="r").sum() < 0
    mirrored = birdmb.gust_response(cycle, CosineGust(lateral=-0.1), periods=2, samples=20)
    np.testing.assert_allclose(mirrored.Y, -flight.Y, atol=1e-12)
    planar = birdmb.find_limit_cycle(birdmb.RigidModel(coarse))
    with pytest.raises(birdmb.BirdmbError, match='motion="free"'):
        birdmb.gust_response(planar, gust)


def test_a_gust_along_the_body_is_a_velocity_added_to_the_bodys(cycles):
    """Against an integration in which the loads are those of the velocity relative to the air."""
    cycle, gust = cycles["rigid"], GaussianGust(vertical=1.0, horizontal=0.5, time=0.1)
    flight = birdmb.gust_response(cycle, gust, axes="body", periods=3)

    def rates(t, x):
        forward, up, _ = gust(t)
        found = cycle.model.rhs(t, x - [forward, -up, 0.0, 0.0])
        # These rates have -q w and q u of the relative velocity.
        return found + x[2] * np.array([up, forward, 0.0, 0.0])

    times = flight.time.values
    exact = solve_ivp(rates, times[[0, -1]], cycle.x0, t_eval=times, rtol=1e-9, atol=1e-10).y.T
    np.testing.assert_allclose(flight.states, exact, atol=2e-6)
    in_world = birdmb.gust_response(cycle, gust, periods=3)
    assert np.abs(in_world.states - flight.states).max() > 1e-3


@pytest.mark.parametrize("name", ["rigid", "multibody"])
def test_linear_response_to_a_gust_along_the_body_is_of_first_order(cycles, name):
    cycle, apart = cycles[name], []
    for strength in (0.4, 0.2):
        gust = GaussianGust(vertical=strength, time=0.1)
        flight = birdmb.gust_response(cycle, gust, axes="body", periods=1)
        apart.append(float(np.abs((flight.deviation - flight.linear) / cycle.state_scale).max()))
    assert apart[0] / apart[1] == pytest.approx(4, rel=0.1)


def test_impossible_requests(cycles):
    with pytest.raises(ValueError, match="axes"):
        birdmb.gust_response(cycles["rigid"], StepGust(), axes="wind")
    with pytest.raises(ValueError, match="at least 1"):
        birdmb.gust_response(cycles["rigid"], StepGust(), periods=0)
    with pytest.raises(ValueError, match="two or three velocities"):
        birdmb.gust_response(cycles["rigid"], lambda _t: 1.0)


def test_figure(cycles):
    flight = birdmb.gust_response(cycles["rigid"], GaussianGust(vertical=1.0), periods=2)
    figure = birdmb.plot_gust_response(flight)
    assert len(figure.axes) == 6
    states = plot_gust_states(flight)
    assert len(states.axes) == 4
    # The undisturbed flight's mean over a beat is the same at all times.
    mean = states.axes[0].lines[1].get_ydata()
    np.testing.assert_allclose(mean, flight.orbit.sel(state="u").values[:60].mean(), atol=1e-6)
