"""`birdmb schema`: the schema of topology files, or the page on their format."""

import json
from pathlib import Path

from birdmb.topology.schema import topology_schema

PAGE = Path(__file__).parents[2] / "docs" / "format.md"


def test_schema(run, tmp_path):
    printed = run("schema")
    assert printed.exit_code == 0
    assert json.loads(printed.stdout) == topology_schema()
    out = tmp_path / "birdmb.schema.json"
    written = run("schema", "--out", str(out))
    assert written.stdout == f"wrote {out}\n"
    assert out.read_text(encoding="utf-8") == printed.stdout


def test_page(run):
    assert run("schema", "--markdown").stdout == PAGE.read_text(encoding="utf-8")


def test_a_place_that_cannot_be_written_is_said(run, tmp_path):
    failed = run("schema", "--out", str(tmp_path))
    assert failed.exit_code == 2
    assert "cannot be written" in failed.stderr
