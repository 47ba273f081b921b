"""A flapping wing against a measurement: `python benchmarks/flapping_robot.py`.

Lift of the rigid wings of D. Yeo, E. M. Atkins and W. Shyy's robot in a wind tunnel (AIAA 2011),
from nine pressure traces, against the quasi-steady loads of `topologies/flapping_robot.toml` with
its shoulder held to the measured flap angle and its body at rest in a stream of 2.9 m/s.
"""

import numpy as np
from rich.console import Console
from rich.table import Table

import birdmb
from birdmb.studies.flight_regime import wake_deficiency

STREAM = 2.9  # m/s
REDUCED_FREQUENCY = 0.257  # as the paper has it
# Lift of both wings, mN, upwards, over a beat in steps of T/100 from t = 0; digitised.
MEASURED = (
    -75.8, -77.8, -79.2, -79.6, -79.4, -78.2, -76.8, -74.6, -71.8, -68.2,
    -64.9, -62.2, -58.0, -53.5, -49.5, -45.4, -39.7, -33.1, -26.3, -18.8,
    -11.9, -7.7, -1.3, 7.4, 14.6, 20.4, 28.1, 35.8, 43.1, 50.5,
    58.0, 64.4, 68.3, 72.9, 78.9, 85.2, 90.6, 95.7, 101.1, 106.1,
    109.4, 112.3, 115.1, 117.5, 119.6, 120.7, 120.6, 119.2, 117.4, 115.3,
    112.8, 110.6, 109.1, 107.2, 105.2, 103.5, 101.0, 97.8, 95.0, 92.1,
    88.6, 85.5, 82.7, 79.4, 76.2, 72.8, 69.4, 65.8, 62.2, 58.9,
    56.1, 51.5, 46.2, 43.0, 39.0, 35.1, 27.8, 19.7, 13.5, 7.9,
    3.3, -1.6, -4.9, -9.0, -13.2, -17.3, -22.2, -26.9, -31.3, -35.7,
    -39.6, -43.7, -48.2, -53.2, -57.9, -62.1, -65.8, -68.3, -70.2, -72.9,
)  # fmt: skip
OTHERS = {"the paper": 29.1, "a vortex lattice": 27.2}  # mean absolute errors, mN
PHASES = np.arange(len(MEASURED)) / len(MEASURED)


def computed_lift(elements: int) -> np.ndarray:
    """Lift (100,) mN over the beat, on so many elements a wing."""
    robot = birdmb.load_bird("flapping_robot").with_values({"wing.discretisation": elements})
    model = birdmb.RigidModel(robot.with_joint("shoulder.flap", mode="prescribed"))
    wings = [model.loads(phase * model.period, [STREAM, 0.0, 0.0, 0.0]) for phase in PHASES]
    return np.array([-1e3 * (w.right.force + w.left.force)[:, 2].sum() for w in wings])


def first_harmonic(lift: np.ndarray) -> tuple[float, float]:
    """Amplitude (mN) of a lift over the beat and the phase of its maximum, a part of the beat."""
    part = 2.0 * np.mean(lift * np.exp(-2j * np.pi * PHASES))
    return abs(part), float(-np.angle(part) / (2.0 * np.pi)) % 1.0


def row(name: str, lift: np.ndarray, measured: np.ndarray) -> list[str]:
    """What is printed of a lift over the beat."""
    amplitude, peak = first_harmonic(lift)
    error = np.abs(lift - measured).mean()
    return [name, *(f"{x:.1f}" for x in (lift.mean(), lift.max(), lift.min(), amplitude)),
            f"{peak:.3f}", f"{error:.1f}" if error else ""]  # fmt: skip


def main() -> None:
    """Print mean, extremes, first harmonic and mean absolute error."""
    measured = np.array(MEASURED)
    table = Table(title="Lift of both wings over a beat, mN; error: mean absolute")
    columns = ("", "mean", "max", "min", "1st harm.", "peak, t/T", "error")
    for column in columns:
        table.add_column(column, justify="right" if column else "left")
    table.add_row(*row("measured", measured, measured))
    for elements in (16, 32, 64):
        table.add_row(*row(f"here, {elements} elements", computed_lift(elements), measured))
    for name, error in OTHERS.items():
        table.add_row(name, *[""] * 5, f"{error:.1f}")
    console = Console()
    console.print(table)
    left = abs(wake_deficiency(REDUCED_FREQUENCY))
    console.print(f"Theodorsen's function leaves {left:.2f} of the circulatory lift at this k.")


if __name__ == "__main__":
    main()
