"""Points to draw a wing by: edges, bones, feathers, chords and the lifting line."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import cast

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import ComplexArray, FloatArray
from birdmb.errors import StateError
from birdmb.topology import Bird, Discretisation
from birdmb.wing.arrays import WingArrays, wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import feather_ends, leading_edge, section_ends, wing_edges
from birdmb.wing.line import orthogonal_line
from birdmb.wing.one_step import one_step_line
from birdmb.wing.rounded import points, rounded_polyline

_POINTS_ALONG_AN_EDGE = 200


@dataclass(frozen=True)
class WingOutline:
    """The right wing in body axes (x forward, y right, z down), m from the body's centre of mass.

    The left wing is its mirror image.
    """

    leading: FloatArray
    """(P, 3), leading edge from the shoulder to the wing tip, as the aerodynamics sees it."""
    trailing: FloatArray
    """(P, 3), trailing edge likewise."""
    bones: FloatArray
    """(B + 1, 3), shoulder and the ends of the bones, the wing's tip last."""
    feathers: FloatArray
    """(F, 2, 3), root and tip of every feather, or ends of every section, outwards."""
    line: FloatArray
    """(N + 1, 3), lifting line at the borders of its N elements: the shoulder, then the nodes."""
    chords: FloatArray
    """(N + 1, 2, 3), leading and trailing point of the chord through each point of `line`."""
    converged: bool
    """Whether the lifting line was found to its tolerance."""

    @property
    def to_centre(self) -> FloatArray:
        """(N + 1, 2, 3), the chords, the innermost one moved over the body to the centre line."""
        chords = self.chords.copy()
        chords[0, :, 1] = 0.0
        return chords

    @property
    def panels(self) -> FloatArray:
        """Surface of each element, (N, 4, 3): corners leading inner, outer, trailing outer, inner.

        The element at the root reaches over the body to the centre line.
        """
        return _between(self.to_centre)


def areas_across(
    wing: WingArrays, angles: FloatArray, discretisation: Discretisation
) -> FloatArray:
    """Parts (K,) of the wing's area across the plane of symmetry, in the other wing's half.

    At `angles` (K, A) rad. Without the gap over the body. Along the chords exact, between them by
    the mean of neighbouring ones.

    Raises:
        StateError: an edge of the wing has no extent.
    """
    parts, still = np.zeros(len(angles)), angles.astype(complex)
    # Rounded edges, and chords between them, are within the hull of the edges' vertices.
    for k in np.flatnonzero(_innermost(wing, still) + wing.root[1] < 0.0):
        leading, trailing = wing_edges(wing, still[k])
        with _extent_told():
            parts[k] = _area_across(wing.root + _chords(leading, trailing, discretisation)[0])
    return parts


@kernel
def _innermost(wing: WingArrays, angles: ComplexArray) -> FloatArray:
    """Least distance (K,) m of the edges' vertices outwards from the shoulder, negative inwards."""
    least = np.empty(angles.shape[0])
    for k in range(least.size):
        leading, trailing = wing_edges(wing, angles[k])
        least[k] = leading[0, 1].real
        for vertex in range(leading.shape[0]):
            least[k] = min(least[k], leading[vertex, 1].real)
        for vertex in range(trailing.shape[0]):
            least[k] = min(least[k], trailing[vertex, 1].real)
    return least


def _area_across(chords: FloatArray) -> float:
    front, back = chords[:, 0, 1], chords[:, 1, 1]
    lower, upper = np.minimum(front, back), np.maximum(front, back)
    extent = np.where(upper > lower, upper - lower, 1.0)
    part = np.where(lower < 0.0, np.where(upper <= 0.0, 1.0, -lower / extent), 0.0)
    areas = _areas(_between(chords))
    return float(np.sum(areas * 0.5 * (part[:-1] + part[1:])) / np.sum(areas))


