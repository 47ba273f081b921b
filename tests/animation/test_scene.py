"""What there is to see of a flight, against the model and against known motions."""

import numpy as np
import pytest

import birdmb
from birdmb.animation.colours import colour_named
from birdmb.animation.modes import mode_deviation, shown_amplitude
from birdmb.animation.placing import place_body
from birdmb.animation.scene import flight_scene
from birdmb.animation.shapes import body_shape, tail_shape
from birdmb.animation.stage import Stage
from birdmb.wing.outline import wing_outline


@pytest.fixture(scope="module")
def scene(tail_cycle):
    return flight_scene(tail_cycle, beats=2, frames=12)


def in_world(cycle, t, points):
    """Points (P, 3) m of planar flight relative to the body, along world axes, by hand."""
    theta = cycle.trajectory([t]).states[0][3]
    x, y, z = points.T
    c, s = np.cos(theta), np.sin(theta)
    return np.column_stack([c * x + s * z, -y, s * x - c * z])


def test_left_and_right_are_mirror_images(scene):
    for part in (scene.chords, scene.edges, scene.bones, scene.feathers):
        right, left = part[:, 0], part[:, 1]
        np.testing.assert_allclose(left, right * [1.0, -1.0, 1.0], atol=1e-12)
    np.testing.assert_allclose(scene.values[:, 0], scene.values[:, 1], atol=1e-12)
    # The right wing is on the right of a bird that flies away: y points to the left.
    assert (scene.bones[:, 0, -1, 1] < -0.1).all()


def test_the_lifting_line_is_where_the_loads_act(scene, tail_cycle):
    for k in (0, 5, 17):
        t = scene.times[k]
        loads = tail_cycle.model.loads(t, tail_cycle.trajectory([t]).states[0])
        expected = in_world(tail_cycle, t, loads.right.node[1:])
        chords = scene.chords[k, 0, 1:] - scene.path[k]
        line = 0.75 * chords[:, 0] + 0.25 * chords[:, 1]
        np.testing.assert_allclose(line, expected, atol=1e-9)


def test_a_beat_later_all_has_moved_by_the_way_flown(scene, tail_cycle):
    x, climb = tail_cycle.mean_velocity * tail_cycle.period
    for part in (scene.chords, scene.bones, scene.body, scene.tail, scene.arrow_points):
        moved = part[12] - part[0]
        np.testing.assert_allclose(moved, np.broadcast_to([x, 0.0, climb], moved.shape), atol=1e-4)
    np.testing.assert_allclose(scene.values[12], scene.values[0], atol=1e-9)
    assert x > 3.0


def test_the_arrows_add_up_to_the_force_of_the_air(scene, tail_cycle):
    states = tail_cycle.trajectory(scene.times).states
    for k, (t, x) in enumerate(zip(scene.times, states, strict=True)):
        force = tail_cycle.model.loads(t, x).force
        expected = in_world(tail_cycle, t, force[None])[0]
        np.testing.assert_allclose(scene.arrow_forces[k].sum(axis=0), expected, atol=1e-10)
    # Five of each wing, tail and body.
    assert scene.arrow_forces.shape[1] == 12


def test_the_bird_is_upright_and_flies_forwards(scene):
    forward, right, down = np.moveaxis(scene.placing.axes, 2, 0)
    assert (forward[:, 0] > 0.9).all()
    np.testing.assert_allclose(right, np.broadcast_to([0.0, -1.0, 0.0], right.shape), atol=1e-12)
    assert (down[:, 2] < -0.9).all()


def test_a_turn_to_the_right_is_a_circle():
    times = np.linspace(0.0, 0.5 * np.pi, 101)
    space = np.zeros((101, 8))
    space[:, 0], space[:, 5] = 10.0, 1.0  # m/s forwards, rad/s to the right
    placing = place_body(times, space)
    circle = 10.0 * np.column_stack([np.sin(times), np.cos(times) - 1.0, 0.0 * times])
    np.testing.assert_allclose(placing.position, circle, atol=1e-7)
    nose = placing.vectors(np.broadcast_to([1.0, 0.0, 0.0], (101, 3)))
    np.testing.assert_allclose(nose[-1], [0.0, -1.0, 0.0], atol=1e-12)


