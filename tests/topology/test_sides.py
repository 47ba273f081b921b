"""Joints whose left and right have values of their own."""

import math

import pytest

import birdmb
from birdmb.studies.relevance import check_relevant
from birdmb.topology.joints import split_side
from birdmb.topology.unused import unused_values
from birdmb.topology.writing import bird_text

FLAP = "shoulder.flap"


def test_a_side_takes_its_own_values_and_the_joints_for_the_rest(ibis_compliant):
    bird = ibis_compliant.with_values(
        {f"{FLAP}.left.stiffness": 12.0, f"{FLAP}.right.amplitude_deg": 40.0}
    )
    own = ibis_compliant.joint(FLAP)
    assert not bird.is_symmetric
    right, left = bird.side("right").joint(FLAP), bird.side("left").joint(FLAP)
    assert (right.stiffness, left.stiffness) == (own.stiffness, 12.0)
    assert right.amplitude == math.radians(40.0)
    assert left.amplitude == own.amplitude
    assert bird.side("left").is_symmetric
    assert bird.value(f"{FLAP}.left.stiffness") == 12.0
    assert bird.value(f"{FLAP}.right.stiffness") == own.stiffness
    assert bird.value(f"{FLAP}.right.amplitude_deg") == pytest.approx(40.0)
    assert bird.value(f"{FLAP}.left.amplitude_deg") == pytest.approx(math.degrees(own.amplitude))
    softer = bird.with_values({f"{FLAP}.stiffness": 15.0})
    assert softer.value(f"{FLAP}.left.stiffness") == 12.0
    assert softer.value(f"{FLAP}.right.stiffness") == 15.0


def test_a_side_that_says_the_same_leaves_the_bird_symmetric(ibis_compliant):
    same = ibis_compliant.with_values({f"{FLAP}.left.stiffness": 20.0})
    assert ibis_compliant.joint(FLAP).stiffness == 20.0
    assert same.is_symmetric
    assert same.with_values({f"{FLAP}.left": None}).fingerprint() == ibis_compliant.fingerprint()
    other = ibis_compliant.with_values({f"{FLAP}.left.stiffness": 12.0})
    assert other.fingerprint() != ibis_compliant.fingerprint()


def test_sides_survive_a_file(ibis_compliant, tmp_path):
    bird = ibis_compliant.with_values(
        {f"{FLAP}.left.stiffness": 12.0, f"{FLAP}.right.offset_deg": 2.0}
    )
    path = tmp_path / "lopsided.toml"
    path.write_text(bird_text(bird))
    assert birdmb.load_bird(path).fingerprint() == bird.fingerprint()


def test_a_file_gives_sides_as_tables(ibis_compliant, tmp_path):
    text = bird_text(ibis_compliant)
    given = text.replace('name = "shoulder.flap"', 'name = "shoulder.flap"\nleft = {damping = 0.3}')
    path = tmp_path / "lopsided.toml"
    path.write_text(given)
    assert birdmb.load_bird(path).side("left").joint(FLAP).damping == 0.3
    path.write_text(given.replace("damping = 0.3", "axis = [1, 0, 0]"))
    with pytest.raises(birdmb.TopologyError, match=r"flap\.left\.axis: axis is the same on both"):
        birdmb.load_bird(path)
    path.write_text(given.replace("damping = 0.3", "damping = -1"))
    with pytest.raises(birdmb.TopologyError, match=r"shoulder\.flap\.left\.damping"):
        birdmb.load_bird(path)


def test_a_spring_on_one_side_makes_the_joint_compliant(ibis):
    with pytest.raises(birdmb.TopologyError, match=r"flap\.stiffness: missing; a compliant joint"):
        ibis.with_values({f"{FLAP}.left.stiffness": 12.0})
    bird = ibis.with_values({f"{FLAP}.left.stiffness": 12.0, f"{FLAP}.right.stiffness": 20.0})
    assert bird.joint(FLAP).mode == "compliant"
    assert bird.side("right").joint(FLAP).stiffness == 20.0


def test_scaling_takes_both_sides_along(ibis_compliant):
    bird = ibis_compliant.with_values({f"{FLAP}.left.stiffness": 10.0})
    scaled = birdmb.scale_bird(bird, 0.4).bird
    left, right = (scaled.value(f"{FLAP}.{side}.stiffness") for side in ("left", "right"))
    assert left / right == pytest.approx(0.5)


def test_values_of_a_side_without_effect_are_known(ibis):
    still = ibis.with_values({f"{FLAP}.left.amplitude": 0.0})
    unused = unused_values(still)
    assert f"{FLAP}.left.phase" in unused
    assert f"{FLAP}.phase" not in unused
    assert f"{FLAP}.right.stiffness" in unused


def test_planar_flight_of_an_asymmetric_bird_is_refused(ibis_compliant):
    bird = ibis_compliant.with_values({f"{FLAP}.left.stiffness": 12.0})
    for model in (birdmb.RigidModel, birdmb.MultibodyModel):
        with pytest.raises(birdmb.TopologyError, match="left and the right wing differ"):
            model(bird)


def test_parts_that_are_called_left_are_not_sides(ibis):
    document = ibis.model_dump()
    document["feathers"][1]["name"] = "left"
    named = birdmb.Bird.model_validate(document)
    check_relevant(named, {"feathers.left.length": [0.2, 0.3]}, birdmb.RigidModel)
    assert split_side("shoulder.left") == ("shoulder.left", "")
    assert split_side("shoulder.left.right") == ("shoulder.left", "right")
    assert split_side("feathers.5.hinge.left") == ("feathers.5.hinge", "left")


def test_what_both_sides_have_of_their_own_leaves_the_joints_unused(ibis_compliant):
    one = ibis_compliant.with_values({f"{FLAP}.left.offset": 0.1, f"{FLAP}.left.stiffness": 12.0})
    both = one.with_values({f"{FLAP}.right.offset": 0.2})
    assert f"{FLAP}.offset" not in unused_values(one)
    assert {f"{FLAP}.offset", f"{FLAP}.offset_deg"} <= unused_values(both).keys()
    assert f"{FLAP}.stiffness" not in unused_values(both)


def test_a_spring_on_a_side_of_a_prescribed_joint_is_refused(ibis):
    with pytest.raises(birdmb.TopologyError) as caught:
        ibis.with_values({f"{FLAP}.left.stiffness": 12.0, f"{FLAP}.mode": "prescribed"})
    assert str(caught.value).endswith(
        "shoulder.flap.left.stiffness: a prescribed joint follows its driver whatever its spring; "
        'leave it out, or give the joint mode = "compliant"'
    )