def _between(chords: FloatArray) -> FloatArray:
    """Panels (N, 4, 3) m between neighbouring chords (N + 1, 2, 3)."""
    inner, outer = chords[:-1], chords[1:]
    return np.stack([inner[:, 0], outer[:, 0], outer[:, 1], inner[:, 1]], axis=1)


def _areas(panels: FloatArray) -> FloatArray:
    """Areas (N,) m2 of the panels (N, 4, 3)."""
    diagonals = np.cross(panels[:, 2] - panels[:, 0], panels[:, 3] - panels[:, 1])
    return np.linalg.norm(diagonals, axis=1) / 2.0


def wing_outline(
    wing: WingArrays, angles: FloatArray, discretisation: Discretisation
) -> WingOutline:
    """Outline of the right wing at `angles` (A,) rad, discretised as the loads are.

    Raises:
        StateError: an edge of the wing has no extent.
    """
    with _extent_told():
        return _outline(wing, angles, discretisation)


@contextmanager
def _extent_told() -> Iterator[None]:
    try:
        yield
    except ZeroDivisionError:
        raise StateError(
            "two neighbouring points of the wing's edge coincide; give the feathers or sections "
            "other lengths, positions or angles, and the bones a length that counts beside theirs."
        ) from None


def _outline(wing: WingArrays, angles: FloatArray, discretisation: Discretisation) -> WingOutline:
    # Complex as the model's own calls are (for rates, here none): no kernel is compiled twice.
    still = angles.astype(complex)
    bones = joint_chain(wing, still)
    if wing.section_bone.size:
        roots, tips = section_ends(wing, bones, still)
        front = roots
    else:
        roots, tips = feather_ends(wing, bones, still)
        front = leading_edge(wing, bones, tips[-1])
    edges = front.real.copy(), tips.real.copy()
    if discretisation.scheme != "one-step":
        edges = (
            _rounded(edges[0], discretisation.rounding),
            _rounded(edges[1], discretisation.rounding),
        )
    chords, converged = _chords(*wing_edges(wing, still), discretisation)
    return WingOutline(
        leading=wing.root + edges[0],
        trailing=wing.root + edges[1],
        bones=wing.root + np.vstack([bones.origin.real, bones.tip.real]),
        feathers=wing.root + np.stack([roots.real, tips.real], axis=1),
        line=wing.root + 0.75 * chords[:, 0] + 0.25 * chords[:, 1],
        chords=wing.root + chords,
        converged=converged,
    )


def _chords(
    leading: ComplexArray, trailing: ComplexArray, discretisation: Discretisation
) -> tuple[FloatArray, bool]:
    """Chords (N + 1, 2, 3) m at the borders of the elements, and whether they were found."""
    stations = 2 * discretisation.elements
    if discretisation.scheme == "one-step":
        pairs, _ = one_step_line(leading, trailing, stations)
    else:
        pairs = orthogonal_line(leading, trailing, stations, discretisation.rounding)
    borders = [0, *range(1, stations, 2)]
    chords = np.stack([pairs.leading[borders].real, pairs.trailing[borders].real], axis=1)
    return chords, bool(pairs.converged)


def _rounded(vertices: FloatArray, rounding: float) -> FloatArray:
    parameters = np.linspace(0.0, 1.0, _POINTS_ALONG_AN_EDGE)
    return cast(FloatArray, points(rounded_polyline(vertices, rounding), parameters))


def span_and_area(bird: Bird) -> tuple[float, float]:
    """Span (m) and area (m2) of the wings stretched out, with the gap over the body."""
    wing = wing_arrays(bird)
    angles = wing.offset.copy()  # of hinges they are the rest angles
    angles[: len(bird.joints)] = 0.0
    outline = wing_outline(wing, angles, bird.wing.resolved_discretisation)
    area = 2.0 * float(_areas(outline.panels).sum())
    return 2.0 * float(outline.leading[:, 1].max()), area
