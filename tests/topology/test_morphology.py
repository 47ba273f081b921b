"""Masses and inertias from morphology: against quadrature, sums, and one measured pigeon."""

from pathlib import Path

import numpy as np
import pytest

import birdmb
from birdmb.errors import ArgumentError, TopologyError
from birdmb.morphology import (
    bird_from_morphology,
    combined,
    cylinder,
    ellipsoid,
    plate,
    point_mass,
    rod,
)

EXAMPLE = Path(__file__).parents[2] / "examples" / "pigeon_morphology.toml"
PIGEON = EXAMPLE.read_text(encoding="utf-8")
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


def inertia_of(points, masses):
    """Centre of mass and inertia tensor about it of point masses."""
    centre = masses @ points / masses.sum()
    x, y, z = (points - centre).T
    tensor = np.array(
        [
            [y**2 + z**2, -x * y, -x * z],
            [-x * y, x**2 + z**2, -y * z],
            [-x * z, -y * z, x**2 + y**2],
        ]
    )
    return centre, tensor @ masses


def agree(solid, points, weights):
    centre, inertia = inertia_of(points, solid.mass * weights / weights.sum())
    np.testing.assert_allclose(solid.centre, centre, rtol=0, atol=1e-13)
    np.testing.assert_allclose(solid.inertia, inertia, rtol=0, atol=1e-12 * np.abs(inertia).max())


def rotation():
    Q, _ = np.linalg.qr(np.array([[1.0, 0.3, -0.2], [0.1, 1.0, 0.5], [0.4, -0.6, 1.0]]))
    return Q


def test_a_rod_is_its_points():
    start, end = np.array([0.1, -0.2, 0.05]), np.array([-0.3, 0.4, 0.2])
    s = (NODES[:, None] + 1) / 2
    agree(rod(0.3, start, end), start + s * (end - start), WEIGHTS)


def test_a_plate_is_its_points():
    sides = np.array([[0.3, 0.1, 0.0], [0.05, 0.2, 0.1]])
    a, b = np.meshgrid(NODES, NODES)
    points = 0.5 * (a.reshape(-1, 1) * sides[0] + b.reshape(-1, 1) * sides[1]) + [0.1, 0.2, 0.3]
    agree(plate(0.2, [0.1, 0.2, 0.3], sides), points, np.outer(WEIGHTS, WEIGHTS).ravel())


def test_a_cylinder_is_its_points():
    Q = rotation()
    length, a, b = 0.4, 0.05, 0.02
    r, phi = np.meshgrid((NODES + 1) / 2, 2 * np.pi * np.arange(24) / 24, indexing="ij")
    section = np.outer(WEIGHTS, np.ones(24)) * r
    x, y = (a * r * np.cos(phi)).ravel(), (b * r * np.sin(phi)).ravel()
    z = length * NODES / 2
    points = np.array([(u, v, w) for u, v in zip(x, y, strict=True) for w in z]) @ Q.T
    axis = length / 2 * Q[:, 2]
    solid = cylinder(1.5, -axis, axis, [a * Q[:, 0], b * Q[:, 1]])
    agree(solid, points, np.outer(section.ravel(), WEIGHTS).ravel())


def test_an_ellipsoid_is_its_points():
    Q = rotation()
    axes = np.array([0.3, 0.1, 0.05])
    r, mu = (NODES + 1) / 2, NODES
    phi = 2 * np.pi * np.arange(24) / 24
    R, M, P = (grid.ravel() for grid in np.meshgrid(r, mu, phi, indexing="ij"))
    across = np.sqrt(1 - M**2)
    ball = np.stack([R * across * np.cos(P), R * across * np.sin(P), R * M], axis=1)
    weights = np.einsum("i,j,k->ijk", WEIGHTS * r**2, WEIGHTS, np.ones(24)).ravel()
    centre = np.array([0.2, 0.0, -0.1])
    agree(ellipsoid(0.7, centre, (Q * axes).T), centre + ball * axes @ Q.T, weights)


def test_textbook_moments():
    across = rod(2.0, [0, 0, 0], [0, 3.0, 0]).inertia
    np.testing.assert_allclose(across, np.diag([1.5, 0, 1.5]), atol=1e-15)
    ball = ellipsoid(5.0, [0, 0, 0], 2.0 * np.eye(3)).inertia
    np.testing.assert_allclose(ball, 8.0 * np.eye(3), atol=1e-14)
    lid = plate(12.0, [0, 0, 0], [[1, 0, 0], [0, 2, 0]]).inertia
    np.testing.assert_allclose(lid, np.diag([4.0, 1.0, 5.0]), atol=1e-15)


