"""Tail, body and profile drag against cases computed by hand and against differences."""

import numpy as np
import pytest

from birdmb.aerodynamics.airframe import aero_constants, airframe_loads
from birdmb.aerodynamics.body_drag import body_drag_force
from birdmb.aerodynamics.prescribed import free_loads, odd_wakes, prescribed_wing, symmetric_loads
from birdmb.aerodynamics.tail import tail_angle, tail_force, tail_influence, tail_surface
from birdmb.wing.arrays import wing_arrays

DENSITY = 1.225


@pytest.fixture
def bird(ibis_tail):
    """With its tail along the body."""
    return ibis_tail.with_values({"tail.incidence_deg": 0})


def planar_airframe_loads(aero, induced, u, w, q):
    """F_x, F_z (N) and M_y (N m) of tail and body in symmetric flight."""
    twist = np.array([u, 0.0, w, 0.0, q, 0.0])
    wrench = airframe_loads(aero, induced.reshape(2, 1), twist, np.empty(0, np.int64))
    return wrench[[0, 2, 4], 0]


def wind(speed, alpha):
    """In the plane of symmetry, meeting a plate along the body at this angle."""
    return np.array([-speed * np.cos(alpha), 0.0, -speed * np.sin(alpha)])


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
    lift = [tail_force(tail, DENSITY, wind(14.0, a))[2, 0] for a in (h, -h)]
    # In the wind's axes: the friction's share of F_z is taken off.
    friction = tail_force(tail, DENSITY, wind(14.0, 0.0))[0, 0]
    slope = (lift[1] - lift[0]) / (2 * h) + friction
    assert slope == pytest.approx(8.99319, rel=1e-5)


def test_tail_drag(bird):
    """At 0.05 rad and 14 m/s, with Re = 14 x 0.30/1.5e-5 = 280000.

    Friction 1/2 x 1.225 x 196 x 0.03275732 x 1.328/sqrt(280000) = 0.00986936 N, induced drag
    1/2 x 8.99319 x 0.05^2 = 0.01124149 N.
    """
    tail = tail_surface(bird)
    force = tail_force(tail, DENSITY, wind(14.0, 0.05))[:, 0]
    along = wind(1.0, 0.05)
    across = np.array([-along[2], 0.0, along[0]])
    assert force @ along == pytest.approx(0.00986936 + 0.01124149, rel=1e-5)
    assert force @ across == pytest.approx(8.99319 * 0.05, rel=1e-5)
    assert across[2] < 0  # lift is upwards


def test_tail_force_derivatives(bird):
    tail = tail_surface(bird.with_values({"tail.incidence_deg": 3}))
    at, h = np.array([-13.0, 1.7, -0.8]), 1e-5
    exact = tail_force(tail, DENSITY, at)[:, 1:]
    columns = [
        (tail_force(tail, DENSITY, at + e) - tail_force(tail, DENSITY, at - e))[:, 0]
        for e in h * np.eye(3)
    ]
    np.testing.assert_allclose(exact, np.column_stack(columns) / (2 * h), rtol=1e-7, atol=1e-9)


def test_incidence_adds_to_the_angle_of_attack(bird):
    tilted = tail_surface(bird.with_values({"tail.incidence_deg": 2}))
    assert tail_angle(tilted, *wind(10.0, 0.03)[[0, 2]]) == pytest.approx(0.03 + np.radians(2))


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
    aero = aero_constants(bird)
    return planar_airframe_loads(aero, np.zeros(2), u, w, q)


def test_a_furled_tail_has_no_loads(bird):
    furled = bird.with_values({"tail.opening_deg": 0, "drag.body": False})
    np.testing.assert_array_equal(quiet_loads(furled, 14.0, -1.0, 0.3), 0.0)


def test_body_drag_of_the_ibis(bird):
    """1.2 kg at 14 m/s.

    S = 0.00813 x 1.2^(2/3) = 0.00918075 m2, diameter 0.10811702 m, Re = 100909.2, FR = 6.25109;
    C_d = 66.6 x 1.2^-0.511 x 6.2511^0.9015 x S^1.063 x Re^-0.197 = 0.2235279; drag 0.2463610 N.
    """
    drag = aero_constants(bird).body
    assert body_drag_force(drag, np.array([14.0, 0.0, 0.0]))[0, 0] == pytest.approx(
        -0.2463610, rel=1e-6
    )
    slow, fast = (body_drag_force(drag, np.array([u, 0.0, 0.0]))[0, 0] for u in (7.0, 14.0))
    assert fast / slow == pytest.approx(2 ** (2 - 0.197))
    own = bird.with_values({"drag.frontal_area": 0.01, "drag.body_coefficient": 0.3})
    # 1/2 x 1.225 x 0.01 x 0.3 x 100
    slanting = body_drag_force(aero_constants(own).body, np.array([6.0, 0.0, 8.0]))[:, 0]
    assert slanting == pytest.approx([-0.18375 * 0.6, 0.0, -0.18375 * 0.8])


