"""What is possible, but probably not meant, about a bird."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from birdmb.aerodynamics.prescribed import driven
from birdmb.cli.inertia import Spring, hinge_springs, spring_of
from birdmb.topology import Bird, Joint
from birdmb.wing.arrays import wing_arrays
from birdmb.wing.outline import wing_outline

_PHASES = 24
_NEAR_RESONANCE = 0.2


def warnings_on(bird: Bird) -> list[str]:
    """One sentence for each thing to beware of."""
    return [*_on_surroundings(bird), *_on_joints(bird), *_on_hinges(bird), *_on_line(bird)]


def _on_surroundings(bird: Bird) -> Iterator[str]:
    if bird.gravity == 0:
        yield "gravity is 0: nothing has to be carried."
    if bird.air.density == 0:
        yield "air.density is 0: nothing carries the bird."


def _on_joints(bird: Bird) -> Iterator[str]:
    if all(joint.amplitude == 0 for joint in bird.joints):
        yield "no joint has an amplitude: the bird glides, and its limit cycle is a steady flight."
    for joint in bird.joints:
        if joint.mode == "compliant":
            yield from _on_spring(bird, joint)
        elif joint.stiffness is not None or joint.damping is not None:
            yield f"{joint.name} is prescribed: its stiffness and damping are not used."


def _on_spring(bird: Bird, joint: Joint) -> Iterator[str]:
    spring = spring_of(bird, joint)
    if spring.inertia == 0:
        yield (
            f"{joint.name} is compliant, but moves no mass: its acceleration is not determined. "
            f"Give segments.{joint.segment} a mass or an inertia about the joint's axis."
        )
        return
    if spring.stiffness == 0:
        yield f"{joint.name} is compliant with stiffness 0: nothing pulls it towards its driver."
    yield from _on_resonance(bird, joint.name, spring)


def _on_hinges(bird: Bird) -> Iterator[str]:
    for name, spring in hinge_springs(bird).items():
        if spring.stiffness == 0:
            yield f"{name} has stiffness 0: only the air holds the feather."
        yield from _on_resonance(bird, name, spring)


def _on_resonance(bird: Bird, name: str, spring: Spring) -> Iterator[str]:
    beat = bird.gait.frequency
    if abs(spring.frequency / beat - 1) < _NEAR_RESONANCE:
        yield (
            f"{name} swings by itself at {spring.frequency:.3g} Hz, close to the wingbeat of "
            f"{beat:.3g} Hz: expect large excursions."
        )


def _on_line(bird: Bird) -> Iterator[str]:
    wing = wing_arrays(bird)
    numbers = bird.wing.resolved_discretisation
    lost = [
        phase
        for phase in np.arange(_PHASES) / _PHASES
        if not wing_outline(wing, driven(wing, phase * bird.period)[0], numbers).converged
    ]
    if lost:
        yield (
            f"no line orthogonal to its chords fits the wing as driven at t = {lost[0]:.3g} T "
            f"({len(lost)} of {_PHASES} phases): it is folded too far."
        )
