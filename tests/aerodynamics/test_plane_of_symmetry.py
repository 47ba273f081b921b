"""The right wing against the plane of symmetry: how near its line may come, and what is refused."""

import numpy as np
import pytest

import birdmb
from birdmb.aerodynamics.elements import clearance, place_elements
from birdmb.models.wing_model import wing_misplaced
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.shape import wing_shape
from tests.aerodynamics.pairs import element_loads
from tests.aerodynamics.test_circulation import DENSITY, both_wings, flat_wing, wind
from tests.wing.test_square_tip import EVEN, STILL, lift, straight_aft

STATE = [18.0, -2.0, -0.1, -0.1]
THROUGH = {"shoulder.flap.offset_deg": -90.0, "shoulder.flap.amplitude_deg": 100.0}


def test_the_gap_over_the_body_may_close(ibis):
    """Lift grows evenly with the gap, from none on: narrower than any element, or wider."""
    lifts = [lift(straight_aft(ibis, EVEN, root=y), 32)[0] for y in (0.0, 1e-9, 1e-4, 5e-3, 0.01)]
    assert lifts[1] == pytest.approx(lifts[0], rel=1e-6)
    slopes = (np.array(lifts[2:]) - lifts[0]) / [1e-4, 5e-3, 0.01]
    np.testing.assert_allclose(slopes, slopes[-1], rtol=0.01)
    # A rectangle that is wider by the gap gains that much area, and aspect ratio besides.
    assert slopes[-1] > lifts[0] / 0.38


@pytest.mark.parametrize("root", [0.0, 0.005])
def test_a_root_near_the_plane_is_that_of_both_wings(ibis, root):
    wing = straight_aft(ibis, EVEN, root=root)
    placed = place_elements(wing_shape(wing, STILL, STILL, 16, 0.5, False), wing.root)
    _, full_z = both_wings(placed)
    gamma = element_loads(placed, DENSITY, 0.0, *wind(), 0.0).circulation
    both = np.concatenate([gamma[::-1], gamma])
    np.testing.assert_allclose((full_z @ both)[16:], placed.induced_z @ gamma, rtol=1e-10)


@pytest.mark.parametrize("elements", [16, 32, 64])
def test_circulations_stay_what_they_are_as_the_line_nears_the_plane(ibis, elements):
    """It touches the plane at a root of 16.5 mm."""

    def largest(root):
        values = {"wing.root.y": root, "wing.discretisation.elements": elements}
        model = birdmb.RigidModel(ibis.with_values(values))
        times = np.arange(8) / 8 * model.period
        return max(np.abs(model.loads(t, STATE).right.circulation).max() for t in times)

    assert largest(0.0166) == pytest.approx(largest(0.03), rel=0.01)


def test_clearance_of_a_flat_wing():
    shape = flat_wing(lambda y: 0.2 + 0 * y, 8)
    assert clearance(place_elements(shape, np.zeros(3))) == 0.0
    assert clearance(place_elements(shape, np.array([0.0, -1e-15, 0.0]))) == 0.0
    assert clearance(place_elements(shape, np.array([0.0, 0.3, 0.0]))) == 0.3
    assert clearance(place_elements(shape, np.array([0.0, -0.3, 0.0]))) == -0.3
    along = shape._replace(line=shape.line[:, [1, 0, 2]])
    assert np.isnan(clearance(place_elements(along, np.array([0.0, 0.1, 0.0]))))


def test_loads_of_a_flow_that_overflows_are_not_finite(ibis):
    """And no error of a solver."""
    wing = wing_arrays(ibis)
    placed = place_elements(wing_shape(wing, STILL, STILL, 16, 0.5, False), wing.root)
    assert np.isnan(element_loads(placed, DENSITY, 0.0, 1e300, 1e300, 0.0).circulation).all()


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"wing.root.y": 0.005}, "wing.root.y must be 0.0166 m or more, not 0.005 m"),
        ({"wing.root.y": 0.0}, "wing.root.y must be 0.0166 m or more, not 0 m"),
        (THROUGH, "swing through one another"),
    ],
)
def test_both_models_refuse_a_line_across_the_plane(ibis, ibis_massless, values, says):
    rigid = birdmb.RigidModel(ibis.with_values(values))
    multibody = birdmb.MultibodyModel(ibis_massless.with_values(values))
    for attempt in (
        lambda: rigid.flow(STATE, 0.0, rigid.period),
        rigid.initial_guess,
        lambda: rigid.loads(0.125, STATE),
        lambda: multibody.loads(0.125, STATE),
        multibody.initial_guess,
    ):
        with pytest.raises(birdmb.StateError, match="across the plane of symmetry"):
            attempt()
    with pytest.raises(birdmb.StateError, match=says):
        rigid.loads(0.125 if says.startswith("wing") else 0.0625, STATE)


def test_the_multibody_bird_does_not_fly_through_the_plane(ibis_massless):
    """From where its wings are apart into where they are not."""
    model = birdmb.MultibodyModel(ibis_massless.with_values({"wing.root.y": 0.005}))
    with pytest.raises(birdmb.StateError, match="across the plane of symmetry"):
        model.flow(STATE, 0.0, model.period)


def test_a_line_along_the_stream_is_told(ibis):
    error = wing_misplaced(ibis, 0.1, STILL, np.nan)
    assert "runs along the stream" in str(error)
