"""The studies, coarsely, and the examples that the documentation's gallery does not run.

All others run as the site is built, by `.ci/docs`.
"""

import re
import runpy
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"
STUDIES = sorted(
    path
    for path in (EXAMPLES / "studies").iterdir()
    if path.suffix == ".py" or (path / "__main__.py").exists()
)
WITHOUT_FILES = {"all_birds"}
INTO_A_FILE = {"pigeon_points"}
NEEDS = {"sweep_dask": "dask.distributed"}
OTHERS = [EXAMPLES / f"{name}.py" for name in (*INTO_A_FILE, *NEEDS)]


@pytest.mark.long
@pytest.mark.parametrize("path", [*STUDIES, *OTHERS], ids=lambda path: path.stem)
def test_example(path, tmp_path, monkeypatch, capsys):
    name, out = path.stem, tmp_path / "results"
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    arguments = [] if name in WITHOUT_FILES else [str(out)]
    if name in INTO_A_FILE:
        arguments = [str(out / "points.csv")]
    else:
        arguments.append("--coarse")
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    monkeypatch.setattr(sys, "path", list(sys.path))  # a directory's own modules come before
    runpy.run_path(str(path), run_name="__main__")
    printed = capsys.readouterr().out.splitlines()
    assert len(printed) >= 3 or name in INTO_A_FILE
    if name not in WITHOUT_FILES:
        made = list(out.iterdir())
        assert made
        assert all(each.stat().st_size > 10_000 for each in made if each.suffix == ".png")


def test_the_gallery_runs_what_is_not_run_here():
    settings = (EXAMPLES.parent / "docs" / "conf.py").read_text(encoding="utf-8")
    (left_out,) = re.findall(r'"ignore_pattern": r"(.*)"', settings)
    paths = set(EXAMPLES.rglob("*.py"))
    run_here = {path for path in paths if path in OTHERS or "studies" in path.parts}
    assert {path for path in paths if re.search(left_out, path.as_posix())} == run_here
