"""What a limit cycle says about the flight of a bird: speed, climb, loads, power."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.models.beat import Beat
from birdmb.models.cycle_variables import outlines, variables_of_wing
from birdmb.models.energy import Work, work_by_sign
from birdmb.models.flight_modes import FlightMode, flight_modes
from birdmb.models.motion import HELD, SPACE_STATES, heading_rate, heading_velocity
from birdmb.models.stepped_cycle import SteppedCycle
from birdmb.models.wing_model import STEPS_PER_BEAT
from birdmb.orbits.cycle_dataset import described
from birdmb.orbits.result import largest_modulus
from birdmb.quantities import DISSIPATORS, described_by
from birdmb.summary import Fact, facts_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from birdmb.animation.animation import Animation

# Of flights that are well resolved both are below 1e-4.
_LARGEST_IMBALANCE = 0.01
_LARGEST_INTEGRATION_ERROR = 0.01
# Loads are of higher degree in the states than one.
_INSTANTS_PER_NODE = 2
_PHI, _THETA = SPACE_STATES.index("phi"), SPACE_STATES.index("theta")


def _mean(values: FloatArray) -> FloatArray:
    """Mean over a beat of values (K, ...), by the trapezoidal rule, spectrally accurate here."""
    return np.asarray(values[:-1].mean(axis=0))


@dataclass(frozen=True, repr=False)
class FlightCycle(SteppedCycle):
    """Limit cycle of a bird: besides the orbit, the means over a beat that its flight is judged by.

    Powers are means over a beat, in W, of both wings together.
    """

    def _title(self) -> str:
        return self.model.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield Fact("verdict", self.stability)
        yield largest_modulus(self)
        if self.why_no_flight is not None:
            yield Fact("", f"not a flight: {self.why_no_flight}")
        yield from facts_of(self, "mean_speed", "mean_climb_rate", "mean_pitch", "period")
        yield from facts_of(self, "power", "cost_of_transport")
        yield Fact("motion", self.model.motion.name)
        yield from self._summary_of_search()
        for check in self.failed_checks:
            yield Fact("", f"not to be trusted: {check}")

    @cached_property
    def beat(self) -> Beat:
        """The beat, at the steps of the model's integration or finer than a collocated one."""
        model = self.model
        times, states = self._states_of_beat
        loads = model.loads_along(times[:-1], states[:-1])
        torques = model.actuator_torques_along(times[:-1], states[:-1], loads)
        holding = model.holding_power(times[:-1], states[:-1], loads)
        # The end is the beginning, to the orbit's closure.
        ends = np.append(np.arange(times.size - 1), 0)
        return Beat(
            times=times,
            states=states,
            twists=model.body_in_space(states)[:, :6],
            loads_along=loads.taken(ends),
            joint_rates=model.motion_of_both(times, states)[1],
            actuator_torques=torques[ends],
            driver_rates=model.drivers_of_both(times)[1],
            holding_power=holding[ends],
        )

    @cached_property
    def _states_of_beat(self) -> tuple[FloatArray, FloatArray]:
        """Times (K,) and states (K, n) of the beat."""
        if self.nodes is None or self.pieces is not None:
            steps = self.model.steps_per_beat
        else:
            steps = max(STEPS_PER_BEAT, _INSTANTS_PER_NODE * self.nodes)
        times = self.start_time + self.period * np.arange(steps + 1) / steps
        return times, self.trajectory(times).states

    @cached_property
    def _mean_in_space(self) -> FloatArray:
        """Mean states in space (8,)."""
        return _mean(self.model.body_in_space(self._states_of_beat[1]))

    @cached_property
    def _mean_along_heading(self) -> FloatArray:
        """Mean velocity (3,) m/s forward, to the right and upwards, seen along the heading."""
        return _mean(heading_velocity(self.model.body_in_space(self._states_of_beat[1])))

    @property
    def mean_velocity(self) -> FloatArray:
        """Mean forward speed, along the heading, and climb rate (2,) m/s."""
        return self._mean_along_heading[[0, 2]]

    @property
    def mean_speed(self) -> float:
        """Modulus of the mean velocity, m/s; in straight flight the way made good per time."""
        return float(np.linalg.norm(self._mean_along_heading))

    @property
    def mean_climb_rate(self) -> float:
        """Mean climb rate, m/s, upwards positive."""
        return float(self.mean_velocity[1])

    @property
    def mean_pitch(self) -> float:
        """Mean pitch angle, rad, nose up positive."""
        return float(self._mean_in_space[_THETA])

    @property
    def mean_bank(self) -> float:
        """Mean roll angle, rad, right wing down positive; 0 in symmetric flight."""
        return float(self._mean_in_space[_PHI])

    @cached_property
    def turn_rate(self) -> float:
        """Mean rate of the heading, rad/s, to the right positive; 0 in symmetric flight."""
        return float(_mean(heading_rate(self.model.body_in_space(self._states_of_beat[1]))))

    @property
    def path_angle(self) -> float:
        """Angle of the mean flight path above the horizon, rad."""
        return float(np.arctan2(self.mean_velocity[1], self.mean_velocity[0]))

    @property
    def power(self) -> float:
        """Power that moving the wings against the air takes: minus the work of its loads on them.

        With the velocity of the lifting line relative to the body (thesis, chapter 6: P_act).
        """
        return float(_mean(self.beat.wing_power))

    @property
    def potential_power(self) -> float:
        """Power drawn from sinking: minus weight times climb rate (thesis, chapter 8: P_g)."""
        model = self.model
        return -model.mass * model.bird.gravity * self.mean_climb_rate

    @property
    def corrected_power(self) -> float:
        """Power that the flight would take if it were level: `power` + `potential_power`."""
        return self.power + self.potential_power

    @property
    def cost_of_transport(self) -> float:
        """`power` per weight and speed, dimensionless; NaN without weight."""
        return self.transport_cost(self.power)

    def transport_cost(self, power: float) -> float:
        """Any power (W) per weight and speed, dimensionless; NaN without weight."""
        model = self.model
        way = model.mass * model.bird.gravity * self.mean_speed
        return power / way if way else math.nan

    @cached_property
    def driver_work(self) -> dict[str, Work]:
        """Positive and negative mean power of the drivers, W, by joint, both wings together."""
        powers = zip(self.model.bird.angle_names, self.beat.driver_power.T, strict=True)
        return {name: work_by_sign(self.beat.times, power) for name, power in powers}

    @checked
    def muscle_power(self, recovery: float = 1.0) -> float:
        """Mean power of all drivers, W, if the part `recovery` of their negative work is recovered.

        1 is what the thesis assumes; 0 that joints which are driven by the air only brake. What the
        muscles take out of the metabolism is left to whoever knows their efficiency.

        Raises:
            ArgumentError: the part is not between 0 and 1.
        """
        if not 0.0 <= recovery <= 1.0:
            raise ArgumentError(f"recovery is the part of negative work won back, not {recovery}.")
        return sum(work.net(recovery) for work in self.driver_work.values())

    @property
    def dissipation(self) -> dict[str, float]:
        """Mean power lost to the air, W: by lift (its induced drag), profile, tail and body.

        Where the wings are massless the sum is `corrected_power`.
        """
        means = _mean(self.beat.dissipation)
        return {name: float(mean) for name, mean in zip(DISSIPATORS, means, strict=True)}

    @property
    def joint_powers(self) -> dict[str, float]:
        """Mean of joint torque times joint rate, W, by joint.

        The torque is that of the actuator where the joint is prescribed, of spring and damper where
        it is compliant. Hinges of feathers are listed after the joints: what they deliver is
        negative, for their dampers take power out of the motion.
        """
        return self._by_joint(self.beat.joint_power)

    @property
    def driver_powers(self) -> dict[str, float]:
        """Mean power of the drivers, W, by joint: joint torque times the driver's rate.

        Of a compliant joint it exceeds the joint's power by what the damper dissipates; so does the
        hinge's of a feather, whose driver stands still and delivers 0.
        """
        return self._by_joint(self.beat.driver_power)

    @property
    def feather_power(self) -> float:
        """Part of `power` that no joint and no hinge delivers, W.

        The loads act on the bones, but the lifting line also moves relative to them, with the
        feathers that fan out; `power` counts that motion, torque times rate does not.
        """
        by_joints = -(self.beat.air_torques * self.beat.joint_rates).sum(axis=(1, 2))
        return float(_mean(self.beat.wing_power - by_joints))

    @property
    def energy_imbalance(self) -> float:
        """What a beat leaves over of the energy, relative to the work done in it; 0 if exact.

        Joints, hinges, air and gravity together must leave the kinetic energy as it was.
        """
        model = self.model
        joints = self.beat.joint_power.sum(axis=1)
        climb = heading_velocity(model.body_in_space(self.beat.states))[:, 2]
        gravity = -model.mass * model.bird.gravity * climb
        powers = np.array([joints, self.beat.air_power, gravity, self.beat.holding_power])
        exchanged = np.abs(powers).sum(axis=0)
        left_over = _mean(powers.sum(axis=0))
        return float(np.abs(left_over) / _mean(exchanged))

    @cached_property
    def failed_checks(self) -> tuple[str, ...]:
        """What the program's own checks say against these numbers, a sentence each."""
        checks = (
            ("energy imbalance of a beat", self.energy_imbalance, _LARGEST_IMBALANCE),
            ("integration error of a beat", self.integration_error, _LARGEST_INTEGRATION_ERROR),
        )
        # NaN fails too.
        return tuple(
            f"the {name} is {value:.1e}, more than {largest:g}"
            for name, value, largest in checks
            if not value <= largest
        )

    @cached_property
    def why_no_flight(self) -> str | None:
        """Why this motion, though it repeats itself, is no flight; `None` if it is one."""
        if self.model.motion is HELD:
            return "the body is held"
        forwards, pitch = self._mean_in_space[[0, _THETA]]
        if np.cos(pitch) <= 0.0:
            angle = f"pitch {np.degrees(pitch):.0f} deg"
            return f"the body stands on its tail or lies on its back ({angle})"
        if forwards <= 0.0:
            return f"the body moves backwards ({forwards:.1f} m/s along its axis)"
        if self.mean_velocity[0] <= 0.0:
            return f"it moves backwards ({self.mean_velocity[0]:.1f} m/s)"
        return None

    @cached_property
    def flight_modes(self) -> tuple[FlightMode, ...]:
        """The modes, by plane and name, in the order of the multipliers."""
        return flight_modes(self, self.model.motion, self.model.mirror, self.model.wake.count)

    @property
    def sort_key(self) -> tuple[float, ...]:
        """What `find_limit_cycles` sorts by: flights first, the slow ones before the fast."""
        return float(self.why_no_flight is not None), self.mean_speed

    @property
    def verdict_errors(self) -> FloatArray:
        """Errors (n,) of the multipliers that the verdict counts: also of the integration.

        Infinite where `failed_checks` leave no faith in any of them.
        """
        errors = super().verdict_errors
        return np.full(errors.shape, np.inf) if self.failed_checks else errors

    def _by_joint(self, values: FloatArray) -> dict[str, float]:
        names = self.model.bird.angle_names
        return {n: float(v) for n, v in zip(names, _mean(values), strict=True)}

    def to_xarray(self) -> xr.Dataset:
        """The orbit as `LimitCycle.to_xarray` gives it, with loads and power over the beat."""
        beat = self.beat
        axes, joints = ["x", "y", "z"], list(self.model.bird.angle_names)
        stack = beat.loads_along.stack
        of_wings = variables_of_wing(stack.right, "", "")
        if not self.model.is_mirrored:
            of_wings |= variables_of_wing(stack.left, "left_", ", of the left wing, mirrored")
        flight = xr.Dataset(
            {
                "force": (("beat_time", "axis"), beat.force, described("N", "air on the bird")),
                "moment": (("beat_time", "axis"), beat.moment, described("N m", "air, about G")),
                "multiplier_integration_error": (
                    "multiplier",
                    self.multiplier_integration_errors,
                    described("1", "by the integration's steps"),
                ),
                "wing_power": ("beat_time", beat.wing_power, described("W", "P_act")),
                "tail_angle": ("beat_time", beat.tail_angle, described("rad", "of attack")),
                "dissipation": (
                    ("beat_time", "load"),
                    beat.dissipation,
                    described("W", "power lost to the air"),
                ),
                "joint_power": (
                    ("beat_time", "joint"),
                    beat.joint_power,
                    described("W", "joint torque times joint rate, both wings"),
                ),
                **of_wings,
            },
            coords={
                "beat_time": ("beat_time", beat.times, described("s", "time over a beat")),
                "axis": axes,
            }
            | {"joint": joints, "load": list(DISSIPATORS)},
            attrs={
                "bird": self.model.bird.name,
                "fingerprint": self.model.bird.fingerprint(),
                "frame": "body axes: x forward, y right, z down, from the body's centre of mass",
                **described_by(self),
                "failed_checks": "; ".join(self.failed_checks),
                "why_no_flight": self.why_no_flight or "",
            },
        )
        model = self.model
        whole = xr.merge([super().to_xarray(), flight], combine_attrs="no_conflicts")
        topology = json.dumps(model.bird.model_dump(mode="json"))
        edges = outlines(model, *self._states_of_beat)
        text = ((), topology, {"long_name": "the bird, as JSON"})
        return whole.assign({**edges, "topology": text}).assign_attrs(
            title=f"limit cycle of {model.bird.name}, {model.kind} model",
            model=model.kind,
            model_settings=json.dumps(model.settings()),
            motion=model.motion.name,
            steps_per_beat=model.steps_per_beat,
            integrator=model.integration_method,
        )

    def plot(self) -> Figure:
        """Draw states, loads and power over a beat, the multipliers and the wing at four phases."""
        from birdmb.figures import plot_overview  # noqa: PLC0415 - it draws

        return plot_overview(self)

    def animate(self, *beside: FlightCycle, **options: Any) -> Animation:
        """The flight as a moving picture, alone or side by side with another one.

        A notebook shows it; `save` writes it as .html, .mp4, .gif, .vtm or .pvd.

        Args:
            beside: another limit cycle of a bird, at the same phase of its beat.
            options: `beats`, `frames` of each, `colour`, `mode`, `scale` and `view`, as of
                `birdmb.animation.animation.animate`.

        Raises:
            ArgumentError: wrong numbers or names.
            StateError: a flight along a mode leaves what the model can tell.
        """
        from birdmb.animation.animation import animate  # noqa: PLC0415 - it draws

        return animate((self, *beside), **options)
