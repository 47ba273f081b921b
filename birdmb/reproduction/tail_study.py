"""The study of chapter 6: what of gait and tail was varied, and which flights were counted."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from birdmb.reproduction.quantities import FLAP_AMPLITUDE, ROLL_OFFSET, bird
from birdmb.studies.sweeps import Study
from birdmb.studies.tail import OPENING, VALID, tail_study

SWEEP_OFFSET = "shoulder.sweep.offset_deg"

RANGES = {
    SWEEP_OFFSET: np.arange(-15.0, -8.9, 0.5).tolist(),
    FLAP_AMPLITUDE: np.arange(45.0, 28.9, -0.5).tolist(),
    OPENING: np.arange(0.0, 45.1, 1.0).tolist(),
}
"""13 x 33 x 46 = 19 734 gaits and openings, degrees."""

TRIM = {ROLL_OFFSET: (-30.0, 30.0)}
"""Wider than the rule, which then tells flights beyond it from flights that do not exist."""

RULES = {"mean_pitch": math.radians(6.0), ROLL_OFFSET: 12.0}
"""Largest mean pitch (rad) and roll offset (degrees), either way, as limits of `within_limits`."""

VALID_RULES = RULES | VALID
"""The same, and the tail within the angle at which its lift is known."""


def chapter_6_study(store: Path, *, every: int = 1, workers: int | None = None) -> Study:
    """The study on the shipped bird with a tail, or every so many values of it.

    With 8 elements a wing where it is coarser than every fourth value.
    """
    coarse = {"wing__discretisation": 8} if every > 4 else {}
    return tail_study(
        bird("ibis_tail", **coarse), store, RANGES, trim=TRIM, every=every, workers=workers
    )
