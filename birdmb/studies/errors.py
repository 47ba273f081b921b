"""What can go wrong in a study, as types."""

from __future__ import annotations

from collections.abc import Mapping

from birdmb.errors import OrbitError


class TrimError(OrbitError):
    """No values within the bounds trim the bird.

    Attributes:
        values: parameter values, by dotted name, that came closest; empty if no cycle was found.
        reached: what they reach, by target ("climb_rate", "speed"), in m/s.
    """

    def __init__(
        self, message: str, values: Mapping[str, float], reached: Mapping[str, float]
    ) -> None:
        """Keep what had been reached."""
        # All arguments go to the base class: that is what keeps the error picklable for executors.
        super().__init__(message, dict(values), dict(reached))
        self.values = dict(values)
        self.reached = dict(reached)

    def __str__(self) -> str:
        """Return the sentence alone."""
        return str(self.args[0])
