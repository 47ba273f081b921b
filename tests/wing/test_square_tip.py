"""Wings that end in a tip edge: the line ends with them, and its loads settle."""

import numpy as np
import pytest

from birdmb.aerodynamics.elements import place_elements
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.edges import wing_edges
from birdmb.wing.line import orthogonal_line
from birdmb.wing.line_ends import edge_ends, line_ends
from birdmb.wing.rounded import rounded_polyline
from birdmb.wing.shape import wing_shape
from tests.aerodynamics.pairs import element_loads, resultant
from tests.aerodynamics.test_circulation import ALPHA, DENSITY, SPEED, wind

STILL = np.zeros(6)
HALF_SPAN = 0.38  # of the ibis' bones
EVEN, WIDENING, TAPERING = (0.1,) * 4, (0.1, 0.15, 0.2, 0.25), (0.25, 0.2, 0.15, 0.1)


def straight_aft(ibis, lengths, *, root=0.0, tip_angle=0.0, **values):
    """Feathers straight aft but for the last one's `tip_angle` in degrees."""
    for name, length in zip("7531", lengths, strict=True):
        values |= {f"feathers.{name}.length": length, f"feathers.{name}.rest_angle_deg": 0.0}
    values |= {"feathers.5.shares": {}, "feathers.3.shares": {}}
    values |= {"wing.root.y": root, "feathers.1.rest_angle_deg": tip_angle}
    return wing_arrays(ibis.with_values(values))


def lift(wing, elements, angles=STILL):
    """Lift (N) of both wings, and the circulations (N,) m2/s."""
    shape = wing_shape(wing, angles, STILL, elements, 0.5, False)
    assert shape.converged
    placed = place_elements(shape, wing.root)
    loads = element_loads(placed, DENSITY, 0.0, *wind(), 0.0)
    fx, fz, _ = resultant(placed, loads)
    return -fz * np.cos(ALPHA) + fx * np.sin(ALPHA), loads.circulation


def rectangular_lift_slope(aspect_ratio, terms=100):
    """Glauert's series by collocation, for sections with a slope of 2 pi."""
    k = np.arange(1, 2 * terms, 2)
    theta = (np.arange(terms) + 0.5) / terms * np.pi / 2
    mu = np.pi / (2 * aspect_ratio)
    system = np.sin(np.outer(theta, k)) * (mu * k + np.sin(theta)[:, None])
    return np.pi * aspect_ratio * np.linalg.solve(system, mu * np.sin(theta))[0]


def test_rectangle_of_feathers_has_the_lift_of_the_exact_rectangle(ibis):
    """A chord of feather and two half-thicknesses, no gap over the body; of second order."""
    chord = 0.1 + 2 * 0.01
    assert rectangular_lift_slope(6.0) == pytest.approx(4.530425, abs=1e-6)  # Glauert's number
    slope = rectangular_lift_slope(2 * HALF_SPAN / chord)
    exact = slope * ALPHA * 0.5 * DENSITY * SPEED**2 * 2 * HALF_SPAN * chord
    wing = straight_aft(ibis, EVEN)
    errors = np.array([abs(lift(wing, n)[0] / exact - 1) for n in (16, 32, 64)])
    assert errors[-1] < 3e-5
    assert (np.log2(errors[:-1] / errors[1:]) > 1.8).all()


@pytest.mark.parametrize("elements", [8, 11, 96])
def test_chords_of_a_rectangle_are_straight(ibis, elements):
    shape = wing_shape(straight_aft(ibis, EVEN), STILL, STILL, elements, 0.5, False)
    np.testing.assert_allclose(shape.chord, 0.12, rtol=1e-12)
    np.testing.assert_allclose(shape.chord_direction, [[-1.0, 0.0, 0.0]] * elements, atol=1e-12)
    np.testing.assert_allclose(shape.line[-1], [0.01 - 0.03, HALF_SPAN, 0.0], atol=1e-14)


@pytest.mark.parametrize("lengths", [WIDENING, TAPERING])
@pytest.mark.parametrize("tip_angle", [-20.0, 0.0, 30.0])
def test_loads_settle_on_more_elements(ibis, lengths, tip_angle):
    wing = straight_aft(ibis, lengths, root=0.05, tip_angle=tip_angle)
    found = [lift(wing, n) for n in (16, 32, 64, 128)]
    lifts = np.array([of for of, _ in found])
    assert np.abs(lifts[1:3] / lifts[-1] - 1).max() < 2e-3
    assert abs(lifts[2] / lifts[-1] - 1) < 6e-4
    # The circulation falls to nothing at the tip, as the square root of the distance to it.
    last = [abs(circulation[-1]) / circulation.max() for _, circulation in found]
    assert last[-1] < 0.6 * last[-2]


