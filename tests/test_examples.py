"""All examples run, into a directory that is not there yet; the long ones coarsely."""

import runpy
import sys
from pathlib import Path

import pytest

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
