"""Sweeps: limit cycles over a grid of parameters, in parallel, kept point by point in a store.

`grid` says which points there are and which neighbour each starts from, `point` computes one,
`store` keeps it, `workers` are the processes, `run` brings them together; `study` is what has been
found.
"""

from birdmb.studies.sweeps.errors import SweepError
from birdmb.studies.sweeps.run import Finished, sweep
from birdmb.studies.sweeps.settings import Trimming
from birdmb.studies.sweeps.study import Study

__all__ = ["Finished", "Study", "SweepError", "Trimming", "sweep"]