def test_two_halves_of_a_rod_are_the_rod():
    whole = rod(1.0, [0, 0, 0], [0.2, 0.4, 0])
    halves = combined([rod(0.5, [0, 0, 0], [0.1, 0.2, 0]), rod(0.5, [0.1, 0.2, 0], [0.2, 0.4, 0])])
    np.testing.assert_allclose(halves.centre, whole.centre)
    np.testing.assert_allclose(halves.inertia, whole.inertia, atol=1e-17)


def test_what_has_no_mass_has_no_centre():
    with pytest.raises(ArgumentError, match="no centre of mass"):
        combined([point_mass(0.0, [0, 0, 0])])


@pytest.fixture(scope="module")
def pigeon():
    return bird_from_morphology(EXAMPLE)


def test_the_pigeon_weighs_what_its_parts_do(pigeon):
    # g; bones, muscles, wrist, skin, tertials, alula, P1 to P10, S1 to S9
    wing = 4.51 + 6.73 + 0.101 + 7.88 + 2.167 + 0.156 + 1.98 + 0.73
    assert sum(s.mass for _, s in pigeon.segments.items()) == pytest.approx(1e-3 * wing, rel=1e-12)
    assert pigeon.body.mass == pytest.approx(0.2104, rel=1e-12)
    # Of the wing weighed as a whole 0.65 g are in none of its listed parts.
    assert 0.0249 - 1e-3 * wing == pytest.approx(0.65e-3, abs=0.01e-3)
    assert pigeon.total_mass == pytest.approx(0.2599, rel=5e-3)


def test_the_pigeons_body_is_that_of_four_solids(pigeon):
    """By textbook formulas and Steiner's theorem, typed for this bird."""
    torso, head, neck, tail = 0.189275, 0.008686, 0.008964, 0.003475
    parts = [
        (torso, (0.1306**2 + 0.0558**2) / 20, -0.0472, 0.0055),
        (head, (0.046**2 + 0.0248**2) / 20, 0.055, -0.015),
        (neck, 0.0582**2 / 12 + 0.0093**2 / 16, 0.016, -0.005),
        (tail, 0.1002**2 / 12, -0.1807, 0.0055),
    ]
    mass = sum(part[0] for part in parts)
    x = sum(m * at for m, _, at, _ in parts) / mass
    z = sum(m * at for m, _, _, at in parts) / mass
    pitch = sum(m * (own + (a - x) ** 2 + (b - z) ** 2) for m, own, a, b in parts)
    product = sum(m * (a - x) * (b - z) for m, _, a, b in parts)
    assert pigeon.body.inertia_yy == pytest.approx(pitch, rel=1e-10)
    assert pigeon.body.inertia_xz == pytest.approx(-product, rel=1e-10)
    root = pigeon.wing.root
    np.testing.assert_allclose([root.x, root.y, root.z], [-0.0093 - x, 0.0167, -0.0041 - z])


def test_the_pigeons_wings_are_like_other_birds(pigeon):
    """C. van den Berg and J. M. V. Rayner, J. Exp. Biol. 198 (1995), wings of 29 species in strips.

    Inertia about the shoulder 0.118 (mass times length squared)^1.04, kg m2, with r2 = 0.997.
    """
    inertia, start = 0.0, 0.0
    for _, segment in pigeon.segments.items():
        y = start + segment.centre_of_mass[1]
        inertia += segment.inertia[0][0] + segment.mass * y**2
        start += segment.length
    mass = sum(segment.mass for _, segment in pigeon.segments.items())
    tip = pigeon.feathers[-1]
    length = start + tip.length * np.sin(tip.rest_angle)
    assert inertia == pytest.approx(0.118 * (mass * length**2) ** 1.04, rel=0.15)


def test_the_shipped_pigeon_is_made_of_its_morphology(pigeon, topologies):
    assert birdmb.load_bird(topologies / "pigeon.toml") == pigeon


@pytest.fixture
def made(tmp_path):
    """A bird of the pigeon's morphology file with other text in it."""

    def make(*changes, like=None):
        text = PIGEON
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / "bird.toml"
        path.write_text(text, encoding="utf-8")
        return bird_from_morphology(path, like)

    return make


