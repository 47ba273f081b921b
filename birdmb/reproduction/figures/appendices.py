"""Figures and tables of the appendices."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.reproduction.figures.drawing import Drawing

DRAWINGS: Mapping[str, Drawing] = {}
