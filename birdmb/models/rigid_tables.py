"""Tables of a rigid bird's wings over phases: made once, for all flights through these."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import PrescribedWing, WakeTable
from birdmb.aerodynamics.prescribed_lags import LagTable
from birdmb.models.kept import KeptByTimes

_PHASES_KEPT = 20_000  # at some 30 kB each


class RigidTable(NamedTuple):
    """Both wings at some phases, the left one mirrored, and what some motions and air need."""

    right: PrescribedWing
    left: PrescribedWing
    wakes: WakeTable
    lags: LagTable | None

    @property
    def for_kernels(
        self,
    ) -> tuple[PrescribedWing, PrescribedWing | None, WakeTable, LagTable | None]:
        """The same without a left wing that is like the right one."""
        left = None if self.left is self.right else self.left
        return self.right, left, self.wakes, self.lags


Tabulate: TypeAlias = Callable[[FloatArray], RigidTable]
"""Makes the table of ascending times (P,) s."""


class RigidTables:
    """Tables by their times, the last ones kept.

    What makes them is not: a model that keeps its tables would then outlive its last use.
    """

    def __init__(self) -> None:
        self._kept = KeptByTimes[RigidTable](_PHASES_KEPT)
        self._latest: tuple[FloatArray, RigidTable] | None = None

    def of(self, times: FloatArray, tabulate: Tabulate) -> RigidTable:
        """The table of ascending times (P,) s."""
        return self._kept.get(times, tabulate)

    def at(self, times: FloatArray, tabulate: Tabulate) -> tuple[RigidTable, IntArray]:
        """The table of the distinct ones of `times` (K,), and which of them each is."""
        if (times[1:] > times[:-1]).all():
            distinct, phase = times.copy(), np.arange(times.size)
        else:
            distinct, phase = np.unique(times, return_inverse=True)
        table = self.of(distinct, tabulate)
        self._latest = distinct, table
        return table, phase

    def holding(self, times: FloatArray, tabulate: Tabulate) -> tuple[RigidTable, IntArray]:
        """A table that holds `times` (K,) among others, and at which of its phases they are.

        The one that was asked for last, if it does: part of a search's instants is asked for, too.
        """
        if self._latest is not None:
            known, table = self._latest
            phase = np.minimum(np.searchsorted(known, times), known.size - 1)
            if known.size and (known[phase] == times).all():
                return table, phase
        return self.at(times, tabulate)
