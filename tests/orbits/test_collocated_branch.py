"""Branches by collocation: nodes by need, resumed bit for bit, shooting where it is too rough."""

import itertools

import numpy as np
import pytest
from test_continuation import duffing

from birdmb.orbits import OdeModel, Steps, continue_branch, find_limit_cycle, floquet, load_branch

STEPS = Steps(longest=0.3)
# Between what 25 nodes leave of the small orbits and of the large ones.
ACCURACY = 1e-9


@pytest.fixture(scope="module")
def resonance():
    """Duffing's curve from the small orbits over both folds to the large ones, and down again."""
    return continue_branch(duffing, (1.6, 1.2), steps=STEPS, accuracy=ACCURACY)


def test_nodes_grow_with_the_orbits_and_shrink_with_them(resonance):
    nodes = [point.nodes for point in resonance.points]
    assert nodes[0] < nodes[-1]
    assert all(0 < point.state_error <= ACCURACY for point in resonance.points)
    last = resonance.points[-1]
    back = continue_branch(duffing, (1.2, 1.6), last.points, steps=STEPS, accuracy=ACCURACY)
    assert back.points[0].nodes == nodes[-1]
    assert back.points[-1].nodes == nodes[0]
    # near the fold there is another change up and down, but no to and fro
    assert sum(a != b for a, b in itertools.pairwise(nodes)) <= 3


def test_the_arclength_does_not_depend_on_the_nodes(resonance):
    """The inner product is a mean: a tangent is a unit vector on any number of nodes."""
    for point in resonance.points:
        states, others = np.split(point.tangent, [point.points.size])
        assert states @ states / len(point.points) + others @ others == pytest.approx(1, abs=1e-7)


@pytest.mark.parametrize("known", [5, 14])
def test_a_branch_whose_nodes_change_is_resumed_bit_for_bit(resonance, tmp_path, known):
    continue_branch(duffing, (1.6, 1.2), steps=STEPS, accuracy=ACCURACY, max_points=known).save(
        tmp_path / "b.nc"
    )
    kept = load_branch(tmp_path / "b.nc")
    again = continue_branch(duffing, (1.6, 1.2), steps=STEPS, accuracy=ACCURACY, resume=kept)
    assert [b.parameter for b in again.bifurcations] == [
        b.parameter for b in resonance.bifurcations
    ]
    for one, other in zip(again.points, resonance.points, strict=True):
        assert (one.parameter, one.nodes) == (other.parameter, other.nodes)
        assert np.array_equal(one.points, other.points)
        assert np.array_equal(one.tangent, other.tangent)
        assert np.array_equal(one.multipliers, other.multipliers)


def test_what_is_saved_has_each_orbit_on_its_own_nodes(resonance, tmp_path):
    resonance.save(tmp_path / "branch.nc")
    kept = load_branch(tmp_path / "branch.nc")
    everything = [*resonance.points, *(found.point for found in resonance.bifurcations)]
    loaded = [*kept.points, *(found.point for found in kept.bifurcations)]
    assert len({point.nodes for point in everything}) > 1
    for one, other in zip(loaded, everything, strict=True):
        assert np.array_equal(one.points, other.points)
        assert np.array_equal(one.tangent, other.tangent)
        assert (one.method, one.state_error) == (other.method, other.state_error)


def test_each_orbit_is_had_again_by_either_method(resonance):
    point = resonance.points[-1]
    model = duffing(point.parameter)
    flown = floquet(model, point.points, segments=len(point.points))
    errors = point.multiplier_errors + flown.multiplier_errors
    assert (np.abs(flown.multipliers - point.multipliers) <= errors).all()
    found = find_limit_cycle(model, point.points, nodes=point.nodes)
    assert found.points == pytest.approx(point.points, abs=1e-8)


def rough(p):
    """x' = p |cos t| - x: a kink in the slope at any p but 0, and an orbit proportional to p."""
    return OdeModel(
        lambda t, x: p * np.abs(np.cos(t)) - x,
        ("x",),
        period=2 * np.pi,
        guess=[0.0],
        state_scale=[1.0],
        rtol=1e-10,
    )


# The integral of e^s |cos s| over all s up to 0.
AT_START = 0.5 + np.exp(np.pi / 2) / np.expm1(np.pi)


def test_where_orbits_become_rough_shooting_goes_on():
    branch = continue_branch(rough, (0.0, 1.0), accuracy=1e-9)
    assert branch.stopped is None
    methods = [point.method for point in branch.points]
    assert (methods[0], methods[-1]) == ("collocation", "shooting")
    assert branch.points[-1].points[0, 0] == pytest.approx(AT_START, abs=1e-8)
    # the multiplier is exp(-2 pi) by either
    for point in branch.points:
        assert abs(point.multipliers[0] - np.exp(-2 * np.pi)) <= point.multiplier_errors[0]


def test_a_collocated_branch_that_becomes_rough_says_so():
    branch = continue_branch(rough, (0.0, 1.0), accuracy=1e-9, method="collocation")
    assert branch.stopped.reason == "the orbits became too rough for collocation"
    assert "its error is still" in str(branch.stopped)


def test_shooting_takes_the_starts_of_its_segments_of_a_path(resonance):
    model = duffing(1.2)
    cycle = find_limit_cycle(model, resonance.points[-1].points, nodes=45)
    for segments in (1, 9):
        shot = find_limit_cycle(model, cycle.points, segments=segments)
        assert shot.points == pytest.approx(cycle.points[:: 45 // segments], abs=1e-7)
