"""A plane wing by lifting line and by vortex lattices: `python benchmarks/plane_wing.py`.

Derivatives of a flat, tapered wing of aspect ratio 7.5, twisted by 2 degrees, at 1 degree
(docs/lateral.md). The lattices written here tell which of the lifting line's neglects makes which
difference from AVL.
"""

from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

from birdmb.aerodynamics.elements import place_elements
from birdmb.aerodynamics.pair import pair_loads
from birdmb.aerodynamics.twist_loads import mirrored, wing_wrench
from birdmb.wing.shape import WingShape

Wrench = Callable[[np.ndarray], np.ndarray]

HALF_SPAN, AREA, CHORD, SPAN, MOMENTS_AT = 7.5, 30.0, 2.0, 15.0, 0.5
ALPHA, TWIST = np.radians(1.0), np.radians(2.0)
STEP = 1e-4
# Drela and Youngren's AVL: 12 equal strips a half wing, one panel along the chord.
AVL = {
    "CL_alpha": 4.638, "Cm_alpha": -0.4292, "CL_q": np.nan, "Cm_q": -0.5171, "Cl_beta": -0.02575,
    "Cn_beta": 0.00047, "Cl_p": -0.5187, "Cn_p": -0.01985, "Cl_r": 0.06424, "Cn_r": -0.00090,
}  # fmt: skip


def chords(y: np.ndarray) -> np.ndarray:
    """Chords (N,) m along x at y (N,) m."""
    return 2.2 - 0.4 * np.abs(y) / HALF_SPAN


def ahead(y: np.ndarray, part: float) -> np.ndarray:
    """How far a part of the chord is ahead of the point that moments are about, m."""
    return MOMENTS_AT - 0.4 * np.abs(y) / HALF_SPAN - part * chords(y)


def lifting_line(elements: int) -> Wrench:
    """Wrench by twist (6,) of the program's lifting line; air of density 1."""
    y = HALF_SPAN * np.sin(np.linspace(0.0, np.pi / 2, 2 * elements))
    line = np.column_stack([ahead(y, 0.25), y, np.zeros_like(y)])
    sweep = np.arctan2(0.3, HALF_SPAN)
    span = np.array([-np.sin(sweep), np.cos(sweep), 0.0])
    back = np.array([-np.cos(TWIST) * np.cos(sweep), -np.cos(TWIST) * np.sin(sweep), np.sin(TWIST)])
    up = np.cross(back, span)
    up *= -np.sign(up[2])
    each = (elements, 1)
    shape = WingShape(
        line, np.zeros((elements, 3)), np.tile(back, each), np.tile(up, each), np.tile(span, each),
        chords(y[0::2]) * np.cos(sweep), np.tile([2.0 * np.pi, 0.0, 0.0], each),
        np.zeros((elements, 2)), True, np.zeros((0, elements, 6)), np.zeros((elements, 3)),
    )  # fmt: skip
    placed = place_elements(shape, np.zeros(3))

    def wrench(twist: np.ndarray) -> np.ndarray:
        both = pair_loads(placed, placed, False, 1.0, 0.0, twist)
        right, left = (
            wing_wrench(placed.position, loads.wrench[:, :, None])[:, 0] for loads in both
        )
        return np.asarray(right + mirrored(left))

    return wrench


