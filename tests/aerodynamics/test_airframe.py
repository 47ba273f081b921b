"""Tail, body and profile drag against cases computed by hand and against differences."""

import numpy as np
import pytest

from birdmb.aerodynamics.airframe import airframe, airframe_loads
from birdmb.aerodynamics.body_drag import body_drag_force
from birdmb.aerodynamics.prescribed import bird_loads, prescribed_wing
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence, tail_surface
from birdmb.wing.arrays import wing_arrays

DENSITY = 1.225


@pytest.fixture
def bird(ibis_tail):
    """With its tail along the body."""
    return ibis_tail.with_values({"tail.incidence_deg": 0})


def wind(speed, alpha):
    """Along x and z, meeting a plate along the body at this angle."""
    return -speed * np.cos(alpha), -speed * np.sin(alpha)


def test_tail_geometry(bird):
    """40 deg and 0.30 m: span 2 x 0.30 tan(20 deg), centre of pressure 0.2 m behind the apex."""
    tail = tail_surface(bird)
    assert tail.span == pytest.approx(0.21838214, rel=1e-7)
    assert tail.area == pytest.approx(0.03275732, rel=1e-6)
    assert (tail.x, tail.z) == pytest.approx((-0.5, 0.0), abs=1e-15)
    tilted = tail_surface(bird.with_values({"tail.incidence_deg": 90}))
    assert (tilted.x, tilted.z) == pytest.approx((-0.3, 0.2))  # leading edge up: it hangs down


def test_tail_lift_slope(bird):
    """dL/dalpha = pi/4 x 1.225 x 14^2 x 0.21838214^2 = 8.99319 N."""
    tail = tail_surface(bird)
    h = 1e-5
    lift = [tail_force(tail, DENSITY, *wind(14.0, a))[1, 0] for a in (h, -h)]
    # In the wind's axes: the friction's share of F_z is taken off.
    friction = tail_force(tail, DENSITY, *wind(14.0, 0.0))[0, 0]
    slope = (lift[1] - lift[0]) / (2 * h) + friction
    assert slope == pytest.approx(8.99319, rel=1e-5)


def test_tail_drag(bird):
    """At 0.05 rad and 14 m/s, with Re = 14 x 0.30/1.5e-5 = 280000.

    Friction 1/2 x 1.225 x 196 x 0.03275732 x 1.328/sqrt(280000) = 0.00986936 N, induced drag
    1/2 x 8.99319 x 0.05^2 = 0.01124149 N.
    """
    tail = tail_surface(bird)
    force = tail_force(tail, DENSITY, *wind(14.0, 0.05))[:, 0]
    along = np.array(wind(1.0, 0.05))
    across = np.array([-along[1], along[0]])
    assert force @ along == pytest.approx(0.00986936 + 0.01124149, rel=1e-5)
    assert force @ across == pytest.approx(8.99319 * 0.05, rel=1e-5)
    assert across[1] < 0  # lift is upwards


def test_tail_force_derivatives(bird):
    tail = tail_surface(bird.with_values({"tail.incidence_deg": 3}))
    at, h = np.array([-13.0, -0.8]), 1e-5
    exact = tail_force(tail, DENSITY, *at)[:, 1:]
    steps = h * np.eye(2)
    columns = [
        (tail_force(tail, DENSITY, *(at + e)) - tail_force(tail, DENSITY, *(at - e)))[:, 0]
        for e in steps
    ]
    np.testing.assert_allclose(exact, np.column_stack(columns) / (2 * h), rtol=1e-7)


def test_incidence_adds_to_the_angle_of_attack(bird):
    tilted = tail_surface(bird.with_values({"tail.incidence_deg": 2}))
    assert tail_angle(tilted, *wind(10.0, 0.03)) == pytest.approx(0.03 + np.radians(2))


def test_downwash_of_a_horseshoe_vortex(bird):
    """One vortex of span 2 s at the apex's height, seen from the plane of symmetry at distance d.

    Wake: 2 (1 + d/sqrt(d^2 + s^2))/(4 pi s); bound: 2 s/(4 pi d sqrt(d^2 + s^2)).
    """
    d, s = 0.5, 0.4
    node = np.array([[0.0, 0.0, 0.0], [0.0, s, 0.0]])
    tail = tail_surface(bird)
    far = np.hypot(d, s)
    wake = 2 * (1 + d / far) / (4 * np.pi * s)
    assert tail_influence(tail, node)[:, 0] == pytest.approx([0.0, wake])
    both = tail_surface(bird.with_values({"tail.downwash": "wake and bound"}))
    bound = 2 * s / (4 * np.pi * d * far)
    assert tail_influence(both, node)[:, 0] == pytest.approx([0.0, wake + bound])
    neither = tail_surface(bird.with_values({"tail.downwash": "none"}))
    assert not tail_influence(neither, node).any()


def test_a_bound_vortex_above_the_tail_speeds_the_air_under_it_down(bird):
    """An infinitely wide vortex at height h above the tail induces Gamma/(2 pi h) along x."""
    wide, h = 1e4, 0.1
    node = np.array([[-0.5, 0.0, -h], [-0.5, wide, -h]])
    both = tail_surface(bird.with_values({"tail.downwash": "wake and bound"}))
    along, _ = tail_influence(both, node)[:, 0]
    # The wind blows towards negative x.
    assert along == pytest.approx(1 / (2 * np.pi * h), rel=1e-6)


