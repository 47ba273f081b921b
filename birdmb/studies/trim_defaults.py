"""The values by which a flight is trimmed if the user names none."""

from __future__ import annotations

import math

from birdmb.errors import ArgumentError
from birdmb.topology import Bird
from birdmb.topology.roles import flap_joint, incidence_joint

_INCIDENCE = (-30.0, 30.0)  # degrees
_AMPLITUDE = (15.0, 70.0)  # degrees


def default_parameters(bird: Bird, count: int) -> dict[str, tuple[float, float]]:
    """Bounds (lowest, highest) by dotted name of the first one or two values to trim by.

    The offset of the joint that turns the chords, then the amplitude of the one that flaps; its
    gain, which swings as far, where it moves by more than one sine.

    Raises:
        ArgumentError: the bird has no such joint.
    """
    turning, flapping = incidence_joint(bird), flap_joint(bird)
    if turning is None:
        example = "wing.root.x=0:0.1" if bird.tail is None else "tail.incidence_deg=-15:5"
        raise _no_default(bird, "turns the chords about the span", example)
    parameters = {f"{turning.name}.offset_deg": _INCIDENCE}
    if count > 1:
        if flapping is None or flapping.driver.is_still:
            raise _no_default(bird, "flaps the wing", "gait.frequency=3:8")
        if flapping.driver.is_one_sine and flapping.amplitude:
            parameters[f"{flapping.name}.amplitude_deg"] = _AMPLITUDE
        else:
            low, high = flapping.driver.range
            swing = math.degrees(high - low) / 2.0 / flapping.gain
            parameters[f"{flapping.name}.gain"] = _AMPLITUDE[0] / swing, _AMPLITUDE[1] / swing
    return parameters


def _no_default(bird: Bird, purpose: str, example: str) -> ArgumentError:
    return ArgumentError(
        f"{bird.name}: it is not clear which one joint {purpose}; say what to trim by, with its "
        f"bounds, as --by {example} or "
        f'parameters={{"{example.partition("=")[0]}": (low, high)}}.'
    )
