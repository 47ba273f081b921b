"""Linear collocation equations on many nodes by a factorisation on few, against a whole one."""

import numpy as np
import pytest

from birdmb.orbits import OdeModel
from birdmb.orbits.collocation import CollocationEquations
from birdmb.orbits.newton import factorise
from birdmb.orbits.right_hand_side import RightHandSide
from birdmb.orbits.two_levels import Factorised

STATES, FEW, MANY = 18, 25, 41


def waving(stiffness):
    """Equations on `FEW` and `MANY` nodes, and derivatives there, of a linear system; T = 1."""
    rng = np.random.default_rng(3)
    mean, wave = rng.standard_normal((2, STATES, STATES))
    mean -= np.diag(np.geomspace(1.0, stiffness, STATES))
    names = tuple(f"x{i}" for i in range(STATES))
    model = OdeModel(lambda _t, x: mean @ x, names, period=1.0, guess=np.zeros(STATES))
    rhs = RightHandSide(model, np.ones(STATES))
    for nodes in (FEW, MANY):
        turn = 2 * np.pi * np.arange(nodes)[:, None, None] / nodes
        along = mean * (1 + 0.3 * np.cos(turn)) + wave * np.sin(3 * turn)
        yield CollocationEquations(rhs, 0.0, 1.0, False, nodes), along


@pytest.mark.parametrize("stiffness", [3.0, 300.0])
def test_a_factorisation_on_few_nodes_solves_on_many(stiffness):
    (few, on_few), (many, on_many) = waving(stiffness)
    solver = Factorised(FEW, factorise(few.assemble(np.zeros(FEW * STATES), on_few))[0])
    unknowns = np.zeros(MANY * STATES)
    whole = many.assemble(unknowns, on_many)
    right = np.random.default_rng(5).standard_normal(unknowns.size)
    product = many.product(unknowns, on_many)
    assert product(right) == pytest.approx(whole @ right, abs=1e-10)
    found = solver.solve_on_more(product, right, on_many, 1e-9)
    assert np.linalg.norm(whole @ found - right) <= 1e-9 * np.linalg.norm(right)
    exact = np.linalg.solve(whole, right)
    assert found == pytest.approx(exact, abs=1e-6 * np.abs(exact).max())


def test_small_systems_and_fewer_nodes_are_left_to_a_factorisation():
    def never(_right):
        raise AssertionError

    (few, on_few), (many, on_many) = waving(3.0)
    product, right = few.product(np.zeros(FEW * STATES), on_few), np.ones(FEW * STATES)
    assert Factorised(9, never).solve_on_more(product, right, on_few, 1e-3) is None
    product, right = many.product(np.zeros(MANY * STATES), on_many), np.ones(MANY * STATES)
    assert Factorised(MANY, never).solve_on_more(product, right, on_many, 1e-3) is None
