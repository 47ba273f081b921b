"""Van der Pol's oscillator: multipliers down to 7e-16, which the monodromy matrix cannot show.

Run `python examples/orbits_van_der_pol.py [DIRECTORY] [--coarse]`; the figures go to the directory.
"""

import argparse
from pathlib import Path

from birdmb.orbits import (
    OdeModel,
    find_limit_cycle,
    floquet,
    mode_disturbance,
    perturbed_response,
    product_multipliers,
)


def van_der_pol(mu: float) -> OdeModel:
    """x'' - mu (1 - x**2) x' + x = 0."""
    return OdeModel(
        lambda _t, s: [s[1], mu * (1 - s[0] ** 2) * s[1] - s[0]], ("x", "v"), guess=[2.0, 0.0]
    )


def main(directory: Path, *, coarse: bool) -> None:
    directory.mkdir(parents=True, exist_ok=True)
    print(" mu  period           multiplier       error      by the product   Liouville's gap")
    cases = ((0.3, 6.3), (1.0, 6.6), (3.0, 8.8), (5.0, 11.6))
    for mu, period_guess in cases[:2] if coarse else cases:
        cycle = find_limit_cycle(van_der_pol(mu), period_guess=period_guess, segments=20)
        plain = floquet(
            cycle.model, cycle.points, cycle.period, segments=20, solver=product_multipliers
        )
        print(
            f"{mu:3.1f}  {cycle.period:.12f}  {cycle.multipliers[1].real:.8e}  "
            f"{cycle.multiplier_errors[1]:.1e}  {plain.multipliers[1].real: .8e}  "
            f"{cycle.liouville_defect():.1e}"
        )
    cycle = find_limit_cycle(van_der_pol(0.3), period_guess=6.3)
    cycle.plot().savefig(directory / "van_der_pol_cycle.png")
    disturbance = mode_disturbance(cycle, 1, 0.3)
    response = perturbed_response(cycle, disturbance, periods=4)
    response.plot().savefig(directory / "van_der_pol_response.png")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("directory", nargs="?", type=Path, default=Path())
    parser.add_argument("--coarse", action="store_true", help="weak damping only: quick")
    options = parser.parse_args()
    main(options.directory, coarse=options.coarse)
