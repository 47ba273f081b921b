"""
What goes wrong, and what is said
=================================

Every deliberate error is a ``BirdmbError`` whose text is a sentence for the user.
"""

from collections.abc import Callable

import birdmb
from birdmb import (
    ArgumentError,
    BirdmbError,
    ConvergenceError,
    DataFileError,
    OrbitError,
    StateError,
    TopologyError,
)

bird = birdmb.load_bird("ibis").with_values({"wing.discretisation": 6})
model = birdmb.RigidModel(bird)


def said(kind: type[BirdmbError], action: Callable[[], object]) -> None:
    """Print the sentence of the error that an action ends in."""
    try:
        action()
    except kind as error:
        print(f"{type(error).__name__}: {error}")


# %%
# A bird that cannot be, and a name that it does not have.

said(TopologyError, lambda: birdmb.load_bird("ibis").with_values({"body.mass": -1.0}))
said(TopologyError, lambda: birdmb.load_bird("ibiss"))

# %%
# Arguments that are wrong by themselves or contradict each other.

said(ArgumentError, lambda: birdmb.find_limit_cycle(model, nodes=24))

# %%
# A search that found nothing, and a flow that left what the model means anything for.

said(ConvergenceError, lambda: birdmb.find_limit_cycle(model, max_iterations=1, segments=1))
said(StateError, lambda: model.flow([float("nan"), 0.0, 0.0, 0.0], 0.0, bird.period))

# %%
# Searches that end elsewhere than on an orbit are told apart.

resting = birdmb.OdeModel(lambda _t, s: [-s[0], -s[1]], ("x", "y"), guess=[1.0, 0.0])
said(OrbitError, lambda: birdmb.find_limit_cycle(resting, period_guess=1.0))

# %%
# Files that are not there, or hold something else.

said(DataFileError, lambda: birdmb.load_cycle("cycle_of_yesterday.nc"))
