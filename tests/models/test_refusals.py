"""Birds that a model cannot fly: each told in one sentence of the package's errors."""

import numpy as np
import pytest

import birdmb

SPRUNG = {"shoulder.flap.stiffness": 20.0, "shoulder.flap.damping": 0.1}
MASSLESS = {
    f"segments.{bone}.{what}": nothing
    for bone in ("humerus", "forearm", "hand")
    for what, nothing in (("mass", 0.0), ("inertia", [[0.0] * 3] * 3))
}


@pytest.fixture(scope="module")
def coarse(ibis):
    return ibis.with_values({"wing.discretisation": 4})


def sprung(bird, *joints):
    for joint in joints:
        bird = bird.with_joint(joint, stiffness=20.0, damping=0.1)
    return bird


def test_a_sprung_joint_without_inertia_is_named(coarse):
    with pytest.raises(birdmb.TopologyError, match=r"ibis.*shoulder\.flap can turn.*Give"):
        birdmb.MultibodyModel(sprung(coarse, "shoulder.flap").with_values(MASSLESS))


def test_only_the_joint_that_moves_nothing_is_named(coarse):
    hand = {name: value for name, value in MASSLESS.items() if ".hand." in name}
    bird = sprung(coarse, "shoulder.flap", "wrist.sweep").with_values(hand)
    with pytest.raises(birdmb.TopologyError, match=r"^ibis[^:]*: wrist\.sweep can turn"):
        birdmb.MultibodyModel(bird)


def test_a_light_wing_is_no_massless_one(ibis_massless):
    bird = ibis_massless.with_values({"wing.discretisation": 4})
    assert birdmb.MultibodyModel(sprung(bird, "shoulder.flap")).state_names[4] == "shoulder.flap"


@pytest.mark.parametrize("integrator", ["explicit", "implicit"])
def test_a_wing_that_folds_too_far_in_the_middle_of_a_beat(coarse, integrator):
    """Raised by Exudyn's user functions, of the drivers and of the forces."""
    bird = coarse.with_values({"feathers.5.length": 2.0})
    model = birdmb.MultibodyModel(bird, integrator=integrator, steps_per_beat=60)
    with pytest.raises(birdmb.StateError, match="no line orthogonal"):
        model.flow([18.0, -2.0, 0.0, -0.1], 0.0, 0.25)


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
@pytest.mark.parametrize(
    "values",
    [
        {"air.density": 1e300},
        {"body.inertia_yy": 5e-324},
        {"drag.profile_coefficient": 1e300},
        {"gait.frequency": 1e300},
    ],
)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_values_beyond_reckoning_end_in_a_sentence(coarse, kind, values):
    with pytest.raises(birdmb.BirdmbError):
        birdmb.find_limit_cycle(kind(coarse.with_values(values)))


@pytest.mark.parametrize("factor", [1e-3, 1.0, 30.0])
def test_driven_joints_follow_alike_in_birds_of_all_sizes(coarse, factor):
    """Froude similarity: lengths by the factor, masses by its cube, times by its root."""
    links = birdmb.MultibodyModel(scaled(coarse, factor))
    x = np.array([18.0 * factor**0.5, -2.0 * factor**0.5, 0.0, -0.1])
    q, v = links.coordinates(0.0, x)
    period = links.bird.period
    q, _, _ = links._exudyn.integrate(q, v, np.empty(0), 0.0, period / 4, 15)
    expected, _ = links.coordinates(period / 4, x)
    np.testing.assert_allclose(q[3:], expected[3:], atol=1e-6)
    assert q[2] != pytest.approx(-0.1, abs=1e-3)


def scaled(bird, factor):
    values = {
        "body.mass": bird.body.mass * factor**3,
        "body.inertia_yy": bird.body.inertia_yy * factor**5,
        "gait.frequency": bird.gait.frequency / factor**0.5,
        **{f"wing.root.{k}": getattr(bird.wing.root, k) * factor for k in "xyz"},
        "wing.half_thickness": bird.wing.half_thickness * factor,
        **{f"feathers.{f.name}.length": f.length * factor for f in bird.feathers},
    }
    for bone in ("humerus", "forearm", "hand"):
        segment = getattr(bird.segments, bone)
        values[f"segments.{bone}.length"] = segment.length * factor
        values[f"segments.{bone}.mass"] = segment.mass * factor**3
        values[f"segments.{bone}.inertia"] = (np.array(segment.inertia) * factor**5).tolist()
    return bird.with_values(values)


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_motions_beyond_any_flight_are_not_integrated(coarse, kind):
    with pytest.raises(birdmb.StateError, match=r"runs away: u = 1e\+08 at t = 0 s"):
        kind(coarse, steps_per_beat=24).flow([1e8, 0.0, 0.0, 0.0], 0.0, 0.25)
