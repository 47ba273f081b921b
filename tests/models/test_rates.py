"""Rates of the multibody bird at many instants in one call."""

import gc
import weakref

import numpy as np
import pytest

import birdmb
from birdmb.models.exudyn_tree import TreeInertia, tree_links
from birdmb.models.gusts import GaussianGust
from birdmb.models.row_groups import groups_of
from birdmb.models.tree_coordinates import IN_PLANE, IN_SPACE, attitude, space_state
from birdmb.models.tree_kernel import bias_forces, mass_matrix, placed_links
from tests.conftest import TOPOLOGIES

PLIANT = {"stiffness": 20.0, "damping": 0.2}
GUST = GaussianGust(vertical=3.0, horizontal=-2.0, time=0.1)
STATE = (18.0, -2.0, 0.3, -0.1)


def coarse(bird):
    return bird.with_values({"wing.discretisation.elements": 4})


def sprung(bird, *joints):
    for joint in joints:
        bird = bird.with_joint(joint, **PLIANT)
    return bird


@pytest.mark.parametrize("joints", [(), ("shoulder.flap",), ("shoulder.flap", "wrist.sweep")])
def test_rates_are_what_the_equations_of_motion_say(ibis, joints):
    """The accelerations come from the whole tree, solved on its own in double precision."""
    model = birdmb.MultibodyModel(sprung(coarse(ibis), *joints))
    times = np.array([0.0, 0.07, 0.07, 0.2])
    rng = np.random.default_rng(1)
    driven = np.array([model.driven_state(t) for t in times])
    states = driven + 0.1 * model.state_scale * rng.standard_normal(driven.shape)
    rates = model.rates(times, states)
    for t, x, found in zip(times, states, rates, strict=True):
        a, _ = model.accelerations(t, x)
        u, w, q, theta = x[:4]
        c, s = np.cos(theta), np.sin(theta)
        body = [a[0] * c - a[1] * s - q * w, a[0] * s + a[1] * c + q * u, a[2], q]
        assert found[:4] == pytest.approx(body, rel=1e-9, abs=1e-9)
        assert found[4::2] == pytest.approx(x[5::2])
        places = [3 + model.bird.angle_names.index(joint) for joint in joints]
        assert found[5::2] == pytest.approx(a[places], rel=1e-9, abs=1e-9)
        assert model.rhs(t, x) == pytest.approx(found, rel=1e-13)


def birds_of_all_kinds(ibis):
    """Shape given by time; by a joint's angle, with a shoulder joint besides; by hinges."""
    hinged = birdmb.load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml")
    yield coarse(sprung(ibis, "shoulder.flap"))
    yield coarse(sprung(ibis, "shoulder.flap", "elbow.sweep", "forearm.roll"))
    yield coarse(sprung(hinged, "wrist.sweep"))
    yield sprung(hinged, "elbow.sweep").with_values({"wing.discretisation": "published"})


def test_rates_do_not_depend_on_which_others_are_asked_for(ibis):
    """Displaced states share what their displacement leaves as it is."""
    for bird in birds_of_all_kinds(ibis):
        model = birdmb.MultibodyModel(bird, gust=GUST)
        instants = np.array([0.03, 0.0, 0.16])
        shifts = np.diag(0.1 * model.state_scale)
        near = model.guess_along(instants)[:, None]
        states = np.concatenate([near, near + shifts, near - shifts], axis=1)
        times = np.repeat(instants, states.shape[1])
        rows = states.reshape(times.size, -1)
        mixed = np.random.default_rng(5).permutation(times.size)
        together = model.rates(times[mixed], rows[mixed])
        alone = [model.rhs(times[k], rows[k]) for k in mixed]
        scale = np.abs(together).max(axis=0)
        np.testing.assert_allclose(together / scale, alone / scale, atol=1e-13)


def test_the_compiled_tree_is_exudyns(ibis):
    rng = np.random.default_rng(6)
    for bird in birds_of_all_kinds(ibis):
        links = tree_links(bird, IN_PLANE, is_mirrored=True)
        n, theta, pitch_rate = links.parent.size, -0.3, 0.7
        angles, rates = rng.uniform(-1.0, 1.0, n), rng.uniform(-20.0, 20.0, n)
        q, v = np.zeros(3 + 2 * n), np.zeros(3 + 2 * n)
        q[2:] = theta, *angles, *angles
        v[:] = 17.0, -3.0, pitch_rate, *rates, *rates
        (mass,), (bias,) = TreeInertia(bird, IN_PLANE).at(q[None, :], v[None, :])
        alike = np.zeros((3 + 2 * n, 3 + n))  # accelerations of the tree by those of one wing
        c, s = np.cos(theta), np.sin(theta)
        alike[:3, :3] = [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]
        alike[3:, 3:] = np.tile(np.eye(n), (2, 1))
        placed = placed_links(links, angles)
        whole, part = alike.T @ mass @ alike, mass_matrix(links, placed)
        np.testing.assert_allclose(part, whole, atol=1e-14 * np.abs(whole).max())
        gravity = bird.gravity * np.array([-s, 0.0, c])
        spin = np.array([0.0, pitch_rate, 0.0])
        whole, part = alike.T @ bias, bias_forces(links, placed, rates, spin, gravity)
        np.testing.assert_allclose(part, whole, atol=1e-13 * np.abs(whole).max())


