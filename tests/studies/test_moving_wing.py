"""Wings that move in a stream, against exact solutions."""

import numpy as np
import pytest

import birdmb
from birdmb import PlaneWing, WingMotion, moving_wing_loads
from birdmb.aerodynamics.wake_lags import BOUND_RATES, BOUND_SHARES
from birdmb.orbits.trigonometric import interpolated
from birdmb.studies.experiments.thin_airfoil import OscillatingSection, wagner_function
from birdmb.studies.flight_regime import wake_deficiency
from birdmb.topology import Stall

# Half a chord, the speed and the density are 1; a wing so long that it is all section.
SMALL = 1e-3
SECTION = PlaneWing.rectangular(2e5, 2.0)
FREQUENCIES = (0.05, 0.1, 0.2, 0.3, 0.4, 0.52)
MOTIONS = ((1.0, 0.0), (0.0, 1.0), (0.6, np.exp(0.9j)))


def jones(k):
    """What his approximation of Wagner's function leaves of the circulation."""
    lags = zip(BOUND_SHARES, BOUND_RATES, strict=True)
    return 1.0 - sum(share * 1j * k / (1j * k + rate) for share, rate in lags)


def oscillating(k, heave, pitch, axis, **choices):
    motion = WingMotion(
        frequency=k / (2.0 * np.pi),
        heave=[0.0, SMALL * heave],
        pitch=[0.0, SMALL * pitch],
        pitch_axis=0.5 * (axis + 1.0),
    )
    unit = {"speed": 1.0, "density": 1.0, "elements": 8, "instants": 17}
    return moving_wing_loads(SECTION, motion, **unit | choices)


@pytest.mark.parametrize("k", FREQUENCIES)
@pytest.mark.parametrize(("heave", "pitch"), MOTIONS)
def test_a_section_has_the_loads_of_theodorsen_and_garrick(k, heave, pitch):
    """With Jones's function exactly but for the tips and the size of the motion."""
    loads = oscillating(k, heave, pitch, axis=-0.4)
    exact = OscillatingSection(k, heave, pitch, -0.4, jones)
    scale = SMALL * loads.dynamic_area
    assert loads.amplitude(loads.lift) / scale == pytest.approx(exact.lift, rel=3e-4)
    assert loads.amplitude(loads.moment) / (2.0 * scale) == pytest.approx(exact.moment, rel=3e-4)
    assert loads.mean_thrust_coefficient / SMALL**2 == pytest.approx(exact.thrust, rel=2e-3)
    assert loads.mean_power_coefficient / SMALL**2 == pytest.approx(exact.power, rel=2e-3)


@pytest.mark.parametrize("k", FREQUENCIES)
@pytest.mark.parametrize(("heave", "pitch"), MOTIONS)
def test_what_the_wake_leaves_is_within_jones_approximation_of_theodorsens_function(
    k, heave, pitch
):
    """Jones's function is off by 0.0145 at most, at k = 0.4."""
    loads = oscillating(k, heave, pitch, axis=0.2, apparent_mass=False)
    circulatory = loads.amplitude(loads.lift) / (SMALL * loads.dynamic_area)
    section = OscillatingSection(k, heave, pitch, 0.2)
    assert abs(circulatory / (2.0 * np.pi * section.downwash) - wake_deficiency(k)) < 0.0147


@pytest.mark.parametrize("k", [0.1, 0.4])
def test_quasi_steady_sections_with_apparent_mass_have_no_deficiency(k):
    loads = oscillating(k, 0.5, np.exp(0.9j), axis=-0.4, wake="quasi-steady")
    exact = OscillatingSection(k, 0.5, np.exp(0.9j), -0.4, lambda _: 1.0)
    scale = SMALL * loads.dynamic_area
    assert loads.amplitude(loads.lift) / scale == pytest.approx(exact.lift, rel=3e-4)
    assert loads.amplitude(loads.moment) / (2.0 * scale) == pytest.approx(exact.moment, rel=3e-4)


def test_a_start_follows_wagner():
    """Within Jones's approximation, 0.012 at most."""
    times = np.linspace(0.0, 30.0, 61)
    start = {"speed": 1.0, "density": 1.0, "elements": 8}
    motion = WingMotion(pitch=[SMALL])
    growing = moving_wing_loads(SECTION, motion, times=times, **start)
    final = moving_wing_loads(SECTION, motion, wake="quasi-steady", instants=3, **start)
    part = growing.lift / final.lift[0]
    shares = zip(BOUND_SHARES, BOUND_RATES, strict=True)
    np.testing.assert_allclose(
        part, 1.0 - sum(a * np.exp(-b * times) for a, b in shares), rtol=2e-4
    )
    exact = np.array([wagner_function(s) for s in times])
    assert np.abs(part - exact).max() < 0.012