def test_rolling_to_the_right_lowers_the_right_wing_and_pitching_lifts_the_nose():
    space = np.zeros((2, 8))
    space[0, 6] = space[1, 7] = 0.3
    placing = place_body(np.array([0.0, 1e-9]), space)
    tips = placing.vectors(np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]))
    np.testing.assert_allclose(tips[0], [0.0, -np.cos(0.3), -np.sin(0.3)], atol=1e-9)
    np.testing.assert_allclose(tips[1], [np.cos(0.3), 0.0, np.sin(0.3)], atol=1e-9)


@pytest.mark.parametrize("mode", [0, 1, 3])
def test_each_beat_multiplies_a_mode_by_its_multiplier(tail_cycle, mode):
    times = tail_cycle.start_time + tail_cycle.period * np.arange(6)
    found = mode_deviation(tail_cycle, mode, 0.1, times)
    powers = tail_cycle.multipliers[mode] ** np.arange(6)
    expected = 0.1 * (powers[:, None] * tail_cycle.modes[:, mode]).real
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(found[0], birdmb.mode_disturbance(tail_cycle, mode, 0.1), atol=1e-12)


def test_within_the_beat_a_mode_is_what_the_flow_makes_of_it(rigid_cycle):
    small, model = 1e-4, rigid_cycle.model
    for mode in (0, 1):
        times = rigid_cycle.start_time + rigid_cycle.period * np.array([0.0, 0.3, 0.7, 1.0])
        found = mode_deviation(rigid_cycle, mode, small, times)
        for k in (1, 2, 3):
            flown = [
                model.flow(rigid_cycle.x0 + sign * found[0], times[0], times[k])
                for sign in (1.0, -1.0)
            ]
            expected = 0.5 * (flown[0] - flown[1]) / model.state_scale
            np.testing.assert_allclose(found[k] / model.state_scale, expected, atol=0.01 * small)


def test_the_modes_of_a_shot_cycle_are_those_of_the_collocated_one(ibis_massless):
    model = birdmb.RigidModel(ibis_massless.with_values({"wing.discretisation": 8}))
    collocated = birdmb.find_limit_cycle(model)
    shot = birdmb.find_limit_cycle(model, collocated, method="shooting")
    times = collocated.start_time + collocated.period * np.linspace(0.0, 2.0, 9)
    one, other = (mode_deviation(cycle, 0, 1.0, times) for cycle in (collocated, shot))
    np.testing.assert_allclose(one / model.state_scale, other / model.state_scale, atol=0.02)


def test_a_growing_mode_is_scaled_by_its_end(rigid_cycle):
    size = abs(rigid_cycle.multipliers[0])
    assert size > 1.0
    assert shown_amplitude(rigid_cycle, 0, 6) == pytest.approx(size**-6)
    assert shown_amplitude(rigid_cycle, 3, 6) == 1.0


def test_a_mode_bends_the_path_and_the_cycle_stays_beside_it(tail_cycle):
    scene = flight_scene(tail_cycle, beats=2, frames=12, mode=1, scale=1.0)
    plain = flight_scene(tail_cycle, beats=2, frames=12)
    np.testing.assert_allclose(scene.undisturbed, plain.path, atol=1e-12)
    assert np.abs(scene.path - plain.path)[-1].max() > 0.1
    assert "phugoid" in scene.remarks[0]
    assert plain.remarks == ()


