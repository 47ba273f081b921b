"""The wing that is drawn is the wing that flies."""

import numpy as np
import pytest

from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.outline import wing_outline
from birdmb.wing.shape import wing_shape

PRESETS = ("converged", "published")


def outline_and_elements(bird, t):
    wing = wing_arrays(bird)
    angles, rates, _ = driver_motion(wing, t)
    numbers = bird.wing.resolved_discretisation
    shape = wing_shape(
        wing, angles, rates, numbers.elements, numbers.rounding, numbers.scheme == "one-step"
    )
    return wing_outline(wing, angles, numbers), place_elements(shape, wing.root)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("t", [0.0, 0.1])
def test_line_and_panels_are_those_of_the_elements(ibis, preset, t):
    bird = ibis.with_values({"wing.discretisation": preset})
    outline, elements = outline_and_elements(bird, t)
    assert outline.converged
    assert np.allclose(outline.line[1:], elements.node[1:], atol=1e-12)
    assert np.allclose(outline.line[0], elements.position[0], atol=1e-12)
    panels = outline.panels
    assert panels.shape == (len(elements.chord), 4, 3)
    assert (panels[0, [0, 3], 1] == 0).all()
    assert np.array_equal(panels[1:, 0], panels[:-1, 1])
    # a control point lies between the borders of its element, and its chord within theirs
    chords = np.linalg.norm(panels[:, 3] - panels[:, 0], axis=1)
    assert (elements.chord[1:-1] <= 1.05 * np.maximum(chords[1:-1], chords[2:])).all()


@pytest.mark.parametrize("preset", PRESETS)
def test_the_chords_end_on_the_edges(ibis, preset):
    bird = ibis.with_values({"wing.discretisation": preset})
    outline, _ = outline_and_elements(bird, 0.06)
    for ends, edge in (
        (outline.chords[:, 0], outline.leading),
        (outline.chords[:, 1], outline.trailing),
    ):
        # the published scheme cuts corners between its sixteen points
        tolerance = 0.02 if preset == "published" else 1e-4
        assert max(distance(point, edge) for point in ends) < tolerance


def distance(point, polyline):
    starts, legs = polyline[:-1], np.diff(polyline, axis=0)
    along = np.einsum("ij,ij->i", point - starts, legs) / np.einsum("ij,ij->i", legs, legs)
    nearest = starts + np.clip(along, 0, 1)[:, None] * legs
    return np.linalg.norm(point - nearest, axis=1).min()


def test_bones_and_feathers_have_their_lengths(ibis):
    outline, _ = outline_and_elements(ibis, 0.03)
    lengths = [getattr(ibis.segments, bone).length for bone in ("humerus", "forearm", "hand")]
    assert np.linalg.norm(np.diff(outline.bones, axis=0), axis=1) == pytest.approx(lengths)
    rachis = outline.feathers[:, 1] - outline.feathers[:, 0]
    assert np.linalg.norm(rachis, axis=1) == pytest.approx([f.length for f in ibis.feathers])
    root = [ibis.wing.root.x, ibis.wing.root.y, ibis.wing.root.z]
    assert np.allclose(outline.bones[0], root)
    assert np.allclose(outline.feathers[-1, 1], outline.leading[-1])


def test_the_stretched_wing(ibis):
    """Span 1.36 m: shoulder gap, bones and first feather end to end."""
    wing = wing_arrays(ibis)
    outline = wing_outline(wing, np.zeros(6), ibis.wing.resolved_discretisation)
    assert 2 * outline.leading[-1, 1] == pytest.approx(1.36)
    assert np.ptp(outline.bones[:, 0]) < 1e-15
    assert (outline.leading[:, 0] >= outline.line[-1, 0]).all()
