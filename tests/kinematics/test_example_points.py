"""The table of points that the README's commands read is what its script writes."""

import csv
import runpy
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).parents[2] / "examples"


def table(path):
    with path.open(encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return header, np.array([[float(cell or "nan") for cell in row] for row in rows])


def test_the_shipped_points_are_those_of_the_script(tmp_path):
    script = runpy.run_path(str(EXAMPLES / "pigeon_points.py"))
    script["main"](tmp_path / "points.csv")
    made, shipped = table(tmp_path / "points.csv"), table(EXAMPLES / "pigeon_points.csv")
    assert made[0] == shipped[0]
    np.testing.assert_allclose(made[1], shipped[1], atol=1.5e-4)  # of the last digit
