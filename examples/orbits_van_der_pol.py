"""
Small multipliers, and a disturbance along a mode
=================================================

The oscillator of Van der Pol: a multiplier that the product of the segments' Jacobians shows no
better than to round-off of the largest, and the response to a disturbance along its mode.
"""

import matplotlib.pyplot as plt

from birdmb import OdeModel, find_limit_cycle, floquet, mode_disturbance, perturbed_response
from birdmb.orbits import product_multipliers


def van_der_pol(mu: float) -> OdeModel:
    """x'' - mu (1 - x**2) x' + x = 0."""
    return OdeModel(
        lambda _t, s: [s[1], mu * (1 - s[0] ** 2) * s[1] - s[0]], ("x", "v"), guess=[2.0, 0.0]
    )


print(" mu  period           multiplier       error      by the product   Liouville's gap")
for mu, period_guess in ((0.3, 6.3), (1.0, 6.6), (3.0, 8.8)):
    cycle = find_limit_cycle(van_der_pol(mu), period_guess=period_guess, segments=20)
    plain = floquet(
        cycle.model, cycle.points, cycle.period, segments=20, solver=product_multipliers
    )
    print(
        f"{mu:3.1f}  {cycle.period:.12f}  {cycle.multipliers[1].real:.8e}  "
        f"{cycle.multiplier_errors[1]:.1e}  {plain.multipliers[1].real: .8e}  "
        f"{cycle.liouville_defect():.1e}"
    )

# %%

cycle = find_limit_cycle(van_der_pol(0.3), period_guess=6.3)
cycle.plot()

# %%

disturbance = mode_disturbance(cycle, 1, 0.3)
response = perturbed_response(cycle, disturbance, periods=4)
response.plot()

# %%

plt.show()