@pytest.mark.parametrize("lengths", [EVEN, WIDENING, TAPERING])
def test_neighbouring_chords_do_not_alternate(ibis, lengths):
    """A condition too many leaves an error that changes sign from station to station."""
    wing = straight_aft(ibis, lengths)
    pairs = orthogonal_line(*wing_edges(wing, STILL + 0j), 256, 0.5)
    assert pairs.converged
    along = pairs.trailing[:, 1].real - pairs.leading[:, 1].real
    # Beside the shoulder, whose chord is given, the line may turn at once.
    bends = np.diff(along[1:], 2)
    alternating = (bends[1:] * bends[:-1] < 0) & (np.abs(bends[1:]) > 1e-6)
    assert alternating.sum() < 6


@pytest.mark.parametrize("lengths", [EVEN, WIDENING, TAPERING])
def test_chords_up_to_the_tip_are_orthogonal(ibis, lengths):
    """Of the last chord itself, to the line that leads to it."""
    wing = straight_aft(ibis, lengths, tip_angle=10.0)
    pairs = orthogonal_line(*wing_edges(wing, STILL + 0j), 256, 0.5)
    line = (0.75 * pairs.leading + 0.25 * pairs.trailing).real
    chord = (pairs.trailing - pairs.leading).real[-1]
    along = line[-1] - line[-3]
    cosine = chord @ along / (np.linalg.norm(chord) * np.linalg.norm(along))
    assert abs(cosine) < 5e-3


@pytest.mark.parametrize("tip_angle", [0.0, 10.0, 30.0])
def test_a_raked_tip_keeps_the_area(ibis, tip_angle):
    """Straightened near the middle of the tip edge: the rectangle of the trapezoid's area."""
    angle = np.radians(tip_angle)
    # All feathers reach as far back as the last one.
    lengths = (*[0.1 * np.cos(angle)] * 3, 0.1)
    shape = wing_shape(
        straight_aft(ibis, lengths, tip_angle=tip_angle), STILL, STILL, 64, 0.5, False
    )
    assert shape.line[-1, 1] == pytest.approx(HALF_SPAN + 0.05 * np.sin(angle), abs=1e-3)


@pytest.mark.parametrize("lengths", [EVEN, WIDENING, TAPERING])
def test_velocities_of_a_square_wing_are_derivatives(ibis, lengths):
    """Against central differences, all joints moving."""
    wing = straight_aft(ibis, lengths, tip_angle=15.0)
    angles = np.array([0.2, 0.3, -0.2, 0.3, 0.2, -0.4])
    rates = np.array([1.0, -2.0, 1.5, 3.0, -2.0, 4.0])
    h = 1e-6

    def line(step):
        return wing_shape(wing, angles + step * rates, STILL, 16, 0.5, False).line[0::2]

    velocity = wing_shape(wing, angles, rates, 16, 0.5, False).velocity
    difference = (line(h) - line(-h)) / (2 * h)
    np.testing.assert_allclose(velocity, difference, atol=1e-7 * np.abs(velocity).max())


def test_conditions_go_where_the_chord_is_short():
    """The end of the longest chord is left to the equation; at a point there is no tip edge."""
    front = rounded_polyline(np.array([[0.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 1.0, 0.0]]), 0.5)
    for tip, expected in ((0.4, (0.0, 1.0)), (0.2, (0.5, 0.5)), (0.1, (1.0, 0.0))):
        back = [[-0.2, 0.0, 0.0], [-0.1 - tip / 2, 0.5, 0.0], [-tip, 1.0, 0.0]]
        ends = line_ends(edge_ends(front, rounded_polyline(np.array(back), 0.5)), 1e-3)
        assert (ends.shoulder, ends.tip) == pytest.approx(expected)
        assert ends.square
    pointed = [[-0.2, 0.0, 0.0], [-0.2, 0.5, 0.0], [0.0, 1.0, 0.0]]
    edges = edge_ends(front, rounded_polyline(np.array(pointed), 0.5))
    assert not line_ends(edges, 1e-3).square


@pytest.mark.parametrize(
    ("values", "square"),
    [
        ({}, False),
        ({"feathers.1.rest_angle_deg": 50}, False),
        ({"feathers.1.rest_angle_deg": 40}, True),
        ({"feathers.1.rest_angle_deg": 0}, True),
        ({"feathers.1.rest_angle_deg": -40}, True),
    ],
)
def test_which_tips_are_square(ibis, values, square):
    assert wing_arrays(ibis.with_values(values)).square_tip is square
