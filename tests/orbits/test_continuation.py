import numpy as np
import pytest
from orbit_systems import roessler, stuart_landau
from scipy.optimize import brentq

from birdmb.errors import OrbitError, StateError
from birdmb.orbits import (
    ArgumentError,
    BranchStopped,
    ConvergenceError,
    OdeModel,
    Steps,
    continue_branch,
    find_limit_cycle,
    load_branch,
    stability_boundary,
)

BOTH = pytest.mark.parametrize("method", ["collocation", "shooting"])
PERIOD = 2 * np.pi
COARSE = Steps(first=0.05, longest=0.2)


def moving(slow, names=("y",), guess=None):
    """Forced system whose orbit is sin t plus an equilibrium of y' = slow(y)."""

    def rhs(t, x):
        return np.cos(t) + np.asarray(slow(x - np.sin(t)))

    return OdeModel(rhs, names, period=PERIOD, guess=guess, state_scale=np.ones(len(names)))


def saddle_node(p):
    """Orbits y = +-sqrt(p): fold at p = 0."""
    return moving(lambda y: 0.2 * (p - y**2), guess=[1.0])


def transcritical(p):
    """Orbit y = 0, crossed at p = 0 by y = p."""
    return moving(lambda y: p * y - y**2, guess=[0.0])


def turning(p, spin=0.4):
    """Orbit y = 0 with multipliers exp(2 pi (p +- i spin)): Neimark-Sacker at p = 0."""

    def slow(y):
        growth = p - y @ y
        return [growth * y[0] - spin * y[1], growth * y[1] + spin * y[0]]

    return moving(slow, ("y", "z"), guess=[0.0, 0.0])


def twisted(p):
    """Zero solution with multipliers -exp(2 pi p), -exp(-2 pi): period doubling at p = 0."""

    def rhs(t, x):
        c, s = np.cos(t / 2), np.sin(t / 2)
        turn = np.array([[c, -s], [s, c]])
        v = turn.T @ x
        return turn @ np.array([p * v[0] - v[0] ** 3, -v[1]]) + 0.5 * np.array([-x[1], x[0]])

    return OdeModel(rhs, ("x", "y"), period=PERIOD, guess=[0, 0], state_scale=[1, 1])


def duffing(frequency):
    def rhs(t, x):
        return [x[1], -0.2 * x[1] - x[0] - x[0] ** 3 + 0.3 * np.cos(frequency * t)]

    def jacobian(_t, x):
        return [[0, 1], [-1 - 3 * x[0] ** 2, -0.2]]

    return OdeModel(
        rhs, ("x", "v"), period=PERIOD / frequency, jacobian=jacobian, guess=[0.3, 0], rtol=1e-10
    )


@BOTH
def test_a_fold_is_passed(method):
    branch = continue_branch(saddle_node, (1.0, -1.0), steps=COARSE, method=method)
    assert {point.method for point in branch.points} == {method}
    (fold,) = branch.bifurcations
    assert fold.kind == "fold"
    assert abs(fold.parameter) < 1e-6
    assert abs(fold.parameter) < fold.parameter_error
    # the branch comes back on the other side, unstable, and ends where it began
    assert branch.stopped is None
    assert branch.parameters[-1] == pytest.approx(1.0)
    assert branch.values("y")[[0, -1]] == pytest.approx([1, -1])
    assert [branch.points[i].stability for i in (0, -1)] == ["stable", "unstable"]


@pytest.mark.long
@BOTH
def test_duffings_folds_separate_one_orbit_from_three(method):
    branch = continue_branch(duffing, (1.6, 1.2), steps=Steps(longest=0.2), method=method)
    kinds = [bifurcation.kind for bifurcation in branch.bifurcations]
    assert kinds == ["fold", "fold"]
    # two methods that share no equation agree in these to ten digits
    folds = [bifurcation.parameter for bifurcation in branch.bifurcations]
    assert folds == pytest.approx([1.30304596945, 1.38385653199], abs=1e-9)
    for fold, inwards in zip(branch.bifurcations, (1, -1), strict=True):
        assert np.abs(fold.point.multipliers - 1).min() < 1e-4
        near = find_limit_cycle(duffing(fold.parameter + inwards * 1e-4), fold.point.points)
        assert np.abs(near.x0 - fold.point.points[0]).max() < 0.05
        try:
            far = find_limit_cycle(duffing(fold.parameter - inwards * 1e-4), fold.point.points)
        except ConvergenceError:
            continue
        assert np.abs(far.x0 - fold.point.points[0]).max() > 0.3