@pytest.mark.parametrize(
    ("aspect_ratio", "share", "rate"), [(3.0, 0.283, 0.540), (6.0, 0.361, 0.381)]
)
def test_elliptic_wings_grow_their_lift_as_jones_computed(aspect_ratio, share, rate):
    """R. T. Jones, NACA Report 681, 1940: after one half chord within 5 % of the final lift."""
    wing = PlaneWing.elliptic(2.0, aspect_ratio)
    half_chords = np.linspace(0.0, 20.0, 81)
    motion = WingMotion(pitch=[SMALL])
    times = half_chords * 0.5 * wing.chords[0]
    start = moving_wing_loads(wing, motion, speed=1.0, times=times)
    final = moving_wing_loads(wing, motion, speed=1.0, wake="quasi-steady")
    off = start.lift / final.lift[0] - (1.0 - share * np.exp(-rate * half_chords))
    assert np.abs(off[half_chords >= 1.0]).max() < 0.025


@pytest.mark.parametrize("wake", ["quasi-steady", "unsteady"])
@pytest.mark.parametrize("apparent_mass", [True, False])
def test_at_rest_all_are_the_steady_lifting_line(wake, apparent_mass):
    """An elliptic wing of aspect ratio 8: C_L = 2 pi alpha/(1 + 2/8), drag C_L^2/(8 pi)."""
    loads = moving_wing_loads(
        PlaneWing.elliptic(2.0, 8.0), WingMotion(pitch=[SMALL]), speed=10.0, wake=wake,
        apparent_mass=apparent_mass, instants=5,
    )  # fmt: skip
    lift = loads.mean_lift_coefficient
    assert lift == pytest.approx(2.0 * np.pi * SMALL / 1.25, rel=3e-4)
    assert -loads.mean_thrust_coefficient == pytest.approx(lift**2 / (8.0 * np.pi), rel=1e-3)


def test_slow_motions_have_quasi_steady_loads_at_first_order():
    wing = PlaneWing.elliptic(2.0, 6.0)
    gaps = []
    for k in (0.02, 0.01, 0.005):
        frequency = k / (np.pi * wing.mean_chord)
        motion = WingMotion(frequency, heave=[0.0, SMALL / k], flap=[0.0, SMALL / k])
        loads = [
            moving_wing_loads(wing, motion, speed=1.0, wake=wake, instants=17)
            for wake in ("unsteady", "quasi-steady")
        ]
        unsteady, steady = (one.amplitude(one.lift) for one in loads)
        gaps.append(abs(unsteady / steady - 1.0))
    assert gaps[-1] < 0.02
    np.testing.assert_allclose(np.log2(np.array(gaps[:-1]) / gaps[1:]), 1.0, atol=0.15)


@pytest.mark.parametrize("wake", ["quasi-steady", "unsteady"])
@pytest.mark.parametrize("apparent_mass", [True, False])
def test_power_is_spent_to_the_last_millionth(wake, apparent_mass):
    """Heaving, pitching and flapping far, a swept and twisted wing with a profile."""
    wing = PlaneWing(
        (0.0, 0.3, 0.7), (0.2, 0.18, 0.05), (0.0, 0.03, 0.15), (0.05, 0.0, -0.1),
        lift_slope=5.7, zero_lift_angle=-0.05, moment_coefficient=-0.04, profile_drag=0.02,
    )  # fmt: skip
    motion = WingMotion(
        4.0, heave=[0.0, 0.03j], pitch=[0.05, 0.2, 0.03j], flap=[0.1, -0.6j, 0.05], pitch_axis=0.4
    )
    loads = moving_wing_loads(wing, motion, speed=9.0, wake=wake, apparent_mass=apparent_mass)
    assert np.abs(loads.energy_gap).max() < 1e-6 * np.abs(loads.power).max()
    assert loads.wake_power.mean() > 0.0


def test_refined_elements_lags_and_instants_change_little():
    wing = PlaneWing((0.0, 0.4, 0.7), (0.2, 0.18, 0.03))
    motion = WingMotion(4.0, pitch=[0.05, 0.2], flap=[0.1, -0.6j])
    coarse = moving_wing_loads(wing, motion, speed=9.0)
    fine = moving_wing_loads(wing, motion, speed=9.0, elements=64, wake_points=12, instants=161)
    for name in ("mean_lift_coefficient", "mean_thrust_coefficient", "mean_power_coefficient"):
        assert getattr(coarse, name) == pytest.approx(getattr(fine, name), rel=3e-3)


@pytest.mark.long
def test_a_start_ends_in_the_periodic_wake():
    wing = PlaneWing.rectangular(0.6, 0.2)
    motion = WingMotion(3.0, heave=[0.0, 0.05], pitch=[0.0, 0.2j])
    again = moving_wing_loads(wing, motion, speed=3.0, elements=8)
    beats = 30
    times = np.concatenate([[0.0], beats * motion.period + again.times])
    start = moving_wing_loads(wing, motion, speed=3.0, elements=8, times=times)
    np.testing.assert_allclose(start.lift[1:], again.lift, atol=1e-5 * np.abs(again.lift).max())


