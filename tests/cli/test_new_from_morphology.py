"""`birdmb new --from`: a topology file of a bird that was weighed and measured."""

import subprocess
import sys
from pathlib import Path

from birdmb.morphology import bird_from_morphology
from birdmb.topology import load_bird

EXAMPLE = Path(__file__).parents[2] / "examples" / "pigeon_morphology.toml"


def new(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "birdmb", "new", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
    )


def test_the_file_is_the_bird(tmp_path):
    path = tmp_path / "mine.toml"
    done = new(path, "--from", EXAMPLE)
    assert done.returncode == 0, done.stderr
    assert load_bird(path) == bird_from_morphology(EXAMPLE).with_values({"name": "mine"})
    assert "pigeon_morphology.toml" in path.read_text(encoding="utf-8").splitlines()[0]


def test_what_is_no_morphology_file_is_refused(tmp_path):
    done = new(tmp_path / "mine.toml", "--from", tmp_path / "none.toml")
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "none.toml: cannot be read" in done.stderr
    assert "must be a morphology file" in done.stderr
