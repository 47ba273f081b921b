"""
Air with a memory
=================

The pigeon in quasi-steady air, and in air whose circulation lags behind the motion. See
:doc:`/memory`.
"""

import birdmb

pigeon = birdmb.load_bird("pigeon").with_values({"wing.discretisation": 8, "air.wake_points": 4})
cycle = birdmb.find_limit_cycle(birdmb.RigidModel(pigeon))
effect: birdmb.MemoryEffect = birdmb.memory_effect(cycle)
print(effect)

# %%

for name, flight in (("quasi-steady", effect.quasi_steady), ("unsteady", effect.unsteady)):
    print(
        f"{name:13} {flight.mean_speed:6.2f} m/s  {flight.mean_climb_rate:+.2f} m/s  "
        f"{flight.corrected_power:5.2f} W  |Λ|max {abs(flight.multipliers[0]):.4f}"
    )

# sphinx_gallery_thumbnail_path = 'figures/memory_flights.png'
