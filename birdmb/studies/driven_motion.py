"""What the drivers of a bird's joints do over a beat, and warnings of what no joint does."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import driver_motion_along
from birdmb.topology import SIDES, Bird
from birdmb.wing.arrays import WingArrays, wing_arrays
from birdmb.wing.edges import COMPLEX_STEP, wing_edges

_INSTANTS = 240  # harmonics up to the hundredth show
# From folded flat to straight and on to folded flat; a starling's humerus flaps by some 110 degrees
# (K. P. Dial, G. E. Goslow & F. A. Jenkins, J. Morphol. 207, 1991).
LARGEST_EXCURSION = np.pi  # rad
# That of a stroke in a sixth of the beat, where a sine takes half of it.
LARGEST_ROUGHNESS = 10.0
# A third of the speed of sound, beyond which air is no more incompressible.
LARGEST_TIP_SPEED = 100.0  # m/s


def motion_warnings(bird: Bird) -> Iterator[str]:
    """A sentence for each joint that is driven as none can be, and for tips that are too fast."""
    fastest = 0.0
    for side, wing, times in _wings(bird):
        angles, rates, accelerations = driver_motion_along(wing, times)
        for i, joint in enumerate(bird.joints):
            name = f"{joint.name}.{side}" if side else joint.name
            yield from _of_joint(bird, name, angles[:, i], accelerations[:, i])
        _, velocities = _tip(wing, angles, rates)
        fastest = max(fastest, float(np.linalg.norm(velocities, axis=1).max()))
    if fastest > LARGEST_TIP_SPEED:
        yield (
            f"the tips of the wings reach {fastest:.3g} m/s by flapping, beyond "
            f"{LARGEST_TIP_SPEED:g} m/s, where air gives way; the model's does not. Check "
            f"gait.frequency and the drivers."
        )


def is_still(bird: Bird) -> bool:
    """Whether no driver moves."""
    return all(joint.on(side).driver.is_still for joint in bird.joints for side in SIDES)


def tip_height(bird: Bird) -> float:
    """Distance (m) along the body's z axis between the highest and lowest place of a wing's tip.

    Of the wing that moves further.
    """
    heights = []
    for _, wing, times in _wings(bird):
        angles, rates, _ = driver_motion_along(wing, times)
        places, _ = _tip(wing, angles, rates)
        heights.append(float(np.ptp(places[:, 2])))
    return max(heights)


def _of_joint(
    bird: Bird, name: str, angles: FloatArray, accelerations: FloatArray
) -> Iterator[str]:
    excursion, furthest = np.ptp(angles), np.abs(angles).max()
    if excursion > LARGEST_EXCURSION:
        yield (
            f"{name} turns through {np.degrees(excursion):.4g} degrees in a beat; no joint of a "
            f"bird does more than 180. Is its driver in degrees, under keys ending in _deg?"
        )
    elif furthest > LARGEST_EXCURSION:
        yield (
            f"{name} gets to {np.degrees(furthest):.4g} degrees, more than half a turn. Is its "
            f"offset in degrees, as offset_deg?"
        )
    of_sine = 0.5 * excursion * (2.0 * np.pi * bird.gait.frequency) ** 2
    roughness = np.abs(accelerations).max() / of_sine if of_sine > 0.0 else 0.0
    if roughness > LARGEST_ROUGHNESS:
        yield (
            f"{name} is accelerated {roughness:.3g} times as much as by a sine over the same "
            f"angles, which joints hardly are. Fewer harmonics of its driver may leave out noise."
        )


def _wings(bird: Bird) -> Iterator[tuple[str, WingArrays, FloatArray]]:
    """Each wing that is different, with its side if both are, and the instants of a beat, s."""
    times = np.arange(_INSTANTS) / _INSTANTS * bird.period
    if bird.is_symmetric:
        yield "", wing_arrays(bird), times
        return
    for side in SIDES:
        yield side, wing_arrays(bird.side(side)), times


def _tip(wing: WingArrays, angles: FloatArray, rates: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Place (P, 3) m of the lifting line's end from the shoulder, and its velocity (P, 3) m/s."""
    ends = []
    for at in angles + 1j * COMPLEX_STEP * rates:
        leading, trailing = wing_edges(wing, at)
        ends.append(0.75 * leading[-1] + 0.25 * trailing[-1])
    tips = np.array(ends)
    return tips.real, tips.imag / COMPLEX_STEP