def test_the_compiled_tree_is_exudyns_in_space(ibis):
    """Both wings apart; the coordinates' accelerations hold terms of the turning axes besides."""
    rng = np.random.default_rng(7)
    for bird in birds_of_all_kinds(ibis):
        links = tree_links(bird, IN_SPACE, is_mirrored=False)
        n = links.parent.size
        q, v, a = (rng.uniform(-1.0, 1.0, 6 + n) for _ in range(3))
        (mass,), (bias,) = TreeInertia(bird, IN_SPACE).at(q[None, :], v[None, :])
        needed = mass @ a + bias
        h = 1e-5
        ahead, back = (space_state(q[:6] + s * h * v[:6], v[:6] + s * h * a[:6]) for s in (1, -1))
        state, R = space_state(q[:6], v[:6]), attitude(q[:6])
        of_body = (ahead - back)[:6] / (2 * h)
        of_body[:3] = R.T @ a[:3]
        placed = placed_links(links, q[6:])
        found = mass_matrix(links, placed) @ np.concatenate([of_body, a[6:]])
        gravity = bird.gravity * R.T[:, 2]
        found += bias_forces(links, placed, v[6:], state[3:6], gravity)
        np.testing.assert_allclose(found[6:], needed[6:], atol=1e-8 * np.abs(needed).max())
        np.testing.assert_allclose(R @ found[:3], needed[:3], atol=1e-8 * np.abs(needed).max())


def test_rows_are_alike_if_key_and_all_values_are():
    keys = np.array([1, 0, 1, 1, 0, 1])
    values = np.array([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [0.0, 2.0], [0.0, 1.0], [0.0, 1.0]])
    groups = groups_of(keys, values)
    assert groups.of.tolist() == [0, 1, 0, 2, 1, 0]
    assert groups.first.tolist() == [0, 1, 3]
    assert groups.members.tolist() == [0, 2, 5, 1, 4, 3]
    assert groups.start.tolist() == [0, 3, 5, 6]


def test_states_that_are_not_finite_have_no_rates(ibis):
    model = birdmb.MultibodyModel(coarse(ibis))
    states = np.array([STATE, (np.nan, *STATE[1:])])
    rates = model.rates(np.array([0.0, 0.1]), states)
    assert np.isfinite(rates[0]).all()
    assert np.isnan(rates[1]).all()


@pytest.fixture(params=["ibis", "ibis_tail", "ibis_published", "in a gust"])
def rigid(request):
    if request.param == "in a gust":
        return birdmb.RigidModel(coarse(request.getfixturevalue("ibis_tail")), gust=GUST)
    bird = request.getfixturevalue(request.param)
    return birdmb.RigidModel(bird if request.param == "ibis_published" else coarse(bird))


@pytest.fixture
def scattered(rigid):
    """Times, some of them twice and in no order, and states all over the place."""
    times = np.array([0.0, 0.07, 0.07, 0.2, 0.11, 0.0, 0.3])
    rng = np.random.default_rng(2)
    return times, STATE + rigid.state_scale * rng.uniform(-0.5, 0.5, (times.size, 4))


def test_rates_of_the_rigid_bird_are_its_right_hand_sides(rigid, scattered):
    each = [rigid.rhs(t, x) for t, x in zip(*scattered, strict=True)]
    np.testing.assert_allclose(rigid.rates(*scattered), each, rtol=1e-15, atol=1e-15)
    in_order = np.linspace(0.0, 0.2, 7)
    each = [rigid.rhs(t, x) for t, x in zip(in_order, scattered[1], strict=True)]
    np.testing.assert_allclose(rigid.rates(in_order, scattered[1]), each, rtol=1e-15, atol=1e-15)


def test_rate_jacobians_of_the_rigid_bird_are_derivatives_of_its_rates(rigid, scattered):
    times, states = scattered
    found = rigid.rate_jacobians(times, states)
    for j, h in enumerate(1e-5 * rigid.state_scale):
        step = h * np.eye(4)[j]
        slopes = (rigid.rates(times, states + step) - rigid.rates(times, states - step)) / (2.0 * h)
        np.testing.assert_allclose(found[:, :, j], slopes, rtol=1e-8, atol=1e-7)


def test_rigid_states_that_are_not_finite_have_no_rates(ibis):
    model = birdmb.RigidModel(coarse(ibis))
    times, states = np.array([0.0, 0.1]), np.array([STATE, (np.inf, *STATE[1:])])
    for found in model.rates(times, states), model.rate_jacobians(times, states):
        assert np.isfinite(found[0]).all()
        assert np.isnan(found[1]).all()


