"""What is wrong with a sweep as it is asked for, told before anything is computed or stored."""

from __future__ import annotations

import os
import pickle

from birdmb.studies.cycles import ModelFactory
from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.grid import Grid, overlap
from birdmb.studies.sweeps.settings import Trimming
from birdmb.topology import Bird

_PROCESSES_PER_CORE = 32


def check_trimming(bird: Bird, grid: Grid, trimming: Trimming) -> None:
    """Refuse a trim by values that the bird has not, or that are varied.

    Raises:
        TopologyError: the bird has no value of that name.
        SweepError: it is varied, too.
    """
    for name in trimming.parameters:
        bird.value(name)
        for varied in grid.parameters:
            if overlap([name, varied]):
                also = "" if name == varied else f" (as {varied})"
                raise SweepError(
                    f"{name} cannot be both varied{also} and trimmed: take one of the two away."
                )


def check_processes(bird: Bird, model: ModelFactory, workers: int | None) -> None:
    """Refuse a number of processes that cannot be meant, and a model that they cannot be sent.

    Raises:
        SweepError: either of the two.
    """
    cores = os.cpu_count() or 1
    if workers is not None and not 1 <= workers <= _PROCESSES_PER_CORE * cores:
        raise SweepError(
            f"{workers} workers are asked for; give 1 to {_PROCESSES_PER_CORE * cores} here (there "
            f"is work for one on each of the {cores} cores), or a cluster's executor."
        )
    try:
        pickle.dumps((bird, model))
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise SweepError(
            f"The model of a sweep cannot be sent to other processes ({error}); use functions and "
            f"classes that can be imported, or an executor of threads."
        ) from error
