"""By what a flight is trimmed if nobody says: joints told by their axes, not by names."""

import pytest

import birdmb
from birdmb.studies.trim_defaults import default_parameters
from birdmb.topology.roles import flap_joint, incidence_joint
from tests.wing.test_sections import plate

FLAP = {"name": "a.up", "segment": "bar", "axis": [-1, 0.2, 0], "amplitude_deg": 30.0}
PITCH = {"name": "a.nose", "segment": "bar", "axis": [0.1, 1, 0]}
SWEEP = {"name": "a.back", "segment": "bar", "axis": [0, 0, 1]}


def test_the_ibis_is_trimmed_by_the_roll_of_its_forearm_and_the_flap(ibis):
    assert flap_joint(ibis).name == "shoulder.flap"
    assert incidence_joint(ibis).name == "forearm.roll"
    assert default_parameters(ibis, 2) == {
        "forearm.roll.offset_deg": (-30.0, 30.0),
        "shoulder.flap.amplitude_deg": (15.0, 70.0),
    }


def test_joints_are_told_by_their_axes():
    bird = plate(joints=[SWEEP, PITCH, FLAP])
    assert list(default_parameters(bird, 2)) == ["a.nose.offset_deg", "a.up.amplitude_deg"]
    assert list(default_parameters(bird, 1)) == ["a.nose.offset_deg"]


def test_one_twist_goes_before_a_pitch_and_two_are_not_clear():
    twists = [
        {"name": f"a.{name}", "segment": "bar", "axis": [0, 1, 0], "twist": True} for name in "bc"
    ]
    assert incidence_joint(plate(joints=[PITCH, FLAP, twists[0]])).name == "a.b"
    assert incidence_joint(plate(joints=[PITCH, FLAP, *twists])) is None


@pytest.mark.parametrize(
    ("joints", "targets", "sentence"),
    [
        ([FLAP], 1, "plate: it is not clear which one joint turns the chords about the span; say "
         "what to trim by, with its bounds, as --by wing.root.x=0:0.1 or "),
        ([PITCH, SWEEP], 2, "plate: it is not clear which one joint flaps the wing; "),
        ([PITCH, FLAP | {"amplitude_deg": 0.0}], 2, "plate: it is not clear which one joint flaps"),
    ],
)  # fmt: skip
def test_where_there_is_no_default_it_is_asked_for(joints, targets, sentence):
    with pytest.raises(birdmb.ArgumentError) as caught:
        birdmb.trim_flight(plate(joints=joints), speed=10.0 if targets == 2 else None)
    assert str(caught.value).startswith(sentence)
