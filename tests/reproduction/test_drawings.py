"""The numbered figures and tables, each drawn coarsely."""

import pytest

from birdmb.figures.saving import save_figure
from birdmb.reproduction.__main__ import main
from birdmb.reproduction.figures import DRAWINGS, drawing

from ..figures.seeing import confusable, covered, unlabelled, unreadable


@pytest.mark.long
@pytest.mark.parametrize("name", DRAWINGS)
def test_drawing(name, tmp_path, monkeypatch):
    """In a column: lines that all can tell apart and no legend covers, units on all axes."""
    kept = []

    def save(figure, path):
        kept.append(figure)
        return save_figure(figure, path)

    monkeypatch.setattr(drawing, "save_figure", save)
    kind, number = name.split()
    directory = tmp_path / "new"
    column = ["--width", "90mm", "--coarse", "--out", str(directory)]
    assert main([f"--{kind}", number, *column]) == 0
    for figure in kept:
        assert unlabelled(figure) == []
        assert confusable(figure) == []
        assert covered(figure) == []
        assert unreadable(figure) == []
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
