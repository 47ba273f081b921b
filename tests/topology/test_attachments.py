"""Further rigid bodies on the body and on the wings' segments."""

import numpy as np
import pytest

import birdmb
from birdmb.topology.messages import validated


def with_attachments(bird, *attachments):
    document = bird.model_dump(exclude_unset=True) | {"attachments": attachments}
    return validated(birdmb.Bird, document, bird.name)


PAYLOAD = {"name": "payload", "on": "body", "mass": 0.1, "position": [0.03, 0.0, 0.02]}
LEG = {
    "name": "leg", "on": "body", "mass": 0.02, "position": [-0.05, 0.03, 0.06],
    "inertia": [4e-6, 5e-6, 2e-6],
}  # fmt: skip
MOTOR = {"name": "motor", "on": "hand", "mass": 0.004, "position": [0.01, 0.02, 0.0]}


def test_a_body_with_a_head_and_legs_is_one_body(ibis):
    """By hand: masses add, the centre is their mean, moments by Steiner; legs come in pairs."""
    bird = with_attachments(
        ibis.with_values({"body.inertia_xx": 0.02, "body.inertia_zz": 0.11}), PAYLOAD, LEG
    )
    masses = np.array([1.2, 0.1, 0.02, 0.02])
    places = np.array([[0, 0, 0], [0.03, 0, 0.02], [-0.05, 0.03, 0.06], [-0.05, -0.03, 0.06]])
    centre = masses @ places / masses.sum()
    whole = bird.assembled
    assert whole.body.mass == pytest.approx(masses.sum())
    assert bird.total_mass == pytest.approx(ibis.total_mass + 0.14)
    x, y, z = (places - centre).T
    yy = ibis.body.inertia_yy + 2 * 5e-6 + masses @ (x**2 + z**2)
    assert whole.body.inertia_yy == pytest.approx(yy, rel=1e-14)
    assert whole.body.inertia_xx == pytest.approx(0.02 + 2 * 4e-6 + masses @ (y**2 + z**2))
    assert whole.body.inertia_xz == pytest.approx(-masses @ (x * z))
    root, moved = ibis.wing.root, whole.wing.root
    assert (moved.x, moved.y, moved.z) == pytest.approx(
        (root.x - centre[0], root.y, root.z - centre[2])
    )
    assert whole.attachments == ()
    assert ibis.assembled is ibis


def test_the_tail_moves_with_the_centre_of_mass(ibis_tail):
    whole = with_attachments(ibis_tail, PAYLOAD).assembled
    ahead = 0.1 * 0.03 / (ibis_tail.body.mass + 0.1)
    assert whole.tail.apex.x == pytest.approx(ibis_tail.tail.apex.x - ahead)


def test_both_models_fly_the_assembled_bird(ibis_compliant):
    """Values typed by hand for body and hand, against attachments."""
    bird = with_attachments(ibis_compliant, PAYLOAD, MOTOR)
    hand, mass = ibis_compliant.segments["hand"], ibis_compliant.body.mass
    total = hand.mass + 0.004
    own, place = np.array(hand.centre_of_mass), np.array([0.01, 0.02, 0.0])
    centre = (hand.mass * own + 0.004 * place) / total

    def steiner(m, r):
        return m * (r @ r * np.eye(3) - np.outer(r, r))

    inertia = (
        np.array(hand.inertia) + steiner(hand.mass, own - centre) + steiner(0.004, place - centre)
    )
    share = 0.1 / (mass + 0.1)
    reduced = mass * share * (0.03**2 + 0.02**2)
    root = ibis_compliant.wing.root
    by_hand = ibis_compliant.with_values(
        {
            "body.mass": mass + 0.1,
            "body.inertia_yy": ibis_compliant.body.inertia_yy + reduced,
            "wing.root.x": root.x - 0.03 * share,
            "wing.root.z": root.z - 0.02 * share,
            "segments.hand.mass": total,
            "segments.hand.centre_of_mass": centre.tolist(),
            "segments.hand.inertia": inertia.tolist(),
        }
    )
    for model in (birdmb.RigidModel, birdmb.MultibodyModel):
        ours, theirs = model(bird), model(by_hand)
        x = theirs.initial_guess()
        assert ours.mass == pytest.approx(theirs.mass)
        np.testing.assert_allclose(ours.initial_guess(), x, rtol=1e-8)
        np.testing.assert_allclose(ours.rhs(0.04, x), theirs.rhs(0.04, x), rtol=1e-9, atol=1e-9)


def test_values_have_dotted_names(ibis):
    bird = with_attachments(ibis, PAYLOAD)
    assert bird.value("attachments.payload.mass") == 0.1
    heavier = bird.with_values({"attachments.payload.mass": 0.2})
    assert heavier.total_mass == pytest.approx(ibis.total_mass + 0.2)
    assert bird.value("attachments.payload.position.x") == 0.03
    moved = {"attachments.payload.position.x": 0.05, "attachments.payload.position.z": -0.01}
    assert bird.with_values(moved).attachments[0].position == (0.05, 0.0, -0.01)
    with pytest.raises(birdmb.TopologyError, match=r"payload\.position.*must be a number"):
        bird.with_values({"attachments.payload.position.x": "ahead"})


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"on": "beak"}, 'attachments.payload.on: no segment is called "beak"; the nearest: '),
        ({"mass": 0.0}, "attachments.payload.mass: must be more than 0, not 0.0 (mass of one, kg)"),
        ({"inertia": [1.0, 1e-3, 1e-3]}, "attachments.payload.inertia: principal moments "),
    ],
)
def test_what_is_wrong_is_one_sentence(ibis, change, sentence):
    with pytest.raises(birdmb.TopologyError) as caught:
        with_attachments(ibis, PAYLOAD | change)
    assert str(caught.value).startswith(f"ibis: {sentence}")
