"""The README's Python example: its types are right, so that editors complete it."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

README = Path(__file__).parent.parent / "README.md"


@pytest.mark.long
def test_the_example_type_checks(tmp_path):
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
    checked = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent",
         f"--cache-dir={tmp_path}", str(example)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert checked.returncode == 0, checked.stdout
