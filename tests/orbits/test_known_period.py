import numpy as np
import pytest
import scipy.linalg
from orbit_systems import ForcedLinear, markus_yamabe, mathieu

from birdmb.orbits import ArgumentError, OdeModel, find_limit_cycle, floquet

MATHIEU = [(1, 0.5), (2, 1), (3, 2), (4, 5)]


def test_mathieu_multipliers():
    cycle = find_limit_cycle(mathieu(1, 0.5))
    assert cycle.multipliers == pytest.approx([-2.14655649, -0.46586242], abs=6e-9)
    assert abs(np.linalg.det(cycle.monodromy) - 1) < 1e-10
    assert cycle.stability == "unstable"


@pytest.mark.parametrize(
    ("a", "q", "trace"),
    [(2, 1, -1.554649354177), (3, 2, 0.493922737185), (4, 5, 13.799346279909)],
)
def test_mathieu_traces(a, q, trace):
    cycle = find_limit_cycle(mathieu(a, q))
    assert np.trace(cycle.monodromy) == pytest.approx(trace, rel=1e-10)
    assert abs(np.linalg.det(cycle.monodromy) - 1) < 1e-10


@pytest.mark.parametrize(("a", "q"), MATHIEU)
def test_damping_shifts_mathieus_exponents(a, q):
    # x = exp(-d t / 2) y turns the damped equation into the undamped one with a - d**2 / 4
    d = 0.2
    damped = find_limit_cycle(mathieu(a, q, damping=d))
    undamped = find_limit_cycle(mathieu(a - d**2 / 4, q))
    assert damped.multipliers == pytest.approx(
        undamped.multipliers * np.exp(-d * np.pi / 2), rel=1e-9
    )
    assert np.linalg.det(damped.monodromy) == pytest.approx(np.exp(-d * np.pi), abs=1e-10)


@pytest.mark.parametrize(("a", "q"), MATHIEU)
def test_multipliers_do_not_depend_on_the_segments(a, q):
    whole = find_limit_cycle(mathieu(a, q)).multipliers
    for segments in (2, 5, 10):
        cut = find_limit_cycle(mathieu(a, q), segments=segments).multipliers
        assert cut == pytest.approx(whole, abs=1e-8)


def test_multipliers_do_not_depend_on_the_starting_phase():
    here = find_limit_cycle(mathieu(1, 0.5)).multipliers
    there = find_limit_cycle(mathieu(1, 0.5), start_time=1.1).multipliers
    assert there == pytest.approx(here, abs=1e-8)


def test_markus_yamabe():
    cycle = find_limit_cycle(markus_yamabe())
    assert cycle.multipliers == pytest.approx([-np.exp(np.pi / 2), -np.exp(-np.pi)], rel=1e-9)
    assert cycle.stability == "unstable"


def duffing(unit=1.0):
    """Forced Duffing oscillator, its position given in metres times `unit`."""

    def rhs(t, x):
        position, rate = x[0] / unit, x[1]
        return [unit * rate, -0.2 * rate - position - position**3 + 0.3 * np.cos(1.2 * t)]

    return OdeModel(rhs, ("x", "v"), period=2 * np.pi / 1.2, atol=[1e-13 * unit, 1e-13])


@pytest.mark.parametrize("jacobian", ["variational", "finite-differences"])
def test_multipliers_do_not_depend_on_the_units(jacobian):
    metres = find_limit_cycle(duffing(), [0.1, 0.1], jacobian=jacobian)
    micrometres = find_limit_cycle(duffing(1e6), [0.1e6, 0.1], jacobian=jacobian)
    accuracy = 1e-9 if jacobian == "variational" else 1e-6
    assert micrometres.multipliers == pytest.approx(metres.multipliers, abs=accuracy)
    assert micrometres.x0 / [1e6, 1] == pytest.approx(metres.x0, abs=1e-8)


def test_twice_the_period_squares_the_multipliers():
    once, twice = duffing(), duffing()
    twice.period = 2 * once.period
    first = find_limit_cycle(once, [0.1, 0.1])
    second = find_limit_cycle(twice, first.x0)
    assert np.sort_complex(second.multipliers) == pytest.approx(
        np.sort_complex(first.multipliers**2), abs=1e-9
    )