@pytest.mark.parametrize("downwash", ["wake", "wake and bound"])
def test_derivatives_of_all_loads_are_exact(bird, downwash):
    """Against central differences, whose error falls by four when their step is halved."""
    changed = bird.with_values(
        {"tail.downwash": downwash, "tail.incidence_deg": 2, "tail.apex.z": 0.05}
    )
    aero = aero_constants(changed)
    table = prescribed_wing(wing_arrays(changed), aero.tail, np.array([0.04]), 16, 0.5, False)
    twist = np.array([14.0, 0.8, -0.5, -0.4, 0.7, 0.3])
    everything = np.arange(6)

    def loads(twist):
        return free_loads(table, table, odd_wakes(table), 0, aero, twist, everything)

    exact = loads(twist)[:, 1:]
    errors = []
    for h in (1e-2, 5e-3):
        columns = [(loads(twist + e) - loads(twist - e))[:, 0] for e in h * np.eye(6)]
        errors.append(np.abs(np.column_stack(columns) / (2 * h) - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.05)


# At t = 0, 0.04 and 0.17 s, u, w and q: F_x, F_z and M_y (rows) and their derivatives by these, as
# the kernel for planar flight alone computed them (birdmb at commit 86fd958).
PLANAR_LOADS = {
    (0, 14.0, -0.5, 0.7): [
        [2.167861566158094, -0.6616356664606153, 2.968684590762591, -0.06959740533380314],
        [-18.93549195481342, -0.446956928409921, -8.658706476594825, -0.17122309291131893],
        [0.39846178025957546, 0.04089176806255576, -0.09744859741723502, -0.16816477927161813],
    ],
    (1, 14.0, -0.5, 0.7): [
        [1.1122063190540152, -0.22976936570383974, 1.6298552317617458, -0.08155691161085674],
        [-12.625607296630372, -0.8567153335910020, -5.741179741933035, -0.24628156868398204],
        [0.5584691184980769, 0.0016673168056861379, 0.11437548050346102, -0.1785640052812692],
    ],
    (2, 9.0, 1.2, -2.0): [
        [-0.11244197717274733, -0.1875612977196069, -0.2505452293980246, -0.05452471295388438],
        [-2.0645463349785014, -0.8690275709804218, -2.9641350647158653, -0.32305503093400656],
        [0.17813644863042444, -0.00575947922303923, -0.2781142504476383, -0.11829932293669294],
    ],
}


@pytest.mark.parametrize("at", PLANAR_LOADS)
def test_loads_of_symmetric_flight_are_what_they_were(bird, at):
    changed = bird.with_values(
        {"tail.downwash": "wake and bound", "tail.incidence_deg": 2, "tail.apex.z": 0.05}
    )
    aero, (k, u, w, q) = aero_constants(changed), at
    times = np.array([0.0, 0.04, 0.17])
    table = prescribed_wing(wing_arrays(changed), aero.tail, times, 16, 0.5, False)
    twist = np.array([u, 0.0, w, 0.0, q, 0.0])
    planar = symmetric_loads(table, k, aero, twist, np.array([0, 2, 4]))
    np.testing.assert_allclose(planar[::2], PLANAR_LOADS[at], rtol=1e-12, atol=1e-13)
    assert not planar[1::2].any()
    free = free_loads(table, table, odd_wakes(table), k, aero, twist, np.arange(6))
    np.testing.assert_allclose(free[:, [0, 1, 3, 5]], planar, rtol=1e-12, atol=1e-13)
    # Sideways motion answers with sideways loads alone.
    np.testing.assert_allclose(free[::2, [2, 4, 6]], 0.0, atol=1e-12)


def test_profile_drag_of_a_still_wing(bird):
    """C_d x 1/2 rho U^2 x area, straight back, for a wing at rest in a wind along x."""
    names = [joint.name for joint in bird.joints]
    held = {f"{name}.{key}": 0.0 for name in names for key in ("offset", "amplitude")}
    still = bird.with_values(held | {"tail.opening_deg": 0, "drag.body": False})
    wing = wing_arrays(still)
    forwards, no_derivatives = np.array([10.0, 0.0, 0.0, 0.0, 0.0, 0.0]), np.empty(0, int)
    loads = []
    for bare in (still, still.with_values({"drag.profile_coefficient": 0})):
        aero = aero_constants(bare)
        table = prescribed_wing(wing, aero.tail, np.array([0.0]), 32, 0.5, False)
        loads.append(symmetric_loads(table, 0, aero, forwards, no_derivatives)[::2, 0])
    area = 2 * float((table.elements.chord * table.elements.width).sum())
    drag = loads[0] - loads[1]
    assert drag[0] == pytest.approx(-0.02 * 0.5 * DENSITY * 100 * area)
    assert drag[1] == pytest.approx(0.0, abs=1e-12)
