"""Every bird of the package, flown by both models: the table of docs/birds.md.

python examples/studies/all_birds.py [--coarse]
"""

import sys

import numpy as np

import birdmb

HEAD = f"{'bird':24}{'model':11}{'m/s':>7}{'climb':>8}{'|Lambda|max':>13}  {'verdict':10}{'W':>8}"
HEAD += f"{'warnings':>10}"


Model = type[birdmb.RigidModel] | type[birdmb.MultibodyModel]


def row(name: str, model: Model, *, coarse: bool) -> str:
    """One line of the table: what the bird's limit cycle is."""
    bird = birdmb.load_bird(name)
    if coarse:
        bird = bird.with_values({"wing.discretisation": 4})
    kind = model.__name__.removesuffix("Model").lower()
    try:
        cycle = birdmb.find_limit_cycle(model(bird))
    except birdmb.BirdmbError as error:
        return f"{name:24}{kind:11}{error}"
    largest = np.abs(cycle.multipliers).max()
    warnings = len(birdmb.assess_validity(cycle).warnings)
    return (
        f"{name:24}{kind:11}{cycle.mean_speed:7.2f}{cycle.mean_climb_rate:+8.2f}{largest:13.4f}  "
        f"{cycle.stability:10}{cycle.power:8.3f}{warnings:10}"
    )


if __name__ == "__main__":
    quick = "--coarse" in sys.argv
    print(HEAD)
    for name in birdmb.bird_names():
        for model in (birdmb.RigidModel,) if quick else (birdmb.RigidModel, birdmb.MultibodyModel):
            print(row(name, model, coarse=quick), flush=True)
