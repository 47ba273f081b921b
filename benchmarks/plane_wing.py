"""A plane wing by lifting line and by vortex lattices: `python benchmarks/plane_wing.py`.

Derivatives of a flat, tapered wing of aspect ratio 7.5, twisted by 2 degrees, at 1 degree
(docs/lateral.md). The lattices written here tell which of the lifting line's neglects makes which
difference from AVL.
"""

from collections.abc import Callable

import numpy as np
from rich.console import Console
from rich.table import Table

from birdmb.studies.experiments.derivatives import (
    AVL,
    LINE,
    MOMENTS_AT,
    WING,
    derivatives,
    quasi_steady_wrench,
    settled_wrench,
)

Wrench = Callable[[np.ndarray], np.ndarray]

HALF_SPAN = 0.5 * WING.span
ON_ITSELF = 1e-12  # m2, where a vortex moves no air
TWIST = float(WING.twists[0])


def chords(y: np.ndarray) -> np.ndarray:
    """Chords (N,) m along x at y (N,) m."""
    return 2.2 - 0.4 * np.abs(y) / HALF_SPAN


def ahead(y: np.ndarray, part: float) -> np.ndarray:
    """How far a part of the chord is ahead of the point that moments are about, m."""
    return MOMENTS_AT - 0.4 * np.abs(y) / HALF_SPAN - part * chords(y)


def lattice(strips: int, control: float, bound: bool, legs: bool, panels: int = 1) -> Wrench:
    """Wrench by twist (6,) of a lattice of horseshoe vortices; air of density 1.

    Args:
        strips: of equal width in each half wing.
        control: part of a panel's chord at which no air may pass.
        bound: whether the bound vortices act on each other, and not each on its own section alone.
        legs: whether the trailing vortices feel the wind where they lie in the wing.
        panels: of equal length along the chord; one unless bound vortices act on each other.
    """
    edge = np.linspace(-HALF_SPAN, HALF_SPAN, 2 * strips + 1)
    middle = 0.5 * (edge[1:] + edge[:-1])
    y, first, second = (np.tile(x, panels) for x in (middle, edge[:-1], edge[1:]))
    before = np.repeat(np.arange(panels), middle.size)
    count = y.size
    vortex, at_control = (before + 0.25) / panels, (before + control) / panels
    start, end = (np.column_stack([ahead(x, vortex), x, np.zeros(count)]) for x in (first, second))
    centre = 0.5 * (start + end)
    at = np.column_stack([ahead(y, at_control), y, np.zeros(count)])
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
            across = np.maximum(na * nb + (a * b).sum(axis=-1), ON_ITSELF)
            scale = (na + nb) / (4 * np.pi * na * nb * across)
            total += scale[..., None] * np.cross(a, b)
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
            for ends, x, sign in ((start, first, -1.0), (end, second, 1.0)):
                length = (1.0 - vortex) * chords(x)
                leg = np.column_stack([-sign * length, np.zeros(count), np.zeros(count)])
                on = ends - np.column_stack([0.5 * length, np.zeros(count), np.zeros(count)])
                forces.append((on, gamma[:, None] * np.cross(wind(on), leg)))
        return np.asarray(
            sum(np.append(f.sum(axis=0), np.cross(x, f).sum(axis=0)) for x, f in forces)
        )

    return wrench


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
        "lattice of 8 panels along the chord": derivatives(
            lattice(12, 0.75, bound=True, legs=True, panels=8)
        ),
        "lifting line": derivatives(quasi_steady_wrench(LINE)),
        "lifting line, unsteady": derivatives(settled_wrench(LINE)),
    }
    for name, values in rows.items():
        table.add_row(name, *("" if np.isnan(v) else f"{v:.4g}" for v in values.values()))
    Console(width=150).print(table)


if __name__ == "__main__":
    main()
