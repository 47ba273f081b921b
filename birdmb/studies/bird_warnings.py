"""Warnings of what is possible, but probably not meant, about a bird; each is a sentence."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from contextlib import suppress

import numpy as np

from birdmb._typing import FloatArray
from birdmb.aerodynamics.prescribed import driver_motion
from birdmb.errors import StateError
from birdmb.models.natural_oscillation import (
    NaturalOscillation,
    hinge_oscillations,
    oscillations_of,
)
from birdmb.models.rigid import RigidModel
from birdmb.models.wing_model import STEPS_PER_BEAT
from birdmb.studies.driven_motion import is_still, motion_warnings
from birdmb.studies.flight_regime import flight_regime, regime_warnings
from birdmb.studies.refinement import LARGEST_CHANGE, LoadChange
from birdmb.topology import SIDES, Bird, Joint
from birdmb.wing.outline import wing_outline

_PHASES = 24
_ROUND_OFF = 1e-9  # m
# Of a harmonic: on fewer steps the error of a beat is many times that of a sine's, and collocation
# took so many nodes where the harmonic had a tenth of the beat's rate.
_STEPS_PER_PERIOD, _NODES_PER_PERIOD = 10, 8
_SIGNIFICANT = 0.05  # rate of a harmonic, of that of the largest


def bird_warnings(bird: Bird) -> list[str]:
    """One sentence for each thing to beware of."""
    each = (
        _on_surroundings(bird),
        _on_joints(bird),
        motion_warnings(bird),
        _on_hinges(bird),
        _on_wing(bird),
        _on_regime(bird),
        _on_planform(bird),
    )
    # Both wings may give the same cause.
    return list(dict.fromkeys(itertools.chain.from_iterable(each)))


def _on_surroundings(bird: Bird) -> Iterator[str]:
    if bird.gravity == 0:
        yield "gravity is 0: nothing has to be carried."
    if bird.air.density == 0:
        yield "air.density is 0: nothing carries the bird."


def _on_joints(bird: Bird) -> Iterator[str]:
    if is_still(bird):
        yield "no joint's driver moves: the bird glides, and its limit cycle is a steady flight."
    for joint in bird.joints:
        yield from _on_roughness(joint)
        if joint.mode == "compliant":
            for name, free in oscillations_of(bird, joint).items():
                yield from _on_compliant(bird, joint, name, free)
        elif joint.stiffness is not None or joint.damping is not None:
            yield f"{joint.name} is prescribed: its stiffness and damping are not used."


def _on_roughness(joint: Joint) -> Iterator[str]:
    orders = [joint.on(side).driver.highest_harmonic(_SIGNIFICANT) for side in SIDES]
    if (order := max(orders)) * _STEPS_PER_PERIOD > STEPS_PER_BEAT:
        steps, nodes = _STEPS_PER_PERIOD * order, _NODES_PER_PERIOD * order
        yield (
            f"the driver of {joint.name} moves in harmonics up to order {order} of the beat, rough "
            f"for the usual {STEPS_PER_BEAT} time steps a beat: let models take "
            f"steps_per_beat={steps} or more, expect collocation to need about {nodes} nodes, or "
            "keep fewer harmonics."
        )


def _on_compliant(bird: Bird, joint: Joint, name: str, free: NaturalOscillation) -> Iterator[str]:
    if free.inertia == 0:
        yield (
            f"{name} is compliant, but moves no mass: its acceleration is not determined. "
            f"Give segments.{joint.segment} a mass or an inertia about the joint's axis."
        )
        return
    if free.stiffness == 0:
        yield f"{name} is compliant with stiffness 0: nothing pulls it towards its driver."
    yield from _on_resonance(bird, name, free)


def _on_hinges(bird: Bird) -> Iterator[str]:
    for name, free in hinge_oscillations(bird).items():
        if free.stiffness == 0:
            yield f"{name} has stiffness 0: only the air holds the feather."
        yield from _on_resonance(bird, name, free)


def _on_resonance(bird: Bird, name: str, free: NaturalOscillation) -> Iterator[str]:
    beat = bird.gait.frequency
    if free.is_near(beat):
        yield (
            f"{name} swings by itself at {free.frequency:.3g} Hz, close to the wingbeat of "
            f"{beat:.3g} Hz: expect large excursions."
        )


def _on_wing(bird: Bird) -> Iterator[str]:
    """On the wing as driven: what the models refuse, else what they fly with."""
    phases = np.arange(_PHASES) / _PHASES
    for side in SIDES[:1] if bird.is_symmetric else SIDES:
        model = RigidModel(bird.side(side))
        try:
            model.wing_at(phases * bird.period)
        except StateError as error:
            yield f"no flight with the wings as driven. {error}"
            return
        yield from _on_overlap(bird, model, phases)


def _on_planform(bird: Bird) -> Iterator[str]:
    """On values that a wing of sections has no use for."""
    given = [key for key in ("half_thickness", "propatagium") if getattr(bird.wing, key)]
    if bird.sections and given:
        names = " and ".join(f"wing.{key}" for key in given)
        yield f"{names}: not used, for sections span the wing. Leave it out."


def _on_regime(bird: Bird) -> Iterator[str]:
    with suppress(StateError):  # of which `_on_wing` tells
        yield from regime_warnings(flight_regime(bird), with_memory=bird.air.wake == "unsteady")


def _on_overlap(bird: Bird, model: RigidModel, phases: FloatArray) -> Iterator[str]:
    numbers = bird.wing.resolved_discretisation
    chords = [f"feather {f.name}" for f in bird.feathers] + [
        f"section {s.name}" for s in bird.sections
    ]
    ends = ("root", "tip") if bird.feathers else ("leading end", "trailing end")
    names = [f"the {end} of {chord}" for end in ends for chord in chords]
    names += ["the shoulder", *(f"the end of the {bone}" for bone in bird.segments.names)]
    places = []
    for phase in phases:
        outline = wing_outline(
            model.wing, driver_motion(model.wing, phase * bird.period)[0], numbers
        )
        places.append([*outline.feathers[:, :, 1].T.ravel(), *outline.bones[:, 1]])
    across = np.array(places)
    k, i = np.unravel_index(np.argmin(across), across.shape)
    if across[k, i] < -_ROUND_OFF:
        affected = np.sum(across.min(axis=1) < -_ROUND_OFF)
        yield (
            f"{names[i]} reaches {-1e3 * across[k, i]:.3g} mm across the plane of symmetry at "
            f"t = {phases[k]:.3g} T, into the other wing ({affected} of {_PHASES} phases). The "
            f"lifting line does not, so that there are loads; they count the area of both wings "
            f"there. A larger wing.root.y keeps them apart."
        )


def load_warnings(change: LoadChange) -> list[str]:
    """A sentence if the loads change much on another number of elements."""
    if not change.largest > LARGEST_CHANGE:
        return []
    return [
        f"the loads change by {change.largest:.1%} on {change.elements} elements a wing: they are "
        f"no more accurate than that. Set wing.discretisation to more elements, or, if they do not "
        f"settle, look at the shape of the wing."
    ]
