"""Changes of stability that no sign of a test function shows, at exact parameters."""

import itertools
from typing import NamedTuple

import numpy as np
import pytest
import scipy.linalg

from birdmb.errors import OrbitError
from birdmb.orbits import BranchPoint, OdeModel, Steps, continue_branch, stability_boundary
from birdmb.orbits.bifurcations import Neutral, counts_outside
from birdmb.orbits.locating import Chord, locate, outside_after

PERIOD = 2 * np.pi
COARSE = Steps(first=0.05, longest=0.2)


class Linear:
    """x' = A x with A of diagonal blocks, in closed form; multipliers exp(2 pi lambda)."""

    period = PERIOD

    def __init__(self, *blocks):
        self.blocks = blocks
        size = sum(1 if isinstance(block, float) else len(block) for block in blocks)
        self.state_names = tuple(f"x{i}" for i in range(size))
        self.state_scale = np.ones(size)

    def initial_guess(self):
        return np.zeros(len(self.state_names))

    def flow(self, x0, t0, t1):
        flows = [exponential(block, t1 - t0) for block in self.blocks]
        return scipy.linalg.block_diag(*flows) @ x0


def exponential(block, t):
    """Exponential of one block times t: a real number, or a `Spiral`."""
    if isinstance(block, float):
        return np.exp(block * t)
    c, s = np.cos(block.spin * t), np.sin(block.spin * t)
    return np.exp(block.growth * t) * np.array([[c, -s], [s, c]])


class Spiral(NamedTuple):
    """A block with the multipliers exp(2 pi (growth +- i spin))."""

    growth: float
    spin: float


def located(family, ends=(-0.31, 0.17), **options):
    branch = continue_branch(family, ends, steps=COARSE, **options)
    assert branch.stopped is None
    for found in branch.bifurcations:
        assert branch.parameters[found.after] <= found.parameter + 1e-6
    return branch.bifurcations


def at(found, parameter):
    """Whether a bifurcation is where it should be, within an error bound that says something."""
    assert abs(found.parameter - parameter) < 1e-6
    assert abs(found.parameter - parameter) <= found.parameter_error < 1e-4
    return True


def test_two_copies_of_one_system_lose_stability_together():
    def family(p):
        def rhs(t, x):
            return (p + 0.3 * np.cos(t)) * x - x**3

        def jacobian(t, x):
            return np.diag(p + 0.3 * np.cos(t) - 3 * x**2)

        return OdeModel(
            rhs, ("x", "y"), period=PERIOD, jacobian=jacobian, guess=[0, 0], state_scale=[1, 1]
        )

    branch = continue_branch(family, (-0.5, 0.5), steps=COARSE)
    (found,) = branch.bifurcations
    assert at(found, 0.0)
    assert found.kind == "multiple"
    assert found.multipliers == pytest.approx([1, 1], abs=1e-5)
    assert found.outside == (0, 2)
    assert found.changes_stability
    stabilities = [point.stability for point in branch.points]
    assert stabilities[found.after] == "stable"
    assert stabilities[found.after + 1] == "unstable"


def test_three_copies():
    """An odd number shows in a sign, which tells of one."""
    (found,) = located(lambda p: Linear(p, p, p))
    assert at(found, 0.0)
    assert (found.kind, found.outside) == ("multiple", (0, 3))
    assert found.multipliers == pytest.approx([1, 1, 1], abs=1e-5)


def test_neimark_sacker_beside_a_conservative_pair():
    (found,) = located(lambda p: Linear(Spiral(p, 0.4), Spiral(0.0, 0.3 + 0.1 * p)))
    assert at(found, 0.0)
    assert found.kind == "Neimark-Sacker"
    assert np.abs(np.angle(found.multipliers)) == pytest.approx(0.8 * np.pi, abs=1e-5)
    assert found.outside == (0, 2)


@pytest.mark.parametrize(("spin", "multiplier"), [(0.5, -1.0), (1.0, 1.0)])
def test_a_pair_that_crosses_at_a_strong_resonance(spin, multiplier):
    (found,) = located(lambda p: Linear(Spiral(p, spin)))
    assert at(found, 0.0)
    assert found.kind == "multiple"
    assert found.multipliers == pytest.approx([multiplier] * 2, abs=1e-5)
    assert found.outside == (0, 2)


def test_two_pairs_of_one_frequency():
    (found,) = located(lambda p: Linear(Spiral(p, 0.3), Spiral(p, 0.3), -0.2))
    assert at(found, 0.0)
    assert (found.kind, found.outside) == ("multiple", (0, 4))


def test_two_of_one_kind_between_two_points_are_two():
    inner, outer = located(lambda p: Linear(p, p - 0.002, -0.1))
    assert at(inner, 0.0)
    assert at(outer, 0.002)
    assert [found.kind for found in (inner, outer)] == ["branch point"] * 2
    assert [found.outside for found in (inner, outer)] == [(0, 1), (1, 2)]
    assert [found.changes_stability for found in (inner, outer)] == [True, False]


