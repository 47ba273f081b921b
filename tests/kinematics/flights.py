"""Marker points of a bird whose gait is known, as a camera would have them."""

from pathlib import Path

import numpy as np

from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.topology import Bird
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.chain import joint_chain
from birdmb.wing.edges import feather_ends

NOISE = 1e-3  # m
RATE = 240.0  # frames per second
BONES = ("shoulder", "elbow", "wrist", "hand_tip")


def points_of(
    bird: Bird, *, beats: float = 5.0, noise: float = NOISE, seed: int = 0, feathers: bool = True
) -> dict[str, np.ndarray]:
    """Times (N,) and points (N, 3) m from the shoulder, body axes, by name."""
    wing = wing_arrays(bird)
    times = np.arange(int(beats / bird.gait.frequency * RATE)) / RATE
    clean: dict[str, list[np.ndarray]] = {}
    for angles in driver_motion_along(wing, times)[0]:
        chain = joint_chain(wing, angles)
        ends = [*chain.origin, chain.tip]
        named = dict(zip(BONES, ends, strict=True))
        if feathers:
            tips = feather_ends(wing, chain, angles)[1]
            named |= {f"feathers.{f.name}": t for f, t in zip(bird.feathers, tips, strict=True)}
        for name, point in named.items():
            clean.setdefault(name, []).append(point)
    random = np.random.default_rng(seed)
    shape = (len(times), 3)
    noisy = {k: np.array(v) + noise * random.standard_normal(shape) for k, v in clean.items()}
    return {"time": times, **noisy}


def angles_of(bird: Bird, *, beats: float = 5.0, noise: float = 0.01) -> dict[str, np.ndarray]:
    """Times (N,) and the joints' angles (N,), rad."""
    times = np.arange(int(beats / bird.gait.frequency * RATE)) / RATE
    angles = driver_motion_along(wing_arrays(bird), times)[0]
    noisy = angles + noise * np.random.default_rng(0).standard_normal(angles.shape)
    return {"time": times, **dict(zip(bird.joint_names, noisy.T, strict=True))}


def in_frame(points: dict[str, np.ndarray], matrix: np.ndarray) -> dict[str, np.ndarray]:
    """The points in axes that a matrix (3, 3) turns to body axes."""
    return {k: v if k == "time" else v @ matrix for k, v in points.items()}


def scaled(points: dict[str, np.ndarray], factor: float) -> dict[str, np.ndarray]:
    """All but the time times a factor."""
    return {k: v if k == "time" else factor * v for k, v in points.items()}


def without(points: dict[str, np.ndarray], *names: str) -> dict[str, np.ndarray]:
    """All but some."""
    return {k: v for k, v in points.items() if k not in names}


def written(points: dict[str, np.ndarray], path: Path) -> str:
    """The path of a CSV file of points and angles, cells empty where they are NaN."""
    columns: dict[str, np.ndarray] = {}
    for name, values in points.items():
        if values.ndim == 1:
            columns[name] = values
        else:
            columns |= {f"{name}_{axis}": values[:, i] for i, axis in enumerate("xyz")}
    rows = zip(*columns.values(), strict=True)
    lines = [",".join("" if np.isnan(x) else f"{x:.7g}" for x in row) for row in rows]
    path.write_text("\n".join([",".join(columns), *lines]) + "\n")
    return str(path)
