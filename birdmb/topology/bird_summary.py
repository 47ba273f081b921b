"""What a bird shows of itself in a console and a notebook."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from birdmb.summary import Fact

if TYPE_CHECKING:
    from birdmb.topology.bird import Bird


def facts_of_bird(bird: Bird) -> Iterator[Fact]:
    """Mass, wingbeat, and the parts that a bird has."""
    yield Fact("mass", f"{bird.total_mass:.4g}", "kg")
    yield Fact("wingbeat", f"{bird.gait.frequency:.4g}", "Hz")
    yield Fact("segments", ", ".join(bird.segments.names))
    yield Fact("joints", str(len(bird.joints)))
    for joint in bird.compliant_joints:
        yield Fact("compliant", joint.name)
    if bird.feathers:
        yield Fact("feathers", str(len(bird.feathers)))
    if bird.hinged_feathers:
        yield Fact("on hinges", str(len(bird.hinged_feathers)))
    if bird.sections:
        yield Fact("sections", str(len(bird.sections)))
    if bird.attachments:
        yield Fact("attachments", str(len(bird.attachments)))
    yield Fact("tail", "none" if bird.tail is None else "yes")
    yield Fact("air", bird.air.wake)
