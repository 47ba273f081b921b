"""Chapter 8 of the thesis under several readings of its text: python examples/chapter8.py [DIR].

Flies the five published pairs of stiffness and damping of the shoulder's flap under each reading,
prints the tables of docs/chapter8.md and leaves them in DIR (default results/) as CSV.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb

TOPOLOGIES = Path(__file__).parent.parent / "topologies"
# k (N m/rad), C (N m s/rad): |Lambda| max, P_act (W), P_g (W)
PUBLISHED = {
    (20.0, 0.2): (1.37, 1.42, 7.41),
    (15.0, 0.2): (1.31, 0.25, 8.90),
    (10.0, 0.2): (1.22, -2.18, 11.92),
    (20.0, 0.1): (1.39, 0.33, 8.45),
    (20.0, 0.0): (1.45, -3.76, 12.55),
}
BONES = ("humerus", "forearm", "hand")


def with_inertia(bird: birdmb.Bird, moment: float) -> birdmb.Bird:
    """The bird with this moment of inertia (kg m2) about every axis of every segment."""
    return bird.with_values({f"segments.{bone}.inertia": [moment] * 3 for bone in BONES})


def flap_first(bird: birdmb.Bird) -> birdmb.Bird:
    """The bird whose shoulder flaps before it pitches."""
    pitch, flap, *others = bird.model_dump()["joints"]
    return bird.model_validate({**bird.model_dump(), "joints": [flap, pitch, *others]})


def readings() -> dict[str, birdmb.Bird]:
    """The birds that the text may mean."""
    slender = birdmb.load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml")
    isotropic = birdmb.load_bird(TOPOLOGIES / "ibis_thesis_ch8.toml")
    hinged = {"shoulder.flap.amplitude_deg": 43.47}
    return {
        "slender bones": slender,
        "point masses": with_inertia(slender, 0.0),
        "0.0003 kg m2": with_inertia(slender, 0.0003),
        "0.002 kg m2": isotropic,
        "0.0033 kg m2": with_inertia(slender, 0.0033),
        "0.01 kg m2, as printed": with_inertia(slender, 0.01),
        "0.002, published discretisation": isotropic.with_values(
            {"wing.discretisation": "published"}
        ),
        "0.002, flap before pitch": flap_first(isotropic),
        "0.002, flap amplitude 43.47 deg": isotropic.with_values(hinged),
        "0.002, sweep offset -19.5 deg": isotropic.with_values(
            {"shoulder.sweep.offset_deg": -19.5}
        ),
    }


def flown(bird: birdmb.Bird, guess: np.ndarray | None) -> birdmb.FlightCycle | str:
    """The limit cycle, or why there is none."""
    try:
        return birdmb.find_limit_cycle(birdmb.MultibodyModel(bird), guess, max_iterations=25)
    except birdmb.BirdmbError as error:
        return type(error).__name__


def main(directory: Path) -> None:
    """Print and keep the tables."""
    console, rows = Console(width=120), []
    for name, bird in readings().items():
        table = Table(
            "k", "C", "|Λ|max", "P_act, W", "P_g, W", "speed, m/s", "flap, deg", title=name
        )
        table.title_justify = "left"
        gaps, guess = [], None
        for (k, c), published in PUBLISHED.items():
            cycle = flown(bird.with_joint("shoulder.flap", stiffness=k, damping=c), guess)
            if isinstance(cycle, str):
                table.add_row(f"{k:g}", f"{c:g}", f"{cycle} ({published[0]:.2f})")
                rows.append([name, k, c, cycle])
                continue
            guess = cycle.x0
            found = (abs(cycle.multipliers[0]), cycle.power, cycle.potential_power)
            flap = np.degrees(cycle.beat.states[:, 4])
            gaps.append(np.subtract(found, published))
            cells = [f"{f:.2f} ({p:.2f})" for f, p in zip(found, published, strict=True)]
            table.add_row(
                f"{k:g}",
                f"{c:g}",
                *cells,
                f"{cycle.mean_speed:.1f}",
                f"{flap.min():.0f}..{flap.max():.0f}",
            )
            rows.append([name, k, c, *found, cycle.mean_speed, flap.min(), flap.max()])
        console.print(table)
        if gaps:
            rms = np.sqrt(np.mean(np.square(gaps), axis=0))
            console.print(
                f"  rms gap to the published values in brackets, {len(gaps)} of 5 points: "
                f"|Λ| {rms[0]:.3f}, P_act {rms[1]:.1f} W, P_g {rms[2]:.1f} W\n"
            )
    directory.mkdir(parents=True, exist_ok=True)
    with (directory / "chapter8.csv").open("w", newline="") as file:
        csv.writer(file).writerows(rows)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