@pytest.mark.parametrize("segments", [1, 4])
def test_difference_error_estimate_bounds_the_true_error(segments):
    model = ForcedLinear()
    cycle = find_limit_cycle(model, [0.0, 0.0, 0.0], segments=segments)
    assert cycle.x0 == pytest.approx(model.orbit(0.0), abs=1e-8)
    true = np.linalg.eigvals(scipy.linalg.expm(model.matrix * model.period))
    errors = np.array([np.abs(true - value).min() for value in cycle.multipliers])
    assert (errors <= cycle.multiplier_errors).all()
    assert cycle.multiplier_errors.max() < 1e3 * errors.max()
    assert cycle.stability == "stable"


def test_levenberg_marquardt_agrees_with_newton():
    newton = find_limit_cycle(duffing(), [0.5, -0.5], segments=3)
    other = find_limit_cycle(duffing(), [0.5, -0.5], segments=3, damping="levenberg-marquardt")
    assert other.x0 == pytest.approx(newton.x0, abs=1e-8)


class Counted:
    """A forced model without derivatives that counts its flows."""

    def __init__(self, model):
        self._model, self.flows = model, 0
        self.state_names, self.period = model.state_names, model.period
        self.state_scale = np.ones(len(model.state_names))

    def flow(self, x0, t0, t1):
        self.flows += 1
        return self._model.flow(x0, t0, t1)


def exactly(model, x0):
    """Multipliers of the orbit near x0, by the variational equations."""
    return np.sort_complex(find_limit_cycle(model, x0, tolerance=1e-12).multipliers)


@pytest.mark.parametrize("away", [0.0, 1e-9, 1e-7, 1e-5])
@pytest.mark.parametrize("segments", [1, 3])
def test_error_bounds_of_differences_cover_step_and_open_orbit(away, segments):
    # In these units the steps of the differences are long: their error is not mere noise.
    model = duffing(0.1)
    orbit = find_limit_cycle(model, [0.01, 0.1], segments=segments, tolerance=1e-12)
    open_orbit = orbit.points + away * np.array([1.0, -2.0])
    by_differences = Counted(model)
    found = floquet(by_differences, open_orbit, segments=segments, closure_tolerance=1e-3)
    assert found.jacobian_method == "finite-differences"
    assert by_differences.flows == segments * (1 + 4 + 3)  # closure, Jacobian, its refinement
    errors = np.abs(np.sort_complex(found.multipliers) - exactly(model, orbit.x0))
    assert (errors < found.multiplier_errors).all()
    # Far below what the step (6e-9) and the open orbit (4 to 13 times its distance) would do.
    if away < 1e-6:
        assert errors.max() < 1e-9
        assert found.multiplier_errors.max() < 2e-5 + 4e3 * away


def test_a_neighbours_jacobian_saves_flows_and_changes_no_result():
    first = find_limit_cycle(duffing(), [0.1, 0.1], jacobian="finite-differences")
    softer, again, garbage = Counted(duffing()), Counted(duffing()), Counted(duffing())
    guess = first.x0 + np.array([0.01, -0.01])
    cold = find_limit_cycle(softer, guess)
    warm = find_limit_cycle(again, guess, jacobian_guess=first.segment_jacobians)
    assert again.flows == softer.flows - 4
    assert not cold.iterations[1].jacobian_reused
    assert all(step.jacobian_reused for step in warm.iterations[1:])
    misled = find_limit_cycle(garbage, guess, jacobian_guess=[[[5.0, -40.0], [3.0, 7.0]]])
    singular = find_limit_cycle(Counted(duffing()), guess, jacobian_guess=[np.eye(2)])
    for other in (warm, misled, singular):
        assert other.x0 == pytest.approx(cold.x0, abs=1e-8)
        assert other.multipliers == pytest.approx(cold.multipliers, abs=1e-8)
    for impossible in (np.eye(2), np.full((1, 2, 2), np.nan), np.ones((2, 2, 2))):
        with pytest.raises(ArgumentError, match="jacobian_guess"):
            find_limit_cycle(Counted(duffing()), guess, jacobian_guess=impossible)


def test_updated_jacobians_converge_faster_than_a_kept_one():
    cycle = find_limit_cycle(Counted(duffing()), [0.1, 0.1], tolerance=1e-11)
    sizes = [step.residual for step in cycle.iterations if step.jacobian_reused]
    ratios = np.divide(sizes[1:], sizes[:-1])
    assert len(ratios) >= 2
    assert (np.diff(ratios) < 0).all()
