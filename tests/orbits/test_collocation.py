"""Limit cycles by Fourier collocation: exact cases, error bars, and what it is too rough for."""

import numpy as np
import pytest
import scipy.linalg
import scipy.special
from orbit_systems import ROESSLER, markus_yamabe, mathieu, roessler, stuart_landau, van_der_pol

from birdmb.errors import StateError
from birdmb.orbits import (
    ArgumentError,
    ConvergenceError,
    NotSmoothError,
    OdeModel,
    continue_branch,
    find_limit_cycle,
)
from birdmb.orbits.trigonometric import (
    between_nodes,
    differentiation_matrix,
    interpolated,
    resampled,
    without_drift,
)
from birdmb.orbits.variational import flow_jacobians


def collocated(model, guess=None, **options):
    return find_limit_cycle(model, guess, method="collocation", **options)


def wave(phase):
    """Harmonics 0 to 5: 11 nodes hold them."""
    turn = 2 * np.pi * np.asarray(phase)
    return np.stack([1 + np.cos(3 * turn), np.sin(5 * turn) - np.cos(turn)], axis=-1)


def test_eleven_nodes_hold_five_harmonics():
    nodes = wave(np.arange(11) / 11)
    anywhere = np.array([-0.3, 0.0, 1 / 11, 0.123, 0.5, 1.0, 1.7, 2.0])
    assert interpolated(nodes, anywhere) == pytest.approx(wave(anywhere), abs=1e-13)
    assert resampled(nodes, 25) == pytest.approx(wave(np.arange(25) / 25), abs=1e-13)
    parts = np.array([0.0, 0.25, 1.0])
    between = between_nodes(nodes, parts)
    assert between == pytest.approx(wave((np.arange(11)[:, None] + parts) / 11), abs=1e-13)
    step = 1e-6
    slope = (wave(np.arange(11) / 11 + step) - wave(np.arange(11) / 11 - step)) / (2 * step)
    assert differentiation_matrix(11) @ nodes == pytest.approx(slope, abs=1e-7)


def test_an_open_path_is_made_to_close():
    phases = np.linspace(0, 1, 12)
    path = np.column_stack([np.sin(2 * np.pi * phases) + 3 * phases, phases])
    closed = without_drift(path)
    assert closed == pytest.approx(
        np.column_stack([np.sin(2 * np.pi * phases[:-1]), np.zeros(11)]), abs=1e-12
    )


def test_flow_jacobians_of_a_constant_matrix_are_its_exponentials():
    matrix = np.array([[0.0, 6.0, 0.3], [-8.0, -1.0, 0.0], [0.5, 0.0, -30.0]])
    factors = flow_jacobians(np.tile(matrix, (9, 1, 1)))
    assert factors == pytest.approx(np.tile(scipy.linalg.expm(matrix / 9), (9, 1, 1)), abs=1e-11)


def test_the_error_of_flow_jacobians_falls_off_with_the_nodes():
    """As fast as the distance from the same on half as many nodes again needs to cover it."""
    exact = np.exp(-60.0)
    error, finer = (
        abs(np.prod(flow_jacobians(np.full((nodes, 1, 1), -60.0))) / exact - 1.0)
        for nodes in (25, 37)
    )
    assert finer < 0.05 * error


def test_a_mode_that_decays_within_an_interval_stays_small():
    factors = flow_jacobians(np.tile([[-1e5, 0.0], [0.0, -0.1]], (17, 1, 1)))
    product = np.linalg.multi_dot(factors)
    assert abs(product[0, 0]) < 1e-30
    assert product[1, 1] == pytest.approx(np.exp(-0.1), rel=1e-12)


@pytest.mark.parametrize(("a", "q"), [(1, 0.5), (3, 2), (4, 5)])
def test_mathieu(a, q):
    found, shot = collocated(mathieu(a, q)), find_limit_cycle(mathieu(a, q), method="shooting")
    assert (found.method, shot.method) == ("collocation", "shooting")
    apart = np.abs(found.multipliers - shot.multipliers)
    assert (apart < found.multiplier_errors + shot.multiplier_errors).all()
    assert np.linalg.det(found.monodromy) == pytest.approx(1, abs=1e-9)


