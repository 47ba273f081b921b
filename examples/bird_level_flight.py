"""The ibis trimmed: flap amplitude for level flight, and with the wing's twist at a given speed.

Run `python examples/bird_level_flight.py [DIRECTORY]`; the figure goes to the directory.
"""

import sys
from functools import partial
from pathlib import Path

import birdmb
from birdmb import RigidModel
from birdmb.studies import assess_validity, trim_flight

IBIS = Path(__file__).parent.parent / "topologies" / "ibis.toml"
AMPLITUDE, TWIST = "shoulder.flap.amplitude_deg", "forearm.roll.offset_deg"


def main(directory: Path) -> None:
    ibis = birdmb.load_bird(IBIS)
    published = ibis.with_values({"wing.discretisation": "published"})
    slow = {AMPLITUDE: (30.0, 60.0), TWIST: (-10.0, 10.0)}
    cases = {
        "level": trim_flight(ibis, {AMPLITUDE: (30.0, 60.0)}),
        "level, as published": trim_flight(
            published, {AMPLITUDE: (30.0, 60.0)}, model=partial(RigidModel, steps_per_beat=150)
        ),
        "climbing 0.5 m/s": trim_flight(ibis, {AMPLITUDE: (30.0, 60.0)}, climb_rate=0.5),
        "level at 16 m/s": trim_flight(ibis, slow, speed=16.0),
    }
    print("                     amplitude (deg)  twist (deg)  speed (m/s)  climb  power (W)")
    for name, trim in cases.items():
        amplitude, twist = trim.bird.value(AMPLITUDE), trim.bird.value(TWIST)
        cycle = trim.cycle
        print(
            f"{name:20s} {amplitude:15.4f}  {twist:11.4f}  {cycle.mean_speed:11.4f}  "
            f"{round(cycle.mean_climb_rate, 6) + 0.0:5.2f}  {cycle.power:9.3f}"
        )
    validity = assess_validity(cases["level"].cycle)
    k, strouhal = validity.reduced_frequency, validity.strouhal_number
    print(f"level: reduced frequency {k:.3f}, Strouhal number {strouhal:.3f}")
    for warning in validity.warnings or ["within the model's validity"]:
        print(warning)
    directory.mkdir(parents=True, exist_ok=True)
    validity.plot().savefig(directory / "level_flight_angle_of_attack.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "results"))
