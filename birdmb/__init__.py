"""Limit cycles, Floquet stability and power of flapping birds.

A bird is data (`load_bird`), a model turns it into a flow (`RigidModel`, `MultibodyModel`), an
orbit is a fixed point of that flow (`find_limit_cycle`), and its multipliers say whether the bird
can fly hands-off.
"""

from importlib import import_module
from importlib.util import find_spec
from typing import Any

import lazy_loader

# The names are listed in __init__.pyi and imported at their first use, so that asking the command
# line for help does not wait for Exudyn and numba.
_imported, _listed, __all__ = lazy_loader.attach_stub(__name__, __file__)


def __getattr__(name: str) -> Any:
    if name in __all__:
        return _imported(name)
    if name == "__version__":
        from importlib.metadata import version  # noqa: PLC0415 - slow to import

        return version("birdmb")
    if not name.startswith("_") and find_spec(f"birdmb.{name}"):
        return import_module(f"birdmb.{name}")
    from birdmb.errors import no_attribute  # noqa: PLC0415 - only mistakes need it

    raise no_attribute("birdmb", name, __all__)


def __dir__() -> list[str]:
    return sorted([*_listed(), "__version__"])
