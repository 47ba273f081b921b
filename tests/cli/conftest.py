import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from birdmb.cli.app import app

TOPOLOGIES = Path(__file__).parents[2] / "topologies"
IBIS = str(TOPOLOGIES / "ibis.toml")
IBIS_TAIL = str(TOPOLOGIES / "ibis_tail.toml")
COMPLIANT = str(TOPOLOGIES / "ibis_compliant_shoulder.toml")
HINGED = str(TOPOLOGIES / "ibis_hinged_feathers.toml")
# Only a process that hangs takes as long, s; one on a busy machine does not.
HANGS = 900
# The answers below do not depend on the model or on its refinement.
QUICK = ("--model", "rigid", "--set", "wing.discretisation=8")

Run = Callable[..., Any]


@pytest.fixture(scope="session")
def run() -> Run:
    """Run the command line with arguments; the result has exit_code, stdout and stderr."""

    def run(*arguments: str) -> Any:
        # 100 columns, whatever terminal the tests run in.
        return CliRunner().invoke(app, arguments, env={"COLUMNS": "100", "TERM": "dumb"})

    return run


@pytest.fixture(scope="session")
def flown(run: Run, tmp_path_factory: pytest.TempPathFactory) -> tuple[Any, dict[str, Any], Path]:
    """A flight with everything written: result of the run, its JSON object, its directory.

    The directory held an older result and a file of the user's before.
    """
    directory = tmp_path_factory.mktemp("flight")
    (directory / "cycle.nc").write_text("old")
    (directory / "notes.txt").write_text("mine")
    result = run("cycle", IBIS, *QUICK, "--out", str(directory), "--json")
    assert result.exit_code == 0, result.stderr
    return result, json.loads(result.stdout), directory
