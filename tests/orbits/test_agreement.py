"""Variational equations that are not the derivative of the flow are noticed."""

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq

from birdmb.errors import StateError
from birdmb.orbits import ConvergenceError, OdeModel, find_limit_cycle, floquet

FRICTION = np.array([[0, 1], [-1, 2 * 0.484]])
PERIOD = 2 * np.pi / 1.6
START = [-0.5135165, 0.26518485]


def friction():
    """Oscillator with negative damping and dry friction: sgn(v) jumps where v changes sign."""

    def rhs(t, x):
        return FRICTION @ x + [0.0, 1.2 * np.cos(1.6 * t) - np.sign(x[1])]

    return OdeModel(rhs, ("x", "v"), period=PERIOD, rtol=1e-8)


def saltation_monodromy(x0):
    """Monodromy of `friction` in closed form: linear between the jumps, saltation at each."""
    x, t, monodromy = np.array(x0), 0.0, np.eye(2)
    # the forced motion of the smooth part: Re(c exp(1.6 i t))
    c = np.linalg.solve(1.6j * np.eye(2) - FRICTION, [0, 1.2])
    while t < PERIOD:
        sign = np.sign(x[1])
        rest = np.array([-sign, 0.0])

        def at(s, x=x, t=t, rest=rest):
            forced = (np.outer(np.exp(1.6j * np.array([t, s])), c)).real
            return forced[1] + rest + scipy.linalg.expm(FRICTION * (s - t)) @ (x - forced[0] - rest)

        grid = np.linspace(t, PERIOD, 200)[1:]
        after = next((s for s in grid if at(s)[1] * sign < 0), None)
        end = PERIOD if after is None else brentq(lambda s: at(s)[1], after - PERIOD / 199, after)
        monodromy = scipy.linalg.expm(FRICTION * (end - t)) @ monodromy
        x, t = at(end), end
        if after is not None:
            rate = -x[0] + 1.2 * np.cos(1.6 * t)
            monodromy = np.diag([1.0, (rate + sign) / (rate - sign)]) @ monodromy
            x[1] = -sign * 1e-15
    return monodromy


def test_dry_friction_is_unstable():
    found = floquet(friction(), START, closure_tolerance=1e-5)
    exact = np.linalg.eigvals(saltation_monodromy(START))
    assert np.abs(exact) == pytest.approx([1.525, 1.525], abs=1e-3)
    errors = np.abs(np.sort_complex(found.multipliers) - np.sort_complex(exact))
    assert (errors < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 0.01
    assert found.stability == "unstable"
    assert found.jacobian_method == "finite-differences"
    assert "contradict differences" in str(found)


def test_the_gap_goes_into_the_bars_of_the_variational_equations():
    found = floquet(friction(), START, closure_tolerance=1e-5, jacobian="variational")
    exact = np.linalg.eigvals(saltation_monodromy(START))
    assert (
        np.abs(np.sort_complex(found.multipliers) - np.sort_complex(exact))
        < found.multiplier_errors
    ).all()
    assert found.stability == "undecided"


def right(_t, x):
    return np.array([[0, 1], [-2 * x[0] * x[1] - 1, 1 - x[0] ** 2]])


def van_der_pol(jacobian):
    return OdeModel(
        lambda _t, x: [x[1], (1 - x[0] ** 2) * x[1] - x[0]],
        ("x", "v"),
        jacobian=jacobian,
        guess=[2.0, 0.1],
    )


WRONG = {
    "sign": lambda t, x: right(t, x) * [[1, 1], [-1, 1]],
    "transposed": lambda t, x: right(t, x).T,
    "a hundred-thousandth": lambda t, x: right(t, x) * [[1, 1], [1, 1.00001]],
}


@pytest.mark.parametrize(("method", "bar"), [("collocation", 1e-8), ("shooting", 1e-9)])
def test_a_right_jacobian_agrees(method, bar):
    found = find_limit_cycle(van_der_pol(right), period_guess=6.6, method=method)
    assert found.jacobian_method == "variational"
    assert found.jacobian_gap == 0
    assert found.remarks == ()
    assert found.multiplier_errors.max() < bar


@pytest.mark.parametrize("kind", WRONG)
def test_a_wrong_jacobian_is_noticed(kind):
    model = van_der_pol(WRONG[kind])
    found = find_limit_cycle(model, period_guess=6.6)
    assert found.jacobian_gap > 0
    assert (np.abs(found.multipliers - [1, 8.596950636e-4]) < found.multiplier_errors).all()
    insisted = floquet(model, found.x0, found.period, jacobian="variational")
    errors = np.abs(insisted.multipliers - found.multipliers)
    assert (errors < insisted.multiplier_errors).all()


def test_a_search_that_a_wrong_jacobian_misleads_says_so():
    with pytest.raises(ConvergenceError, match="a Jacobian given to the model is wrong"):
        find_limit_cycle(van_der_pol(WRONG["transposed"]), period_guess=6.6, jacobian="variational")


class Bounce:
    """Map of a ball at the moment of impact, whose Jacobian leaves the impact out."""

    state_names = ("x",)
    period = 1.0
    state_scale = np.ones(1)

    def flow(self, x0, _t0, _t1):
        if x0[0] < 0:
            raise StateError("below the floor.")
        return np.abs(x0 - 1.0) * np.where(x0 > 1.0, 0.5, 2.0) + 1.0

    def flow_jacobian(self, x0, t0, t1):
        return self.flow(x0, t0, t1), np.array([[0.5]])


def test_a_kink_exactly_at_the_start():
    found = floquet(Bounce(), [1.0], jacobian="variational")
    # one-sided slopes 0.5 and -2
    assert found.multiplier_errors[0] >= 2.5 * (1 - 1e-6)
    assert found.stability == "undecided"
