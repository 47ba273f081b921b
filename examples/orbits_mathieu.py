"""Mathieu's equation: the zero solution as an orbit, and the edge of its instability tongue.

Run `python examples/orbits_mathieu.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from pathlib import Path

import numpy as np

from birdmb.orbits import OdeModel, Steps, floquet, stability_boundary


def mathieu(a: float, q: float, damping: float = 0.0) -> OdeModel:
    """x'' + damping x' + (a - 2 q cos 2t) x = 0."""
    return OdeModel(
        lambda t, s: [s[1], -damping * s[1] - (a - 2 * q * np.cos(2 * t)) * s[0]],
        ("x", "v"),
        period=np.pi,
        guess=[0.0, 0.0],
        state_scale=[1.0, 1.0],
    )


def main(directory: Path) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    for a, q in ((1, 0.5), (2, 1), (3, 2), (4, 5)):
        orbit = floquet(mathieu(a, q), [0.0, 0.0], segments=5)
        pair = ", ".join(f"{value:.9f}" for value in orbit.multipliers)
        print(f"a = {a}, q = {q}: {orbit.stability:9s} multipliers {pair}")

    boundary = stability_boundary(
        lambda q, a: mathieu(a, q, damping=0.1),
        (0.0, 1.0),
        np.linspace(0.6, 1.4, 9),
        first_name="q",
        second_name="a",
        steps=Steps(first=0.1, longest=0.2),
    )
    print(boundary.to_xarray()["first_parameter"].to_series().to_string())
    boundary.plot().savefig(directory / "mathieu_tongue.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
