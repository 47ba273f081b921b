"""What a study says of stability, in sentences: each verdict with speed and climb of its flights.

At one point several flights may exist, stable ones and others; which is meant only its speed tells.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from birdmb.studies.sweeps.jumps import neighbours_apart

KINDS = ("stable", "unstable", "undecided")
_LISTED = 3


def verdict_lines(study: xr.Dataset) -> list[str]:
    """How many flights of a study's dataset are stable, and so on; their speeds and climb rates."""
    lines = []
    for kind in KINDS:
        shown = study["stability"].values == kind
        if not shown.any():
            continue
        speed, climb = (study[name].values[shown] for name in ("mean_speed", "mean_climb_rate"))
        backwards = np.count_nonzero(study["flight"].values[shown] == "backwards")
        lines.append(
            f"{shown.sum()} {kind}: {_span(speed, '.4g')} m/s, climbing {_span(climb, '+.2g')} m/s"
            f"{f', {backwards} of them backwards' if backwards else ''}"
        )
    return lines


def jump_lines(study: xr.Dataset) -> list[str]:
    """Which neighbours lie on different flights, with the speeds of both; none if there are none.

    Args:
        study: dataset of a study.
    """
    pairs = neighbours_apart(study)
    if not pairs:
        return []
    many = (
        f"{len(pairs)} pairs of neighbours lie" if len(pairs) > 1 else "1 pair of neighbours lies"
    )
    lines = [
        f"{many} on different flights: the step between does not explain how they differ; smaller "
        f"steps, or birdmb branch, tell more."
    ]
    lines += [
        f"  {_told(study, here)} and {_told(study, there)}" for here, there in pairs[:_LISTED]
    ]
    if len(pairs) > _LISTED:
        lines.append(f"  ... and {len(pairs) - _LISTED} more: sheet_jump of Study.to_xarray()")
    return lines


def short(value: object) -> str:
    """A value of a parameter, for a sentence."""
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _told(study: xr.Dataset, values: dict[str, Any]) -> str:
    at = study.sel(values)
    listed = ", ".join(f"{name} = {short(value)}" for name, value in values.items())
    return (
        f"{listed} ({at['stability'].item()}, {at['mean_speed'].item():.4g} m/s, climb "
        f"{at['mean_climb_rate'].item():+.2g} m/s)"
    )


def _span(values: np.ndarray, form: str) -> str:
    low, high = (format(end, form) for end in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"