def lattice(strips: int, control: float, bound: bool, legs: bool) -> Wrench:
    """Wrench by twist (6,) of a lattice of one horseshoe vortex a strip; air of density 1.

    Args:
        strips: of equal width in each half wing.
        control: part of the chord at which no air may pass.
        bound: whether the bound vortices act on each other, and not each on its own section alone.
        legs: whether the trailing vortices feel the wind where they lie in the wing.
    """
    edge = np.linspace(-HALF_SPAN, HALF_SPAN, 2 * strips + 1)
    middle = 0.5 * (edge[1:] + edge[:-1])
    count = middle.size
    start, end = (
        np.column_stack([ahead(y, 0.25), y, np.zeros(count)]) for y in (edge[:-1], edge[1:])
    )
    centre = 0.5 * (start + end)
    at = np.column_stack([ahead(middle, control), middle, np.zeros(count)])
    normal = np.array([-np.sin(TWIST), 0.0, -np.cos(TWIST)])

    def induced(points: np.ndarray) -> np.ndarray:
        """Velocities (K, N, 3) at points (K, 3) per circulation of each horseshoe."""
        total = np.zeros((len(points), count, 3))
        # From `start`, where the left leg comes from far behind, to `end`, where the right leaves.
        for ends, sign in ((start, -1.0), (end, 1.0)):
            r = points[:, None] - ends[None]
            across = r[..., 1] ** 2 + r[..., 2] ** 2
            begun = 1.0 - r[..., 0] / np.linalg.norm(r, axis=-1)
            if not bound:
                begun = np.ones_like(begun)  # as at the line itself: half of an infinite vortex
            direction = np.stack([np.zeros_like(across), r[..., 2], -r[..., 1]], axis=-1)
            total += sign * (begun / (4 * np.pi * across))[..., None] * direction
        if bound:
            a, b = points[:, None] - start[None], points[:, None] - end[None]
            na, nb = np.linalg.norm(a, axis=-1), np.linalg.norm(b, axis=-1)
            scale = (na + nb) / (na * nb * (na * nb + (a * b).sum(axis=-1)))
            with np.errstate(invalid="ignore"):
                own = np.nan_to_num(scale[..., None] * np.cross(a, b) / (4 * np.pi))
            total += own
        return total

    system = induced(at) @ normal
    if not bound:  # each section by itself, as thin-airfoil theory has it
        system -= np.diag(1.0 / (np.pi * chords(middle)))
    at_bound = induced(centre)
    np.einsum("iik->ik", at_bound)[:] = np.nan_to_num(np.einsum("iik->ik", at_bound))

    def wrench(twist: np.ndarray) -> np.ndarray:
        def wind(points: np.ndarray) -> np.ndarray:
            return np.asarray(-(twist[:3] + np.cross(twist[3:], points)))

        gamma = np.linalg.solve(system, -wind(at) @ normal)
        flow = wind(centre) + np.einsum("ijk,j->ik", at_bound, gamma)
        forces = [(centre, gamma[:, None] * np.cross(flow, end - start))]
        if legs:
            for ends, y, sign in ((start, edge[:-1], -1.0), (end, edge[1:], 1.0)):
                length = 0.75 * chords(y)
                leg = np.column_stack([-sign * length, np.zeros(count), np.zeros(count)])
                on = ends - np.column_stack([0.5 * length, np.zeros(count), np.zeros(count)])
                forces.append((on, gamma[:, None] * np.cross(wind(on), leg)))
        return np.asarray(
            sum(np.append(f.sum(axis=0), np.cross(x, f).sum(axis=0)) for x, f in forces)
        )

    return wrench


def derivatives(wrench: Wrench) -> dict[str, float]:
    """The derivatives in stability axes; rates by span/(2 U), in pitch by chord/(2 U)."""
    c, s = np.cos(ALPHA), np.sin(ALPHA)
    axes = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])

    def found(alpha: float, beta: float, rates: np.ndarray) -> np.ndarray:
        velocity = [np.cos(beta) * np.cos(alpha), np.sin(beta), np.cos(beta) * np.sin(alpha)]
        spin = axes.T @ (rates * 2.0 / np.array([SPAN, CHORD, SPAN]))
        force, moment = np.split(wrench(np.append(velocity, spin)), 2)
        lift = force[0] * np.sin(alpha) - force[2] * np.cos(alpha)
        roll, pitch, yaw = axes @ moment / np.array([SPAN, CHORD, SPAN])
        return np.array([lift, roll, pitch, yaw]) / (0.5 * AREA)

    def slope(alpha: float = 0.0, beta: float = 0.0, rate: int | None = None) -> np.ndarray:
        rates = np.zeros(3) if rate is None else np.eye(3)[rate]
        ends = [found(ALPHA + h * alpha, h * beta, h * rates) for h in (STEP, -STEP)]
        return np.asarray((ends[0] - ends[1]) / (2 * STEP))

    a, b, p, q, r = slope(alpha=1), slope(beta=1), slope(rate=0), slope(rate=1), slope(rate=2)
    return {
        "CL_alpha": a[0], "Cm_alpha": a[2], "CL_q": q[0], "Cm_q": q[2], "Cl_beta": b[1],
        "Cn_beta": b[3], "Cl_p": p[1], "Cn_p": p[3], "Cl_r": r[1], "Cn_r": r[3],
    }  # fmt: skip


def main() -> None:
    """Print the table."""
    table = Table("", *AVL, title="Derivatives of a plane wing, stability axes")
    rows = {
        "AVL": AVL,
        "lattice written here": derivatives(lattice(12, 0.75, bound=True, legs=True)),
        "  without its legs' loads": derivatives(lattice(12, 0.75, bound=True, legs=False)),
        "  nor what bound vortices do to others": derivatives(
            lattice(12, 0.75, bound=False, legs=False)
        ),
        "  and with the wind at the quarter chord": derivatives(
            lattice(12, 0.25, bound=False, legs=False)
        ),
        "lifting line": derivatives(lifting_line(48)),
    }
    for name, values in rows.items():
        table.add_row(name, *("" if np.isnan(v) else f"{v:.4g}" for v in values.values()))
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
