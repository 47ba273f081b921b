"""How much faster two workers sweep than one: `python benchmarks/sweep.py [--coarse]`.

A sweep of 40 points of the bird with a compliant shoulder, with one worker and with two, start of
the workers included; takes some minutes, with `--coarse` (8 elements a wing, 60 steps a beat) less
than one. Needs a machine with nothing else to do.
"""

import os
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb

COMPLIANT = Path(__file__).parent.parent / "topologies" / "ibis_compliant_shoulder.toml"
VARY = {
    "shoulder.flap.stiffness": np.linspace(60.0, 15.0, 10),
    "shoulder.flap.damping": [0.2, 0.15, 0.1, 0.05],
}


def timed(workers: int, coarse: bool, directory: Path) -> tuple[float, birdmb.Study]:
    """Wall-clock seconds of the sweep, and what it found."""
    bird, model = birdmb.load_bird(COMPLIANT), partial(birdmb.MultibodyModel)
    if coarse:
        bird = bird.with_values({"wing.discretisation": 8})
        model = partial(birdmb.MultibodyModel, steps_per_beat=60)
    began = time.perf_counter()
    study = birdmb.sweep(
        bird, VARY, store=directory / f"{workers}.db", workers=workers, model=model
    )
    return time.perf_counter() - began, study


def main(coarse: bool) -> None:
    """Print the table."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    table = Table(
        "workers", "sweep", "speed-up", "busy", "warm point", "from", "cold point", "failed"
    )
    with tempfile.TemporaryDirectory() as directory:
        runs = [timed(workers, coarse, Path(directory)) for workers in (1, 2)]
    for workers, (seconds, study) in enumerate(runs, 1):
        data = study.to_xarray(timings=True)
        warm = data.seconds.values[(data.start != "cold").values]
        cold = data.seconds.values[(data.start == "cold").values]
        table.add_row(
            str(workers),
            f"{seconds:.1f} s",
            f"{runs[0][0] / seconds:.2f}",
            f"{data.seconds.values.sum() / (workers * seconds):.0%}",
            f"{np.median(warm):.2f} s",
            f"{warm.min():.2f} to {warm.max():.2f} s",
            f"{np.median(cold):.2f} s",
            str(len(study.failures)),
        )
    console = Console()
    console.print(table)
    same = runs[0][1].to_xarray().identical(runs[1][1].to_xarray())
    console.print(f"bitwise the same: {'yes' if same else 'NO'}; load when begun: {load:.1f}")


if __name__ == "__main__":
    main("--coarse" in sys.argv[1:])