def robot_and_its_wing():
    """The robot with its shoulder held to the driver, its wing by sections, and their motion."""
    robot = birdmb.load_bird("flapping_robot").with_joint("shoulder.flap", mode="prescribed")
    robot = robot.with_values({"wing.discretisation": 32, "drag.profile_coefficient": 0.0})
    wing = PlaneWing(
        [robot.segments["bar"].length * one.position for one in robot.sections],
        [one.chord for one in robot.sections],
        [-one.offset - 0.25 * one.chord for one in robot.sections],
    )
    driver = robot.joint("shoulder.flap").driver
    flap = [driver.mean, *(np.array(driver.cosine) - 1j * np.array(driver.sine))]
    return robot, wing, WingMotion(robot.gait.frequency, flap=flap)


def test_the_robot_is_the_same_wing_by_its_sections_as_by_its_topology():
    """To what the flat planform and the orthogonal lifting line differ by at the rounded tips."""
    robot, wing, motion = robot_and_its_wing()
    model = birdmb.RigidModel(robot)
    loads = moving_wing_loads(
        wing, motion, speed=2.9, wake="quasi-steady", apparent_mass=False, instants=17
    )
    of_robot = [model.loads(t, [2.9, 0.0, 0.0, 0.0]) for t in loads.times]
    lift = [-(one.right.force + one.left.force)[:, 2].sum() for one in of_robot]
    np.testing.assert_allclose(loads.lift, lift, atol=0.01 * np.ptp(lift))


def test_the_robot_in_a_tunnel_with_memory_has_the_lift_of_its_wing():
    """Of the held bird, whose states are the lags of its wake alone."""
    robot, wing, motion = robot_and_its_wing()
    remembering = robot.with_values({"air.wake": "unsteady"})
    held = birdmb.MultibodyModel(remembering, motion="held", body_state=[2.9, 0.0, 0.0, 0.0])
    beat = birdmb.find_limit_cycle(held).beat
    of_robot = -2.0 * beat.loads_along.stack.right.force[:, :, 2].sum(axis=1)
    loads = moving_wing_loads(wing, motion, speed=2.9)
    lift = interpolated(loads.lift, beat.times / robot.period)
    np.testing.assert_allclose(lift, of_robot, atol=0.004 * np.abs(lift).max())


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: PlaneWing((0.1, 1.0), (1.0, 1.0)), "from 0"),
        (lambda: PlaneWing((0.0, 1.0, 1.0), (1.0, 1.0, 1.0)), "ascend"),
        (lambda: PlaneWing((0.0, 1.0), (1.0, 1.0, 1.0)), "chords must be as many"),
        (lambda: PlaneWing((0.0, 1.0), (0.0, 1.0)), "positive"),
        (lambda: WingMotion(frequency=0.0), "frequency must be positive"),
        (lambda: WingMotion(flap=[np.nan]), "flap must be a series"),
        (lambda: loads_of(wake="steady"), 'not "steady"'),
        (lambda: loads_of(speed=0.0), "positive and finite"),
        (lambda: loads_of(elements=2), "elements or more"),
        (lambda: loads_of(wake_points=40), "wake_points"),
        (lambda: loads_of(instants=8), "odd and 5 or more"),
        (lambda: loads_of(times=[1.0, 0.0]), "ascending"),
    ],
)
def test_what_cannot_be_is_refused(make, message):
    with pytest.raises(birdmb.ArgumentError, match=message):
        make()


def loads_of(**choices):
    motion = WingMotion(heave=[0.0, 0.1])
    return moving_wing_loads(PlaneWing.rectangular(6.0, 1.0), motion, **{"speed": 1.0} | choices)


def test_a_wing_that_stalls_needs_a_memory():
    wing = birdmb.PlaneWing.rectangular(1.0, 0.2, stall=Stall(angle=0.2))
    with pytest.raises(birdmb.ArgumentError, match="how far flow has separated is a memory"):
        birdmb.moving_wing_loads(wing, birdmb.WingMotion(1.0), speed=5.0, wake="quasi-steady")


def test_a_stall_that_is_never_reached_changes_nothing():
    motion = birdmb.WingMotion(2.0, heave=[0.0, 0.01])
    found = [
        birdmb.moving_wing_loads(
            birdmb.PlaneWing.rectangular(1.0, 0.2, stall=stall), motion, speed=5.0,
            elements=8, wake_points=4, instants=33,
        ).lift
        for stall in (None, Stall(angle=np.radians(60.0)))
    ]  # fmt: skip
    np.testing.assert_allclose(found[1], found[0], atol=1e-4 * np.abs(found[0]).max())


def test_what_separation_takes_is_the_gap_in_the_energy():
    """Never negative but for the lag of separation, and positive on average."""
    motion = birdmb.WingMotion(2.0, heave=[0.0, 0.15])
    wing = birdmb.PlaneWing.rectangular(1.0, 0.2, stall=Stall(angle=np.radians(12.0)))
    loads = birdmb.moving_wing_loads(
        wing, motion, speed=5.0, elements=8, wake_points=4, instants=65
    )
    assert loads.energy_gap.mean() > 0.05 * loads.power.mean()
