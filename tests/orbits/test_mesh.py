"""Collocation on an adaptive mesh: orbits with jumps, kinks and fast phases."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.sparse.linalg import splu

from birdmb import OdeModel, find_limit_cycle
from birdmb.errors import OrbitError
from birdmb.orbits.piecewise import GAUSS as PLACES
from birdmb.orbits.piecewise import PiecewiseEquations, PiecewisePath, split, uniform
from birdmb.orbits.right_hand_side import RightHandSide

FREQUENCY, DAMPING = 2.0, 0.1
MATRIX = np.array([[0.0, 1.0], [-(FREQUENCY**2), -2 * DAMPING * FREQUENCY]])


def struck(switch=0.5):
    """An oscillator that a square wave drives."""
    return OdeModel(
        lambda t, x: MATRIX @ x + [0.0, 1.0 if t % 1.0 < switch else -1.0],
        ("x", "v"),
        period=1.0,
        jacobian=lambda _t, _x: MATRIX,
    )


def struck_start(switch):
    """State at t = 0 of its orbit: two matrix exponentials."""
    rest = np.array([1.0 / FREQUENCY**2, 0.0])
    first, second = expm(MATRIX * switch), expm(MATRIX * (1.0 - switch))
    through = (np.eye(2) - first) @ rest
    right = second @ through - (np.eye(2) - second) @ rest
    return np.linalg.solve(np.eye(2) - second @ first, right)


@pytest.mark.parametrize("switch", [0.5, 1 / np.pi])
def test_a_square_wave_is_met_wherever_it_switches(switch):
    cycle = find_limit_cycle(struck(switch), [0.0, 0.0], method="collocation", accuracy=1e-8)
    assert cycle.method == "collocation"
    assert cycle.intervals is not None
    assert cycle.nodes == 4 * cycle.intervals
    assert cycle.method_reason.startswith("a mesh was taken: The orbit is too rough")
    error = np.abs((cycle.x0 - struck_start(switch)) / cycle.state_scale).max()
    assert error <= cycle.state_error <= 1e-8
    assert np.prod(cycle.multipliers).real == pytest.approx(np.exp(np.trace(MATRIX)), rel=1e-10)
    path = cycle.trajectory(np.array([switch, 1.0 + switch])).states
    rest = np.array([1.0 / FREQUENCY**2, 0.0])
    there = rest + expm(MATRIX * switch) @ (struck_start(switch) - rest)
    np.testing.assert_allclose(path, [there, there], atol=1e-8)


def van_der_pol(mu):
    return OdeModel(
        lambda _t, x: [x[1], mu * (1 - x[0] ** 2) * x[1] - x[0]],
        ("x", "v"),
        jacobian=lambda _t, x: [[0.0, 1.0], [-2 * mu * x[0] * x[1] - 1, mu * (1 - x[0] ** 2)]],
    )


@pytest.mark.parametrize(
    ("mu", "guess", "period"),
    # By Radau's method at tolerances of 1e-10 over several periods (scipy).
    [(10.0, 19.0, 19.07836957), (30.0, 50.5, 50.54368648)],
)
def test_relaxation_oscillations(mu, guess, period):
    cycle = find_limit_cycle(van_der_pol(mu), [2.0, 0.0], period_guess=guess, method="collocation")
    assert cycle.intervals is not None
    assert cycle.period == pytest.approx(period, abs=2e-8)
    assert cycle.multipliers[cycle.trivial_index] == pytest.approx(1.0, abs=1e-7)
    # The other one is below 1e-130: too small to tell, and said so.
    other = 1 - cycle.trivial_index
    assert abs(cycle.multipliers[other]) <= cycle.multiplier_errors[other] < 1e-50
    assert cycle.stability == "stable"
    # Intervals crowd where it leaps.
    widths = np.diff(cycle.pieces.mesh)
    assert widths.max() > 100 * widths.min()


def test_a_mesh_finds_the_smooth_orbit_too_at_high_order():
    """At the mesh's points the error falls with the width to the power of 2 M = 8."""
    model = OdeModel(lambda t, x: [-(x[0] ** 3) + np.cos(2 * np.pi * t)], ("x",), period=1.0)
    exact = find_limit_cycle(model, [0.1], accuracy=1e-10)
    rhs = RightHandSide(model, np.ones(1))
    errors = []
    for count in (2, 4):
        equations = PiecewiseEquations(rhs, 0.0, 1.0, False, uniform(count))
        u = np.zeros(equations.intervals * 5)
        for _ in range(12):
            u = u - splu(equations.jacobian(u)).solve(equations.residual(u))
        errors.append(abs(u[0] - exact.x0[0]))
    assert errors[1] < errors[0] / 2**6.5


