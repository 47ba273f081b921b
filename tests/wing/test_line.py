"""The lifting line: orthogonal, smooth, and with exact velocities."""

import numpy as np
import pytest

from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.topology import PRESETS
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import wing_edges
from birdmb.wing.line import orthogonal_line
from birdmb.wing.one_step import one_step_line
from birdmb.wing.rounded import (
    points,
    rounded_polyline,
    write_points_and_tangents,
    write_rates,
)
from birdmb.wing.shape import turned, wing_shape
from tests.conftest import REFERENCE
from tests.wing.test_edges import from_reference_axes

ROUNDING = PRESETS["converged"].rounding
PHASES = np.arange(8) / 32


@pytest.fixture(scope="module")
def wing(ibis):
    return wing_arrays(ibis)


def edges_at(wing, t):
    return wing_edges(wing, driver_motion(wing, t)[0] + 0j)


def test_rounded_polyline_leaves_the_legs_only_near_the_corners():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [1, 2, 0], [1, 2, 3]])
    line = rounded_polyline(vertices, 0.5)
    on_legs = points(line, np.array([0.0, 1.0, 2 / 6]))
    np.testing.assert_allclose(on_legs, [vertices[0], vertices[3], [1, 1, 0]], atol=1e-15)
    # Half-width 0.5 * 1 * 2 / 3 at the first corner: there the legs are left.
    s = np.array([1 - 1 / 3, 1 + 1 / 3])
    expected = [[min(along, 1), max(0, along - 1), 0] for along in s]
    np.testing.assert_allclose(points(line, s / 6), expected, atol=1e-15)
    corner = points(line, np.array([1 / 6]))[0]
    assert 0 < np.hypot(1 - corner[0], corner[1]) < 1 / 3


def test_tangents_of_a_rounded_polyline_are_its_derivatives():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0.3], [1, 2, 0], [1, 2, 3]])
    s = np.linspace(0, 1, 41)
    found, tangents = np.empty((41, 3)), np.empty((41, 3))
    write_points_and_tangents(rounded_polyline(vertices, 0.5), s, found, tangents)
    stepped = points(rounded_polyline(vertices + 0j, 0.5), s + 1e-30j)
    np.testing.assert_allclose(found, stepped.real, rtol=0, atol=1e-15)
    np.testing.assert_allclose(tangents, stepped.imag / 1e-30, rtol=0, atol=1e-13)


def test_rates_of_a_rounded_polyline_are_those_of_its_points():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0.3], [1, 2, 0], [1, 2, 3]])
    moving = vertices + 1e-30j * np.random.default_rng(3).standard_normal(vertices.shape)
    s, rates = np.linspace(0, 1, 41), np.empty((41, 3))
    write_rates(rounded_polyline(moving, 0.5), s, rates)
    ahead, back = (
        points(rounded_polyline(vertices + h * moving.imag / 1e-30, 0.5), s) for h in (1e-6, -1e-6)
    )
    np.testing.assert_allclose(rates / 1e-30, (ahead - back) / 2e-6, rtol=0, atol=1e-8)


@pytest.mark.parametrize("t", PHASES)
def test_chords_are_orthogonal_to_the_line(wing, t):
    pairs = orthogonal_line(*edges_at(wing, t), 64, ROUNDING)
    assert pairs.converged
    line = (0.75 * pairs.leading + 0.25 * pairs.trailing).real
    chord = (pairs.trailing - pairs.leading).real[1:-1]
    along = line[2:] - line[:-2]
    cosine = np.sum(chord * along, axis=1) / (
        np.linalg.norm(chord, axis=1) * np.linalg.norm(along, axis=1)
    )
    # Near the tip the chords are short: their cosines tell the tolerance of the Newton iteration.
    assert np.abs(cosine).max() < 1e-6


