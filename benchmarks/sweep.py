"""What a point of a sweep costs, and how much faster two workers are than one.

`python benchmarks/sweep.py [--coarse] [--point]`: evaluations of the right-hand side and
processor time of warm-started points of the bird with a compliant shoulder, one by one in this
process; then, unless `--point` is given, a sweep of 40 points with one worker and with two, start
of the workers included; `--coarse`: with 8 elements a wing. The sweep needs a machine with nothing
else to do.
"""

import os
import sys
import tempfile
import time
from concurrent.futures import Executor, Future
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.studies.sweeps.tasks import Outcome, Task

COMPLIANT = Path(__file__).parent.parent / "topologies" / "ibis_compliant_shoulder.toml"
VARY = {
    "shoulder.flap.stiffness": np.linspace(60.0, 15.0, 10),
    "shoulder.flap.damping": [0.2, 0.15, 0.1, 0.05],
}


# Apart as in a map of 20 x 20.
ROW = {
    "shoulder.flap.stiffness": [20.0],
    "shoulder.flap.damping": np.linspace(0.2, 0.13, 8),
}


def prepared(
    coarse: bool, kind: type[birdmb.MultibodyModel]
) -> tuple[birdmb.Bird, partial[birdmb.MultibodyModel]]:
    """The bird and what makes its model."""
    bird = birdmb.load_bird(COMPLIANT)
    if not coarse:
        return bird, partial(kind)
    return bird.with_values({"wing.discretisation": 8}), partial(kind)


def timed(workers: int, coarse: bool, directory: Path) -> tuple[float, birdmb.Study]:
    """Wall-clock seconds of the sweep, and what it found."""
    bird, model = prepared(coarse, birdmb.MultibodyModel)
    began = time.perf_counter()
    study = birdmb.sweep(
        bird, VARY, store=directory / f"{workers}.db", workers=workers, model=model
    )
    return time.perf_counter() - began, study


class Counting(birdmb.MultibodyModel):
    """The multibody model, counting at how many instants its right-hand side was evaluated."""

    instants = 0

    def rates(self, times: np.ndarray, states: np.ndarray) -> np.ndarray:
        """As the multibody model's."""
        type(self).instants += len(times)
        return super().rates(times, states)


class Timed(Executor):
    """Computes points in this process and tells what each cost."""

    def __init__(self) -> None:
        """Nothing is known yet."""
        self.costs: list[tuple[Task, Outcome, int, float]] = []

    def submit(self, function: Any, task: Task, /) -> Future[Outcome]:
        """Compute at once."""
        instants, began = Counting.instants, time.process_time()
        outcome = function(task)
        seconds = time.process_time() - began
        self.costs.append((task, outcome, Counting.instants - instants, seconds))
        future: Future[Outcome] = Future()
        future.set_result(outcome)
        return future


def points(coarse: bool, directory: Path) -> Table:
    """Cost of each of a row of warm points."""
    (bird, model), executor = prepared(coarse, Counting), Timed()
    birdmb.sweep(bird, ROW, store=directory / "row.db", executor=executor, model=model)
    table = Table("stiffness, damping", "instants", "nodes", "processor time")
    warm = [cost for cost in executor.costs if cost[1].start != "cold"]
    for task, outcome, instants, seconds in warm:
        assert outcome.result is not None
        values = ", ".join(f"{value:g}" for value in task.values.values())
        nodes = str(outcome.result["nodes"])
        table.add_row(values, str(instants), nodes, f"{1e3 * seconds:.0f} ms")
    instants, seconds = np.median([cost[2:] for cost in warm], axis=0)
    table.add_row("median", f"{instants:.0f}", "", f"{1e3 * seconds:.0f} ms", style="bold")
    return table


def main(coarse: bool, point_only: bool) -> None:
    """Print the tables."""
    console = Console()
    with tempfile.TemporaryDirectory() as directory:
        console.print(points(coarse, Path(directory)))
    if point_only:
        return
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
    console.print(table)
    same = runs[0][1].to_xarray().identical(runs[1][1].to_xarray())
    console.print(f"bitwise the same: {'yes' if same else 'NO'}; load when begun: {load:.1f}")


if __name__ == "__main__":
    main("--coarse" in sys.argv[1:], "--point" in sys.argv[1:])
