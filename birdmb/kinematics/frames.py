"""The axes that points are given in, and the motion of the body among them."""

from __future__ import annotations

import re
from itertools import permutations, product

import numpy as np

from birdmb._typing import BoolArray, FloatArray
from birdmb.kinematics.errors import KinematicsError
from birdmb.topology.messages import shown

_FEWEST = 3  # markers that tell an attitude
_FLAT = 0.02  # of the extent of markers on a line

_WORDS = {
    **dict.fromkeys(("forward", "+x"), (0, 1.0)),
    **dict.fromkeys(("backward", "-x"), (0, -1.0)),
    **dict.fromkeys(("right", "+y"), (1, 1.0)),
    **dict.fromkeys(("left", "-y"), (1, -1.0)),
    **dict.fromkeys(("down", "+z"), (2, 1.0)),
    **dict.fromkeys(("up", "-z"), (2, -1.0)),
}
_NAMES = (("forward", "backward"), ("right", "left"), ("down", "up"))


def to_body_axes(frame: str) -> FloatArray:
    """Matrix (3, 3) from components along the axes of a file to those along body axes.

    Args:
        frame: "body"; or where the file's x, y and z axes point to, in words such as
            "forward-left-up" or as body axes such as "+x-y-z" (x forward, y right, z down).

    Raises:
        KinematicsError: it is none, or names a direction twice.
    """
    if frame == "body":
        return np.eye(3)
    signed = re.fullmatch(r"([+-][xyz])([+-][xyz])([+-][xyz])", frame)
    parts = signed.groups() if signed else frame.split("-")
    found = [_WORDS.get(part) for part in parts]
    known = [each for each in found if each is not None]
    if len(found) != 3 or {axis for axis, _ in known} != {0, 1, 2}:
        raise KinematicsError(
            f"the frame {shown(frame)} must say where the axes x, y and z point to: body, words "
            "such as forward-left-up, or body axes such as +x-y-z."
        )
    matrix = np.zeros((3, 3))
    for column, (axis, sign) in enumerate(known):
        matrix[axis, column] = sign
    return matrix


def all_frames() -> tuple[str, ...]:
    """The 48 ways in which the axes of a file may point, in words."""
    return tuple(
        "-".join(_NAMES[axis][side] for axis, side in zip(order, sides, strict=True))
        for order in permutations(range(3))
        for sides in product((0, 1), repeat=3)
    )


def without_body_motion(
    points: FloatArray, on_body: BoolArray, places: FloatArray, origin: str
) -> tuple[FloatArray, float]:
    """Points (N, M, 3) in body axes from the shoulder, by a rigid fit to the markers on the body.

    Kabsch, Acta Cryst. A 32, 1976. Frames without three of these markers become NaN.

    Args:
        points: measured, in any axes.
        on_body: which (M,) are fixed to the body.
        places: their places (M, 3) from the shoulder, body axes.
        origin: the file, for sentences.

    Returns:
        The points, and how far those on the body are from their places, rms, m.

    Raises:
        KinematicsError: the markers do not tell the attitude.
    """
    measured, wanted = points[:, on_body], places[on_body]
    extent = np.linalg.svd(wanted - wanted.mean(axis=0), compute_uv=False)
    if len(wanted) < _FEWEST or extent[1] < _FLAT * extent[0]:
        raise KinematicsError(
            f"{origin}: the body's attitude needs three markers on the body or more, not on a line."
        )
    there = np.asarray(np.isfinite(measured).all(axis=2))
    if not (there.sum(axis=1) >= _FEWEST).any():
        raise KinematicsError(f"{origin}: in no frame are three markers on the body seen.")
    weight = there[:, :, None] / np.maximum(there.sum(axis=1), 1)[:, None, None]
    measured = np.where(there[:, :, None], measured, 0.0)
    centre, target = (weight * measured).sum(axis=1), (weight * wanted).sum(axis=1)
    spread = np.einsum(
        "nmi,nmj->nij", weight * (measured - centre[:, None]), wanted - target[:, None]
    )
    u, _, v = np.linalg.svd(spread)
    u[:, :, 2] *= np.sign(np.linalg.det(u @ v))[:, None]  # a rotation, no reflection
    turned = u @ v
    moved = (points - centre[:, None]) @ turned + target[:, None]
    moved[there.sum(axis=1) < _FEWEST] = np.nan
    off = moved[:, on_body] - wanted
    return moved, float(np.sqrt(np.nanmean(np.sum(off**2, axis=2))))
