"""Rates and accelerations of drivers are the exact derivatives of their angles."""

import numpy as np
import pytest

from birdmb.aerodynamics.prescribed import driver_motion, driver_motion_along
from birdmb.wing.arrays import wing_arrays

FLAP, STEP = "shoulder.flap", 1e-30
TIMES = np.linspace(-0.1, 0.4, 37)
SAMPLES = np.exp(np.cos(2 * np.pi * np.arange(40) / 40))

KINDS = {
    "a sine": {},
    "harmonics": {
        "harmonics": [{"order": 2, "amplitude": 0.1, "phase": 1.0}, {"order": 7, "cosine": 0.02}],
        "gain": 0.8,
    },
    "an uneven stroke": {"downstroke_fraction": 0.35},
    "samples": {"amplitude": 0.0, "phase": 0.0, "samples": SAMPLES},
    "uneven samples": {
        "amplitude": 0.0,
        "phase": 0.0,
        "samples": np.delete(SAMPLES, [3, 20]),
        "sample_phases": np.delete(np.arange(40) / 40, [3, 20]),
    },
    "another side": {"left": {"gain": 0.5, "harmonics": [{"order": 3, "sine": 0.1}]}},
}


@pytest.mark.parametrize("keys", KINDS.values(), ids=KINDS)
@pytest.mark.parametrize("side", ["left", "right"])
def test_by_complex_step(ibis, keys, side):
    wing = wing_arrays(ibis.with_joint(FLAP, **keys).side(side))
    angles, rates, accelerations = driver_motion_along(wing, TIMES)
    ahead = driver_motion_along(wing, TIMES + 1j * STEP)
    np.testing.assert_allclose(rates, ahead[0].imag / STEP, rtol=1e-12, atol=1e-11)
    np.testing.assert_allclose(accelerations, ahead[1].imag / STEP, rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(angles, ahead[0].real, rtol=1e-14, atol=1e-15)
    for k in (0, 11):
        single = driver_motion(wing, TIMES[k])
        np.testing.assert_allclose(single[0], angles[k], rtol=1e-14, atol=1e-15)


def test_a_sine_against_its_own_formula(ibis):
    """The arrays hold products, not amplitude and phase: within round-off of these."""
    angles, rates, accelerations = driver_motion_along(wing_arrays(ibis), TIMES)
    w = 2 * np.pi * ibis.gait.frequency
    for i, joint in enumerate(ibis.joints):
        argument = w * TIMES + joint.phase
        swing = joint.amplitude * np.sin(argument)
        np.testing.assert_allclose(angles[:, i], joint.offset + swing, atol=1e-14)
        np.testing.assert_allclose(rates[:, i], w * joint.amplitude * np.cos(argument), atol=1e-12)
        np.testing.assert_allclose(accelerations[:, i], -(w**2) * swing, atol=1e-10)


def test_the_angles_are_those_of_the_joint(ibis):
    for keys in KINDS.values():
        bird = ibis.with_joint(FLAP, **keys).side("left")
        angles = driver_motion_along(wing_arrays(bird), TIMES)[0]
        for i, joint in enumerate(bird.joints):
            phases = TIMES * bird.gait.frequency
            np.testing.assert_allclose(angles[:, i], joint.driver.at(phases), atol=1e-13)
