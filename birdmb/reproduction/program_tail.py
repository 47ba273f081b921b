"""The tail as the published program has it: its pitch rate and its downwash."""

from __future__ import annotations

from functools import partial

import numpy as np
import numpy.typing as npt

from birdmb._typing import FloatArray, IntArray
from birdmb.aerodynamics.prescribed import PrescribedWing, at_phase, symmetric_loads
from birdmb.aerodynamics.tail import tail_force, tail_influence, tail_surface
from birdmb.aerodynamics.twist_loads import wing_flow
from birdmb.models import RigidModel
from birdmb.models.rigid_tables import RigidTable
from birdmb.topology import Bird

_FILAMENTS = 3  # of the 17 that leave 16 elements
_DIFFERENCE = 1e-5  # of the state scale


class ProgramTail(RigidModel):
    """The rigid bird with two errors of the published program in its tail.

    The pitch rate has the wrong sign in the tail's wind, and of the wake only the three vortices at
    one wing tip act on it, beside the bound vortices. Planar flight in still air; derivatives are
    by differences.

    Args:
        bird: a bird with a tail.
        wrong_rate: whether it has the first one.
        wrong_wake: whether it has the second one.
        steps_per_beat: as for `RigidModel`.
    """

    def __init__(
        self,
        bird: Bird,
        *,
        wrong_rate: bool = True,
        wrong_wake: bool = True,
        steps_per_beat: int | None = None,
    ) -> None:
        # The tail's loads are added here.
        super().__init__(bird.model_copy(update={"tail": None}), steps_per_beat=steps_per_beat)
        self.bird = bird
        tail = bird.tail
        if wrong_wake and tail is not None:
            tail = tail.model_copy(update={"downwash": "wake and bound"})
        self._surface = tail_surface(bird.model_copy(update={"tail": tail}))
        self._wrong_rate, self._wrong_wake = wrong_rate, wrong_wake

    def _options(self) -> dict[str, object]:
        return {
            "wrong_rate": self._wrong_rate,
            "wrong_wake": self._wrong_wake,
            "steps_per_beat": self._steps_wanted,
        }

    def _influence(self, node: FloatArray) -> FloatArray:
        """As `tail_influence`."""
        surface = self._surface
        if not self._wrong_wake:
            return tail_influence(surface, node)
        found = tail_influence(surface._replace(in_wake=False), node)
        for k in range(len(node) - _FILAMENTS, len(node)):
            dx, dz = surface.x - node[k, 0], surface.z - node[k, 2]
            across = node[k, 1] ** 2 + dz**2
            down = node[k, 1] * (1 - dx / np.hypot(dx, np.sqrt(across))) / (4 * np.pi * across)
            found[1, k - 1] += down
            if k < len(node) - 1:
                found[1, k] -= down
        return found

    def _rates_at(
        self, table: PrescribedWing, k: int, x: FloatArray, influence: FloatArray
    ) -> FloatArray:
        u, w, q, theta = x
        aero, body = self._constants
        twist, no_derivatives = np.array([u, 0.0, w, 0.0, q, 0.0]), np.empty(0, np.int64)
        elements = at_phase(table.elements, k)
        flow = wing_flow(elements, elements.velocity, twist, no_derivatives)
        induced = influence @ table.inverse[k] @ flow.bound[:, 0]
        surface, turning = self._surface, -q if self._wrong_rate else q
        wind = np.array(
            [-u - turning * surface.z + induced[0], 0.0, -w + turning * surface.x + induced[1]]
        )
        fx, _, fz = tail_force(surface, aero.density, wind)[:, 0]
        of_tail = np.array([fx, fz, surface.z * fx - surface.x * fz])
        forces = symmetric_loads(table, k, aero, twist, no_derivatives)[::2, 0] + of_tail
        s, c = np.sin(theta), np.cos(theta)
        return np.array(
            [
                -q * w - body.gravity * s + forces[0] / body.mass,
                q * u + body.gravity * c + forces[1] / body.mass,
                forces[2] / body.inertia[1, 1],
                q,
            ]
        )

    def _along(
        self,
        table: RigidTable,
        phase: IntArray,
        times: FloatArray,  # noqa: ARG002 - those of RigidModel
        states: FloatArray,
        *,
        slopes_wanted: bool,
    ) -> tuple[FloatArray, FloatArray]:
        wing = table.right
        influences = {k: self._influence(wing.elements.node[k]) for k in set(phase.tolist())}
        steps = np.diag(_DIFFERENCE * self.state_scale)
        rates, slopes = [], []
        for k, x in zip(phase.tolist(), states, strict=True):
            at = partial(self._rates_at, wing, k, influence=influences[k])
            rates.append(at(x))
            if slopes_wanted:
                columns = [(at(x + d) - at(x - d)) / (2 * d.sum()) for d in steps]
                slopes.append(np.column_stack(columns))
        return np.array(rates), np.array(slopes)

    def _integrate(
        self, x0: npt.ArrayLike, t0: float, t1: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        steps = self._steps(t0, t1)
        table = self._table(t0 % self.bird.period, t1 - t0, steps).right
        influences = [self._influence(node) for node in table.elements.node]
        h, start = (t1 - t0) / steps, np.asarray(x0, dtype=float)

        def rates_at(i: int, x: FloatArray) -> FloatArray:
            return self._rates_at(table, i, x, influences[i])

        def flown(x: FloatArray) -> tuple[FloatArray, FloatArray]:
            states, rates = [x], []
            for i in range(0, 2 * steps, 2):
                k1 = rates_at(i, x)
                k2 = rates_at(i + 1, x + h / 2 * k1)
                k3 = rates_at(i + 1, x + h / 2 * k2)
                k4 = rates_at(i + 2, x + h * k3)
                x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
                states.append(x)
                rates.append(k1)
            rates.append(rates_at(2 * steps, x))
            return np.array(states), np.array(rates)

        states, rates = flown(start)
        columns = [
            (flown(start + d)[0][-1] - flown(start - d)[0][-1]) / (2 * d.sum())
            for d in np.diag(_DIFFERENCE * self.state_scale)
        ]
        return states, rates, np.column_stack(columns)
