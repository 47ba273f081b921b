"""Chapter 7: the multibody bird with wings next to massless beside the rigid one."""

from __future__ import annotations

from birdmb.models import MultibodyModel, RigidModel
from birdmb.orbits import find_limit_cycle
from birdmb.reproduction.published import Case, Published
from birdmb.reproduction.quantities import STATES, orbit_quantities, published_wing

_UNITS = ("m/s", "m/s", "rad/s", "rad")
_CIRCULATION = "the published program stops its circulation early, which shifts u by 0.005 m/s"
_RIGID = (0.01, 0.01, 0.001, 0.0002)
_TWO_MODELS = (
    f"{_CIRCULATION}; and its two models lie 0.008 m/s and 0.002 rad/s apart, of which wings of "
    "1e-5 kg explain a tenth"
)
_MULTIBODY = (0.018, 0.018, 0.003, 0.0004)


def _states(
    values: tuple[float, ...], tolerances: tuple[float, ...], reason: str
) -> tuple[Published, ...]:
    rows = zip(STATES, _UNITS, values, tolerances, strict=True)
    return tuple(Published(*row, reason=reason) for row in rows)


CASES = (
    Case(
        "7",
        "chapter 7, rigid bird, published discretisation",
        "birdmb cycle ibis --model rigid --set shoulder.flap.amplitude_deg=43.47 "
        "--set wing.discretisation=published",
        lambda: orbit_quantities(
            find_limit_cycle(
                RigidModel(published_wing("ibis", shoulder__flap__amplitude_deg=43.47))
            )
        ),
        _states((18.511, -2.110, -0.118, -0.1164), _RIGID, _CIRCULATION),
    ),
    Case(
        "7",
        "chapter 7, multibody bird with wings of 1e-5 kg, published discretisation",
        "birdmb cycle ibis_massless --set wing.discretisation=published",
        lambda: orbit_quantities(find_limit_cycle(MultibodyModel(published_wing("ibis_massless")))),
        _states((18.516, -2.102, -0.120, -0.1161), _MULTIBODY, _TWO_MODELS),
    ),
)
