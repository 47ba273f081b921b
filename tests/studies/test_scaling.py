"""Birds of other masses."""

import numpy as np
import pytest

import birdmb
from birdmb.studies.scaling import scale_bird
from birdmb.topology.writing import bird_text
from birdmb.wing.outline import span_and_area


@pytest.fixture(scope="module")
def birds(ibis, ibis_compliant, ibis_tail):
    hinge = {"stiffness": 5.0, "damping": 0.01, "mass": 1e-3}
    return (ibis, ibis_compliant, ibis_tail.with_values({"feathers.5.hinge": hinge}))


@pytest.mark.parametrize("mass", [0.05, 0.4, 4.0])
def test_span_area_and_frequency_follow_the_laws(birds, mass):
    for like in birds:
        bird = scale_bird(like, mass).bird
        span, area = span_and_area(bird)
        assert bird.total_mass == pytest.approx(mass)
        assert span == pytest.approx(1.17 * mass**0.39)
        assert area == pytest.approx(0.16 * mass**0.72)
        assert bird.gait.frequency == pytest.approx(3.87 * mass**-0.33)


def test_what_else_scales(ibis_tail):
    like = ibis_tail.with_joint("shoulder.flap", stiffness=20.0, damping=0.2).with_values(
        {"drag.frontal_area": 0.009}
    )
    bird = scale_bird(like, 8 * like.total_mass).bird
    wider = span_and_area(bird)[0] / span_and_area(like)[0]
    slower = like.gait.frequency / bird.gait.frequency
    joint = bird.joint("shoulder.flap")
    assert joint.stiffness == pytest.approx(20.0 * 8 * wider)
    assert joint.damping == pytest.approx(0.2 * 8 * wider * slower)
    assert bird.tail.chord == pytest.approx(2 * like.tail.chord)
    assert bird.tail.apex.x == pytest.approx(2 * like.tail.apex.x)
    assert bird.tail.opening == like.tail.opening
    assert bird.drag.frontal_area == pytest.approx(4 * 0.009)
    assert bird.body.inertia_yy == pytest.approx(32 * like.body.inertia_yy)


def test_a_scaled_bird_flies(ibis):
    cycle = birdmb.find_limit_cycle(birdmb.RigidModel(scale_bird(ibis, 0.4).bird))
    assert cycle.mean_speed > 5


def test_the_assumptions_are_said(ibis, ibis_compliant):
    text = " ".join(scale_bird(ibis, 0.4).assumptions)
    assert "1.17 m^0.39" in text
    assert "Springs" not in text
    assert "Springs" in " ".join(scale_bird(ibis_compliant, 0.4).assumptions)


@pytest.mark.parametrize("mass", [0.0, -1.0, np.inf, np.nan])
def test_impossible_masses(ibis, mass):
    with pytest.raises(birdmb.BirdmbError, match="mass must be positive"):
        scale_bird(ibis, mass)


def test_a_bird_that_was_written_is_read_as_the_same(birds, tmp_path):
    changed = birds[0].with_values({"forearm.roll.offset": 0.123456789012345, "tail": None})
    for bird in (*birds, changed, scale_bird(birds[2], 0.7).bird):
        bird.save(tmp_path / "bird.toml", about=["A line."])
        assert birdmb.load_bird(tmp_path / "bird.toml") == bird
    text = bird_text(birds[0], ["One.", "Two."])
    assert text.startswith("# One.\n# Two.\n")
    assert "amplitude_deg = 42.0" in text
    assert "axis = [0.0, 1.0, 0.0]" in text
