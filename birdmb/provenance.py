"""The software that computed a result."""

from __future__ import annotations

from importlib.metadata import version

# Packages whose version may change the last bits of a result.
_PACKAGES = ("birdmb", "exudyn", "numba", "numpy", "scipy")


def software() -> dict[str, str]:
    """Versions of this package, and of those that its results depend on, by name."""
    return {name: version(name) for name in _PACKAGES}
