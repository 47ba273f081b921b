"""The published program's tail acts on rates and flow, and one error may be mended by itself."""

import numpy as np
import pytest

import birdmb
from birdmb.reproduction.program_tail import ProgramTail


@pytest.fixture(scope="module")
def bird(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation": 8, "tail.incidence_deg": 0.0})


def test_it_acts_on_rates_and_flow(bird):
    """Collocation reads the rates, shooting the flow; the tailless bird's are none of them."""
    model, tailless = ProgramTail(bird), birdmb.RigidModel(bird.with_values({"tail": None}))
    x, h = model.initial_guess(), 1e-5
    ahead = model.flow(x, 0.01, 0.01 + h)
    np.testing.assert_allclose((ahead - x) / h, model.rhs(0.01 + h / 2, x), rtol=1e-2, atol=1e-2)
    assert np.abs(model.rhs(0.01, x) - tailless.rhs(0.01, x)).max() > 1.0
    times = np.array([0.01])
    (slopes,) = model.rate_jacobians(times, x[None])
    step = np.array([1e-3, 0.0, 0.0, 0.0])
    change = model.rhs(0.01, x + step) - model.rhs(0.01, x - step)
    np.testing.assert_allclose(slopes[:, 0], change / 2e-3, rtol=1e-5, atol=1e-6)


def test_without_its_errors_it_is_the_tail_of_the_package(bird):
    mended = ProgramTail(bird, wrong_rate=False, wrong_wake=False)
    own = birdmb.RigidModel(bird)
    x = own.initial_guess() + np.array([0.0, 0.3, 0.2, 0.05])
    np.testing.assert_allclose(mended.rhs(0.03, x), own.rhs(0.03, x), rtol=1e-12, atol=1e-12)
    for options in ({"wrong_rate": False}, {"wrong_wake": False}):
        assert np.abs(ProgramTail(bird, **options).rhs(0.03, x) - own.rhs(0.03, x)).max() > 1e-3


def test_it_keeps_its_tail_and_its_errors_when_it_is_altered(bird):
    model = ProgramTail(bird, wrong_rate=False).with_steps(30)
    assert (model.bird, model.steps_per_beat) == (bird, 30)
    x = model.initial_guess() + np.array([0.0, 0.0, 0.5, 0.0])
    expected = ProgramTail(bird, wrong_rate=False).rhs(0.0, x)
    np.testing.assert_array_equal(model.rhs(0.0, x), expected)