def test_a_pair_goes_out_while_a_real_one_comes_in():
    inwards, outwards = located(lambda p: Linear(Spiral(p - 0.003, 0.3), -2 * p))
    assert at(inwards, 0.0)
    assert at(outwards, 0.003)
    assert [found.kind for found in (inwards, outwards)] == ["branch point", "Neimark-Sacker"]
    assert [found.outside for found in (inwards, outwards)] == [(1, 0), (0, 2)]


def test_multipliers_that_stay_on_the_circle_are_no_bifurcations():
    """Their moduli change sides by less than their error bounds."""

    def family(p):
        return Linear(1e-13 * np.sin(40 * p), p - 0.4, Spiral(1e-13 * np.cos(30 * p), 0.2))

    assert located(family) == ()


def test_orbits_that_are_one_of_a_family_are_said():
    with pytest.raises(OrbitError, match="one of a continuous family"):
        continue_branch(lambda p: Linear(0.0, p, -0.2), (-0.3, 0.2))


class Reversible:
    """A map whose multipliers are the zeros z of s^2 - s + 1/4 + p, s = z + 1/z.

    Two pairs on the circle meet at p = 0 and leave it as a quadruple (Krein).
    """

    state_names, period, state_scale = tuple("abcd"), 1.0, np.ones(4)

    def __init__(self, p):
        self.matrix = scipy.linalg.companion([1.0, -1.0, 2.25 + p, -1.0, 1.0])

    def flow(self, x0, _t0, _t1):
        return self.matrix @ x0


def test_conservative_pairs_that_meet_and_leave_the_circle():
    found = located(Reversible, (-0.05, 0.06), guess=np.zeros(4))
    assert [bifurcation.outside for bifurcation in found] == [(0, 2)]
    assert abs(found[0].parameter) <= found[0].parameter_error < 1e-3


def test_the_boundary_is_where_stability_changes():
    """The first of two multipliers that come in leaves the orbit unstable."""

    def family(p, q):
        return Linear(-p, q - p, -1.0)

    boundary = stability_boundary(family, (-0.3, 0.5), [0.0, 0.1, 0.2], steps=COARSE)
    found = boundary.to_xarray()["first_parameter"].values
    assert found == pytest.approx([0.0, 0.1, 0.2], abs=1e-6)


def made_up(parameter, families, noise):
    """A point of a branch without a flow: multipliers exp(slope (p - at)) in copies."""
    values = []
    for where, slope, at_, copies, angle in families:
        for _ in range(copies):
            modulus = np.exp(slope * (parameter - at_) + 1e-12 * noise.standard_normal())
            turned = modulus * np.exp(1j * angle)
            values += [turned, turned.conjugate()] if where == "pair" else [where * modulus + 0j]
    multipliers = np.array(values)
    multipliers = multipliers[np.lexsort((-multipliers.imag, -np.abs(multipliers)))]
    return BranchPoint(
        parameter=parameter,
        period=1.0,
        points=np.zeros((1, len(values))),
        residual=0.0,
        multipliers=multipliers,
        multiplier_errors=np.full(len(values), 1e-10),
        trivial_index=None,
        stability="stable",
        tangent=np.array([0.0, 1.0]),
        next_step=0.1,
    )


@pytest.mark.parametrize("seed", range(40))
def test_every_crossing_of_made_up_multipliers_is_located(seed):
    """Real ones and pairs in one to three copies, all outwards: none cancels another."""
    chance, noise = np.random.default_rng(seed), np.random.default_rng(seed + 1000)
    families = [
        (
            (1, -1, "pair")[chance.integers(3)],
            chance.uniform(0.5, 3),
            chance.uniform(-0.5, 2.5),
            chance.integers(1, 4),
            chance.uniform(0.3, 2.8),
        )
        for _ in range(chance.integers(1, 5))
    ]
    families.append(("pair", 0.0, 0.0, chance.integers(0, 2), 1.0))  # conservative
    points = [made_up(p, families, noise) for p in np.linspace(0, 2, chance.integers(2, 12))]
    neutral = Neutral.of(points[0])
    outside, found = counts_outside(points[0], neutral), []
    for i, (before, after) in enumerate(itertools.pairwise(points)):
        earlier, neutral = neutral, neutral.still(after)
        chord = Chord(
            before,
            after,
            after.parameter - before.parameter,
            2.0,
            lambda s, start=before.parameter: made_up(start + s, families, noise),
        )
        located = locate(chord, i, outside, neutral, earlier)
        outside = outside_after(outside, located, after, neutral)
        found += located
    exact = sorted(
        (at_, copies * (1 + (where == "pair")))
        for where, slope, at_, copies, _ in families
        if slope and 0 < at_ < 2
    )
    assert [bifurcation.parameter for bifurcation in found] == pytest.approx(
        [at_ for at_, _ in exact], abs=1e-6
    )
    assert [bifurcation.crossing.sum() for bifurcation in found] == [n for _, n in exact]
    for bifurcation, (at_, number) in zip(found, exact, strict=True):
        assert abs(bifurcation.parameter - at_) <= bifurcation.parameter_error
        assert bifurcation.outside[1] - bifurcation.outside[0] == number