@BOTH
def test_roesslers_first_period_doubling(method):
    def family(c):
        return roessler(c, rtol=1e-10, atol=1e-12)

    branch = continue_branch(
        family,
        (3.5, 4.2),
        [0, -4.6, 0.05],
        period_guess=5.9,
        steps=COARSE,
        max_bifurcations=1,
        method=method,
    )
    (doubling,) = branch.bifurcations

    orbit = find_limit_cycle(family(3.9), [0, -5, 0.05], period_guess=5.9)

    def distance(c):
        cycle = find_limit_cycle(family(c), orbit.x0, period_guess=orbit.period)
        return cycle.multipliers.real.min() + 1

    assert doubling.kind == "period doubling"
    assert doubling.parameter == pytest.approx(brentq(distance, 3.85, 3.95, xtol=1e-7), abs=1e-6)
    assert [branch.points[i].stability for i in (0, -1)] == ["stable", "unstable"]


@BOTH
@pytest.mark.parametrize(
    ("family", "kind"),
    [
        (turning, "Neimark-Sacker"),
        (twisted, "period doubling"),
        (transcritical, "branch point"),
    ],
)
def test_exact_bifurcations(family, kind, method):
    branch = continue_branch(family, (-0.31, 0.17), steps=COARSE, method=method)
    (found,) = branch.bifurcations
    assert found.kind == kind
    assert abs(found.parameter) < 1e-6
    assert abs(found.parameter) <= found.parameter_error
    assert branch.parameters[found.after] < 0 < branch.parameters[found.after + 1]


def test_a_neutral_saddle_is_no_bifurcation():
    def family(p):
        return moving(lambda y: [(0.3 + p) * y[0], -0.3 * y[1]], ("y", "z"), guess=[0, 0])

    assert continue_branch(family, (-0.1, 0.1), steps=COARSE).bifurcations == ()


@pytest.mark.long
@BOTH
def test_cycles_that_shrink_to_an_equilibrium(method):
    branch = continue_branch(
        stuart_landau,
        (0.5, -0.5),
        [0.7, 0.0],
        period_guess=3.1,
        steps=Steps(longest=0.05),
        method=method,
    )
    assert branch.stopped.reason == "the cycles shrank to an equilibrium"
    assert 0 < branch.parameters[-1] < 0.01
    assert branch.values("period") == pytest.approx(np.pi)


def test_the_end_of_the_domain_is_said():
    def family(p):
        if p > 0.2:
            raise StateError("no bird has such a wing.")
        return turning(p)

    branch = continue_branch(family, (-0.3, 1.0), steps=COARSE)
    assert branch.stopped.reason == "the branch left the domain of the model"
    assert "no bird has such a wing" in str(branch.stopped)
    assert branch.parameters[-1] == pytest.approx(0.2, abs=1e-4)
    with pytest.raises(OrbitError, match=r"The branch stopped at parameter 0.19"):
        raise branch.stopped


@pytest.mark.long
def test_a_step_that_becomes_too_small_is_said():
    def family(p):
        # the orbit jumps at p = 0: there is nothing to follow
        return moving(lambda y: np.sign(p) - y, guess=[-1.0])

    branch = continue_branch(family, (-0.5, 0.5), steps=Steps(shortest=1e-4))
    assert branch.stopped.reason == "the step became too small"
    assert branch.parameters[-1] == pytest.approx(0, abs=1e-3)


