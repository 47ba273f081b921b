"""What is refused to be varied is what the flight of a beat does not depend on, and no more."""

from functools import partial

import numpy as np
import pytest

import birdmb
from birdmb.errors import ArgumentError
from birdmb.studies import parameter_study
from birdmb.studies.relevance import check_relevant, ignored_values
from birdmb.studies.sweeps import sweep
from birdmb.topology.unused import unused_values

from .sweeping import TOPOLOGIES, Inline

RIGID = partial(birdmb.RigidModel, steps_per_beat=8)
MULTIBODY = partial(birdmb.MultibodyModel, steps_per_beat=40)
STIFFNESS, DAMPING = "shoulder.flap.stiffness", "shoulder.flap.damping"


@pytest.fixture(scope="module")
def bird():
    """With a hinged feather, a compliant joint, and a joint whose driver stands still."""
    hinged = birdmb.load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml")
    return hinged.with_values(
        {
            "wing.discretisation": {"scheme": "orthogonal", "elements": 4, "rounding": 0.5},
            STIFFNESS: 40.0,
            DAMPING: 0.1,
            "elbow.sweep.amplitude": 0.0,
        }
    )


def changed(bird, name):
    """The bird with a number slightly changed; `None` if there is none to change."""
    value = bird.value(name)
    if not isinstance(value, float):
        return None
    for factor in (1.001, 0.999):
        try:
            return bird.with_values({name: value * factor if value else 1e-3 * (factor - 0.9)})
        except birdmb.TopologyError:
            continue
    return None


def test_the_rigid_model_ignores_what_does_not_move_its_flow(bird):
    def flown(bird):
        return RIGID(bird).flow([12.0, 0.5, 0.1, 0.05], 0.0, bird.period)

    before, without = flown(bird), {**ignored_values(bird, RIGID), **unused_values(bird)}
    looked_at = 0
    for name in bird.value_names():
        other = changed(bird, name)
        if other is None:
            continue
        if not other.is_symmetric:  # does not fly in the plane
            assert name in without
            continue
        looked_at += 1
        same = np.array_equal(flown(other), before)
        assert same == (name in without), name
    assert looked_at > 80


def test_the_multibody_model_ignores_nothing_but_springs_of_prescribed_joints(bird):
    in_space = {f"body.inertia_{axes}" for axes in ("xx", "xz", "zz")}
    in_space |= {"body.side_area", "body.side_coefficient"}
    of_a_side = {name for name in bird.value_names() if ".left" in name or ".right" in name}
    assert set(ignored_values(bird, MULTIBODY)) == in_space | of_a_side
    assert not ignored_values(bird, partial(MULTIBODY, motion="free"))
    assert not in_space & set(ignored_values(bird, partial(birdmb.RigidModel, motion="free")))
    assert ignored_values(bird, lambda bird: birdmb.RigidModel(bird, motion="free")) == {}
    unused = unused_values(bird)
    assert DAMPING not in unused
    spring = {"cubic_stiffness": 9.0, "stiffness": 5.0, "damping": 3.0, "stiffness_below": 1.0}
    stiff = bird.with_joint("shoulder.pitch", mode="prescribed", **spring)
    assert {f"shoulder.pitch.{key}" for key in spring} < set(unused)
    x0 = birdmb.MultibodyModel(bird, steps_per_beat=40).initial_guess()
    ends = [MULTIBODY(each).flow(x0, 0.0, 0.02) for each in (bird, stiff)]
    np.testing.assert_array_equal(*ends)


@pytest.mark.parametrize(
    ("values", "model", "says"),
    [
        ({STIFFNESS: [60.0, 20.0]}, RIGID, "no springs"),
        ({"feathers.5.hinge.stiffness": [1.0, 2.0]}, RIGID, "no springs"),
        ({"shoulder.flap.mode": ["prescribed", "compliant"]}, RIGID, "no springs"),
        ({"segments.hand.mass": [0.01, 0.02]}, RIGID, "have no mass"),
        ({"body.mass": [1.0], "shoulder.pitch.cubic_stiffness": [0.0, 9.0]}, MULTIBODY, "is pre"),
        ({"drag.frontal_area": [0.1, 0.2]}, MULTIBODY, "drag.body is false"),
        ({"elbow.sweep.phase_deg": [0.0, 90.0]}, MULTIBODY, "its amplitude is 0"),
        ({"air.kinematic_viscosity": [1e-5, 2e-5]}, RIGID, "friction"),
        ({"name": ["a", "b"]}, MULTIBODY, "a label"),
    ],
)
def test_what_changes_nothing_is_not_varied(bird, tmp_path, values, model, says):
    bare = bird.with_values({"tail": None, "drag.body": False})
    with pytest.raises(ArgumentError, match=f"cannot be varied, it has no effect: .*{says}"):
        sweep(bare, values, store=tmp_path / "s.db", executor=Inline(), model=model)
    assert not (tmp_path / "s.db").exists()


def test_what_another_value_brings_into_use_is_varied(bird):
    for values in (
        {"shoulder.pitch.stiffness": [50.0], "shoulder.pitch.damping": [0.1, 0.2]},
        {"shoulder.flap.mode": ["prescribed", "compliant"], DAMPING: [0.1, 0.2]},
        {"elbow.sweep.amplitude_deg": [0.0, 5.0], "elbow.sweep.phase_deg": [0.0, 90.0]},
        {"shoulder.pitch.damping": [0.1], "shoulder.pitch.stiffness": ["much", 50.0]},
    ):
        check_relevant(bird, values, MULTIBODY)


def test_parameter_studies_refuse_the_same(bird):
    with pytest.raises(ArgumentError, match="no springs"):
        parameter_study(bird, STIFFNESS, [60.0, 20.0], RIGID)