def test_lengths_are_those_between_ends_where_these_are_given(made):
    points = [
        [-0.0093, 0.0167, -0.0041],
        [-0.0284, 0.0376, -0.0241],
        [-0.0093, 0.0815, -0.0041],
        [-0.0051, 0.1140, 0.0041],
    ]
    bird = made(
        ("length = 0.0465\n", f"end = {points[1]}\n"),
        ("length = 0.0583\n", f"end = {points[2]}\n"),
        ("length = 0.0625\n", f"end = {points[3]}\n"),
    )
    lengths = [segment.length for _, segment in bird.segments.items()]
    np.testing.assert_allclose(lengths, np.linalg.norm(np.diff(points, axis=0), axis=1), rtol=1e-11)


def test_parts_without_a_place_follow_each_other(made, pigeon):
    places = ("x = 0.055 ", "x = 0.016 ", "x = -0.0472 ", "x = -0.1807 ")
    bird = made(*((place, f"# {place}") for place in places))
    lengths, masses = (0.046, 0.0582, 0.1306, 0.1002), (0.008686, 0.008964, 0.189275, 0.003475)
    middles = -np.cumsum(lengths) + np.array(lengths) / 2
    centre = middles @ masses / sum(masses)
    assert bird.wing.root.x == pytest.approx(-0.0093 - centre, rel=1e-9)
    assert bird.wing.root.z == pigeon.wing.root.z


def test_gait_and_joints_may_be_those_of_another_bird(tmp_path, ibis):
    path = tmp_path / "bird.toml"
    text = PIGEON.replace("[gait]\nfrequency = 7.0", "#")
    before, joints = text.split("[[joints]]", 1)
    path.write_text(before + joints[joints.index("[[feathers]]") :], encoding="utf-8")
    bird = bird_from_morphology(path, ibis)
    assert (bird.gait, bird.joints) == (ibis.gait, ibis.joints)
    with pytest.raises(TopologyError, match="missing"):
        bird_from_morphology(path)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("mass = 0.008686", "mass = -1", r"body\.parts\.head\.mass: must be more than 0"),
        ('shape = "plate"', 'shape = "cone"', r'body\.parts\.tail\.shape: must be "ellipsoid"'),
        ('shape = "plate"', 'shape = "plate"\nheight = 0.1', r"height: a plate is thin"),
        ("[[body.parts]]", "[body]\nmass = 1\n[[body.parts]]", r"body\.mass: follows from"),
        ("shoulder =", "root = 1\nshoulder =", r"wing\.root: follows from the shoulder"),
        ("length = 0.0465\n", "", r"segments\.humerus\.length: missing"),
        ("length = 0.0465\n", "length = 1\nend = [0, 1, 0]\n", r"end: given twice"),
        ("length = 0.0583\n", "end = [0, 1, 0]\n", r"segments\.forearm\.end: there is no dist"),
        ("length = 0.0465\n", "end = [-0.0093, 0.0167, -0.0041]\n", r"end: the segment has no"),
        ("position = 0.7,", "position = 7,", r"feathers\.tertials\.position: must be 1 or less"),
        ('"ulna", mass', '"ulna", mas', r"bones\.ulna\.mas: unknown key; the nearest known: mass"),
        ("shoulder = [-0.0093, 0", "shoulder = [0, -0", r"wing\.shoulder.*: must be 0 or more"),
        ("muscles = [{", "muscels = [{", r"segments\.humerus\.muscels: unknown key.*muscles"),
        ("skin_mass = 0.00788", "skin_mass = '7 g'", r"wing\.skin_mass: must be a number"),
    ],
)
def test_what_is_wrong_is_told_in_a_sentence(made, old, new, sentence):
    with pytest.raises(TopologyError, match=sentence) as caught:
        made((old, new))
    assert "\n" not in str(caught.value)


def test_skin_needs_a_segment_to_lie_on(made):
    chords = [("skin_chord = 0.05\n", ""), ("skin_chord = 0.05\n", ""), ("skin_chord = 0.03\n", "")]
    with pytest.raises(TopologyError, match=r"wing\.skin_mass: no segment has a skin_chord"):
        made(*chords)


def test_a_body_has_parts(tmp_path):
    path = tmp_path / "bird.toml"
    before, parts = PIGEON.split("[[body.parts]]", 1)
    path.write_text(f"{before}[body]\nparts = []\n{parts[parts.index('[wing]') :]}")
    with pytest.raises(TopologyError, match=r"body\.parts: empty; a body needs one part"):
        bird_from_morphology(path)


def test_a_segment_has_a_mass(tmp_path):
    path = tmp_path / "bird.toml"
    path.write_text(f"{PIGEON}\n[segments.claw]\nlength = 0.01\n", encoding="utf-8")
    with pytest.raises(TopologyError, match=r"segments\.claw: nothing in it has a mass"):
        bird_from_morphology(path)
