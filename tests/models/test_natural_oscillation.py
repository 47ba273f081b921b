"""How a compliant joint swings by itself."""

import math

import pytest

from birdmb.models.natural_oscillation import joint_oscillation


def test_inertia_of_a_straight_wing_about_the_flap_axis(ibis_compliant):
    straight = {f"{joint}.offset": 0.0 for joint in ibis_compliant.joint_names}
    bird = ibis_compliant.with_values(straight)
    free = joint_oscillation(bird, bird.joint("shoulder.flap"))
    expected, reached = 0.0, 0.0
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        expected += segment.inertia[0][0] + segment.mass * (reached + segment.length / 2) ** 2
        reached += segment.length
    assert free.inertia == pytest.approx(expected, rel=1e-12)
    assert free.frequency == pytest.approx(math.sqrt(20 / expected) / (2 * math.pi))
