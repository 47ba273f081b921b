"""
Level flight
============

The ibis trimmed: the flap amplitude with which it flies level, and the amplitude and twist of the
wing with which it does so at a given speed. Then how far that flight is from the limits of
quasi-steady air.
"""

import matplotlib.pyplot as plt

import birdmb

AMPLITUDE, TWIST = "shoulder.flap.amplitude_deg", "forearm.roll.offset_deg"

ibis = birdmb.load_bird("ibis")
cases: dict[str, birdmb.Trim] = {
    "level": birdmb.trim_flight(ibis, {AMPLITUDE: (30.0, 60.0)}),
    "climbing 0.5 m/s": birdmb.trim_flight(ibis, {AMPLITUDE: (30.0, 60.0)}, climb_rate=0.5),
    "level at 16 m/s": birdmb.trim_flight(
        ibis, {AMPLITUDE: (30.0, 60.0), TWIST: (-10.0, 10.0)}, speed=16.0
    ),
}
print("                     amplitude (deg)  twist (deg)  speed (m/s)  climb  power (W)")
for name, trim in cases.items():
    cycle = trim.cycle
    print(
        f"{name:20s} {trim.bird.value(AMPLITUDE):15.4f}  {trim.bird.value(TWIST):11.4f}  "
        f"{cycle.mean_speed:11.4f}  {round(cycle.mean_climb_rate, 6) + 0.0:5.2f}  "
        f"{cycle.power:9.3f}"
    )

# %%
# Where there is no such flight, the error says what was tried.

try:
    birdmb.trim_flight(ibis, {AMPLITUDE: (30.0, 32.0)}, climb_rate=2.0)
except birdmb.TrimError as error:
    print(error)

# %%
# The angles of attack along the wing over a beat, and what a flight has beyond the limits.

validity = birdmb.assess_validity(cases["level"].cycle)
print(f"reduced frequency {validity.reduced_frequency:.3f}")
print(f"Strouhal number {validity.strouhal_number:.3f}")
for warning in validity.warnings or ["within the model's validity"]:
    print(warning)
validity.plot()

# %%

plt.show()