def test_line_is_second_order_in_the_number_of_stations(wing):
    lengths = []
    for stations in (65, 129, 257, 513):
        pairs = orthogonal_line(*edges_at(wing, 0.0), stations, 1.0)
        line = (0.75 * pairs.leading + 0.25 * pairs.trailing).real
        lengths.append(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
    steps = np.abs(np.diff(lengths))
    orders = np.log2(steps[:-1] / steps[1:])
    assert (orders > 1.8).all(), orders


@pytest.mark.parametrize("published", [False, True])
@pytest.mark.parametrize("t", [0.01, 0.09, 0.13, 0.2])
def test_velocities_are_the_derivatives_of_the_positions(wing, t, published):
    elements = 8 if published else 32

    def controls(when):
        angles, rates, _ = driver_motion(wing, when)
        return wing_shape(wing, angles, rates, elements, ROUNDING, published)

    h = 2e-6
    difference = (controls(t + h).line[0::2] - controls(t - h).line[0::2]) / (2 * h)
    velocity = controls(t).velocity
    np.testing.assert_allclose(velocity, difference, atol=2e-7 * np.abs(velocity).max())


def test_line_is_smooth_in_time(wing):
    """The error of differencing the velocity falls like h^2, as it does for smooth functions only.

    The published line, whose points jump from leg to leg, fails this.
    """

    def velocity(t):
        angles, rates, _ = driver_motion(wing, t)
        return wing_shape(wing, angles, rates, 32, ROUNDING, False).velocity

    for t in PHASES:
        fine, coarse = (
            (velocity(t + h) - 2 * velocity(t) + velocity(t - h)) / h**2 for h in (5e-5, 1e-4)
        )
        assert np.abs(fine - coarse).max() < 0.05 * np.abs(fine).max()


def test_published_line_is_the_reference_programs(wing):
    reference = np.load(REFERENCE / "geometry.npz")
    for i, t in enumerate(reference["t"]):
        pairs, _ = one_step_line(*edges_at(wing, t), 16)
        line = 0.75 * pairs.leading + 0.25 * pairs.trailing
        np.testing.assert_allclose(
            line.real, from_reference_axes(reference["line_right"][i]), atol=1e-14
        )
        chord = np.linalg.norm((pairs.trailing - pairs.leading).real, axis=1)
        np.testing.assert_allclose(chord, reference["chord_right"][i], atol=1e-14)


def test_published_velocities_are_the_reference_programs(wing):
    """To the reference's central differences, 2e-6 m/s."""
    reference = np.load(REFERENCE / "geometry.npz")
    for i, t in enumerate(reference["t"]):
        angles, rates, _ = driver_motion(wing, t)
        shape = wing_shape(wing, angles, rates, 8, ROUNDING, True)
        np.testing.assert_allclose(
            shape.velocity, from_reference_axes(reference["v_kin"][i, 8:]), atol=2e-6
        )


def test_shoulder_joints_turn_the_shape_as_a_whole(wing):
    """A shape at zero shoulder angles, turned, is the shape at those angles, rates and all."""
    angles, rates, _ = driver_motion(wing, 0.06)
    still_angles, still_rates = angles.copy(), rates.copy()
    still_angles[:3] = still_rates[:3] = 0.0
    still = wing_shape(wing, still_angles, still_rates, 16, ROUNDING, False)
    spin = rates[:3] @ joint_chain(wing, angles).axis[:3]
    whole = turned(still, joint_chain(wing, angles).frame[3], spin)
    direct = wing_shape(wing, angles, rates, 16, ROUNDING, False)
    for name in ("line", "velocity", "chord_direction", "normal", "span_direction", "chord"):
        np.testing.assert_allclose(getattr(whole, name), getattr(direct, name), atol=1e-10)


def test_loads_pass_over_smoothly_from_bone_to_bone(wing):
    for t in PHASES:
        angles, rates, _ = driver_motion(wing, t)
        beyond = wing_shape(wing, angles, rates, 64, ROUNDING, False).distal_fraction
        assert (np.diff(beyond, axis=0) >= 0).all()
        assert (beyond[0] == 0).all()
        assert (beyond[-1] == 1).all()
        assert (beyond[:, 0] >= beyond[:, 1]).all()
        assert ((beyond > 0) & (beyond < 1)).any()


def test_a_line_that_cannot_be_found_is_told(ibis):
    """With the wing folded up on itself, most phases of the beat have no such line."""
    folded = wing_arrays(
        ibis.with_values({"elbow.sweep.offset_deg": 130, "wrist.sweep.offset_deg": -150})
    )
    lines = [orthogonal_line(*edges_at(folded, t), 128, ROUNDING) for t in PHASES]
    assert not all(pairs.converged for pairs in lines)


def test_fine_lines_do_not_double_back(wing):
    for t in PHASES:
        pairs = orthogonal_line(*edges_at(wing, t), 192, ROUNDING)
        assert pairs.converged
        steps = np.diff((0.75 * pairs.leading + 0.25 * pairs.trailing).real, axis=0)
        assert (np.sum(steps[1:] * steps[:-1], axis=1) > 0).all()
