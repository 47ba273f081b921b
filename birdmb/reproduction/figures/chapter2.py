"""Table of chapter 2: the ibis beside the allometric laws of birds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from birdmb.reproduction.figures.drawing import Drawing, keep_table
from birdmb.reproduction.quantities import bird
from birdmb.studies.scaling import (
    allometric_area,
    allometric_frequency,
    allometric_span,
)
from birdmb.wing.outline import span_and_area


def allometric_laws(out: Path, _coarse: bool) -> None:
    """Tabulate the laws of span, area and frequency, what follows from them, and the ibis."""
    ibis = bird("ibis")
    mass, gravity = ibis.body.mass, ibis.gravity
    span, area = span_and_area(ibis)
    by_span, by_area = allometric_span(mass), allometric_area(mass)
    rows = (
        ("wing span (m)", "1.17 m^0.39", by_span, span),
        ("wing area (m2)", "0.16 m^0.72", by_area, area),
        ("wingbeat frequency (Hz)", "3.87 m^-0.33", allometric_frequency(mass), 4.0),
        ("aspect ratio", "8.56 m^0.06", by_span**2 / by_area, span**2 / area),
        ("wing loading (N/m2)", "61.3 m^0.28", mass * gravity / by_area, mass * gravity / area),
    )
    columns = ("quantity", "law", f"law at {mass:.3g} kg", "the ibis")
    keep_table(out, "table 2.1", columns, rows)


DRAWINGS: Mapping[str, Drawing] = {
    "table 2.1": Drawing("the ibis beside allometric laws", allometric_laws),
}
