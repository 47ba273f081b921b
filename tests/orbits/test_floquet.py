from dataclasses import dataclass

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from orbit_systems import ForcedLinear, mathieu, roessler, stuart_landau, van_der_pol
from scipy.optimize import linear_sum_assignment

from birdmb.orbits import (
    ArgumentError,
    LimitCycle,
    NotClosedError,
    OdeModel,
    find_limit_cycle,
    floquet,
    periodic_multipliers,
    product_multipliers,
)
from birdmb.orbits.periodic import periodic_eigenvalues

SOLVERS = [periodic_multipliers, product_multipliers]


def periodic_product(blocks, seed=1):
    """Factors X_{k+1} D_k X_k^-1 with random X: the product is similar to that of the blocks."""
    rng = np.random.default_rng(seed)
    bases = rng.standard_normal(blocks.shape)
    return np.array(
        [
            np.roll(bases, -1, axis=0)[k] @ blocks[k] @ np.linalg.inv(bases[k])
            for k in range(len(blocks))
        ]
    )


def rotation(modulus, angle):
    c, s = np.cos(angle), np.sin(angle)
    return modulus * np.array([[c, -s], [s, c]])


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("segments", [1, 3])
def test_zero_solution_of_mathieu(solver, segments):
    result = floquet(mathieu(1, 0.5), [0, 0], segments=segments, solver=solver)
    assert result.multipliers == pytest.approx([-2.14655649, -0.46586242], abs=6e-9)
    assert result.liouville_defect() < 1e-9
    assert result.trivial_index is None


@pytest.mark.parametrize("segments", [1, 4])
def test_error_bounds_cover_the_errors(segments):
    exact = floquet(mathieu(1, 0.5, rtol=3e-14, atol=1e-16), [0, 0]).multipliers
    result = floquet(mathieu(1, 0.5), [0, 0], segments=segments)
    errors = np.abs(result.multipliers - exact)
    assert (errors < result.multiplier_errors).all()
    assert (result.multiplier_errors < 1e-8).all()


def test_periodic_solver_keeps_small_multipliers():
    exact = np.array([1.4, 0.83, 1e-9, 0.9e-9, 1e-20])
    factors = periodic_product(np.array([np.diag(exact ** (1 / 8))] * 8))
    found = periodic_multipliers(factors, np.zeros_like(factors), np.ones(5))
    assert found.multipliers == pytest.approx(exact, rel=1e-10)
    assert (np.abs(found.multipliers - exact) < found.errors).all()
    assert (found.errors < 1e-8 * exact).all()
    lost = product_multipliers(factors, np.zeros_like(factors), np.ones(5))
    # What round-off leaves of the smallest is chance; that its bound owns up to it is not.
    assert lost.errors[4] > 1e6 * exact[4]
    assert (np.abs(lost.multipliers - exact) < lost.errors).all()


def test_periodic_solver_keeps_the_smallest_multipliers_and_finds_them_alone():
    """The sum of the logarithms is that of the determinants, of many states and none alike."""
    rng = np.random.default_rng(4)
    exact = np.sort(10.0 ** rng.uniform(-30, 0.3, 24))[::-1]
    exact[-1] = 1e-190
    factors = periodic_product(np.array([np.diag(exact ** (1 / 40))] * 40))
    found = periodic_multipliers(factors, np.zeros_like(factors), np.ones(24))
    assert found.multipliers == pytest.approx(exact, rel=1e-8)
    assert (np.abs(found.multipliers - exact) < found.errors).all()
    alone = periodic_eigenvalues(factors)
    alone = alone[np.argsort(-np.abs(alone))]
    assert alone == pytest.approx(exact, rel=1e-8)
    logarithms = np.log(np.abs(alone)).sum()
    assert np.linalg.slogdet(factors)[1].sum() == pytest.approx(logarithms, rel=1e-9)


@pytest.mark.parametrize("small", [0.5, 1e-12])
def test_periodic_solver_keeps_complex_pairs(small):
    m = 6
    block = scipy.linalg.block_diag(
        rotation(1.1 ** (1 / m), 0.3 / m), rotation(small ** (1 / m), 2 / m), small ** (1 / m) / 4
    )
    found = periodic_multipliers(
        periodic_product(np.array([block] * m)), np.zeros((m, 5, 5)), np.ones(5)
    )
    pairs = [1.1 * np.exp(0.3j), 1.1 * np.exp(-0.3j), small * np.exp(2j), small * np.exp(-2j)]
    assert found.multipliers == pytest.approx([*pairs, small / 4**m], rel=1e-9)


@given(
    shape=st.tuples(st.integers(1, 6), st.integers(1, 5)),
    seed=st.integers(0, 2**16),
    spread=st.sampled_from([0.0, 1.0, 6.0]),
    singular=st.booleans(),
)
@settings(max_examples=40, deadline=None, derandomize=True)
def test_both_solvers_agree_within_their_errors(shape, seed, spread, singular):
    (m, n), rng = shape, np.random.default_rng(seed)
    factors = rng.standard_normal((m, n, n)) * np.exp(rng.uniform(-spread, spread, (m, n, 1)))
    if singular:
        factors[0, :, 0] = 0
    one, other = (solver(factors, np.zeros_like(factors), np.ones(n)) for solver in SOLVERS)
    distance = np.abs(one.multipliers[:, None] - other.multipliers)
    allowed = one.errors[:, None] + other.errors + 1e-300  # an exact zero has no error
    assert (distance / allowed)[linear_sum_assignment(distance / allowed)].max() < 1


