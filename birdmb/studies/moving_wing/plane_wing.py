"""A plane wing by sections along its span, and its lifting line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.summary import Summarised
from birdmb.topology import Profile, Stall
from birdmb.wing.shape import WingShape

_ELLIPSE_SECTIONS = 400  # straight between them: the area is short of the ellipse's by 3e-6


@checked
@dataclass(frozen=True, repr=False)
class PlaneWing(Summarised):
    """A rigid wing without dihedral, symmetric about its root, straight between its sections.

    Attributes:
        positions: distances of S sections from the plane of symmetry, ascending from 0, m.
        chords: their chords along the stream, m.
        leading_edges: how far the leading edge of each is behind the root's, m; by default such
            that the quarter chords lie on a straight line across the stream.
        twists: their angles to the root's zero incidence, leading edge up, rad; 0 by default.
        lift_slope: of the profile, 1/rad.
        zero_lift_angle: of the profile, rad.
        moment_coefficient: of the profile about the quarter chord, nose up.
        profile_drag: drag coefficient of the sections.
        stall: how flow separates from the sections in an unsteady wake (docs/model.md, section 11);
            by default it stays attached.
    """

    positions: Sequence[float]
    chords: Sequence[float]
    leading_edges: Sequence[float] | None = None
    twists: Sequence[float] | None = None
    lift_slope: float = 2.0 * np.pi
    zero_lift_angle: float = 0.0
    moment_coefficient: float = 0.0
    profile_drag: float = 0.0
    stall: Stall | None = None

    def __post_init__(self) -> None:
        """Check the sections.

        Raises:
            ArgumentError: positions do not ascend from 0, chords are not positive (0 at the tip is
                a point), or there are not as many of all.
        """
        positions, chords = np.asarray(self.positions, float), np.asarray(self.chords, float)
        if positions.ndim != 1 or positions.size < 2 or positions[0] != 0.0:
            raise ArgumentError("the positions of a wing's sections must be two or more, from 0.")
        if not (np.diff(positions) > 0.0).all():
            raise ArgumentError("the positions of a wing's sections must ascend.")
        for name in ("chords", "leading_edges", "twists"):
            values = getattr(self, name)
            if values is not None and np.shape(values) != positions.shape:
                raise ArgumentError(
                    f"{name} must be as many as the wing's positions, {positions.size}, "
                    f"not {np.size(values)}."
                )
        if not ((chords[:-1] > 0.0).all() and chords[-1] >= 0.0):
            raise ArgumentError("a wing's chords must be positive; only at the tip it may be 0.")

    @classmethod
    def rectangular(
        cls, span: float, chord: float, *, profile_drag: float = 0.0, stall: Stall | None = None
    ) -> Self:
        """A rectangle; `span` from tip to tip, m."""
        ends = (0.0, 0.5 * span), (chord, chord)
        return cls(*ends, profile_drag=profile_drag, stall=stall)

    @classmethod
    def elliptic(cls, span: float, aspect_ratio: float) -> Self:
        """Chords like an ellipse's on a straight quarter-chord line; `span` from tip to tip, m."""
        share = np.linspace(0.0, 0.5 * np.pi, _ELLIPSE_SECTIONS)
        chords = 4.0 * span / (np.pi * aspect_ratio) * np.cos(share)
        chords[-1] = 0.0
        return cls((0.5 * span * np.sin(share)).tolist(), chords.tolist())

    @property
    def profile(self) -> Profile:
        """What its sections do to the air."""
        return Profile(
            lift_slope=self.lift_slope,
            zero_lift_angle=self.zero_lift_angle,
            moment_coefficient=self.moment_coefficient,
            stall=self.stall,
        )

    @property
    def span(self) -> float:
        """From tip to tip, m."""
        return 2.0 * self.positions[-1]

    @property
    def area(self) -> float:
        """Of both halves, m2."""
        return 2.0 * float(np.trapezoid(self.chords, self.positions))

    @property
    def mean_chord(self) -> float:
        """Area over span, m."""
        return self.area / self.span


def lifting_line(wing: PlaneWing, elements: int, pitch_axis: float) -> WingShape:
    """The right half's lifting line, still, in body axes.

    With so many elements, from a point that is the part `pitch_axis` of the root's chord behind its
    leading edge.
    """
    y = 0.5 * wing.span * np.sin(np.linspace(0.0, 0.5 * np.pi, 2 * elements))
    chord, behind = _along(wing, y, wing.chords), _quarter_chords(wing, y)
    x = (pitch_axis - 0.25) * wing.chords[0] - behind
    line = np.column_stack([x, y, np.zeros_like(y)])
    before = line[np.maximum(np.arange(0, 2 * elements, 2) - 1, 0)]
    span = line[1::2] - before
    span /= np.linalg.norm(span, axis=1)[:, None]
    twist = _along(wing, y[0::2], wing.twists or np.zeros(len(wing.positions)))
    streamwise = np.column_stack([-np.cos(twist), np.zeros_like(twist), np.sin(twist)])
    across = streamwise - (streamwise * span).sum(axis=1)[:, None] * span
    narrowed = np.linalg.norm(across, axis=1)
    back = across / narrowed[:, None]
    profile = [wing.lift_slope, wing.zero_lift_angle, wing.moment_coefficient]
    still = np.zeros((elements, 3))
    return WingShape(
        line,
        still,
        back,
        np.cross(back, span),
        span,
        chord[0::2] * narrowed,
        np.tile(profile, (elements, 1)),
        np.zeros((elements, 2)),
        True,
        np.zeros((0, elements, 6)),
        still,
    )


def _along(wing: PlaneWing, y: FloatArray, values: Sequence[float] | FloatArray) -> FloatArray:
    return np.interp(y, wing.positions, values)


def _quarter_chords(wing: PlaneWing, y: FloatArray) -> FloatArray:
    """How far the quarter chords at y (K,) m are behind the root's, m."""
    if wing.leading_edges is None:
        return np.zeros_like(y)
    chords = np.asarray(wing.chords, float)
    behind = np.asarray(wing.leading_edges, float) + 0.25 * (chords - chords[0])
    return _along(wing, y, behind - wing.leading_edges[0])
