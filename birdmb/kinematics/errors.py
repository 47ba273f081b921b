"""What is wrong with a measured motion."""

from __future__ import annotations

from birdmb.errors import BirdmbError


class KinematicsError(BirdmbError):
    """A measured motion cannot be read, or tells no gait; the text names file and column."""
