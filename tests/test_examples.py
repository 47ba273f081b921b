"""The studies, coarsely, and the examples that the documentation's gallery does not run.

All others run as the site is built, by `.ci/docs`.
"""

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
# The same rule is in docs/conf.py.
OTHERS = [
    path
    for path in sorted(EXAMPLES.glob("*.py"))
    if '__name__ == "__main__"' in path.read_text(encoding="utf-8")
]


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


def test_what_the_gallery_leaves_out_is_run_here():
    assert {"pigeon_points", "sweep_dask"} <= {path.stem for path in OTHERS}
    assert "first_flight" not in {path.stem for path in OTHERS}
    settings = (EXAMPLES.parent / "docs" / "conf.py").read_text(encoding="utf-8")
    assert '__name__ == "__main__"' in settings
    assert "/studies/|" in settings
