"""Birds in air that remembers: limits, derivatives, and one formulation against the other."""

import numpy as np
import pytest

import birdmb
from birdmb.models.motion import FREE

pytestmark = pytest.mark.long

UNSTEADY = {"air.wake": "unsteady", "air.wake_points": 4}
TIMES = np.array([0.03, 0.11, 0.2])
LATERAL = [1, 3, 5, 6]


def in_memory(bird, **values):
    coarse = {"wing.discretisation": 12}
    return bird.with_values({**UNSTEADY, **coarse, **values})


def beside(model, times=TIMES, by=0.1):
    """States beside the guess, all of them."""
    guess = model.guess_along(times)
    return guess + by * np.random.default_rng(1).normal(size=guess.shape) * model.state_scale


@pytest.fixture(scope="module")
def rigid(ibis_tail):
    return birdmb.RigidModel(in_memory(ibis_tail))


@pytest.mark.parametrize("motion", ["planar", "free"])
def test_the_jacobian_is_that_of_the_rates(ibis_tail, motion):
    model = birdmb.RigidModel(in_memory(ibis_tail), motion=motion)
    states, h = beside(model)[:1], 1e-6 * model.state_scale
    exact = model.rate_jacobians(TIMES[:1], states)[0]
    columns = [
        (model.rates(TIMES[:1], states + e) - model.rates(TIMES[:1], states - e))[0] / (2 * e.sum())
        for e in np.diag(h)
    ]
    size = np.abs(exact).max(axis=1, keepdims=True)
    np.testing.assert_allclose(np.column_stack(columns) / size, exact / size, atol=1e-6)


def test_a_side_by_side_memory_is_that_of_a_symmetric_flight(rigid, ibis_tail):
    free = birdmb.RigidModel(in_memory(ibis_tail), motion="free")
    one, both = rigid.guess_along(TIMES), free.guess_along(TIMES)
    expected, found = rigid.rates(TIMES, one), free.rates(TIMES, both)
    np.testing.assert_allclose(found[:, [0, 2, 4, 7]], expected[:, :4], atol=1e-10)
    np.testing.assert_allclose(found[:, LATERAL], 0.0, atol=1e-10)
    lags = found[:, 8:].reshape(3, 2, -1)
    np.testing.assert_allclose(lags[:, 0], expected[:, 4:], atol=1e-8)
    np.testing.assert_allclose(lags[:, 1], expected[:, 4:], atol=1e-8)


