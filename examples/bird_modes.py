"""
Which states a mode is made of
==============================

The Floquet modes of the ibis with a compliant shoulder: what grows, what decays, and which states
take part.
"""

import matplotlib.pyplot as plt
import numpy as np

import birdmb

bird = birdmb.load_bird("ibis_compliant_shoulder").with_values({"wing.discretisation": 8})


def print_modes(orbit: birdmb.FloquetResult) -> None:
    """Multipliers with their errors, doubling times and participations."""
    print("multiplier               error  doubles/halves (s)   " + "  ".join(orbit.state_names))
    for i, value in enumerate(orbit.multipliers):
        shares = "  ".join(
            f"{share:{len(name)}.2f}"
            for name, share in zip(orbit.state_names, orbit.participation[:, i], strict=True)
        )
        print(
            f"{value.real:+.3e} {value.imag:+.3e}i  {orbit.multiplier_errors[i]:.0e}  "
            f"{orbit.doubling_times[i]:18.4f}   {shares}"
        )


# %%
# An orbit that is known needs no search: its state at one time is enough.

rigid = birdmb.RigidModel(bird)
x0 = birdmb.find_limit_cycle(rigid).x0
print_modes(birdmb.floquet(rigid, x0, segments=5))

# %%
# The compliant joint adds its angle and its rate, with multipliers that die out within a beat.

flight = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
print_modes(flight)

# %%

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
bottom = np.zeros(len(flight.multipliers))
for name, share in zip(flight.state_names, flight.participation, strict=True):
    axes.bar(range(len(share)), share, bottom=bottom, label=name)
    bottom += share
names = [
    f"{value.real:.3g}{value.imag:+.2g}i" if value.imag else f"{value.real:.3g}"
    for value in flight.multipliers
]
axes.set_xticks(range(len(names)), names)
axes.set(xlabel="Floquet multiplier", ylabel="participation")
axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
plt.show()
