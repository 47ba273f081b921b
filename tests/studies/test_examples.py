"""The examples run, print a table and leave a figure."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

import birdmb

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.long
@pytest.mark.parametrize("name", ["bird_wind_tunnel", "bird_perturbed_flight", "bird_level_flight"])
def test_example(name, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", [name, str(tmp_path / "results")])
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")
    assert len(capsys.readouterr().out.splitlines()) >= 4
    (figure,) = (tmp_path / "results").iterdir()
    assert figure.suffix == ".png"
    assert figure.stat().st_size > 10_000


def test_the_tail_of_chapter_6s_program_acts_on_rates_and_flow(ibis_tail):
    """Collocation reads the rates, shooting the flow; the tailless bird's are none of them."""
    program = runpy.run_path(str(EXAMPLES / "chapter6.py"))["ProgramTail"]
    bird = ibis_tail.with_values({"wing.discretisation": 8, "tail.incidence_deg": 0.0})
    model, tailless = program(bird), birdmb.RigidModel(bird.with_values({"tail": None}))
    x, h = model.initial_guess(), 1e-5
    ahead = model.flow(x, 0.01, 0.01 + h)
    np.testing.assert_allclose((ahead - x) / h, model.rhs(0.01 + h / 2, x), rtol=1e-2, atol=1e-2)
    assert np.abs(model.rhs(0.01, x) - tailless.rhs(0.01, x)).max() > 1.0
    times = np.array([0.01])
    (slopes,) = model.rate_jacobians(times, x[None])
    step = np.array([1e-3, 0.0, 0.0, 0.0])
    change = model.rhs(0.01, x + step) - model.rhs(0.01, x - step)
    np.testing.assert_allclose(slopes[:, 0], change / 2e-3, rtol=1e-5, atol=1e-6)