def test_a_body_that_stands_still_in_still_air_falls_and_has_no_derivatives(ibis):
    """Sections without any wind have no loads, and no angle of attack: nothing to differentiate."""
    bird = coarse(ibis)
    for joint in bird.joints:
        bird = bird.with_joint(joint.name, amplitude=0.0)
    model, still = birdmb.RigidModel(bird), (np.zeros(1), np.zeros((1, 4)))
    assert model.rates(*still)[0] == pytest.approx([0.0, bird.gravity, 0.0, 0.0])
    with pytest.raises(birdmb.StateError, match="cannot be computed"):
        model.rate_jacobians(*still)


def test_guess_along_of_the_rigid_bird_is_its_mean_trim(ibis):
    model = birdmb.RigidModel(coarse(ibis))
    for times in np.linspace(0.0, 0.25, 28)[:-1], np.array([0.1, 0.0, 0.02]):
        guess = model.guess_along(times)
        assert guess.shape == (times.size, 4)
        np.testing.assert_allclose(
            guess, np.tile(model.initial_guess(), (times.size, 1)), rtol=1e-4
        )


def test_the_mean_loads_balance_in_the_mean_trim(ibis, ibis_tail):
    for bird in (ibis, ibis_tail, ibis.with_values({"wing.discretisation": "published"})):
        model = birdmb.RigidModel(bird)
        times = np.linspace(0.0, bird.period, 17)[:-1]
        mean = model.rates(times, np.tile(model.initial_guess(), (16, 1))).mean(axis=0)
        np.testing.assert_allclose(mean, 0.0, atol=1e-6)


def test_guess_along_of_a_multibody_bird_follows_the_drivers(ibis):
    model = birdmb.MultibodyModel(sprung(coarse(ibis), "shoulder.flap", "wrist.sweep"))
    tethered = birdmb.MultibodyModel(
        model.bird, motion="held", body_state=(*STATE[:2], 0.0, STATE[3])
    )
    times = np.array([0.0, 0.03, 0.2])
    guess = model.guess_along(times)
    np.testing.assert_array_equal(tethered.guess_along(times), guess[:, 4:])
    np.testing.assert_array_equal(guess[:, :4], np.tile(model.driven_state()[:4], (3, 1)))
    for t, x in zip(times, guess, strict=True):
        angles, rates = birdmb.RigidModel(model.bird).joint_motion(t, STATE)
        np.testing.assert_allclose(x[4::2], angles[[1, 5]], rtol=1e-14)
        np.testing.assert_allclose(x[5::2], rates[[1, 5]], rtol=1e-14)


def test_guess_along_leaves_hinges_at_rest():
    bird = coarse(birdmb.load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml"))
    guess = birdmb.MultibodyModel(bird).guess_along(np.array([0.0, 0.1]))
    rest = [feather.hinge.rest for feather in bird.hinged_feathers]
    np.testing.assert_array_equal(guess[:, -2 * len(rest) :: 2], np.tile(rest, (2, 1)))
    assert not guess[:, -2 * len(rest) + 1 :: 2].any()


def test_rigid_rates_do_not_depend_on_the_instants_asked_for_before(ibis):
    """None, many, part of them in any order and as often as one likes, others."""
    model = birdmb.RigidModel(coarse(ibis))
    times = np.linspace(0.0, 0.24, 9)
    for asked in (times[:0], times, times[::-3], np.repeat(times[2:5], 2), times[:4] + 0.01):
        states = np.array(STATE) + 0.1 * np.arange(asked.size)[:, None]
        alone = [birdmb.RigidModel(model.bird).rhs(*at) for at in zip(asked, states, strict=True)]
        found = model.rates(asked, states)
        np.testing.assert_allclose(found, np.reshape(alone, (-1, 4)), rtol=1e-10)


@pytest.mark.parametrize("kind", [birdmb.RigidModel, birdmb.MultibodyModel])
def test_birds_repeat_after_whole_beats_of_still_air(ibis, kind):
    model = kind(coarse(ibis))
    period, times = model.period, np.array([0.03, 0.11])
    states = np.tile(STATE, (2, 1))
    for beats in (1.0, 3.0):
        assert model.repeats_after(beats * period)
        again = model.rates(times + beats * period, states)
        np.testing.assert_allclose(again, model.rates(times, states), rtol=1e-9)
    for beats in (0.5, 1.5, 1.0 + 1e-9):
        assert not model.repeats_after(beats * period)
    assert not model.in_gust(GUST).repeats_after(period)


def test_a_rigid_model_ends_with_its_last_use(ibis):
    """Its tables are large, and studies make thousands of models."""
    model = birdmb.RigidModel(coarse(ibis))
    model.rates(np.array([0.1]), np.array([STATE]))
    watched = weakref.ref(model)
    gc.disable()
    try:
        del model
        assert watched() is None
    finally:
        gc.enable()
