"""What can go wrong with an orbit, as types; each text says how far it got and what to try."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal

from birdmb._typing import FloatArray
from birdmb.errors import ArgumentError, OrbitError
from birdmb.orbits.iteration import Iteration

_LARGEST_TOLERANCE = 1e-2


def require_tolerance(name: str, tolerance: float) -> None:
    """Refuse a closure error that is no number or takes any guess for an orbit.

    Raises:
        ArgumentError: it is not positive, or above 0.01 state scales.
    """
    if not 0 < tolerance <= _LARGEST_TOLERANCE:
        raise ArgumentError(
            f"{name} must be positive and at most {_LARGEST_TOLERANCE:g} of the state scale, not "
            f"{tolerance}; the error of an orbit that is not closed grows with it."
        )


class BranchFileError(OrbitError, ValueError):
    """A file holds no branch, a damaged one, or one of another format."""


class NotClosedError(OrbitError):
    """An orbit given as known does not close; `residual` is by how much, in state scales."""

    def __init__(self, message: str, residual: float) -> None:
        """Keep the closure error."""
        super().__init__(message, residual)
        self.residual = residual

    def __str__(self) -> str:
        """Return the sentence alone."""
        return str(self.args[0])


StopReason = Literal[
    "the step became too small",
    "the orbits became too rough for collocation",
    "the branch left the domain of the model",
    "the number of points allowed was reached",
    "the cycles shrank to an equilibrium",
    "the number of bifurcations asked for was reached",
    "the run was interrupted",
]
BIFURCATIONS_FOUND: Final = "the number of bifurcations asked for was reached"


class BranchStopped(OrbitError):  # noqa: N818 - it reports an end, often no error
    """Why a branch ended before the end of its parameter range; the branch keeps its points.

    Attributes:
        reason: one of the sentences of `StopReason`.
        parameter: the parameter of the last good point.
    """

    def __init__(self, reason: StopReason, parameter: float, detail: str = "") -> None:
        """Say why and where."""
        super().__init__(reason, parameter, detail)
        self.reason, self.parameter, self.detail = reason, parameter, detail

    def __str__(self) -> str:
        """Return the sentence."""
        end = f": {self.detail}" if self.detail else "."
        return f"The branch stopped at parameter {self.parameter:.8g}: {self.reason}{end}"


class ConvergenceError(OrbitError):
    """No orbit was found.

    Attributes:
        best_x: state at the start of the best orbit reached, shape (n,).
        residual: its closure error (largest component, units of the states).
        history: the accepted iterations that led there.
    """

    def __init__(
        self,
        message: str,
        best_x: FloatArray,
        residual: float,
        history: Sequence[Iteration] = (),
    ) -> None:
        """Keep what had been reached."""
        # All arguments go to the base class: that is what keeps the error picklable for executors.
        super().__init__(message, best_x, residual, history)
        self.best_x = best_x
        self.residual = residual
        self.history = tuple(history)

    def __str__(self) -> str:
        """Return the sentence alone."""
        return str(self.args[0])


class NotSmoothError(ConvergenceError):
    """The orbit is too rough for collocation: its error does not fall off with the nodes.

    Attributes:
        path: states (N, n) of the best orbit reached at N even instants; none if there are none.
    """

    def __init__(
        self,
        message: str,
        best_x: FloatArray,
        residual: float,
        history: Sequence[Iteration] = (),
        path: FloatArray | None = None,
    ) -> None:
        """Keep what had been reached."""
        super().__init__(message, best_x, residual, history)
        self.args = (message, best_x, residual, history, path)
        self.path = path


class SingularJacobianError(ConvergenceError):
    """The shooting equations have no unique solution at the point reached."""


class EquilibriumError(ConvergenceError):
    """A cycle was asked for, and the iteration ended on an equilibrium or at period zero."""