def test_the_jacobian_is_that_of_the_residual():
    model = van_der_pol(2.0)
    rhs = RightHandSide(model, np.array([2.0, 3.0]))
    mesh = split(uniform(3), np.array([1, 3, 2]))
    equations = PiecewiseEquations(rhs, 0.0, 7.0, True, mesh)
    u = np.random.default_rng(3).normal(size=equations.intervals * 5 * 2 + 1) * 0.3
    u[-1] = 1.1
    h = 1e-6
    columns = [
        (equations.residual(u + e) - equations.residual(u - e)) / (2 * h)
        for e in h * np.eye(u.size)
    ]
    found = equations.jacobian(u).toarray()
    # The last row is the phase condition, whose residual is always zero.
    np.testing.assert_allclose(found[:-1], np.column_stack(columns)[:-1], atol=1e-6)


def test_a_path_keeps_its_values_on_a_finer_mesh():
    rng = np.random.default_rng(5)
    path = PiecewisePath(uniform(3), rng.normal(size=(3, 5, 2)))
    finer = path.on(split(uniform(3), np.array([2, 1, 4])))
    phases = rng.uniform(-1.0, 2.0, 50)
    np.testing.assert_allclose(finer.states(phases), path.states(phases), atol=1e-12)


def test_a_jump_that_a_state_causes_is_refused():
    """Dry friction: neighbours stop to slide at other times, which no derivative along it holds."""

    def sliding(t, x):
        return [x[1], -x[0] - 0.1 * x[1] - 0.2 * np.sign(x[1]) + 2.0 * np.cos(0.5 * t)]

    model = OdeModel(sliding, ("x", "v"), period=4 * np.pi)
    with pytest.raises(OrbitError):  # of the search, or of the jump
        find_limit_cycle(model, [2.7, 0.0], method="collocation", accuracy=1e-5)
    equations = PiecewiseEquations(
        RightHandSide(model, np.ones(2)), 0.0, 4 * np.pi, False, uniform(64)
    )
    times = 4 * np.pi * np.linspace(0.0, 1.0, 65)[:-1, None] + 4 * np.pi / 64 * np.append(
        0.0, PLACES
    )
    # A motion whose velocity changes sign at a border of the mesh, and no step of time there.
    states = np.stack([-2.0 * np.cos(0.5 * times), np.sin(0.5 * times)], axis=-1)
    at = equations.jumps_by_state(equations.pack(states, 4 * np.pi))
    assert at == pytest.approx(2 * np.pi, abs=1e-9) or at == pytest.approx(4 * np.pi, abs=1e-9)


def test_a_wrong_derivative_is_not_taken_on_a_mesh_either():
    wrong = OdeModel(
        struck().rhs,
        ("x", "v"),
        period=1.0,
        jacobian=lambda _t, _x: MATRIX + np.diag([3.0], -1),
    )
    cycle = find_limit_cycle(wrong, [0.0, 0.0], method="collocation")
    right = find_limit_cycle(struck(), [0.0, 0.0], method="collocation")
    assert cycle.jacobian_gap > 0.1  # in units of the state scale
    np.testing.assert_allclose(cycle.multipliers, right.multipliers, atol=1e-6)


def test_an_equilibrium_is_no_orbit_on_a_mesh_either():
    model = OdeModel(lambda _t, x: [x[1] - x[0], -x[0] - x[1]], ("x", "v"))
    with pytest.raises(OrbitError):
        find_limit_cycle(model, [0.1, 0.0], period_guess=6.0, method="collocation")


def test_auto_shoots_first_beside_a_rough_orbit():
    cycle = find_limit_cycle(struck(), [0.0, 0.0])
    assert cycle.method == "shooting"
    assert "too rough" in cycle.method_reason


def test_what_neither_finds_is_told():
    """No orbit at all: x' = 1 + x^2 runs away."""
    model = OdeModel(lambda _t, x: [1.0 + x[0] ** 2], ("x",), period=1.0)
    with pytest.raises(OrbitError):
        find_limit_cycle(model, [0.0], method="collocation")
