"""The bird assembled in Exudyn: one kinematic tree of body and both wings.

Coordinates: those of the body (`birdmb.models.tree_coordinates`), in space or in the plane of
symmetry, then the joints of the right wing in chain order and the hinges of its feathers, then
those of the left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import NodeGenericODE2, ObjectKinematicTree
from scipy.spatial.transform import Rotation

from birdmb._typing import FloatArray, IntArray
from birdmb.models.compiled_calls import COMPILED
from birdmb.models.feather_rods import FeatherRod, feather_rods
from birdmb.models.tree_coordinates import IN_PLANE
from birdmb.models.tree_kernel import TreeLinks
from birdmb.topology import Bird
from birdmb.topology.inertia import joined, steiner

_NEXT_TO_NO_MASS = 1e-30
_MIRROR = np.diag([1.0, -1.0, 1.0])
_SPAN = np.array([0.0, 1.0, 0.0])
_SLIDES = (exu.JointType.PrismaticX, exu.JointType.PrismaticY, exu.JointType.PrismaticZ)
_TURNS = np.eye(3)[::-1]  # axes of yaw, pitch and roll
# Which way along or about the body's axes each coordinate moves it at zero coordinates.
_DIRECTION = np.array([0, 1, 2, 5, 4, 3])
_MASS_MATRIX = exu.ComputeItemType.MassMatrix
_LEFT_HAND_SIDE = exu.ComputeItemType.ODE2LHS


@dataclass
class _Link:
    """A link of the tree; its frame's z axis is the joint's axis."""

    parent: int
    joint: exu.JointType
    offset: FloatArray
    transformation: FloatArray
    mass: float = 0.0
    centre: FloatArray = field(default_factory=lambda: np.zeros(3))
    inertia: FloatArray = field(default_factory=lambda: np.zeros((3, 3)))

    def add_body(self, mass: float, centre: FloatArray, inertia: FloatArray) -> None:
        """Weld a body on: `centre` (3,) and `inertia` (3, 3) about it, in the link's frame."""
        own = self.mass, self.centre, self.inertia
        self.mass, self.centre, self.inertia = joined([own, (mass, centre, inertia)])


def _axis_frame(axis: FloatArray) -> FloatArray:
    """Rotation matrix that takes the z axis to `axis`."""
    return _frame_of(tuple(axis.tolist())).copy()


@lru_cache(maxsize=256)
def _frame_of(axis: tuple[float, ...]) -> FloatArray:
    # Models are made by the thousand, with joints about few axes: this would be most of it.
    rotation, _ = Rotation.align_vectors([axis], [[0.0, 0.0, 1.0]])
    return np.asarray(rotation.as_matrix())


def bird_links(bird: Bird, body_coordinates: IntArray) -> list[_Link]:
    """Links of the tree: body, right wing, left wing (body axes at zero coordinates).

    `body_coordinates` (B,) are those of `tree_coordinates.COORDINATES` that may move.
    """
    bird = bird.assembled
    links: list[_Link] = []
    axes = np.eye(3)
    for coordinate in body_coordinates.tolist():
        parent = len(links) - 1
        if coordinate < len(_SLIDES):
            links.append(_Link(parent, _SLIDES[coordinate], np.zeros(3), np.eye(3)))
        else:
            frame = _axis_frame(_TURNS[coordinate - len(_SLIDES)])
            links.append(_Link(parent, exu.JointType.RevoluteZ, np.zeros(3), axes.T @ frame))
            axes = frame
    inertia = bird.body.inertia_tensor
    if body_coordinates.size == IN_PLANE.size:
        # Only the pitch inertia can matter in longitudinal flight, and the others may be unknown.
        inertia = np.diag([0.0, bird.body.inertia_yy, 0.0])
    links[-1].add_body(bird.body.mass, np.zeros(3), axes.T @ inertia @ axes)
    root = np.array([bird.wing.root.x, bird.wing.root.y, bird.wing.root.z])
    rods, carrier = feather_rods(bird), len(links) - 1
    for side in (np.eye(3), _MIRROR):
        _add_wing(links, carrier, bird, rods, side, side @ root, axes)
    return links


def _add_wing(
    links: list[_Link],
    carrier: int,
    bird: Bird,
    rods: Sequence[FeatherRod],
    side: FloatArray,
    root: FloatArray,
    body_frame: FloatArray,
) -> None:
    # Position and axes of the segment at hand, seen from the frame of the link that carries it.
    parent, place, axes = carrier, body_frame.T @ root, body_frame.T
    handed = np.linalg.det(side)
    hinges = []
    for bone, segment in bird.segments.items():
        for joint in bird.joints:
            if joint.segment != bone:
                continue
            # A reflection turns an axis like a mirrored vector, and the sense of rotation besides.
            frame = _axis_frame(handed * side @ np.array(joint.axis))
            links.append(_Link(parent, exu.JointType.RevoluteZ, place, axes @ frame))
            parent, place, axes = len(links) - 1, np.zeros(3), frame.T
        centre = place + axes @ side @ np.array(segment.centre_of_mass)
        inertia = axes @ side @ np.array(segment.inertia) @ side @ axes.T
        links[parent].add_body(segment.mass, centre, inertia)
        for rod in rods:
            if rod.bone == bone:
                frame = _axis_frame(handed * side @ _SPAN)
                hinge = _Link(
                    parent, exu.JointType.RevoluteZ, place + axes @ side @ rod.root, axes @ frame
                )
                rod_axis = frame.T @ side @ rod.direction
                hinge.add_body(
                    rod.mass,
                    0.5 * rod.length * rod_axis,
                    steiner(rod.mass, rod.length / np.sqrt(12.0) * rod_axis),
                )
                hinges.append(hinge)
        place = place + axes @ side @ np.array([0.0, segment.length, 0.0])
    # Exudyn divides by the mass that hangs on a link: one that carries none gives NaN.
    links[-1].mass = max(links[-1].mass, _NEXT_TO_NO_MASS)
    links.extend(hinges)


