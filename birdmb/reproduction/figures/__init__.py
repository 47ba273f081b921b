"""The numbered figures and tables of the thesis, by their names: "figure 5.12", "table 6.2"."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.reproduction.figures import (
    appendices,
    chapter2,
    chapter3,
    chapter4,
    chapter5_cycle,
    chapter5_studies,
    chapter6,
    chapter7,
    chapter8,
)
from birdmb.reproduction.figures.drawing import Drawing

DRAWINGS: Mapping[str, Drawing] = {
    **chapter2.DRAWINGS,
    **chapter3.DRAWINGS,
    **chapter4.DRAWINGS,
    **chapter5_cycle.DRAWINGS,
    **chapter5_studies.DRAWINGS,
    **chapter6.DRAWINGS,
    **chapter7.DRAWINGS,
    **chapter8.DRAWINGS,
    **appendices.DRAWINGS,
}