def test_mirrored_states_have_mirrored_rates(ibis_tail):
    free = birdmb.RigidModel(in_memory(ibis_tail), motion="free")
    states, mirror = beside(free), free.mirror
    of_image = free.rates(TIMES, mirror.signs * states[:, mirror.order])
    expected = mirror.signs * free.rates(TIMES, states)[:, mirror.order]
    np.testing.assert_allclose(of_image, expected, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("motion", ["planar", "free"])
def test_massless_wings_of_a_tree_are_those_of_the_rigid_bird(ibis_massless, motion):
    """The difference is the wings' mass, to first order."""
    differences = []
    for share in (1.0, 0.1):
        masses = {
            f"segments.{name}.{key}": share * getattr(segment, key)
            for name, segment in ibis_massless.segments.items()
            for key in ("mass",)
        }
        bird = in_memory(ibis_massless, **masses)
        rigid = birdmb.RigidModel(bird, motion=motion)
        tree = birdmb.MultibodyModel(bird, motion=motion)
        states = beside(rigid)
        expected, found = rigid.rates(TIMES, states), tree.rates(TIMES, states)
        differences.append(np.abs((found - expected) / rigid.state_scale).max())
        size = np.abs(expected / rigid.state_scale).max()
    assert differences[0] < 1e-4 * size
    assert differences[1] == pytest.approx(0.1 * differences[0], rel=0.2)


def test_steady_flight_is_that_of_air_without_memory(ibis_tail):
    """Wings that stand still: the lags settle, and all forces are those of the lifting line."""
    still = {f"{joint.name}.amplitude": 0.0 for joint in ibis_tail.joints}
    gliding = in_memory(ibis_tail, **still)
    remembering = birdmb.RigidModel(gliding)
    forgetful = birdmb.RigidModel(gliding.with_values({"air.wake": "quasi-steady"}))
    body = np.array([[15.0, 1.0, 0.0, 0.05]])
    states = remembering.with_lags(TIMES[:1], body)
    own, other = (
        model.loads_along(TIMES[:1], x).stack
        for model, x in ((remembering, states), (forgetful, body))
    )
    np.testing.assert_allclose(own.right.circulation, other.right.circulation, rtol=1e-10)
    # The body accelerates, and with it the air about its wings: the rest is the same.
    q, w = body[0, 2], 0.0
    assert q == w
    rates = remembering.rates(TIMES[:1], states)[0, :4]
    expected = forgetful.rates(TIMES[:1], body)[0]
    mass = np.diag([gliding.body.mass, gliding.body.mass, gliding.body.inertia_yy])
    table, _ = remembering._tables.at(TIMES[:1], remembering._tabulated)
    apparent = table.lags.inertia[0][np.ix_([0, 2, 4], [0, 2, 4])]
    np.testing.assert_allclose((mass + apparent) @ rates[:3], mass @ expected[:3], rtol=1e-9)


def test_slow_flapping_is_quasi_steady_to_first_order(ibis):
    """Slower beats of the same strokes, in the same stream: forces differ in proportion."""
    differences = []
    for frequency in (0.02, 0.01):
        bird = in_memory(ibis, **{"gait.frequency": frequency})
        held = {"motion": "held", "body_state": [15.0, 1.0, 0.0, 0.05]}
        model = birdmb.MultibodyModel(bird, **held)
        cycle = birdmb.find_limit_cycle(model)
        other = birdmb.MultibodyModel(bird.with_values({"air.wake": "quasi-steady"}), **held)
        times = cycle.beat.times
        forces = other.loads_along(times, np.empty((times.size, 0))).stack.force
        differences.append(np.abs(cycle.beat.force - forces).max() / np.abs(forces).max())
    assert differences[0] < 0.02
    assert differences[1] == pytest.approx(0.5 * differences[0], rel=0.1)


def test_multipliers_are_those_of_shooting(rigid):
    collocated = birdmb.find_limit_cycle(rigid, method="collocation")
    shot = birdmb.find_limit_cycle(rigid, method="shooting")
    scale = rigid.state_scale
    assert np.abs((collocated.x0 - shot.x0) / scale).max() < 1e-6
    difference = np.abs(collocated.multipliers - shot.multipliers)[:4]
    assert (difference <= collocated.verdict_errors[:4] + shot.verdict_errors[:4]).all()
    assert difference.max() < 1e-5
    assert collocated.energy_imbalance < 1e-6


def test_energy_is_kept_with_memory_apparent_mass_and_springs(ibis_compliant):
    bird = in_memory(ibis_compliant)
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
    assert cycle.energy_imbalance < 1e-6
    assert cycle.flown_closure < 1e-5
    names = [mode.name for mode in cycle.flight_modes]
    # Flight and joint have six states; of what fades, the lags have the most.
    assert names.count("wake") >= 12
    assert names[0] != "wake"


def test_what_memory_adds_refines(ibis):
    """To the largest multiplier, with lags at all elements: 0.0382, 0.0374 at 8 and 16."""
    added = []
    for elements in (8, 16):
        bird = ibis.with_values({"wing.discretisation": elements})
        remembering = bird.with_values({"air.wake": "unsteady", "air.wake_points": elements})
        both = [
            birdmb.find_limit_cycle(birdmb.RigidModel(each), accuracy=1e-5).multipliers[0].real
            for each in (remembering, bird)
        ]
        added.append(both[0] - both[1])
    assert added[0] == pytest.approx(0.038, abs=0.001)
    assert added[1] == pytest.approx(added[0], rel=0.05)


def test_what_memory_needs(ibis):
    published = ibis.with_values({"air.wake": "unsteady", "wing.discretisation": "published"})
    with pytest.raises(birdmb.TopologyError, match="smooth in time"):
        birdmb.RigidModel(published)
    few = ibis.with_values({"air.wake": "unsteady", "wing.discretisation": 5})
    with pytest.raises(birdmb.TopologyError, match=r"air\.wake_points is 6"):
        birdmb.MultibodyModel(few)
    with pytest.raises(birdmb.TopologyError, match=r"air\.wake_points"):
        ibis.with_values({"air.wake_points": 3})


def test_a_flight_turns_in_space(ibis_tail):
    """States in space stand before the lags of both wings, by name."""
    model = birdmb.RigidModel(in_memory(ibis_tail), motion="free")
    assert model.motion_state_names == FREE.states
    assert model.state_names[8] == "wake.bound_slow.1.right"
    assert model.state_names[-1] == "wake.trailing_fast.4.left"
    assert len(model.state_names) == len(model.state_units) == model.state_scale.size == 40
