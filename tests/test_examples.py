"""All examples run, into a directory that is not there yet; the long ones coarsely."""

import runpy
import sys
from pathlib import Path

import numpy as np
import pytest

import birdmb

EXAMPLES = Path(__file__).parents[1] / "examples"
WITHOUT_FILES = {"birds"}
INTO_A_FILE = {"pigeon_points"}
NEEDS = {"sweep_dask": "dask.distributed"}


@pytest.mark.long
@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_example(path, tmp_path, monkeypatch, capsys):
    name, out = path.stem, tmp_path / "results"
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    target = out / "points.csv" if name in INTO_A_FILE else out
    arguments = [] if name in WITHOUT_FILES else [str(target)]
    if "--coarse" in path.read_text(encoding="utf-8"):
        arguments.append("--coarse")
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    runpy.run_path(str(path), run_name="__main__")
    printed = capsys.readouterr().out.splitlines()
    assert len(printed) >= 3 or name in INTO_A_FILE
    if name not in WITHOUT_FILES:
        made = list(out.iterdir())
        assert made
        assert all(each.stat().st_size > 10_000 for each in made if each.suffix == ".png")


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