def test_markus_yamabe():
    found = collocated(markus_yamabe())
    errors = np.abs(found.multipliers - [-np.exp(np.pi / 2), -np.exp(-np.pi)])
    assert (errors < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 1e-8
    assert found.jacobian_method == "variational"


@pytest.mark.parametrize("mu", [0.01, 0.3, 2.0])
def test_stuart_landau(mu):
    found = collocated(stuart_landau(mu), [0.8 * mu**0.5, 0.1 * mu**0.5], period_guess=3.0)
    assert found.period == pytest.approx(np.pi, rel=1e-9)
    assert np.hypot(*found.points.T) == pytest.approx(mu**0.5, rel=1e-8)
    errors = np.abs(found.multipliers - [1, np.exp(-2 * mu * np.pi)])
    assert (errors < found.multiplier_errors).all()
    assert found.multiplier_errors.max() < 1e-7
    assert found.trivial_index == 0


@pytest.mark.parametrize(
    ("mu", "guess", "period", "small"),
    [(1, 6.5, 6.663286859323, 8.59695064e-4), (3, 8.8, 8.859095499720, 6.98947563e-16)],
)
def test_van_der_pol(mu, guess, period, small):
    found = collocated(van_der_pol(mu), period_guess=guess)
    assert found.period == pytest.approx(period, abs=1e-8)
    assert found.multipliers[1] == pytest.approx(small, rel=1e-6)
    assert abs(found.multipliers[0] - 1) < found.multiplier_errors[0] < 1e-6
    assert found.stability == "stable"


@pytest.mark.parametrize("c", ROESSLER)
def test_roessler(c):
    period, multiplier = ROESSLER[c]
    found = collocated(roessler(c), period_guess=period * 1.01)
    assert found.period == pytest.approx(period, abs=2e-8)
    assert found.multipliers[1] == pytest.approx(multiplier, abs=2e-8)
    assert found.liouville_defect() < 1e-6


def test_roessler_s_unstable_cycles():
    """Of period one beside the chaos at c = 10, where shooting from the same guess finds none."""
    found = collocated(roessler(4.5), [0.0, -6.0, 0.05], period_guess=5.9)
    shot = find_limit_cycle(roessler(4.5), [0.0, -6.0, 0.05], period_guess=5.9, segments=6)
    assert found.period == pytest.approx(shot.period, abs=1e-8)
    apart = np.abs(found.multipliers - shot.multipliers)
    assert (apart < found.multiplier_errors + shot.multiplier_errors).all()
    wild = collocated(roessler(10), [0.0, -9.0, 0.02], period_guess=5.9)
    times = wild.period * np.arange(6) / 6
    again = find_limit_cycle(
        roessler(10), wild.trajectory(times).states, period_guess=wild.period, segments=6
    )
    assert wild.period == pytest.approx(again.period, abs=1e-7)
    apart = np.abs(wild.multipliers - again.multipliers)
    assert (apart < wild.multiplier_errors + again.multiplier_errors).all()
    assert wild.stability == "unstable"


def duffing(omega):
    return OdeModel(
        lambda t, x: [x[1], -0.1 * x[1] - x[0] - x[0] ** 3 + 0.3 * np.cos(omega * t)],
        ("x", "v"),
        period=2 * np.pi / omega,
    )


@pytest.mark.parametrize("guess", [[1.6, 0.5], [-0.5, 0.1], [0.9, 1.3]])
def test_three_coexisting_cycles_are_those_of_shooting(guess):
    shot = find_limit_cycle(duffing(1.6), guess, method="shooting")
    found = collocated(duffing(1.6), shot.x0 + np.array([1e-3, -1e-3]))
    assert np.abs(found.x0 - shot.x0).max() < found.state_error * found.state_scale.max() + 1e-8
    apart = np.abs(found.multipliers - shot.multipliers)
    assert (apart < found.multiplier_errors + shot.multiplier_errors).all()


def test_error_bars_hold_with_any_number_of_nodes():
    exact = find_limit_cycle(roessler(3.5), period_guess=5.9, segments=2, tolerance=1e-11)
    for nodes in (25, 37, 55, 83):
        found = collocated(roessler(3.5), exact, nodes=nodes)
        assert found.nodes == nodes
        apart = np.abs(found.trajectory([0.0]).states - found.x0).max()
        assert apart < 1e-12
        errors = np.abs(found.multipliers[:2] - exact.multipliers[:2])
        assert (errors < found.multiplier_errors[:2] + exact.multiplier_errors[:2]).all()
        assert abs(found.period - exact.period) < found.state_error * exact.period + 1e-9


def test_more_nodes_bring_the_error_down_exponentially():
    errors = [
        collocated(roessler(3.5), period_guess=5.9, nodes=n).state_error for n in (25, 37, 55)
    ]
    assert errors[1] < errors[0] / 30
    assert errors[2] < errors[1] / 100


@pytest.mark.parametrize(("decay", "sharpness"), [(2e3, 100), (5e3, 400), (2e5, 300)])
def test_stiff_rates_that_nodes_miss_get_more_instants(decay, sharpness):
    """A turning frame in which one direction decays in pulses, the other by exp(-0.1) a turn.

    On 25 nodes and on 37 the interpolated rates grow somewhere, and multipliers are of any size.
    """

    def frame(t):
        c, s = np.cos(2 * np.pi * t), np.sin(2 * np.pi * t)
        return np.array([[c, -s], [s, c]])

    def matrix(t, _x=None):
        rates = np.diag([-decay / (1 + sharpness * np.sin(np.pi * t) ** 2), -0.1])
        turning = 2 * np.pi * np.array([[0.0, -1.0], [1.0, 0.0]])
        return turning + frame(t) @ rates @ frame(t).T

    def rhs(t, x):
        return matrix(t) @ (x - frame(t)[:, 0]) + 2 * np.pi * frame(t)[:, 1]

    model = OdeModel(rhs, ("x", "y"), period=1.0, jacobian=matrix, guess=[1.0, 0.0])
    found = collocated(model)
    assert (np.abs(found.multipliers - [np.exp(-0.1), 0.0]) < found.multiplier_errors + 1e-60).all()
    assert found.multiplier_errors.max() < 1e-8
    assert len(found.points) > found.nodes == 25


def test_rates_that_are_rougher_than_the_orbit_get_more_instants():
    # x = cos t for any damping; a damping with a sharp peak is seen by the multiplier alone
    def damping(t):
        return 0.02 + 12 * np.exp(200 * (np.cos(t) - 1))

    def rhs(t, x):
        return [-np.sin(t) - damping(t) * (x[0] - np.cos(t))]

    found = collocated(OdeModel(rhs, ("x",), period=2 * np.pi), [1.0])
    # the mean of exp(k cos t) is the Bessel function I0(k)
    mean = 0.02 + 12 * float(scipy.special.ive(0, 200))
    assert len(found.points) > found.nodes == 25
    assert found.x0 == pytest.approx([1.0], abs=1e-12)
    error = abs(found.multipliers[0] - np.exp(-2 * np.pi * mean))
    assert error < found.multiplier_errors[0] < 1e-6


def kinked(t, x):
    return [x[1], -0.3 * x[1] - x[0] - 2 * max(x[0], 0.0) + np.cos(t)]


def test_a_kink_is_recognised_and_left_to_shooting():
    model = OdeModel(kinked, ("x", "v"), period=2 * np.pi)
    on_mesh = collocated(model, [0.5, 0.0], accuracy=1e-10)
    assert on_mesh.intervals is not None
    assert "too rough for collocation: with" in on_mesh.method_reason
    found = find_limit_cycle(model, [0.5, 0.0], accuracy=1e-10)
    assert found.method == "shooting"
    assert found.nodes is None
    assert "too rough for collocation" in found.method_reason
    shot = find_limit_cycle(model, [0.5, 0.0], method="shooting")
    assert found.x0 == pytest.approx(shot.x0, abs=1e-8)
    assert on_mesh.x0 == pytest.approx(shot.x0, abs=1e-8)
    apart = np.abs(on_mesh.multipliers - shot.multipliers)
    assert (apart <= on_mesh.multiplier_errors + shot.multiplier_errors).all()
    with pytest.raises(NotSmoothError, match=r'take method="shooting"'):
        continue_branch(lambda _: model, (0.0, 1.0), [0.5, 0.0], method="collocation")
    assert shot.method_reason == 'method="shooting" was asked for'


def test_a_square_wave_is_left_to_shooting():
    model = OdeModel(lambda t, x: [np.sign(np.sin(t + 0.3)) - x[0]], ("x",), period=2 * np.pi)
    found = find_limit_cycle(model, [0.0])
    assert found.method == "shooting"
    assert abs(found.multipliers[0] - np.exp(-2 * np.pi)) < found.multiplier_errors[0] < 1e-4


def test_what_a_neighbour_found_is_a_guess():
    first = collocated(van_der_pol(1), period_guess=6.5)
    again = collocated(van_der_pol(1.02), first)
    cold = collocated(van_der_pol(1.02), period_guess=6.5)
    assert again.period == pytest.approx(cold.period, abs=1e-8)
    assert len(again.iterations) < len(cold.iterations)
    with pytest.raises(ArgumentError, match="has the states x, v; this model has x, y, z"):
        collocated(roessler(3.5), first)


def test_a_path_is_a_guess():
    exact = collocated(van_der_pol(1), period_guess=6.5)
    for count in (9, 32):
        times = exact.period * np.arange(count) / count
        found = collocated(van_der_pol(1), exact.trajectory(times).states, period_guess=6.6)
        assert found.period == pytest.approx(exact.period, abs=1e-8)


def test_a_right_hand_side_alone_is_enough():
    class Rates:
        state_names = ("x",)
        period = 2 * np.pi

        def rates(self, times, states):
            return np.cos(times)[:, None] - states - 0.1 * states**3

        def flow(self, _x0, _t0, _t1):
            raise StateError("no flow is needed.")

        def guess_along(self, times):
            return np.zeros((len(times), 1))

    found = find_limit_cycle(Rates())
    mean = float(np.mean(1 + 0.3 * found.trajectory().states[:-1] ** 2))
    assert found.method == "collocation"
    assert found.multipliers == pytest.approx([np.exp(-2 * np.pi * mean)], rel=1e-8)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"method": "collocation", "segments": 2}, "segments are of shooting"),
        ({"method": "collocation", "jacobian": "variational"}, "is of shooting"),
        ({"nodes": 20}, "odd"),
        ({"nodes": 21, "method": "shooting"}, "nodes are of collocation"),
        ({"method": "newton"}, '"auto", "collocation" or "shooting"'),
        ({"accuracy": 1.0}, "accuracy must be positive"),
        ({"guess": [[1.0, 2.0, 3.0]] * 12}, r"need \(2,\), or \(K, 2\)"),
    ],
)
def test_wrong_arguments(options, words):
    with pytest.raises(ArgumentError, match=words):
        find_limit_cycle(van_der_pol(1), period_guess=6.5, **options)


def test_no_orbit_at_all():
    # x' = 1 + x^2 has no periodic solution
    model = OdeModel(lambda _t, x: 1 + x**2, ("x",), period=1.0)
    with pytest.raises(ConvergenceError, match="No orbit found"):
        collocated(model, [0.1])
