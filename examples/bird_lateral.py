"""
Roll, spiral, Dutch roll
========================

The ibis with its tail spread in space: does a bird that flies well in its plane of symmetry also
stay upright and keep its heading? See :doc:`/lateral`.
"""

import numpy as np

import birdmb

bird = birdmb.load_bird("ibis_tail").with_values({"wing.discretisation": 8})
model = birdmb.RigidModel(bird, motion="free")
cycle = birdmb.find_limit_cycle(model)
for mode in cycle.flight_modes:
    size = abs(mode.multiplier)
    does = "doubles" if size > 1 else "halves"
    print(f"{mode.plane:13}{mode.name:12} |Λ| {size:.4f}, {does} in {mode.doubling_time:.2g} s")

# %%
# The straight flight is unstable in its spiral. Many starts lead to other flights of the same bird,
# turns to either side among them; a few are enough here.

starts = [cycle.x0, *birdmb.models.starts.steady_turns(cycle.x0[None], bird.gravity)]
for found in birdmb.find_limit_cycles(model, starts):
    bank, turn = np.degrees([found.mean_bank, found.turn_rate])
    print(
        f"{found.mean_speed:.2f} m/s, bank {bank:+.1f}°, turning {turn:+.1f}°/s: "
        f"|Λ|max {abs(found.multipliers[0]):.4f}, {found.stability}"
    )

# sphinx_gallery_thumbnail_path = 'figures/lateral_modes.png'
