"""Compliant joints against closed forms: springs, a pendulum, stiff and soft limits."""

import numpy as np
import pytest
from scipy.optimize import brentq

import birdmb
from tests.models.test_rigid_cycle import sorted_like

STILL = [0.0, 0.0, 0.0, 0.0]


def one_bone(ibis, **flap):
    """The flap joint alone moves: a 1 kg point mass 1 m from the shoulder, no air."""
    # Far from the plane of symmetry, which a wing cannot swing through.
    values = {"air.density": 0.0, "wing.discretisation": 8, "wing.root.y": 3.0}
    for joint in ibis.joint_names:
        values |= {f"{joint}.offset_deg": 0.0, f"{joint}.amplitude_deg": 0.0}
    for bone in ("forearm", "hand"):
        values |= {f"segments.{bone}.mass": 0.0, f"segments.{bone}.inertia": np.zeros((3, 3))}
    values |= {
        "segments.humerus.mass": 1.0,
        "segments.humerus.inertia": np.zeros((3, 3)),
        "segments.humerus.centre_of_mass": [0.0, 1.0, 0.0],
    }
    return ibis.with_values(values).with_joint("shoulder.flap", **flap)


def test_a_free_hinge_is_a_pendulum(ibis):
    """Released horizontally: T = 4 K(1/sqrt 2) sqrt(l/g) = 2.367841947576 s."""
    bird = one_bone(ibis, stiffness=0.0, damping=0.0)
    model = birdmb.MultibodyModel(bird, motion="held", body_state=STILL, steps_per_beat=120)

    def rate_at(t):
        return model.flow([0.0, 0.0], 0.0, t)[1]

    # At half a period it stands still on the other side.
    half = brentq(rate_at, 1.1, 1.25, xtol=1e-12)
    assert 2 * half == pytest.approx(2.367841947576, abs=1e-9)
    assert model.flow([0.0, 0.0], 0.0, half)[0] == pytest.approx(-np.pi, abs=1e-9)


@pytest.mark.parametrize(
    ("stiffness", "expected", "integrator", "error"),
    [
        (20.0, 0.431587830 + 0.051064j, "explicit", 1e-8),
        (10.0, -0.096856 + 0.423668j, "explicit", 1e-8),
        (20.0, 0.431587830 + 0.051064j, "implicit", 2e-6),
    ],
)
def test_a_spring_and_damper_against_the_closed_form(ibis, stiffness, expected, integrator, error):
    """I = 0.03 kg m2, C = 0.2, T = 0.25 s: exp(lambda T), I lambda^2 + C lambda + k = 0."""
    bird = one_bone(ibis, stiffness=stiffness, damping=0.2).with_values(
        {
            "gravity": 0.0,
            "segments.humerus.mass": 0.03,
            "shoulder.flap.amplitude_deg": 20.0,
        }
    )
    model = birdmb.MultibodyModel(
        bird, motion="held", body_state=STILL, integrator=integrator, steps_per_beat=60
    )
    cycle = birdmb.find_limit_cycle(model)
    roots = np.roots([0.03, 0.2, stiffness])
    exact = np.exp(roots * 0.25)
    np.testing.assert_allclose(*sorted_like(cycle.multipliers, exact), atol=error)
    assert abs(cycle.multipliers[0].real - expected.real) < 1e-6 + error
    assert abs(abs(cycle.multipliers[0].imag) - expected.imag) < 1e-6 + error
    # The orbit itself: a driven oscillator, angle and phase of the steady state.
    w = 8 * np.pi
    gain = (stiffness + 0.2j * w) / (stiffness - 0.03 * w**2 + 0.2j * w)
    driver = np.radians(20.0) * np.exp(1j * np.pi)
    angle = (gain * driver).imag
    assert cycle.x0[0] == pytest.approx(angle, abs=error)


def test_explicit_and_implicit_integration_agree(ibis_compliant):
    bird = ibis_compliant.with_values({"wing.discretisation": 8})
    explicit = birdmb.MultibodyModel(bird, integrator="explicit", steps_per_beat=480)
    implicit = birdmb.MultibodyModel(bird, integrator="implicit", steps_per_beat=240)
    x = explicit.initial_guess()
    np.testing.assert_allclose(implicit.flow(x, 0.0, 0.1), explicit.flow(x, 0.0, 0.1), atol=1e-7)


