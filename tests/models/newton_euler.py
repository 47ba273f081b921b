"""An independent formulation of the bird's dynamics: Newton-Euler in world axes, vector by vector.

It shares nothing with the models but the bird's data: rotations come from scipy, the mass matrix
from inverse dynamics column by column, and both wings are written out.
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

MIRROR = np.diag([1.0, -1.0, 1.0])


@dataclass
class Frame:
    """A frame on its way along the chain, in world axes."""

    R: np.ndarray
    origin: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    spin: np.ndarray
    spin_rate: np.ndarray

    def moved(self, offset):
        r = self.R @ offset
        return Frame(
            self.R,
            self.origin + r,
            self.velocity + np.cross(self.spin, r),
            self.acceleration
            + np.cross(self.spin_rate, r)
            + np.cross(self.spin, np.cross(self.spin, r)),
            self.spin,
            self.spin_rate,
        )

    def turned(self, axis, q, v, a):
        e = self.R @ axis
        return Frame(
            self.R @ Rotation.from_rotvec(q * axis).as_matrix(),
            self.origin,
            self.velocity,
            self.acceleration,
            self.spin + v * e,
            self.spin_rate + a * e + np.cross(self.spin, v * e),
        )


@dataclass
class Body:
    """A rigid body, the frame of its centre of mass, and the coordinates that move it."""

    mass: float
    inertia: np.ndarray
    frame: Frame
    path: list


def at_offsets(joints, twist=True):
    """Rotation from the body through these joints, each at its driver's offset."""
    R = Rotation.identity()
    for joint in joints:
        if twist or not joint.twist:
            R = R * Rotation.from_rotvec(joint.offset * np.array(joint.axis))
    return R


def rod(bird, feather):
    """Root and direction (3,) of a feather in its bone's frame, drivers at their offsets."""
    bones = ("humerus", "forearm", "hand")
    number = bones.index(feather.bone)
    chains = [[j for j in bird.joints if bones.index(j.segment) <= i] for i in range(3)]
    R = at_offsets(chains[number])
    aft = np.array([-1.0, 0.0, 0.0])
    aft_at_root = aft
    if feather.position == 1.0 and number < 2:
        own = [j for j in chains[number + 1] if j.segment == bones[number + 1]]
        aft_at_root = (aft + at_offsets(own, twist=False).apply(aft)) / 2
    root = np.array([0.0, feather.position * getattr(bird.segments, feather.bone).length, 0.0])
    root += bird.wing.half_thickness * aft_at_root
    followed = Rotation.identity()
    for joint, share in zip(bird.joints, bird.feather_shares(feather), strict=True):
        followed = followed * Rotation.from_rotvec(share * joint.offset * np.array(joint.axis))
    outwards = Rotation.from_rotvec(feather.rest_angle * np.array([0.0, 0.0, -1.0]))
    return root, R.inv().apply(followed.apply(outwards.apply(aft)))


def along(c, in_space):
    return np.array(c[:3] if in_space else [c[0], 0.0, c[1]], dtype=float)


def walk(bird, q, v, a):
    """All bodies, and for each rotational coordinate its axis and a point on it, in the world.

    The body's coordinates are X, Z and pitch, or X, Y, Z, yaw, pitch and roll.
    """
    y = np.array([0.0, 1.0, 0.0])
    still = np.zeros(3)
    joints, angles = len(bird.joints), len(bird.angle_names)
    in_space = len(q) - 2 * angles == 6
    slides = 3 if in_space else 2
    trunk = Frame(np.eye(3), *(along(c, in_space) for c in (q, v, a)), still, still)
    axes, own = {}, []
    for k, axis in enumerate(np.eye(3)[::-1] if in_space else [y], start=slides):
        axes[k] = (trunk.R @ axis, trunk.origin)
        trunk = trunk.turned(axis, q[k], v[k], a[k])
        own.append(k)
    inertia = bird.body.inertia_tensor if in_space else np.diag([0.0, bird.body.inertia_yy, 0.0])
    bodies = [Body(bird.body.mass, inertia, trunk, own)]
    root = np.array([bird.wing.root.x, bird.wing.root.y, bird.wing.root.z])
    first_of_right = slides + len(own)
    for side, first in ((np.eye(3), first_of_right), (MIRROR, first_of_right + angles)):
        frame, path = trunk.moved(side @ root), own
        for bone in ("humerus", "forearm", "hand"):
            segment = getattr(bird.segments, bone)
            for j, joint in enumerate(bird.joints):
                if joint.segment != bone:
                    continue
                k = first + j
                axis = np.linalg.det(side) * side @ np.array(joint.axis)
                axes[k] = (frame.R @ axis, frame.origin)
                frame = frame.turned(axis, q[k], v[k], a[k])
                path = [*path, k]
            at_centre = frame.moved(side @ np.array(segment.centre_of_mass))
            inertia = side @ np.array(segment.inertia) @ side
            bodies.append(Body(segment.mass, inertia, at_centre, path))
            for h, feather in enumerate(bird.hinged_feathers):
                if feather.bone != bone:
                    continue
                k = first + joints + h
                place, direction = (side @ vector for vector in rod(bird, feather))
                axis = np.linalg.det(side) * side @ y
                hinge = frame.moved(place)
                axes[k] = (hinge.R @ axis, hinge.origin)
                hinge = hinge.turned(axis, q[k], v[k], a[k])
                middle = hinge.moved(feather.length / 2 * direction)
                across = np.eye(3) - np.outer(direction, direction)
                inertia = feather.hinge.mass * feather.length**2 / 12 * across
                bodies.append(Body(feather.hinge.mass, inertia, middle, [*path, k]))
            frame = frame.moved(side @ np.array([0.0, segment.length, 0.0]))
    return bodies, axes


def inverse_dynamics(bird, q, v, a):
    """Generalised forces (n,) that coordinates with these accelerations need against gravity."""
    bodies, axes = walk(bird, q, v, a)
    forces = np.zeros(len(q))
    for body in bodies:
        f, R = body.frame, body.frame.R
        force = body.mass * (f.acceleration - np.array([0.0, 0.0, bird.gravity]))
        inertia = R @ body.inertia @ R.T
        moment = inertia @ f.spin_rate + np.cross(f.spin, inertia @ f.spin)
        slides = [0, 1, 2] if bodies[0].path[0] == 3 else [0, 2]
        forces[: len(slides)] += force[slides]
        for k in body.path:
            axis, point = axes[k]
            forces[k] += axis @ (moment + np.cross(f.origin - point, force))
    return forces


def mass_matrix(bird, q):
    """Mass matrix (n, n), column by column from inverse dynamics at rest."""
    zero = np.zeros(len(q))
    rest = inverse_dynamics(bird, q, zero, zero)
    return np.column_stack([inverse_dynamics(bird, q, zero, e) - rest for e in np.eye(len(q))])


def momentum(bird, q, v):
    """Linear momentum (3,) and angular momentum about the common centre of mass (3,)."""
    bodies, _ = walk(bird, q, v, np.zeros(len(q)))
    total = sum(b.mass for b in bodies)
    centre = sum(b.mass * b.frame.origin for b in bodies) / total
    linear = sum(b.mass * b.frame.velocity for b in bodies)
    angular = np.zeros(3)
    for b in bodies:
        R = b.frame.R
        angular += R @ b.inertia @ R.T @ b.frame.spin
        angular += np.cross(b.frame.origin - centre, b.mass * b.frame.velocity)
    return linear, angular
