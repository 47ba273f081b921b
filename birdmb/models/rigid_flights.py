"""The flights of the rigid bird, as starts for those of others."""

from __future__ import annotations

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.rigid import RigidModel
from birdmb.models.wake_states import without_memory
from birdmb.orbits import find_limit_cycles
from birdmb.topology import Bird


def rigid_flights(bird: Bird, times: FloatArray) -> FloatArray:
    """States (S, K, 4) of the body at `times` (K,) s in the flights of the rigid bird.

    None where it has no flight, or where the model of the rigid bird does not apply.
    """
    try:
        # In air without a memory, which is where one with a memory leads to in steady flight.
        still = RigidModel(without_memory(bird))
        flights = find_limit_cycles(still, accuracy=1e-3, deflations=4)
    except StateError:
        flights = []
    states = [flight.trajectory(times).states for flight in flights]
    return np.array(states).reshape(len(states), times.size, 4)
