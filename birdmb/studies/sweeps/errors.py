"""What can go wrong with a sweep as a whole; what goes wrong at a point is its outcome."""

from __future__ import annotations

from birdmb.errors import BirdmbError


class SweepError(BirdmbError):
    """The sweep cannot be carried out as asked; what its store holds is kept."""
