"""How a model says that it has lost its meaning, as `StateError`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.compiled_calls import behind
from birdmb.topology import Bird

# In typical sizes of the states: Mach 300, or turning 10 000 rad/s.
_RUNAWAY = 1e4


def lifting_line_lost(bird: Bird, t: float, angles: FloatArray) -> StateError:
    """Say at which joint angles the lifting line could not be found."""
    return StateError(
        f"{bird.name}: no line orthogonal to its chords fits the wing at t = {t:.4f} s "
        f"({_listed(bird, angles)}); the wing is folded too far, feathers point forwards, they or "
        f"sections are out of all proportion, or wing.discretisation has too many elements for its "
        f"rounding."
    )


def wing_misplaced(bird: Bird, t: float, angles: FloatArray, clearance: float) -> StateError:
    """Say at which joint angles the wing lies where it has no loads.

    `clearance` (m) is negative or NaN, see `birdmb.aerodynamics.elements.clearance`.
    """
    at = f"at t = {t:.4f} s ({_listed(bird, angles)})"
    if np.isnan(clearance):
        return StateError(
            f"{bird.name}: a part of the lifting line runs along the stream {at}, where the wing "
            f"has no span; sweep it less."
        )
    root = bird.wing.root.y
    return StateError(
        f"{bird.name}: the wings swing through one another {at}: the lifting line is "
        f"{-1e3 * clearance:.3g} mm across the plane of symmetry, where it has no loads. At the "
        f"same joint angles wing.root.y must be {_rounded_up(root - clearance):.4g} m or more, not "
        f"{root:.4g} m; or let the joints flap or sweep the wing less far inwards."
    )


def _rounded_up(length: float) -> float:
    """A length (m) as it may be typed, to the next tenth of a millimetre."""
    return float(np.ceil(length * 1e4) / 1e4)


def _listed(bird: Bird, angles: FloatArray) -> str:
    return ", ".join(
        f"{name} {np.degrees(angle):.4g} deg"
        for name, angle in zip(bird.angle_names, angles, strict=True)
    )


def refuse_runaway(
    bird: Bird, names: Sequence[str], x: FloatArray, scale: FloatArray, t: float
) -> None:
    """Raise `StateError` for a state (n,) that no flight has, before it is integrated for long."""
    beyond = np.flatnonzero(np.abs(x) > _RUNAWAY * scale).tolist()
    if beyond:
        listed = ", ".join(f"{names[i]} = {x[i]:.3g}" for i in beyond)
        raise StateError(f"{bird.name}: the motion runs away: {listed} at t = {t:.4g} s.")


@contextmanager
def overflow_told(bird: Bird, what: str) -> Iterator[None]:
    """Raise `StateError` where computing `what` divides by zero or meets a singular matrix.

    An interrupted kernel comes out as what interrupted it.
    """
    try:
        yield
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        reason = str(error) or type(error).__name__
        raise StateError(
            f"{bird.name}: {what} cannot be computed ({reason}): the flight diverged, or a value "
            f"of the bird is too large or too small to reckon with; `birdmb check` shows them."
        ) from error
    except SystemError as error:
        raise behind(error) from None
