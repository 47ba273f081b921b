"""What the README shows: its Python example is typed, as are the others; its commands run."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import birdmb

README = Path(__file__).parent.parent / "README.md"
EXAMPLES = README.parent / "examples"


@pytest.mark.long
def test_its_example_and_those_of_the_gallery_type_check(tmp_path):
    pytest.importorskip("mypy")
    found = re.search(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    example = tmp_path / "example.py"
    example.write_text(
        found.group(1)
        + "rigid: birdmb.FlightCycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))\n"
        + "found: list[birdmb.FlightCycle] = birdmb.find_limit_cycles(birdmb.RigidModel(bird))\n",
        encoding="utf-8",
    )
    # Dask has no types.
    others = [each for each in EXAMPLES.glob("*.py") if each.stem != "sweep_dask"]
    assert len(others) >= 10
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent",
         f"--cache-dir={tmp_path}", str(example), *map(str, others)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert checked.returncode == 0, checked.stdout


@pytest.mark.long
def test_from_marker_points_to_multipliers_in_three_commands(tmp_path):
    """What is printed comes back: the gait of the package's pigeon, from which the points are."""
    block = README.read_text(encoding="utf-8").partition("## Fly a bird of your own")[2]
    commands = block.split("```")[1].split("\n")[1:-1]
    assert [command.split()[1] for command in commands] == ["new", "kinematics", "cycle"]
    (tmp_path / "examples").symlink_to(README.parent / "examples")
    for command in commands:
        arguments = command.split()[1:]
        run = [sys.executable, "-m", "birdmb", *arguments]
        done = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
    assert "Floquet multipliers" in done.stdout
    fitted, put_in = birdmb.load_bird(tmp_path / "mine.toml"), birdmb.load_bird("pigeon")
    for joint in put_in.joints:
        found = fitted.joint(joint.name)
        for key in ("offset", "amplitude"):
            # Five of the standard errors that the second command prints, 0.1 degrees at most.
            off = abs(getattr(found, key) - getattr(joint, key))
            assert off < np.radians(0.5), (joint.name, key)
    assert fitted.gait.frequency == pytest.approx(7.0, abs=5e-3)
    assert fitted.body == put_in.body
