"""Limit cycles, Floquet stability and power of flapping birds.

A bird is data (`load_bird`), a model turns it into a flow (`RigidModel`, `MultibodyModel`), an
orbit is a fixed point of that flow (`find_limit_cycle`), and its multipliers say whether the bird
can fly hands-off.
"""

import lazy_loader

# The names are listed in __init__.pyi and imported at their first use, so that asking the command
# line for help does not wait for Exudyn and numba.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
