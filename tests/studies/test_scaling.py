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


def test_what_is_given_goes_before_the_laws(birds):
    """The robin-sized task of a user: a mass, a span and a frequency of his own."""
    for like in birds:
        bird = scale_bird(like, 0.35, span=0.65, frequency=7.0).bird
        span, area = span_and_area(bird)
        assert (bird.total_mass, span, bird.gait.frequency) == pytest.approx((0.35, 0.65, 7.0))
        by_law = (1.17 * 0.35**0.39) ** 2 / (0.16 * 0.35**0.72)
        assert span**2 / area == pytest.approx(by_law)


@pytest.mark.parametrize("given", [{"span": 0.9}, {"frequency": 6.0}])
def test_a_mass_that_is_not_given_follows_from_the_rest(ibis, given):
    bird = scale_bird(ibis, **given).bird
    mass = bird.total_mass
    laws = {"span": 1.17 * mass**0.39, "frequency": 3.87 * mass**-0.33}
    for name, value in given.items():
        assert laws[name] == pytest.approx(value)
    assert span_and_area(bird)[0] == pytest.approx(laws["span"])
    assert bird.gait.frequency == pytest.approx(laws["frequency"])


def test_a_wing_of_sections_and_what_is_attached_scale_too():
    gull = birdmb.load_bird("gull_glider")
    payload = {"name": "payload", "on": "body", "mass": 0.05, "position": [0.02, 0.0, 0.01]}
    document = gull.model_dump(exclude_unset=True) | {"attachments": [payload]}
    like = birdmb.Bird.model_validate(document)
    bird = scale_bird(like, 8 * like.total_mass).bird
    assert span_and_area(bird) == pytest.approx(
        (1.17 * bird.total_mass**0.39, 0.16 * bird.total_mass**0.72)
    )
    assert bird.attachments[0].mass == pytest.approx(0.4)
    assert bird.attachments[0].position == pytest.approx((0.04, 0.0, 0.02))


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


@pytest.mark.parametrize(
    ("mass", "wanted"),
    [*((mass, "positive, in kg") for mass in (0.0, -1.0, np.inf)), (np.nan, "a number")],
)
def test_impossible_masses(ibis, mass, wanted):
    with pytest.raises(birdmb.ArgumentError, match=f"mass must be {wanted}, not"):
        scale_bird(ibis, mass)


def test_a_scaling_to_nothing_in_particular(ibis):
    with pytest.raises(birdmb.ArgumentError, match="give the mass, the span or the frequency"):
        scale_bird(ibis)


def test_a_bird_that_was_written_is_read_as_the_same(birds, tmp_path):
    changed = birds[0].with_values({"forearm.roll.offset": 0.123456789012345, "tail": None})
    for bird in (*birds, changed, scale_bird(birds[2], 0.7).bird):
        bird.save(tmp_path / "bird.toml", about=["A line."])
        assert birdmb.load_bird(tmp_path / "bird.toml") == bird
    text = bird_text(birds[0], ["One.", "Two."])
    assert text.startswith("# One.\n# Two.\n")
    assert "amplitude_deg = 42.0" in text
    assert "axis = [0.0, 1.0, 0.0]" in text
