"""The examples run, print a table and leave a figure."""

import runpy
import sys
from pathlib import Path

import pytest

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
