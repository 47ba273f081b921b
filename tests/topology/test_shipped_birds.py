"""The topology files say what their comments and the published gait say."""

import math
import pickle

import numpy as np
import pytest

from birdmb.topology import Apex, Drag, Tail, load_bird

BONES = ("humerus", "forearm", "hand")

NAMES = (
    "ibis",
    "ibis_massless",
    "ibis_compliant_shoulder",
    "ibis_hinged_feathers",
    "ibis_tail",
    "ibis_thesis_ch8",
)

# joint: axis, offset, amplitude and phase in degrees
GAIT = {
    "shoulder.pitch": ((0, 1, 0), math.degrees(0.2), math.degrees(0.014), -90),
    "shoulder.flap": ((-1, 0, 0), 0, 42, 180),
    "shoulder.sweep": ((0, 0, -1), -19, 20, 90),
    "elbow.sweep": ((0, 0, -1), 30, 30, -90),
    "forearm.roll": ((0, 1, 0), 0, 30, -90),
    "wrist.sweep": ((0, 0, -1), -30, 30, 90),
}


@pytest.fixture
def birds(topologies):
    return {name: load_bird(topologies / f"{name}.toml") for name in NAMES}


def test_every_file_is_named_after_its_bird(topologies):
    names = {path.stem: load_bird(path).name for path in topologies.glob("*.toml")}
    assert names.keys() > set(NAMES)
    assert list(names) == list(names.values())


def test_gait(ibis):
    assert ibis.joint_names == tuple(GAIT)
    for name, (axis, *degrees) in GAIT.items():
        joint = ibis.joint(name)
        assert joint.axis == axis
        driver = (joint.offset, joint.amplitude, joint.phase)
        np.testing.assert_allclose(np.degrees(driver), degrees, rtol=1e-15)
        assert joint.twist == (name == "forearm.roll")
    assert ibis.period == 0.25
    assert ibis.compliant_joints == ()


def test_masses(birds):
    assert birds["ibis"].total_mass == pytest.approx(1.26)
    assert birds["ibis_massless"].total_mass == pytest.approx(1.2 + 6e-5)


@pytest.mark.parametrize("name", ["ibis", "ibis_massless", "ibis_compliant_shoulder"])
@pytest.mark.parametrize("bone", BONES)
def test_inertia_is_that_of_a_round_bar(birds, name, bone):
    segment = getattr(birds[name].segments, bone)
    m, length, r = segment.mass, segment.length, 0.01
    across = m * length**2 / 12 + m * r**2 / 4
    expected = np.diag([across, m * r**2 / 2, across])
    np.testing.assert_allclose(segment.inertia, expected, rtol=1e-4)
    assert segment.centre_of_mass == (0, length / 2, 0)


def test_variants_differ_from_the_ibis_only_where_they_say(birds):
    ibis = birds["ibis"]
    compliant = ibis.with_joint("shoulder.flap", stiffness=20, damping=0.2).with_values(
        {"name": "ibis_compliant_shoulder", "shoulder.sweep.offset_deg": -18.5}
    )
    assert birds["ibis_compliant_shoulder"] == compliant
    inertias = {f"segments.{bone}.inertia": [0.002] * 3 for bone in BONES}
    assert birds["ibis_thesis_ch8"] == compliant.with_values(
        {"name": "ibis_thesis_ch8", **inertias}
    )
    hinge = {"stiffness": 1.0, "damping": 0.002, "mass": 0.0015}
    assert birds["ibis_hinged_feathers"] == ibis.with_values(
        {
            "name": "ibis_hinged_feathers",
            "feathers.5.hinge": {**hinge, "rest_deg": 6.1},
            "feathers.3.hinge": {**hinge, "rest_deg": 5.3},
        }
    )
    massless = {
        f"segments.{bone}.{key}": getattr(getattr(birds["ibis_massless"].segments, bone), key)
        for bone in BONES
        for key in ("mass", "inertia")
    }
    assert birds["ibis_massless"] == ibis.with_values(
        {"name": "ibis_massless", "shoulder.flap.amplitude_deg": 43.47, **massless}
    )


def test_shares_of_the_published_feathers(ibis):
    added = [
        {"name": "2", "bone": "hand", "position": 0.5, "length": 0.225},
        {"name": "4", "bone": "forearm", "position": 0.5, "length": 0.175}
        | {"shares": {"wrist.sweep": 0.5}},
        {"name": "6", "bone": "humerus", "position": 0.5, "length": 0.125}
        | {"shares": {"elbow.sweep": 0.25}},
    ]
    document = ibis.model_dump()
    bird = type(ibis).model_validate(
        document | {"feathers": [*added, *reversed(document["feathers"])]}
    )
    # shoulder.pitch, .flap, .sweep, elbow.sweep, forearm.roll, wrist.sweep
    assert {feather.name: bird.feather_shares(feather) for feather in bird.feathers} == {
        "7": (1, 1, 1, 0, 0, 0),
        "6": (1, 1, 1, 0.25, 0, 0),
        "5": (1, 1, 1, 0.5, 0, 0),
        "4": (1, 1, 1, 1, 0.5, 0.5),
        "3": (1, 1, 1, 1, 1, 0.5),
        "2": (1, 1, 1, 1, 1, 1),
        "1": (1, 1, 1, 1, 1, 1),
    }
    assert [feather.name for feather in bird.feathers] == list("7654321")


@pytest.mark.parametrize("name", NAMES)
def test_birds_are_values(birds, name):
    bird = birds[name]
    copy = pickle.loads(pickle.dumps(bird))
    assert copy == bird
    assert hash(copy) == hash(bird)
    assert copy.fingerprint() == bird.fingerprint()
    assert type(bird).model_validate(bird.model_dump()) == bird
    assert type(bird).model_validate_json(bird.model_dump_json()) == bird
    assert len({other.fingerprint() for other in birds.values()}) == len(NAMES)


def test_the_bird_with_a_tail_is_the_ibis_in_the_gait_of_chapter_6(birds):
    assert birds["ibis_tail"] == birds["ibis"].model_copy(
        update={
            "tail": Tail(apex=Apex(x=-0.3), chord=0.3, opening_deg=40, incidence_deg=2),
            "drag": Drag(profile_coefficient=0.02, body=True),
        }
    ).with_values(
        {
            "name": "ibis_tail",
            "shoulder.sweep.offset_deg": -14.5,
            "shoulder.sweep.amplitude_deg": 14,
            "elbow.sweep.offset_deg": 10,
            "elbow.sweep.amplitude_deg": 10,
            "forearm.roll.offset_deg": -8.398,
        }
    )
