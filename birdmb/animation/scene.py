"""What there is to see of a flying bird at every frame, in world axes; no backend knows more.

World axes: x along the first heading, y to the left, z up; m from the body's first place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.animation.colours import Colour, ColourName, colour_named
from birdmb.animation.modes import mode_deviation, shown_amplitude
from birdmb.animation.placing import Placing, place_body
from birdmb.animation.shapes import body_shape, tail_shape
from birdmb.animation.words import flight_words, mode_words, stroke_words, title_words
from birdmb.errors import ArgumentError
from birdmb.models import FlightCycle
from birdmb.models.loads import LoadsAlong
from birdmb.wing.outline import WingOutline, wing_outline

MOST_BEATS, MOST_FRAMES = 100, 48
_USUAL_BEATS, _USUAL_FRAMES, _FEWEST_FRAMES = 3, 30, 8
# Of all beats: pages stay below 10 MB.
_USUALLY_ALTOGETHER = 120
_ARROWS_PER_WING = 5
# Right wing, left wing.
_SIDES = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])


@dataclass(frozen=True)
class Scene:
    """A bird in flight at F frames; both wings along the second axis, the right one first.

    Attributes:
        title: bird and model.
        flight: speed, climb rate and frequency, in a line.
        mode: position of the Floquet mode along which it flies; `None` of the cycle itself.
        remarks: of the mode, a line each.
        times: (F,) s.
        beats: (F,) beats since the first frame.
        strokes: F words: "downstroke", "upstroke" or "gliding".
        colour: the quantity of `values`.
        values: (F, 2, N) of the wings' elements.
        chords: (F, 2, N + 1, 2, 3) m, leading and trailing points at the elements' borders, from
            the centre line to the tip.
        edges: (F, 2, 2, P, 3) m, leading and trailing edge from the shoulder to the tip.
        bones: (F, 2, B + 1, 3) m, shoulder and ends of the bones.
        feathers: (F, 2, E, 2, 3) m, ends of every feather, or section, of the topology.
        body: (F, V, 3) m, surface of the body.
        body_faces: (T, 3), its triangles.
        tail: (F, 3, 3) m, corners of the tail; `None` without one.
        arrow_points: (F, A, 3) m, where the air's forces act.
        arrow_forces: (F, A, 3) N: parts of both wings, then tail and body where they have any.
        placing: the body's place and axes.
        undisturbed: (F, 3) m, path of the cycle itself.
        span: m, the largest of all frames.
    """

    title: str
    flight: str
    mode: int | None
    remarks: tuple[str, ...]
    times: FloatArray
    beats: FloatArray
    strokes: tuple[str, ...]
    colour: Colour
    values: FloatArray
    chords: FloatArray
    edges: FloatArray
    bones: FloatArray
    feathers: FloatArray
    body: FloatArray
    body_faces: IntArray
    tail: FloatArray | None
    arrow_points: FloatArray
    arrow_forces: FloatArray
    placing: Placing
    undisturbed: FloatArray
    span: float

    @property
    def path(self) -> FloatArray:
        """Path (F, 3) m of the body's centre of mass."""
        return self.placing.position

    @property
    def border_values(self) -> FloatArray:
        """Values (F, 2, N + 1) of the colour at the elements' borders: the neighbours' means."""
        inner = 0.5 * (self.values[:, :, :-1] + self.values[:, :, 1:])
        return np.concatenate([self.values[:, :, :1], inner, self.values[:, :, -1:]], axis=2)

    @property
    def frames_per_beat(self) -> int:
        """Number of frames in a beat."""
        return round((len(self.times) - 1) / self.beats[-1])

    @property
    def lowest(self) -> float:
        """Height of the lowest point of wings, tail and body in all frames, m."""
        parts = [self.edges, self.chords, self.body, *([] if self.tail is None else [self.tail])]
        return min(float(part[..., 2].min()) for part in parts)

    @property
    def highest(self) -> float:
        """Height of the highest of them, m."""
        return max(float(part[..., 2].max()) for part in (self.edges, self.chords, self.body))