def tree_links(bird: Bird, body_coordinates: IntArray, *, is_mirrored: bool) -> TreeLinks:
    """Body and wings of the tree for compiled rates; of mirror images the right wing alone."""
    links = bird_links(bird, body_coordinates)
    first = body_coordinates.size
    body, wings = links[first - 1], links[first:]
    if is_mirrored:
        wings = wings[: len(wings) // 2]
    to_body = _axis_frame(_TURNS[body_coordinates[-1] - len(_SLIDES)])
    parents = np.array([link.parent for link in wings], dtype=np.int64) - first
    carried = parents < 0
    offsets = [
        to_body @ k.offset if own else k.offset for k, own in zip(wings, carried, strict=True)
    ]
    axes = [
        to_body @ k.transformation if own else k.transformation
        for k, own in zip(wings, carried, strict=True)
    ]
    return TreeLinks(
        parent=np.where(carried, -1, parents),
        offset=np.array(offsets).reshape(-1, 3),
        axes=np.array(axes).reshape(-1, 3, 3),
        mass=np.array([link.mass for link in wings], dtype=float),
        centre=np.array([link.centre for link in wings]).reshape(-1, 3),
        inertia=np.array([link.inertia for link in wings]).reshape(-1, 3, 3),
        weighs=np.array(
            [link.mass > 0.0 or bool(link.inertia.any()) for link in wings], dtype=bool
        ),
        copies=2.0 if is_mirrored else 1.0,
        body_mass=body.mass,
        body_inertia=to_body @ body.inertia @ to_body.T,
        directions=np.sort(_DIRECTION[body_coordinates]),
    )


def add_tree(mbs: Any, links: Sequence[_Link], gravity: float, **options: Any) -> tuple[Any, Any]:
    """Put the links into a system; the numbers of the node of their coordinates and of the tree."""
    zeros = [0.0] * len(links)
    node = mbs.AddNode(
        NodeGenericODE2(
            referenceCoordinates=zeros,
            initialCoordinates=zeros,
            initialCoordinates_t=zeros,
            numberOfODE2Coordinates=len(links),
        )
    )
    tree = mbs.AddObject(
        ObjectKinematicTree(
            nodeNumber=node,
            jointTypes=[link.joint for link in links],
            linkParents=[link.parent for link in links],
            jointTransformations=exu.Matrix3DList([link.transformation for link in links]),
            jointOffsets=exu.Vector3DList([link.offset for link in links]),
            linkInertiasCOM=exu.Matrix3DList([link.inertia for link in links]),
            linkCOMs=exu.Vector3DList([link.centre for link in links]),
            linkMasses=[link.mass for link in links],
            gravity=[0.0, 0.0, gravity],
            **options,
        )
    )
    return node, tree


class TreeInertia:
    """Mass matrix and inertial forces of a bird's tree, without any loads.

    Args:
        bird: the bird.
        body_coordinates: as for `bird_links`.
    """

    def __init__(self, bird: Bird, body_coordinates: IntArray) -> None:
        links = bird_links(bird, body_coordinates)
        self.size, self.body_coordinates = len(links), body_coordinates
        self._container = exu.SystemContainer()
        self._mbs = self._container.AddSystem()
        _, self._tree = add_tree(self._mbs, links, bird.gravity)
        self._mbs.Assemble()

    def at(self, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Mass matrices M (K, c, c) and forces b (K, c) at coordinates q and velocities v (K, c).

        M q'' + b = generalised forces; b holds gravity and what inertia does at constant rates.
        """
        mass, bias = np.empty((*q.shape, self.size)), np.empty(q.shape)
        current = exu.ConfigurationType.Current
        data, compute = self._mbs.systemData, self._mbs.ComputeItem
        with COMPILED:  # another thread's coordinates would come in between
            for k in range(len(q)):
                data.SetODE2Coordinates(q[k], current)
                data.SetODE2Coordinates_t(v[k], current)
                mass[k] = compute(self._tree, _MASS_MATRIX)
                bias[k] = compute(self._tree, _LEFT_HAND_SIDE)
        return mass, bias


def typical_inertias(bird: Bird, body_coordinates: IntArray, size: int) -> FloatArray:
    """Mass (kg) or moment of inertia (kg m2) that is typical of each coordinate, (size,)."""
    length = sum(segment.length for _, segment in bird.segments.items())
    typical = np.full(size, bird.total_mass * length**2)
    typical[: np.count_nonzero(body_coordinates < len(_SLIDES))] = bird.total_mass
    return typical
