"""Flights as moving pictures: a page to turn, two birds side by side, a mode that grows, a film.

`python examples/moving_pictures.py [DIR] [--coarse]` writes them into DIR (default results/) and
says what each shows (docs/animation.md).
"""

import argparse
from pathlib import Path

import birdmb

TOPOLOGIES = Path(__file__).parent.parent / "topologies"


def flown(
    name: str, model: type[birdmb.RigidModel] | type[birdmb.MultibodyModel], *, coarse: bool
) -> birdmb.FlightCycle:
    """The limit cycle of a bird."""
    bird = birdmb.load_bird(TOPOLOGIES / f"{name}.toml")
    if coarse:
        bird = bird.with_values({"wing.discretisation": 8})
    return birdmb.find_limit_cycle(model(bird))


def main(out: Path, *, coarse: bool) -> None:
    """Write the pages and the film."""
    out.mkdir(parents=True, exist_ok=True)
    frames = 8 if coarse else None
    rigid = flown("ibis", birdmb.RigidModel, coarse=coarse)
    compliant = flown("ibis_compliant_shoulder", birdmb.MultibodyModel, coarse=coarse)
    pictures = {
        "ibis.html": rigid.animate(frames=frames),
        "rigid_and_compliant.html": rigid.animate(compliant, colour="load", frames=frames),
        "growing_mode.html": rigid.animate(mode=0, view="path", frames=frames),
        "ibis.gif": rigid.animate(beats=1, frames=frames),
    }
    for name, moving in pictures.items():
        path, *_ = moving.save(out / name)
        shown = " beside ".join(scene.title for scene in moving.scenes)
        remarks = "".join(f"; {remark}" for remark in moving.scenes[0].remarks)
        print(f"{path.name}: {shown}{remarks}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path("results"))
    parser.add_argument("--coarse", action="store_true", help="few frames, coarse wings: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
