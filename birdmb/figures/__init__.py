"""Figures of a bird's limit cycle, for papers and talks.

Each function takes a `FlightCycle` and returns a `matplotlib.figure.Figure`, which `savefig` writes
to a file and a notebook shows as it is; no window and no pyplot is involved.
"""

from birdmb.figures.loads import loads_and_power
from birdmb.figures.multipliers import multipliers
from birdmb.figures.overview import overview
from birdmb.figures.states import states
from birdmb.figures.wing import wing_phases

__all__ = ["loads_and_power", "multipliers", "overview", "states", "wing_phases"]
