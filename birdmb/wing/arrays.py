"""The right wing as plain arrays: what the compiled kernels read of a bird."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._typing import BoolArray, FloatArray, IntArray
from birdmb.topology import Bird, Driver


class WingArrays(NamedTuple):
    """Joint chain, bones and feathers or sections of the right wing (SI, rad).

    J joints, B bones, F feathers or else S sections. A wing is placed by A = J + H angles: those of
    the joints, then those of the H hinges of feathers. The driver of a hinge is its rest angle, at
    all times.
    """

    root: FloatArray  # (3,) shoulder joint from the body's centre of mass, body frame
    half_thickness: float
    bone_length: FloatArray  # (B,) from the shoulder outwards
    axis: FloatArray  # (J, 3) unit vectors in the parent's frame
    segment: IntArray  # (J,) the bone that each joint carries
    twist: BoolArray  # (J,) spread along its bone
    feather_bone: IntArray  # (F,) from the shoulder outwards
    feather_position: FloatArray  # (F,) 0 at the bone's root, 1 at its end
    feather_length: FloatArray  # (F,)
    feather_rest_angle: FloatArray  # (F,) 0 aft, pi/2 outwards along the bone
    feather_share: FloatArray  # (F, J) of each joint's angle that the feather follows
    feather_hinge: IntArray  # (F,) which of the A angles turns the feather on its hinge, -1: none
    square_tip: bool  # a wing of feathers ends in a tip edge, not in a point
    skin: int  # bone to whose end the leading edge of feathers runs straight from the shoulder
    section_bone: IntArray  # (S,) from the shoulder outwards
    section_position: FloatArray  # (S,) 0 at the bone's root, 1 at its end
    section_chord: FloatArray  # (S,)
    section_offset: FloatArray  # (S,) of the quarter chord ahead of the bone
    section_twist: FloatArray  # (S,) leading edge up
    bone_end: FloatArray  # (B,) where among the leading edge's vertices each bone ends
    profile: FloatArray  # (1 or S, 3) lift slope, zero-lift angle, moment coefficient
    offset: FloatArray  # (A,) drivers: their means
    cosine: FloatArray  # (A, K) and their factors of cos(k w t), k = 1 to K, w = 2 pi f
    sine: FloatArray  # (A, K) and of sin(k w t)
    angular_frequency: float  # w


class JointArrays(NamedTuple):
    """The part of `WingArrays` that places joints: less to hand over where no shape is made."""

    root: FloatArray  # (3,) as in `WingArrays`
    bone_length: FloatArray  # (B,)
    axis: FloatArray  # (J, 3)
    segment: IntArray  # (J,)
    twist: BoolArray  # (J,)
    angle_count: int  # A


def joint_arrays(wing: WingArrays) -> JointArrays:
    """What of a wing places its joints."""
    return JointArrays(
        wing.root,
        wing.bone_length,
        wing.axis,
        wing.segment,
        wing.twist,
        int(wing.offset.size),
    )


def wing_arrays(bird: Bird) -> WingArrays:
    """Arrays of a bird's right wing, in the order of its joint chain and feather list."""
    bird = bird.assembled
    joints, feathers, angles = bird.joints, bird.feathers, bird.angle_names
    names, sections = bird.segments.names, bird.sections
    rest = [feather.hinge.rest for feather in feathers if feather.hinge]
    drivers = [joint.driver for joint in joints] + [Driver(angle) for angle in rest]
    series = np.zeros((2, len(drivers), max([1, *(len(driver.cosine) for driver in drivers)])))
    for i, driver in enumerate(drivers):
        series[:, i, : len(driver.cosine)] = driver.cosine, driver.sine
    return WingArrays(
        root=np.array([bird.wing.root.x, bird.wing.root.y, bird.wing.root.z]),
        half_thickness=bird.wing.half_thickness,
        bone_length=np.array([segment.length for _, segment in bird.segments.items()]),
        axis=np.array([joint.axis for joint in joints], dtype=float).reshape(-1, 3),
        segment=np.array([names.index(joint.segment) for joint in joints], dtype=np.int64),
        twist=np.array([joint.twist for joint in joints], dtype=np.bool_),
        feather_bone=np.array([names.index(f.bone) for f in feathers], dtype=np.int64),
        feather_position=np.array([f.position for f in feathers], dtype=float),
        feather_length=np.array([f.length for f in feathers], dtype=float),
        feather_rest_angle=np.array([f.rest_angle for f in feathers], dtype=float),
        feather_share=np.array([bird.feather_shares(f) for f in feathers], dtype=float).reshape(
            len(feathers), len(joints)
        ),
        feather_hinge=np.array(
            [angles.index(f.hinge_name) if f.hinge else -1 for f in feathers], dtype=np.int64
        ),
        square_tip=bool(feathers) and _has_square_tip(bird),
        skin=_skin(bird),
        section_bone=np.array([names.index(s.bone) for s in sections], dtype=np.int64),
        section_position=np.array([s.position for s in sections], dtype=float),
        section_chord=np.array([s.chord for s in sections], dtype=float),
        section_offset=np.array([s.offset for s in sections], dtype=float),
        section_twist=np.array([s.twist for s in sections], dtype=float),
        bone_end=_bone_ends(bird),
        profile=_profiles(bird),
        offset=np.array([driver.mean for driver in drivers]),
        cosine=series[0],
        sine=series[1],
        angular_frequency=2.0 * np.pi * bird.gait.frequency,
    )


def _skin(bird: Bird) -> int:
    """Which bone the skin before the joints reaches to, from the shoulder."""
    names, wanted = bird.segments.names, bird.wing.propatagium
    if wanted is not None:
        return names.index(wanted)
    return 1 if len(names) > 2 else 0


def _bone_ends(bird: Bird) -> FloatArray:
    """Where (B,) among the leading edge's vertices the bones end.

    Fractions of the way from one vertex to the next. An edge of feathers has one at each end.
    """
    names = bird.segments.names
    ends = np.arange(1.0, len(names) + 1.0)
    if not bird.sections:
        return ends
    places = [names.index(section.bone) + section.position for section in bird.sections]
    return np.interp(ends, places, np.arange(float(len(places))))


def _profiles(bird: Bird) -> FloatArray:
    """Lift slope, zero-lift angle, moment coefficient (1 or S, 3); one row if all are alike."""
    rows = [(p.lift_slope, p.zero_lift_angle, p.moment_coefficient) for p in bird.profiles]
    return np.array(rows if len(set(rows)) > 1 else rows[:1])


def _has_square_tip(bird: Bird) -> bool:
    """Whether, joints at zero, the edge from hand tip to last feather tip runs aft more than out.

    Such an edge is no leading edge: a line that went on along it would have to turn backwards. At
    45 degrees both views of the tip give loads that settle on more elements.
    """
    last = bird.feathers[-1]
    outwards = last.length * np.sin(last.rest_angle)
    backwards = 2.0 * bird.wing.half_thickness + last.length * np.cos(last.rest_angle)
    return bool(outwards < backwards)
