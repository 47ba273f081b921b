"""What the memory of the air does to stability: the same birds in air with a memory and without.

`python examples/studies/air_with_memory [DIR] [--coarse] [--only PART ...]` prints the tables of
docs/memory.md and draws its pictures into DIR (default results/), where the tables go as CSV.
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from flights import flights, refinement
from frequency import frequency
from openings import openings
from report import Report
from rich.console import Console
from shoulder import shoulder

PARTS = {each.__name__: each for each in (flights, refinement, frequency, openings, shoulder)}


def main(out: Path, parts: Sequence[str], *, coarse: bool) -> None:
    """Print the tables, and draw the pictures."""
    out.mkdir(parents=True, exist_ok=True)
    report = Report(out, coarse, Console(width=150))
    for part in parts:
        PARTS[part](report)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few flights, coarse wings: quick")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="these parts")
    options = parser.parse_args()
    main(options.directory, options.only, coarse=options.coarse)