@pytest.mark.parametrize("solver", SOLVERS)
def test_nearly_defective_pairs_have_large_errors(solver):
    error = 1e-12
    for gap in (0.0, 1e-9, 1e-7):
        jordan = np.array([[[0.9, 1.0], [0.0, 0.9 + gap]]])
        found = solver(jordan, np.full((1, 2, 2), error), np.ones(2))
        # the worst perturbation splits the pair by the root of its size
        worst = np.linalg.eigvals(jordan[0] + [[0, 0], [error, 0]])
        moved = np.abs(worst[:, None] - np.array([0.9, 0.9 + gap])).min(axis=1).max()
        assert moved < found.errors.min() < 10 * np.sqrt(error)


@pytest.mark.parametrize("solver", SOLVERS)
def test_modes_are_carried_by_the_flow(solver):
    result = floquet(ForcedLinear(), ForcedLinear().orbit(0), segments=4, solver=solver)
    for k in range(4):
        carried = result.segment_jacobians[k] @ result.modes_along[k]
        carried /= np.exp(result.exponents * result.period / 4)
        assert carried == pytest.approx(result.modes_along[(k + 1) % 4], abs=1e-8)
    assert result.left_modes.conj().T @ result.modes == pytest.approx(np.eye(3), abs=1e-8)
    assert result.monodromy @ result.modes == pytest.approx(
        result.modes * result.multipliers, abs=1e-8
    )


def test_exponents_are_those_of_the_constant_matrix():
    model = ForcedLinear(period=0.9)
    result = floquet(model, model.orbit(0))
    exact = np.linalg.eigvals(model.matrix)
    assert np.sort_complex(result.exponents) == pytest.approx(np.sort_complex(exact), abs=1e-8)
    assert np.sort(result.doubling_times) == pytest.approx(np.sort(np.log(2) / np.abs(exact.real)))


def test_participation_does_not_depend_on_units_and_finds_the_state():
    # x and v swing; z decays on its own
    model = OdeModel(
        lambda _t, x: [x[1], -x[0] - 0.1 * x[1], -2 * x[2]], ("x", "v", "z"), period=2.0
    )
    share = floquet(model, [0, 0, 0]).participation
    assert share[:, 2] == pytest.approx([0, 0, 1], abs=1e-9)
    assert share[:2, 0] == pytest.approx([0.5, 0.5], abs=1e-2)
    assert share.sum(axis=0) == pytest.approx(1)


def test_trivial_multiplier_is_a_check():
    cycle = find_limit_cycle(roessler(3.5), [0.0, -4.6, 0.05], period_guess=5.9, segments=4)
    result = floquet(cycle.model, cycle.points, cycle.period, segments=4)
    assert result.trivial_index == 0
    assert result.trivial_error < result.multiplier_errors[0] < 1e-7
    assert result.liouville_defect() < 1e-7


def test_trivial_multiplier_is_told_from_a_slow_one():
    # radius decays so slowly that its multiplier is nearly 1 as well
    mu = 1e-6
    model = stuart_landau(mu, state_scale=[1e-3, 1e-3])
    result = floquet(model, [np.sqrt(mu), 0.0], np.pi)
    index = result.trivial_index
    assert np.abs(result.modes[:, index] / 1e-3) == pytest.approx([0, 1], abs=1e-4)


def test_an_equilibrium_has_no_trivial_multiplier():
    model = van_der_pol(1)
    result = floquet(model, [0, 0], period=2.0)
    exact = np.exp(2.0 * np.linalg.eigvals([[0, 1], [-1, 1]]))
    assert result.multipliers == pytest.approx(exact[np.argsort(-exact.imag)], abs=1e-8)
    assert result.trivial_index is None
    assert result.stability == "unstable"


def test_a_conservative_orbit_is_undecided():
    result = floquet(mathieu(3, 2), [0, 0])
    assert np.abs(result.multipliers) == pytest.approx(1, abs=1e-9)
    assert result.stability == "undecided"


def test_an_open_orbit_is_refused():
    with pytest.raises(NotClosedError, match=r"does not close: .* misses its start") as caught:
        floquet(van_der_pol(1), [2.0, 0.3], 6.66)
    assert caught.value.residual > 1e-3


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "needs its period"),
        ({"period": -1.0}, "positive"),
        ({"period": 6.0, "segments": 0}, "segments"),
        ({"period": 6.0, "jacobian": "none"}, "finite-differences"),
    ],
)
def test_wrong_arguments(options, words):
    with pytest.raises(ArgumentError, match=words):
        floquet(van_der_pol(1), [2.0, 0.0], **options)


def test_the_verdict_counts_what_a_model_knows_of_its_integration():
    @dataclass(frozen=True)
    class Rough(LimitCycle):
        @property
        def verdict_errors(self):
            return self.multiplier_errors + 0.2

    model = OdeModel(lambda _t, x: -0.1 * x, ("x",), period=1.0)
    assert find_limit_cycle(model, [0.1]).stability == "stable"
    model.limit_cycle_type = Rough
    assert find_limit_cycle(model, [0.1]).stability == "undecided"