@pytest.mark.long
def test_save_load_resume(tmp_path):
    seen = []
    options = {"steps": COARSE, "observables": {"reach": lambda c: c.trajectory().states.max()}}
    first = continue_branch(saddle_node, (1.0, -1.0), max_points=4, callback=seen.append, **options)
    assert first.stopped.reason == "the number of points allowed was reached"
    assert tuple(seen) == first.points
    first.save(tmp_path / "branch.nc")
    loaded = load_branch(tmp_path / "branch.nc")
    assert isinstance(loaded.stopped, BranchStopped)
    whole = continue_branch(saddle_node, (1.0, -1.0), resume=loaded, **options)
    assert np.array_equal(whole.parameters[:4], first.parameters)
    assert whole.parameters[-1] == pytest.approx(1.0)
    assert [bifurcation.kind for bifurcation in whole.bifurcations] == ["fold"]
    whole.save(tmp_path / "whole.nc")
    again = load_branch(tmp_path / "whole.nc")
    assert again.bifurcations[0].parameter == whole.bifurcations[0].parameter
    assert again.bifurcations[0].after == whole.bifurcations[0].after
    assert again.stopped is None
    assert np.array_equal(again.values("reach"), whole.values("reach"))
    assert np.array_equal(again.points[2].multipliers, whole.points[2].multipliers)


def test_plot_names_what_was_found():
    branch = continue_branch(turning, (-0.3, 0.2), parameter_name="growth (1/s)", steps=COARSE)
    top, bottom = branch.plot("z").axes
    assert top.texts[0].get_text().startswith("Neimark-Sacker")
    assert (top.get_ylabel(), bottom.get_xlabel()) == ("z", "growth (1/s)")


def test_an_empty_range_is_refused():
    with pytest.raises(ArgumentError, match="two different ends"):
        continue_branch(turning, (1.0, 1.0))


def test_stability_boundary():
    def family(p, q):
        if q > 2:
            raise StateError("too fast to follow.")
        return turning(p - 0.1 * q**2, spin=0.3 + 0.05 * q)

    boundary = stability_boundary(family, (-0.3, 0.5), [0.0, 1.0, 3.0, 2.0], steps=COARSE)
    data = boundary.to_xarray()
    found = data["first_parameter"].values
    assert found == pytest.approx([0, 0.1, np.nan, 0.4], abs=1e-6, nan_ok=True)
    assert set(data["kind"].values) == {"Neimark-Sacker", ""}
    assert data["reason"].values[2] == "too fast to follow."
    assert len(boundary.plot().axes) == 1


class Killed(BaseException):
    """Stands for a crash."""


@pytest.mark.long
@BOTH
@pytest.mark.parametrize("after", [1, 5])
def test_a_killed_run_resumes_on_the_same_branch(tmp_path, after, method):
    path = tmp_path / "branch.nc"
    whole = continue_branch(saddle_node, (1.0, -1.0), steps=COARSE, method=method)
    seen = []

    def kill(item):
        seen.append(item)
        if len(seen) == after:
            raise Killed

    settings = {"system": "saddle node", "speed": 0.2}
    options = {"steps": COARSE, "store": path, "settings": settings, "method": method}
    with pytest.raises(Killed):
        continue_branch(saddle_node, (1.0, -1.0), callback=kill, **options)
    kept = load_branch(path)
    assert kept.stopped.reason == "the run was interrupted"
    assert kept.settings == options["settings"]
    continue_branch(saddle_node, (1.0, -1.0), resume=kept, **options)
    again = load_branch(path)
    assert again.stopped is None
    assert np.array_equal(again.parameters, whole.parameters)
    assert np.array_equal(again.values("y"), whole.values("y"))
    assert [b.parameter for b in again.bifurcations] == [b.parameter for b in whole.bifurcations]
    assert [b.after for b in again.bifurcations] == [b.after for b in whole.bifurcations]
    assert [file.name for file in tmp_path.iterdir()] == ["branch.nc"]


def test_a_finished_branch_is_resumed_without_work():
    whole = continue_branch(saddle_node, (1.0, 0.5), steps=COARSE)
    again = continue_branch(saddle_node, (1.0, 0.5), resume=whole)
    assert again.points == whole.points
    assert again.stopped is None
