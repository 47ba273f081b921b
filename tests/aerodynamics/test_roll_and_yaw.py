"""Loads of opposite circulations on both wings, against exact and against computed derivatives."""

import numpy as np
import pytest

from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_loads
from birdmb.aerodynamics.twist_loads import mirrored
from birdmb.wing.shape import WingShape

from .pairs import THIN
from .test_circulation import flat_wing

DENSITY = 1.225
ALPHA = np.radians(1.0)


def wrench(placed, twist):
    """Wrench (6,) of both wings."""
    total = np.zeros(6)
    for image, loads in zip((np.array, mirrored), _both(placed, twist), strict=True):
        force = loads.wrench[:, :3]
        moments = np.cross(placed.position, force)
        total += image(np.concatenate([force.sum(axis=0), moments.sum(axis=0)]))
    return total


def _both(placed, twist):
    return pair_loads(placed, placed, False, DENSITY, 0.0, np.asarray(twist, float))


@pytest.mark.parametrize("aspect_ratio", [6.0, 12.0])
def test_roll_damping_of_an_elliptic_wing(aspect_ratio):
    """Cl_p = -(pi/4) AR/(AR + 4) with the lift slope 2 pi, at second order."""
    root, speed = 8.0 / (np.pi * aspect_ratio), 10.0  # span 2
    per_rate = 0.5 * DENSITY * speed**2 * (np.pi * root / 2) * 2.0 * 2.0 / (2.0 * speed)
    exact = -np.pi / 4 * aspect_ratio / (aspect_ratio + 4)
    errors = []
    for n in (16, 32, 64):
        placed = place_elements(flat_wing(lambda y: root * np.sqrt(1 - y**2), n), np.zeros(3))
        roll = [wrench(placed, [speed, 0, 0, p, 0, 0])[3] for p in (1e-3, -1e-3)]
        errors.append(abs((roll[0] - roll[1]) / 2e-3 / per_rate / exact - 1))
    assert errors[-1] < 3e-5
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert np.log2(errors[1] / errors[2]) > 1.8


def plane_wing(elements):
    """A twisted, tapered, flat wing: quarter-chord line from 0.05 to 0.35 behind G; span 15."""
    y = 7.5 * np.sin(np.linspace(0.0, np.pi / 2, 2 * elements))
    chord = 2.2 - 0.4 * y / 7.5
    line = np.column_stack([0.5 - 0.4 * y / 7.5 - 0.25 * chord, y, np.zeros_like(y)])
    sweep, twist = np.arctan2(0.3, 7.5), np.radians(2.0)
    span = np.array([-np.sin(sweep), np.cos(sweep), 0.0])
    back = np.cos(twist) * np.array([-np.cos(sweep), -np.sin(sweep), 0.0])
    back[2] = np.sin(twist)
    up = np.cross(back, span)
    up *= -np.sign(up[2])
    still = np.zeros((elements, 3))
    each = (elements, 1)
    return WingShape(
        line, still, np.tile(back, each), np.tile(up, each), np.tile(span, each),
        chord[0::2] * np.cos(sweep), np.tile(THIN, each), np.zeros((elements, 2)), True,
        np.zeros((0, elements, 6)), np.zeros((elements, 3)),
    )  # fmt: skip


# Of a vortex lattice (AVL, 12 equal strips a half wing), stability axes at 1 degree; and by how
# much a lifting line may differ. It has no bound vortices that act on each other, which makes it
# stiffer, the more so for the short waves along the span that rolling makes.
LATTICE = {"CL_alpha": (4.638, 0.05), "Cl_p": (-0.5187, 0.10), "Cl_r": (0.06424, 0.05)}


def test_a_plane_wing_against_a_vortex_lattice():
    placed = place_elements(plane_wing(24), np.zeros(3))
    area, span = 30.0, 15.0
    c, s = np.cos(ALPHA), np.sin(ALPHA)
    to_stability = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
    pressure, h = 0.5 * DENSITY, 1e-4

    def coefficients(alpha=ALPHA, roll=0.0, yaw=0.0):
        """Lift and rolling moment at 1 m/s, rates made dimensionless with span/(2 U)."""
        spin = to_stability.T @ np.array([roll, 0.0, yaw]) * 2.0 / span
        found = wrench(placed, [np.cos(alpha), 0.0, np.sin(alpha), *spin])
        lift = found[0] * np.sin(alpha) - found[2] * np.cos(alpha)
        rolling = (to_stability @ found[3:])[0]
        return np.array([lift / (pressure * area), rolling / (pressure * area * span)])

    def slope(name, at=0.0):
        return (coefficients(**{name: at + h}) - coefficients(**{name: at - h})) / (2 * h)

    found = {
        "CL_alpha": slope("alpha", ALPHA)[0],
        "Cl_p": slope("roll")[1],
        "Cl_r": slope("yaw")[1],
    }
    for name, (lattice, relative) in LATTICE.items():
        assert found[name] == pytest.approx(lattice, rel=relative), name
    # The mean of its section lift over the area.
    assert coefficients()[0] == pytest.approx(0.2433, rel=0.05)


def test_mirrored_motions_have_mirrored_loads():
    placed = place_elements(plane_wing(8), np.zeros(3))
    twist = np.array([10.0, 1.0, 0.5, 0.3, 0.2, -0.4])
    np.testing.assert_allclose(
        wrench(placed, mirrored(twist)), mirrored(wrench(placed, twist)), rtol=1e-12
    )
