"""The numbered figures and tables, each drawn coarsely."""

import pytest

from birdmb.reproduction.__main__ import main
from birdmb.reproduction.figures import DRAWINGS


@pytest.mark.long
@pytest.mark.parametrize("name", DRAWINGS)
def test_drawing(name, tmp_path):
    kind, number = name.split()
    assert main([f"--{kind}", number, "--out", str(tmp_path / "new"), "--coarse"]) == 0
    stem = name.replace(" ", "_").replace(".", "_")
    made = [path for path in (tmp_path / "new").iterdir() if path.stem.startswith(stem)]
    assert made
    assert all(path.stat().st_size > (10_000 if path.suffix == ".png" else 20) for path in made)


def test_the_list_names_all(capsys):
    assert main(["--list"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(DRAWINGS)


def test_an_unknown_figure_is_named(capsys, tmp_path):
    assert main(["--figure", "99.1", "--out", str(tmp_path)]) == 2
    assert "no figure 99.1" in capsys.readouterr().err