def test_an_elliptic_wing_far_ahead_induces_twice_the_downwash_at_itself(bird):
    """Far behind, in the wake's middle: Gamma_0/b, twice the Gamma_0/(2 b) on the line."""
    errors = []
    for n in (50, 100):
        y = np.sin(np.linspace(0, np.pi / 2, n + 1))
        node = np.column_stack([np.full(n + 1, 1e4), y, np.zeros(n + 1)])
        middle = np.sin((np.arange(n) + 0.5) / n * np.pi / 2)
        down = tail_influence(tail_surface(bird), node)[1] @ np.sqrt(1 - middle**2)
        errors.append(abs(down - 0.5))  # b = 2
    # Of first order, for the wake is felt in its own plane, where 1/y has its pole.
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.01)
    assert 2 * errors[1] - errors[0] == pytest.approx(0, abs=3e-5)


def test_pitching_up_swings_the_tail_down(bird):
    """Nose up at 1 rad/s, the tail 0.5 m behind G goes down at 0.5 m/s: air comes from below."""
    loads = quiet_loads(bird, 14.0, 0.0, 0.0), quiet_loads(bird, 14.0, 0.0, 1.0)
    change = loads[1] - loads[0]
    # 8.99319 N/rad x atan(0.5/14), and its moment about G, 0.5 m ahead, nose down.
    assert change[1] == pytest.approx(-8.99319 * np.arctan(0.5 / 14), rel=5e-3)
    assert change[2] == pytest.approx(-0.5 * 8.99319 * np.arctan(0.5 / 14), rel=5e-3)


def quiet_loads(bird, u, w, q):
    """Loads of tail and body alone."""
    frame = airframe(bird)
    return airframe_loads(frame, np.zeros((2, 4)), u, w, q)[:, 0]


def test_a_furled_tail_has_no_loads(bird):
    furled = bird.with_values({"tail.opening_deg": 0, "drag.body": False})
    np.testing.assert_array_equal(quiet_loads(furled, 14.0, -1.0, 0.3), 0.0)


def test_body_drag_of_the_ibis(bird):
    """1.2 kg at 14 m/s.

    S = 0.00813 x 1.2^(2/3) = 0.00918075 m2, diameter 0.10811702 m, Re = 100909.2, FR = 6.25109;
    C_d = 66.6 x 1.2^-0.511 x 6.2511^0.9015 x S^1.063 x Re^-0.197 = 0.2235279; drag 0.2463610 N.
    """
    drag = airframe(bird).body
    assert body_drag_force(drag, 14.0, 0.0)[0, 0] == pytest.approx(-0.2463610, rel=1e-6)
    slow, fast = (body_drag_force(drag, u, 0.0)[0, 0] for u in (7.0, 14.0))
    assert fast / slow == pytest.approx(2 ** (2 - 0.197))
    own = bird.with_values({"drag.frontal_area": 0.01, "drag.body_coefficient": 0.3})
    # 1/2 x 1.225 x 0.01 x 0.3 x 100
    assert body_drag_force(airframe(own).body, 6.0, 8.0)[:, 0] == pytest.approx(
        [-0.18375 * 0.6, -0.18375 * 0.8]
    )


@pytest.mark.parametrize("downwash", ["wake", "wake and bound"])
def test_derivatives_of_all_loads_are_exact(bird, downwash):
    """Against central differences, whose error falls by four when their step is halved."""
    changed = bird.with_values(
        {"tail.downwash": downwash, "tail.incidence_deg": 2, "tail.apex.z": 0.05}
    )
    frame = airframe(changed)
    table = prescribed_wing(wing_arrays(changed), frame.tail, np.array([0.04]), 16, 0.5, False)
    state = np.array([14.0, -0.5, 0.7])
    exact = bird_loads(table, 0, frame, *state)[:, 1:]
    errors = []
    for h in (1e-2, 5e-3):
        columns = [
            (bird_loads(table, 0, frame, *(state + e)) - bird_loads(table, 0, frame, *(state - e)))
            for e in h * np.eye(3)
        ]
        differences = np.column_stack([c[:, 0] for c in columns]) / (2 * h)
        errors.append(np.abs(differences - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)


def test_profile_drag_of_a_still_wing(bird):
    """C_d x 1/2 rho U^2 x area, straight back, for a wing at rest in a wind along x."""
    names = [joint.name for joint in bird.joints]
    held = {f"{name}.{key}": 0.0 for name in names for key in ("offset", "amplitude")}
    still = bird.with_values(held | {"tail.opening_deg": 0, "drag.body": False})
    wing = wing_arrays(still)
    loads = []
    for bare in (still, still.with_values({"drag.profile_coefficient": 0})):
        frame = airframe(bare)
        table = prescribed_wing(wing, frame.tail, np.array([0.0]), 32, 0.5, False)
        loads.append(bird_loads(table, 0, frame, 10.0, 0.0, 0.0)[:, 0])
    area = 2 * float((table.elements.chord * table.elements.width).sum())
    drag = loads[0] - loads[1]
    assert drag[0] == pytest.approx(-0.02 * 0.5 * DENSITY * 100 * area)
    assert drag[1] == pytest.approx(0.0, abs=1e-12)
