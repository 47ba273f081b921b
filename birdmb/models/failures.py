"""How a model says that it has lost its meaning, as `StateError`."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from birdmb._typing import FloatArray
from birdmb.errors import StateError
from birdmb.models.compiled_calls import behind
from birdmb.topology import Bird


def lifting_line_lost(bird: Bird, t: float, angles: FloatArray) -> StateError:
    """Say at which joint angles the lifting line could not be found."""
    listed = ", ".join(
        f"{name} {np.degrees(angle):.1f} deg"
        for name, angle in zip(bird.angle_names, angles, strict=True)
    )
    return StateError(
        f"{bird.name}: no line orthogonal to its chords fits the wing at t = {t:.4f} s "
        f"({listed}); the wing is folded too far, or wing.discretisation has too many elements for "
        f"its rounding."
    )


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
