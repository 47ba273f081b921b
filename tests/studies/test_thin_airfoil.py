"""The exact solutions that moving wings are held against, against published numbers."""

import numpy as np
import pytest
from scipy.integrate import quad

from birdmb.studies.experiments.thin_airfoil import (
    OscillatingSection,
    SprungPlate,
    wagner_function,
)
from birdmb.studies.flight_regime import wake_deficiency

FREQUENCIES = (0.05, 0.1, 0.2, 0.5236)
FIRST = 1e-6  # below, Re C is 1 and the sine its argument


@pytest.mark.parametrize(
    ("k", "value"),
    [(0.05, 0.9090 - 0.1306j), (0.1, 0.8319 - 0.1723j), (0.2, 0.7276 - 0.1886j)],
)
def test_theodorsens_function(k, value):
    """Table of NACA Report 496."""
    assert wake_deficiency(k) == pytest.approx(value, abs=1e-4)


@pytest.mark.parametrize("s", [0.5, 2.0, 8.0])
def test_wagners_function_is_the_step_response_of_theodorsens(s):
    """I. E. Garrick, NACA Report 629, 1938: 2/pi times the integral of Re C(k) sin(k s)/k."""
    swing = quad(lambda k: (wake_deficiency(k).real - 0.5) / k, FIRST, np.inf, weight="sin", wvar=s)
    below = 0.5 * s * FIRST
    assert wagner_function(s) == pytest.approx(0.5 + 2.0 / np.pi * (swing[0] + below), abs=1e-9)


def test_wagners_function_starts_at_a_half():
    assert wagner_function(0.0) == pytest.approx(0.5, abs=1e-9)


@pytest.mark.parametrize("k", FREQUENCIES)
def test_heaving_alone(k):
    """Garrick: thrust pi k^2 |C|^2 h^2, of which the efficiency is |C|^2/Re C."""
    section = OscillatingSection(k, 0.3, 0.0, 0.0)
    c = wake_deficiency(k)
    assert section.thrust == pytest.approx(np.pi * k**2 * abs(c) ** 2 * 0.3**2, rel=1e-12)
    assert section.thrust / section.power == pytest.approx(abs(c) ** 2 / c.real, rel=1e-12)


@pytest.mark.parametrize("k", FREQUENCIES)
@pytest.mark.parametrize("axis", [-1.0, 0.0, 0.5])
def test_power_is_thrust_and_what_the_wake_keeps(k, axis):
    """Garrick's energy: pi |w|^2 (Re C - |C|^2) is left in the wake, w at three quarters."""
    section = OscillatingSection(k, 0.6, 0.3 * np.exp(0.8j), axis)
    c = wake_deficiency(k)
    left = np.pi * abs(section.downwash) ** 2 * (c.real - abs(c) ** 2)
    assert section.power == pytest.approx(section.thrust + left, rel=1e-12)


def test_the_axis_is_a_choice():
    """The same motion told from another axis has the same lift, thrust and power."""
    at = OscillatingSection(0.3, 0.5, 0.2 * np.exp(1.1j), -0.4)
    moved = OscillatingSection(0.3, at.heave - 1.3 * at.pitch, at.pitch, 0.9)
    assert moved.lift == pytest.approx(at.lift, rel=1e-12)
    assert moved.moment == pytest.approx(at.moment + 0.5 * 1.3 * at.lift, rel=1e-12)
    assert moved.thrust == pytest.approx(at.thrust, rel=1e-12)
    assert moved.power == pytest.approx(at.power, rel=1e-12)


def test_a_free_plate_follows_its_path_in_slow_heaving():
    """Without spring and inertia it is a weathercock: its angle is that of its path."""
    assert SprungPlate(0.0, 0.0).oscillating(1e-5).pitch == pytest.approx(1e-5j, rel=1e-4)


def test_a_sprung_plate_obeys_its_equation():
    plate = SprungPlate(0.4, 1.7)
    k = 0.6
    moving = plate.oscillating(k)
    torque = (plate.stiffness - plate.inertia * k**2) * moving.pitch
    assert torque == pytest.approx(2.0 * moving.moment, rel=1e-12)
    held = SprungPlate(0.4, 1e9).oscillating(k)
    assert abs(held.pitch) < 1e-8
    # What turns freely at its axis takes no power there: all of it goes into heaving.
    heaving = 0.5 * (-(1j * k * moving.heave).conjugate() * moving.lift).real
    assert moving.power == pytest.approx(heaving, rel=1e-12)
