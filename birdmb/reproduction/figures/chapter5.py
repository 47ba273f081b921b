"""Figures and tables of chapter 5."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.reproduction.figures.drawing import Drawing

DRAWINGS: Mapping[str, Drawing] = {}