def test_implicit_steps_are_of_fifth_order(ibis_compliant):
    bird = ibis_compliant.with_values({"wing.discretisation": 8})
    x = birdmb.MultibodyModel(bird).initial_guess()
    ends = [
        birdmb.MultibodyModel(bird, integrator="implicit", steps_per_beat=n).flow(x, 0.0, 0.25)
        for n in (60, 120, 240)
    ]
    errors = [np.abs(end - ends[-1]).max() for end in ends[:-1]]
    assert np.log2(errors[0] / errors[1]) > 4.0


@pytest.mark.long
def test_a_stiff_joint_is_integrated_implicitly_without_being_asked(ibis_massless):
    """Of next to no inertia, the wing hangs between spring and air."""
    bird = ibis_massless.with_joint("shoulder.flap", stiffness=20, damping=0.2).with_values(
        {"wing.discretisation": 6}
    )
    assert birdmb.MultibodyModel(bird).integration.method == "implicit"
    # Forty times as heavy it is still stiff, but explicit steps can follow it for a while.
    heavier = bird.with_values(
        {
            f"segments.{bone}.{key}": (np.array(bird.value(f"segments.{bone}.{key}")) * 40).tolist()
            for bone in ("humerus", "forearm", "hand")
            for key in ("mass", "inertia")
        }
    )
    stiff = birdmb.MultibodyModel(heavier, motion="held", body_state=[18.0, -2.0, 0.0, -0.1])
    assert stiff.integration == ("implicit", 60)
    cycle = birdmb.find_limit_cycle(stiff)
    assert cycle.residual < 1e-8
    assert np.abs(cycle.multipliers).max() < 1e-3
    explicit = birdmb.MultibodyModel(
        heavier,
        motion="held",
        body_state=[18.0, -2.0, 0.0, -0.1],
        integrator="explicit",
        steps_per_beat=4800,
    )
    end = explicit.flow(cycle.x0, 0.0, 0.05)
    np.testing.assert_allclose(stiff.flow(cycle.x0, 0.0, 0.05), end, rtol=1e-5, atol=1e-5)


@pytest.mark.long
def test_cubic_springs_against_energy(ibis):
    """Undamped, released at rest: (k/2 + k3/4 a^2) a^2 is the energy when it passes its driver."""
    bird = one_bone(ibis, stiffness=5.0, damping=0.0).with_values(
        {"gravity": 0.0, "shoulder.flap.cubic_stiffness": 40.0}
    )
    model = birdmb.MultibodyModel(bird, motion="held", body_state=STILL, steps_per_beat=240)
    amplitude = 0.5
    passing = brentq(lambda t: model.flow([amplitude, 0.0], 0.0, t)[0], 0.2, 0.9, xtol=1e-12)
    rate = model.flow([amplitude, 0.0], 0.0, passing)[1]
    energy = 5.0 / 2 * amplitude**2 + 40.0 / 4 * amplitude**4
    assert 0.5 * rate**2 == pytest.approx(energy, rel=1e-9)


def test_asymmetric_springs_swing_further_on_the_softer_side(ibis):
    """Energy again: k_above a^2 = k_below b^2."""
    bird = one_bone(ibis, stiffness=20.0, damping=0.0).with_values(
        {"gravity": 0.0, "shoulder.flap.stiffness_below": 5.0}
    )
    model = birdmb.MultibodyModel(bird, motion="held", body_state=STILL, steps_per_beat=960)
    turn = np.pi / 2 * (1 / np.sqrt(20.0) + 1 / np.sqrt(5.0))
    # A quarter of the period on either side brings it to rest at twice the angle.
    angle, rate = model.flow([0.1, 0.0], 0.0, turn)
    assert angle == pytest.approx(-0.2, rel=1e-6)
    assert rate == pytest.approx(0.0, abs=1e-5)


def test_stiffness_to_infinity_goes_to_the_prescribed_joint(ibis):
    """At first order: the gap to the driver is the load over the stiffness."""
    bird = ibis.with_values({"wing.discretisation": 6})
    gaps = []
    for k in (3e2, 3e3):
        sprung = bird.with_joint("shoulder.flap", stiffness=k, damping=0.02 * np.sqrt(k))
        model = birdmb.MultibodyModel(sprung, motion="held", body_state=[18.0, -2.0, 0.0, -0.1])
        cycle = birdmb.find_limit_cycle(model)
        gaps.append(np.abs(cycle.x0 - model.driven_state(0.0)))
    orders = np.log10(np.array(gaps[0]) / gaps[1])
    assert ((orders > 0.8) & (orders < 1.3)).all(), orders


def test_a_held_body_does_not_turn(ibis_compliant):
    with pytest.raises(ValueError, match="cannot turn"):
        birdmb.MultibodyModel(ibis_compliant, motion="held", body_state=[10.0, 0.0, 0.1, 0.0])