def flight_scene(
    cycle: FlightCycle,
    *,
    beats: int | None = None,
    frames: int | None = None,
    colour: ColourName = "circulation",
    mode: int | None = None,
    scale: float | None = None,
) -> Scene:
    """The flight of a bird over several beats of its limit cycle.

    Args:
        cycle: limit cycle of a bird.
        beats: how many wingbeats; by default 3, with a mode 6.
        frames: pictures of each; by default 30, fewer in a long flight.
        colour: what the wings are coloured by.
        mode: position among `cycle.multipliers` of a Floquet mode to fly along, by the linearised
            equations; by default none.
        scale: its amplitude at the start, of the largest entry in units of the state scale; by
            default such that it nowhere exceeds 1.

    Raises:
        ArgumentError: a number out of bounds, a colour or mode that there is not, or a scale
            without a mode.
        StateError: the disturbed wing or flight leaves what the model can tell, as along a mode
            that has grown too far.
    """
    quantity = colour_named(colour)
    beats = usual_beats(mode) if beats is None else beats
    frames = usual_frames(beats) if frames is None else frames
    _require(beats, frames, mode, scale)
    model = cycle.model
    times = cycle.start_time + cycle.period * np.arange(beats * frames + 1) / frames
    orbit = cycle.trajectory(times).states
    states, remarks = orbit, tuple[str, ...]()
    undisturbed = placing = place_body(times, model.body_in_space(orbit))
    if mode is not None:
        amplitude = shown_amplitude(cycle, mode, beats) if scale is None else scale
        states = orbit + mode_deviation(cycle, mode, amplitude, times)
        remarks = mode_words(cycle, mode, amplitude)
        placing = place_body(times, model.body_in_space(states))
    loads = model.loads_along(times, states)
    angles, _ = model.motion_of_both(times, states)
    wings = _outlines(cycle, angles)

    def of_wings(points: Callable[[WingOutline], FloatArray]) -> FloatArray:
        """Points of both wings at all frames in world axes."""
        both = np.array([[points(each) for each in pair] for pair in wings])
        between = (1,) * (both.ndim - 3)
        return placing.points(both * _SIDES.reshape(2, *between, 3))

    chords = of_wings(lambda wing: wing.to_centre)
    body, faces = body_shape(model.bird)
    tail = tail_shape(model.bird)
    at, forces = _arrows(loads)
    return Scene(
        title=title_words(cycle),
        flight=flight_words(cycle),
        mode=mode,
        remarks=remarks,
        times=times,
        beats=np.arange(beats * frames + 1) / frames,
        strokes=stroke_words(cycle, times),
        colour=quantity,
        values=_values(quantity, loads, wings),
        chords=chords,
        edges=of_wings(lambda wing: np.stack([wing.leading, wing.trailing])),
        bones=of_wings(lambda wing: wing.bones),
        feathers=of_wings(lambda wing: wing.feathers),
        body=placing.points(np.broadcast_to(body, (len(times), *body.shape))),
        body_faces=faces,
        tail=None
        if tail is None
        else placing.points(np.broadcast_to(tail, (len(times), *tail.shape))),
        arrow_points=placing.points(at),
        arrow_forces=placing.vectors(forces),
        placing=placing,
        undisturbed=undisturbed.position,
        span=2.0 * max(float(each.leading[:, 1].max()) for pair in wings for each in pair),
    )


def usual_beats(mode: int | None) -> int:
    """How many beats to show, if nothing is said: more along a mode."""
    return _USUAL_BEATS if mode is None else 2 * _USUAL_BEATS


def usual_frames(beats: int, birds: int = 1) -> int:
    """How many frames of each to show, if nothing is said, of so many birds."""
    altogether = _USUALLY_ALTOGETHER * 2 // (1 + birds)
    return min(_USUAL_FRAMES, max(_FEWEST_FRAMES, altogether // max(beats, 1)))


def _require(beats: int, frames: int, mode: int | None, scale: float | None) -> None:
    if not 1 <= beats <= MOST_BEATS:
        raise ArgumentError(f"beats must be from 1 to {MOST_BEATS}, not {beats}.")
    if not _FEWEST_FRAMES <= frames <= MOST_FRAMES:
        raise ArgumentError(
            f"frames of a beat must be from {_FEWEST_FRAMES} to {MOST_FRAMES}, not {frames}."
        )
    if scale is None:
        return
    if mode is None:
        raise ArgumentError("scale is the amplitude of a mode; say which mode.")
    if not 0.0 < scale < np.inf:
        raise ArgumentError(f"scale must be positive and finite, not {scale}.")


def _outlines(
    cycle: FlightCycle, angles: FloatArray
) -> tuple[tuple[WingOutline, WingOutline], ...]:
    """Outlines of both wings, the left one mirrored, at angles (F, 2, A) rad."""
    model, known = cycle.model, dict[bytes, WingOutline]()
    discretisation = model.bird.wing.resolved_discretisation

    def found(side: int, at: FloatArray) -> WingOutline:
        wing = (model.wing, model.left_wing)[side]
        # What is prescribed repeats itself every beat, on both sides, to round-off.
        key = bytes([side and not model.has_like_wings]) + np.round(at, 12).tobytes()
        if key not in known:
            known[key] = wing_outline(wing, at, discretisation)
        return known[key]

    return tuple((found(0, right), found(1, left)) for right, left in angles)


def _values(
    colour: Colour, loads: LoadsAlong, wings: tuple[tuple[WingOutline, WingOutline], ...]
) -> FloatArray:
    values = []
    for side, wing in enumerate((loads.stack.right, loads.stack.left)):
        chords = np.array([pair[side].chords for pair in wings])
        vectors = chords[:, :, 0] - chords[:, :, 1]
        line = np.array([pair[side].line for pair in wings])
        forward = 0.5 * (vectors[:, :-1] + vectors[:, 1:])
        values.append(colour.of(wing, forward, np.diff(line, axis=1)))
    return np.stack(values, axis=1)


def _arrows(loads: LoadsAlong) -> tuple[FloatArray, FloatArray]:
    """Points (F, A, 3) m and forces (F, A, 3) N in body axes, whose sum is that of the air."""
    points, forces = [], []
    stack = loads.stack
    for side, wing in zip(_SIDES, (stack.right, stack.left), strict=True):
        for part in np.array_split(np.arange(wing.chord.shape[1]), _ARROWS_PER_WING):
            force, position = wing.force[:, part], wing.position[:, part]
            weight = np.linalg.norm(force, axis=2, keepdims=True)
            weight /= np.maximum(weight.sum(axis=1, keepdims=True), np.finfo(float).tiny)
            points.append((weight * position).sum(axis=1) * side)
            forces.append(force.sum(axis=1) * side)
    tail = loads.at(0).tail
    if tail is not None:
        points.append(np.broadcast_to(tail.position, stack.tail_force.shape))
        forces.append(stack.tail_force)
    if stack.body_force.any():
        points.append(np.zeros_like(stack.body_force))
        forces.append(stack.body_force)
    return np.stack(points, axis=1), np.stack(forces, axis=1)
