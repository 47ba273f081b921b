"""The order in which the gallery shows the examples: that in which a reader needs them."""

from __future__ import annotations

ORDER = (
    *("first_flight", "birds", "own_bird", "measured_gait", "bird_level_flight"),
    *("bird_flap_amplitude", "bird_perturbed_flight", "bird_wind_tunnel", "bird_gust"),
    *("bird_modes", "bird_lateral", "bird_memory", "bird_branch", "bird_sweep", "bird_tail"),
    *("moving_wing", "errors"),
)


def reading_order(name: str) -> tuple[int, str]:
    """The sorting key of an example's file: those that are not listed follow by name."""
    stem = name.removesuffix(".py")
    return (ORDER.index(stem) if stem in ORDER else len(ORDER)), stem
