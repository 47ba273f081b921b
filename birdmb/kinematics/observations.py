"""What was measured, beside what the bird's chain makes of joint angles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from birdmb._typing import Array, BoolArray, FloatArray, IntArray
from birdmb.kinematics.markers import Markers, places_along
from birdmb.wing.arrays import WingArrays
from birdmb.wing.edges import COMPLEX_STEP


@dataclass(frozen=True)
class Observations:
    """Measured columns: x, y, z of M markers in body axes, then C joint angles; R = 3 M + C.

    Attributes:
        origin: the file, for sentences.
        times: times (N,), s.
        values: the columns (N, R), m and rad, NaN where nothing was measured.
        wing: the wing that the markers are on.
        markers: the markers.
        joints: which joint (C,) each column of angles is of.
        names: names of the M markers and C joints.
        body_motions: of the body in each frame that are not known: 0, 3 translations, or these and
            3 small rotations.
    """

    origin: str
    times: FloatArray
    values: FloatArray
    wing: WingArrays
    markers: Markers
    joints: IntArray
    names: tuple[str, ...]
    body_motions: int

    @cached_property
    def group(self) -> IntArray:
        """Which marker or joint (R,) a column is of, a place in `names`."""
        count = len(self.markers.names)
        return np.concatenate([np.repeat(np.arange(count), 3), count + np.arange(len(self.joints))])

    @property
    def is_point(self) -> BoolArray:
        """Which columns (R,) are of points."""
        return np.asarray(self.group < len(self.markers.names))

    @property
    def reach(self) -> float:
        """Length of the stretched wing's bones, m."""
        return float(self.wing.bone_length.sum())

    @property
    def typical(self) -> FloatArray:
        """Typical sizes (R,) of the columns: the wing's reach, and a radian."""
        return np.where(self.is_point, self.reach, 1.0)

    @property
    def typical_of_names(self) -> FloatArray:
        """The same of each of `names` (M + C,)."""
        return np.where(np.arange(len(self.names)) < len(self.markers.names), self.reach, 1.0)

    def predicted(self, angles: Array) -> Array:
        """The columns (P, R) at joint angles (P, A), rad."""
        marked = self.markers
        places = places_along(
            self.wing, marked.bone, marked.position, marked.feather, marked.fixed, angles
        )
        return np.concatenate([places.reshape(len(angles), -1), angles[:, self.joints]], axis=1)

    def derivatives(self, angles: FloatArray) -> FloatArray:
        """Derivatives (P, R, J) of the columns by the joints' angles, by complex step."""
        count = self.wing.segment.size
        found = np.empty((len(angles), len(self.group), count))
        for joint in range(count):
            stepped = angles.astype(complex)
            stepped[:, joint] += 1j * COMPLEX_STEP
            found[:, :, joint] = self.predicted(stepped).imag / COMPLEX_STEP
        return found

    def body_motion_basis(self, weights: FloatArray, places: FloatArray) -> FloatArray:
        """Orthonormal directions (P, R, g) that the body's unknown motion moves columns in.

        Of columns times `weights` (P, R), at `places` (P, R) about which the body turns.
        """
        count = len(self.markers.names)
        moved = np.zeros((*weights.shape, self.body_motions))
        if not self.body_motions or not count:
            return moved[:, :, :0]
        for axis in range(3):
            moved[:, axis : 3 * count : 3, axis] = 1.0
        if self.body_motions == 6:
            points = places[:, : 3 * count].reshape(len(places), count, 3)
            for axis, direction in enumerate(np.eye(3)):
                turned = np.cross(direction, points).reshape(len(places), -1)
                moved[:, : 3 * count, 3 + axis] = turned
        basis, _ = np.linalg.qr(weights[:, :, None] * moved)
        return np.asarray(basis)


def without(basis: FloatArray, columns: FloatArray) -> FloatArray:
    """Columns (P, R, ...) without their parts along orthonormal directions (P, R, g)."""
    flat = columns.reshape(*columns.shape[:2], -1)
    return np.asarray((flat - basis @ (basis.transpose(0, 2, 1) @ flat)).reshape(columns.shape))
