"""What `birdmb new --from` makes: a topology file of a bird that was weighed and measured."""

from __future__ import annotations

from pathlib import Path

from birdmb.morphology import bird_from_morphology
from birdmb.topology import load_bird


def save_measured_bird(file: Path, morphology: Path, like: str | None) -> Path:
    """Write the bird of a morphology file, under the name of the topology file; return its path.

    `like` is a bird whose gait and joints are taken where the morphology file has none.
    """
    bird = bird_from_morphology(morphology, None if like is None else load_bird(like))
    about = [f"Masses, inertias and the shoulder's place follow from {morphology.name}."]
    if like is not None:
        about.append(f"Gait and joints that it does not give are those of {like}.")
    return bird.with_values({"name": file.stem}).save(file, about=about)
