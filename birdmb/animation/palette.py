"""Colours of the parts of a scene, alike on pages and in films."""

from __future__ import annotations

VALUES = "RdBu_r"  # diverging, of both plotly and matplotlib
BONE, EDGE, FEATHER = "#20242b", "#3a4250", "#5d6776"
BODY, TAIL = "#7a6a58", "#a08d76"
FORCE, TRACK = "#e08a00", "#2f5d8a"
LAND, GRID = "#dfe7da", "#bccab3"
