"""What the search for a trim gives up, and what it takes as a last resort."""

from types import SimpleNamespace

import numpy as np
import pytest

from birdmb.errors import OrbitError
from birdmb.studies.trim_equations import give_up_creeping
from birdmb.studies.trim_search import Trial


@pytest.mark.parametrize(("pitch", "steep"), [(10, False), (29, False), (31, True), (-40, True)])
def test_a_body_that_stands_up_is_steep(pitch, steep):
    cycle = SimpleNamespace(mean_pitch=np.radians(pitch))
    assert Trial(np.zeros(1), cycle, {}, np.zeros(1)).steep == steep


@pytest.mark.parametrize(("damping", "creeps"), [(1.0, False), (0.1, False), (0.05, True)])
def test_a_search_that_takes_tiny_steps_is_given_up(damping, creeps):
    step = SimpleNamespace(damping=damping, number=3, residual=0.5)
    if creeps:
        with pytest.raises(OrbitError, match="creeps after 3 steps"):
            give_up_creeping(step)
    else:
        give_up_creeping(step)
