"""Rates of the multibody bird at many instants in one call."""

import numpy as np
import pytest

import birdmb

PLIANT = {"stiffness": 20.0, "damping": 0.2}
STATE = (18.0, -2.0, 0.3, -0.1)


def coarse(bird):
    return bird.with_values({"wing.discretisation.elements": 4})


def sprung(bird, *joints):
    for joint in joints:
        bird = bird.with_joint(joint, **PLIANT)
    return bird


@pytest.mark.parametrize("joints", [(), ("shoulder.flap",), ("shoulder.flap", "wrist.sweep")])
def test_rates_are_what_the_equations_of_motion_say(ibis, joints):
    """The accelerations come from the whole tree, solved on its own in double precision."""
    model = birdmb.MultibodyModel(sprung(coarse(ibis), *joints))
    times = np.array([0.0, 0.07, 0.07, 0.2])
    rng = np.random.default_rng(1)
    driven = np.array([model.driven_state(t) for t in times])
    states = driven + 0.1 * model.state_scale * rng.standard_normal(driven.shape)
    rates = model.rates(times, states)
    for t, x, found in zip(times, states, rates, strict=True):
        a, _ = model.accelerations(t, x)
        u, w, q, theta = x[:4]
        c, s = np.cos(theta), np.sin(theta)
        body = [a[0] * c - a[1] * s - q * w, a[0] * s + a[1] * c + q * u, a[2], q]
        assert found[:4] == pytest.approx(body, rel=1e-9, abs=1e-9)
        assert found[4::2] == pytest.approx(x[5::2])
        places = [3 + model.bird.angle_names.index(joint) for joint in joints]
        assert found[5::2] == pytest.approx(a[places], rel=1e-9, abs=1e-9)
        assert model.rhs(t, x) == pytest.approx(found, rel=1e-13)


def test_states_that_are_not_finite_have_no_rates(ibis):
    model = birdmb.MultibodyModel(coarse(ibis))
    states = np.array([STATE, (np.nan, *STATE[1:])])
    rates = model.rates(np.array([0.0, 0.1]), states)
    assert np.isfinite(rates[0]).all()
    assert np.isnan(rates[1]).all()
