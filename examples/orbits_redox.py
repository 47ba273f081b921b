"""
A stiff oscillator
==================

The circadian redox oscillator of del Olmo, Kramer & Herzel (2019), Int. J. Mol. Sci. 20, 2368, with
rates from 0.1 to 1000 per h. Time is in h.
"""

import matplotlib.pyplot as plt

import birdmb


def redox(p: float = 1.0) -> birdmb.OdeModel:
    """Peroxides in mitochondria D1 and cytosol D2, sulfiredoxin R, active peroxiredoxin A."""
    a, b, d, e, q = 1000.0, 2.0, 0.2, 0.1, 0.1
    return birdmb.OdeModel(
        lambda _t, s: [
            p - a * s[3] * s[0] - d * s[0],
            d * s[0] - e * s[1],
            e * s[1] - q * s[2],
            b * (1 - s[3]) * s[2] - a * s[3] * s[0],
        ],
        ("D1", "D2", "R", "A"),
        jacobian=lambda _t, s: [
            [-a * s[3] - d, 0, 0, -a * s[0]],
            [d, -e, 0, 0],
            [0, e, -q, 0],
            [-a * s[3], 0, b * (1 - s[3]), -b * s[2] - a * s[0]],
        ],
        guess=[0.5, 0.5, 0.6, 0.2],
        integrator="LSODA",
        rtol=1e-9,
        atol=1e-12,
    )


cycle: birdmb.LimitCycle = birdmb.find_limit_cycle(
    redox(), period_guess=23.0, segments=4, damping="levenberg-marquardt", tolerance=1e-7
)
print(f"period {cycle.period:.6f} h, {cycle.stability}, {len(cycle.iterations)} iterations")
for i, value in enumerate(cycle.multipliers):
    leader = cycle.state_names[cycle.participation[:, i].argmax()]
    print(
        f"  multiplier {value.real:.6e} ± {cycle.multiplier_errors[i]:.1e}, "
        f"halves or doubles in {cycle.doubling_times[i]:.3g} h, mostly {leader}"
    )

# %%

cycle.plot()

# %%

plt.show()
