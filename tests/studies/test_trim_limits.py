"""What the search for a trim takes as a last resort."""

from types import SimpleNamespace

import numpy as np
import pytest

from birdmb.studies.trim_search import Trial


@pytest.mark.parametrize(("pitch", "steep"), [(10, False), (29, False), (31, True), (-40, True)])
def test_a_body_that_stands_up_is_steep(pitch, steep):
    cycle = SimpleNamespace(mean_pitch=np.radians(pitch))
    assert Trial(np.zeros(1), cycle, {}, np.zeros(1)).steep == steep