def test_colours_are_the_models_own(scene, tail_cycle):
    t = scene.times[3]
    state = tail_cycle.trajectory([t]).states[0]
    right = tail_cycle.model.loads(t, state).right
    np.testing.assert_allclose(scene.values[3, 0], right.circulation, atol=1e-12)
    by = {
        name: flight_scene(tail_cycle, beats=1, frames=12, colour=name).values[3, 0]
        for name in ("incidence", "load")
    }
    np.testing.assert_allclose(by["incidence"], np.degrees(right.angle_of_attack), atol=1e-9)
    # Of a panel, whose normal is that of its diagonals but for its warp.
    angles, _ = tail_cycle.model.joint_motion(t, state)
    discretisation = tail_cycle.model.bird.wing.resolved_discretisation
    panel = wing_outline(tail_cycle.model.wing, angles, discretisation).panels[12]
    up = np.cross(panel[1] - panel[3], panel[2] - panel[0])
    up *= -np.sign(up[2]) / np.linalg.norm(up)
    expected = right.force[12] @ up / (right.chord[12] * right.width[12])
    assert by["load"][12] == pytest.approx(expected, rel=1e-2)


def test_the_trunk_has_the_bodys_mass_and_the_tail_its_span(ibis_tail, ibis):
    points, faces = body_shape(ibis_tail)
    corners = points[faces]
    volume = abs(np.einsum("ta,ta->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0)
    assert 700.0 * volume == pytest.approx(ibis_tail.body.mass, rel=0.06)
    tail = tail_shape(ibis_tail)
    assert tail[1, 1] - tail[2, 1] == pytest.approx(ibis_tail.tail.span)
    assert tail_shape(ibis) is None


def test_downstrokes_are_when_the_wing_tips_go_down(scene):
    tips = scene.chords[:, 0, -1, 0, 2] - scene.path[:, 2]
    down = np.gradient(tips) < 0.0
    # Around the turns tip and wing disagree.
    clear = np.abs(np.gradient(tips)) > 0.3 * np.abs(np.gradient(tips)).max()
    words = np.array([word == "downstroke" for word in scene.strokes])
    assert clear.sum() > 10
    np.testing.assert_array_equal(words[clear], down[clear])


def test_a_gliding_bird_has_no_strokes():
    bird = birdmb.load_bird("gull_glider").with_values({"wing.discretisation": 8})
    glide = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
    assert set(flight_scene(glide, beats=1, frames=8).strokes) == {"gliding"}


def test_the_wake_is_where_the_trailing_edge_was(scene):
    lines, values = Stage((scene,)).wake(scene)
    tip = scene.chords[:, 0, -1, 1]
    np.testing.assert_array_equal(lines[20, 6], tip[8:21])
    np.testing.assert_array_equal(values[20, 6], scene.border_values[8:21, 0, -1])
    assert np.isnan(lines[5, 6, :7]).all()
    assert np.isfinite(lines[5, 6, 7:]).all()


def test_the_bird_is_within_the_box_that_the_camera_sees(scene):
    for view in ("bird", "path"):
        stage = Stage((scene,), view)
        box = stage.box(scene)
        for part in (scene.edges, scene.body, scene.tail, stage.tips(scene)):
            flat = part.reshape(len(part), -1, 3)
            assert (flat >= box[:, None, :, 0]).all()
            assert (flat <= box[:, None, :, 1]).all()
        sides = np.diff(box, axis=2)
        np.testing.assert_allclose(sides, np.broadcast_to(sides[0], sides.shape), atol=1e-9)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"beats": 0}, "beats must be from 1 to 100, not 0"),
        ({"frames": 49}, "frames of a beat must be from 8 to 48, not 49"),
        ({"mode": 4}, "mode must be from 0 to 3, not 4"),
        ({"scale": 1.0}, "say which mode"),
        ({"mode": 0, "scale": -1.0}, "scale must be positive"),
        ({"colour": "red"}, '"circulation", "incidence" or "load", not "red"'),
        ({"view": "side"}, 'view must be "bird" or "path"'),
    ],
)
def test_what_cannot_be_shown_is_said(tail_cycle, options, sentence):
    with pytest.raises(birdmb.ArgumentError, match=sentence):
        tail_cycle.animate(**options)


def test_no_more_than_two_birds(tail_cycle):
    with pytest.raises(birdmb.ArgumentError, match="one bird or two, not 3"):
        tail_cycle.animate(tail_cycle, tail_cycle)


def test_every_colour_has_a_unit():
    units = [colour_named(name).unit for name in ("circulation", "incidence", "load")]
    assert units == ["m²/s", "°", "N/m²"]
