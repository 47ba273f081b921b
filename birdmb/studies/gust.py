"""Flight through a gust, by the full model and by the linear one with its Floquet modes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from birdmb._typing import FloatArray, IntArray
from birdmb.arguments import checked
from birdmb.errors import ArgumentError, StateError
from birdmb.models import FlightCycle, Gust
from birdmb.models.gusts import velocity_of
from birdmb.orbits.multipliers import Spectrum
from birdmb.orbits.periodic import periodic_multipliers
from birdmb.studies.body_gust import BodyGust, GustAxes, attitude_along
from birdmb.studies.perturbed import flight_path

# A table of the linearised model has this many phases for each integration step of a beat.
_PHASES_PER_STEP = 2
_STEP = 1e-5  # of the differences, in units of the state scale and in m/s
_RELATIVE_TOLERANCE = 1e-8
_ABSOLUTE_TOLERANCE = 1e-10  # of the state scale, for a gust of 1 m/s
# A gust along the body's axes is flown again with the attitude found, until that stays.
_MOST_FLIGHTS = 30
_SETTLED = 1e-8  # of the state scale


@checked
def gust_response(
    cycle: FlightCycle,
    gust: Gust,
    *,
    axes: GustAxes = "world",
    periods: int = 10,
    samples: int = 60,
) -> xr.Dataset:
    """Follow a bird from its limit cycle through a gust, and compare with the linear response.

    The gust is the same everywhere at a time. The linear response solves the equations linearised
    about the cycle, dx' = A(t) dx + B(t) g(t), and is split into the Floquet modes of the cycle;
    its difference from the full one is of second order in the gust, but for what the integration's
    steps err by.

    Args:
        cycle: limit cycle of a bird, stable or not.
        gust: velocity of the air (m/s, forwards, upwards and, of a bird in space, to the right)
            at a time (s): `GaussianGust`, `CosineGust`, `StepGust`, or any function; times at which
            it or its slopes jump are looked for in its attribute `discontinuities`.
        axes: "world" for velocities along the horizon and the vertical, "body" for velocities along
            the body's x axis, against its z axis and along its y axis, which turn with it.
        periods: beats to follow it, from the cycle's start time on.
        samples: times per beat.

    Returns:
        By `time` (s): `states` by the full model (by `state`), the undisturbed `orbit`, their
        difference `deviation`, the `linear` deviation, `gust` (m/s, by `direction`: "forward",
        "right", "up", along `axes`), path `X` and height `h` (m) with and (`orbit_X`, `orbit_h`)
        without the gust, and `Y` to the right where the bird moves in space; by `mode` the part of
        each in the linear deviation, `mode_deviation` (a conjugate pair is one mode), with
        `multiplier_real` and `multiplier_imag`. `attrs["failure"]` says why the full model ended
        early, its states then being NaN; it is empty if it did not.

    Raises:
        ArgumentError: numbers that are not positive, a gust that is no velocity, axes of no such
            name, a side gust on a bird that flies in its plane of symmetry, or a gust along the
            body's axes so strong that its attitude does not settle.
    """
    if periods < 1 or samples < 1:
        raise ArgumentError("periods and samples must be at least 1.")
    motion = cycle.model.motion
    beats = np.arange(periods * samples + 1) / samples
    times: FloatArray = cycle.start_time + cycle.period * beats
    wind = np.array([velocity_of(gust, float(t)) for t in times])
    orbit = cycle.trajectory(times).states
    along_cycle = gust
    if axes == "body":
        along_cycle = BodyGust(gust, attitude_along(times, orbit, motion))
        states, failure = _flown_along_body(cycle, gust, times, orbit)
    else:
        states, failure = _flown(cycle, gust, times)
    linearised = _linearise(cycle)
    linear = _linear_response(cycle, linearised, along_cycle, times)
    spectrum = _modes_over_a_beat(cycle, linearised, samples)
    kept, parts = _by_mode(spectrum, linear, samples)
    reached = np.isfinite(states).all(axis=1)
    orbit_path = flight_path(times, orbit, motion)
    path = np.full(orbit_path.shape, np.nan)
    path[reached] = flight_path(times[reached], states[reached], motion)
    metres = {"units": "m"}
    sideways = {"Y": ("time", path[:, 2], metres)} if motion.lateral.any() else {}
    return xr.Dataset(
        {
            "states": (("time", "state"), states),
            "orbit": (("time", "state"), orbit),
            "deviation": (("time", "state"), states - orbit),
            "linear": (("time", "state"), linear),
            "mode_deviation": (("mode", "time", "state"), parts),
            "multiplier_real": ("mode", spectrum.multipliers[kept].real),
            "multiplier_imag": ("mode", spectrum.multipliers[kept].imag),
            "gust": (("time", "direction"), wind * [1.0, 1.0, -1.0], {"units": "m/s"}),
            "X": ("time", path[:, 0], metres),
            "h": ("time", path[:, 1], metres),
            "orbit_X": ("time", orbit_path[:, 0], metres),
            "orbit_h": ("time", orbit_path[:, 1], metres),
            **sideways,
        },
        coords={
            "time": ("time", times, {"units": "s"}),
            "state": list(cycle.state_names),
            "mode": kept,
            "direction": ["forward", "right", "up"],
        },
        attrs={
            "bird": cycle.model.bird.name,
            "period": cycle.period,
            "axes": axes,
            "failure": failure,
        },
    )


class _Window:
    """A gust as it is between two times: of a jump at either, the side within counts."""

    def __init__(self, gust: Gust) -> None:
        self._gust = gust
        self.first = self.last = 0.0

    def __call__(self, t: float) -> Sequence[float]:
        margin = 1e-9 * (self.last - self.first)
        return self._gust(min(max(t, self.first + margin), self.last - margin))


def _flown(cycle: FlightCycle, gust: Gust, times: FloatArray) -> tuple[FloatArray, str]:
    """States (K, n) at `times` (K,) s by the full model, and why it ended early."""
    window = _Window(gust)
    model = cycle.model.in_gust(window)
    states = np.full((times.size, len(cycle.x0)), np.nan)
    states[0] = x = cycle.x0
    beats = times[0] + cycle.period * np.arange(1, round((times[-1] - times[0]) / cycle.period) + 1)
    for first, last in _pieces(gust, times[0], times[-1], beats):
        window.first, window.last = first, last
        within = (times > first) & (times <= last)
        try:
            path = model.trajectory(x, first, last, np.append(times[within], last)).states
        except StateError as error:
            return states, str(error)
        states[within], x = path[:-1], path[-1]
    return states, ""


def _flown_along_body(
    cycle: FlightCycle, gust: Gust, times: FloatArray, states: FloatArray
) -> tuple[FloatArray, str]:
    """As `_flown`, with a gust along the body's axes; `states` (K, n) give the first attitude."""
    motion, scale = cycle.model.motion, cycle.state_scale
    for _ in range(_MOST_FLIGHTS):
        followed = BodyGust(gust, attitude_along(times, states, motion))
        before, (states, failure) = states, _flown(cycle, followed, times)
        change = np.abs((states - before) / scale)
        same_end = np.array_equal(np.isfinite(states), np.isfinite(before))
        if same_end and np.nanmax(change) < _SETTLED:
            return states, failure
    raise ArgumentError(
        f"the attitude in this gust along the body's axes does not settle in {_MOST_FLIGHTS} "
        f'flights; take a weaker gust, fewer periods or axes="world".'
    )


def _pieces(gust: Gust, first: float, last: float, others: FloatArray) -> list[tuple[float, float]]:
    discontinuities = np.append(np.array(getattr(gust, "discontinuities", ()), dtype=float), others)
    inside = discontinuities[(discontinuities > first) & (discontinuities < last)]
    ends = np.unique(np.concatenate([[first], inside, [last]]))
    return list(pairwise(ends.tolist()))


@dataclass(frozen=True)
class _Linearised:
    """The equations about a limit cycle: functions of time, with its period."""

    by_state: Callable[[float], FloatArray]
    """(n, n) 1/s, A(t)."""
    by_gust: Callable[[float], FloatArray]
    """(n, 3), B(t): by the air's velocity forwards, to the right and down."""

    def rates(self, t: float, y: FloatArray, wind: FloatArray) -> FloatArray:
        """Rates (n,) of a deviation (n,) in a wind (3,) m/s."""
        return np.asarray(self.by_state(t) @ y + self.by_gust(t) @ wind)


def _linearise(cycle: FlightCycle) -> _Linearised:
    model = cycle.model
    phases = np.linspace(0.0, cycle.period, _PHASES_PER_STEP * model.steps_per_beat + 1)
    times = cycle.start_time + phases
    n, steps = len(cycle.x0), _STEP * cycle.state_scale
    # In the plane of symmetry no air moves sideways.
    felt = (0, 1, 2) if model.motion.lateral.any() else (0, 2)
    blown = {i: [model.in_gust(_Steady(i, h)) for h in (_STEP, -_STEP)] for i in felt}
    a, b = np.empty((phases.size, n, n)), np.zeros((phases.size, n, 3))
    for k, (t, x) in enumerate(zip(times, cycle.trajectory(times).states, strict=True)):
        for i, h in enumerate(np.diag(steps)):
            a[k, :, i] = (model.rhs(t, x + h) - model.rhs(t, x - h)) / (2.0 * steps[i])
        for i, (ahead, behind) in blown.items():
            b[k, :, i] = (ahead.rhs(t, x) - behind.rhs(t, x)) / (2.0 * _STEP)

    def periodic(values: FloatArray) -> Callable[[float], FloatArray]:
        values[-1] = values[0]
        spline = CubicSpline(phases, values, bc_type="periodic")
        return lambda t: np.asarray(spline(np.mod(t - cycle.start_time, cycle.period)))

    return _Linearised(periodic(a), periodic(b))


@dataclass(frozen=True)
class _Steady:
    """Air that moves along one of the directions forwards, right and down."""

    direction: int
    velocity: float

    def __call__(self, _t: float) -> tuple[float, float, float]:
        forward, right, down = self.velocity * np.eye(3)[self.direction]
        return float(forward), -float(down), float(right)


def _linear_response(
    cycle: FlightCycle, linearised: _Linearised, gust: Gust, times: FloatArray
) -> FloatArray:
    """Deviation (K, n) from the cycle, from none at the first of `times` (K,) s."""
    scale = cycle.state_scale
    deviation = np.zeros((times.size, scale.size))
    window, y = _Window(gust), np.zeros(scale.size)
    for first, last in _pieces(gust, times[0], times[-1], times[:0]):
        window.first, window.last = first, last
        within = (times > first) & (times <= last)
        found = solve_ivp(
            lambda t, y: (
                linearised.by_state(t) @ y + linearised.by_gust(t) @ velocity_of(window, t)
            ),
            (first, last),
            y,
            method="Radau",
            t_eval=np.union1d(times[within], last),
            jac=lambda t, _y: linearised.by_state(t),
            rtol=_RELATIVE_TOLERANCE,
            atol=_ABSOLUTE_TOLERANCE * scale,
            max_step=cycle.period / 10,  # lest a short gust be stepped over
        )
        y = found.y[:, -1]
        deviation[within] = found.y.T[: within.sum()]
    return deviation


def _by_mode(spectrum: Spectrum, linear: FloatArray, samples: int) -> tuple[IntArray, FloatArray]:
    """Which modes stand for all, and the part (m, K, n) of each in the linear deviation (K, n)."""
    kept = np.flatnonzero(spectrum.multipliers.imag >= 0)
    parts = np.empty((kept.size, *linear.shape))
    for k, y in enumerate(linear):
        modes = spectrum.modes_along[k % samples]
        amplitudes = np.linalg.solve(modes, y)
        for i, m in enumerate(kept):
            pair = 2.0 if spectrum.multipliers[m].imag else 1.0
            parts[i, k] = pair * (amplitudes[m] * modes[:, m]).real
    return kept, parts


def _modes_over_a_beat(cycle: FlightCycle, linearised: _Linearised, samples: int) -> Spectrum:
    """Floquet modes at `samples` times of a beat.

    From a Jacobian for each sample, for over a whole beat modes that decay fast would be lost
    beside the slow ones.
    """
    n, scale = len(cycle.x0), cycle.state_scale
    times = cycle.start_time + cycle.period / samples * np.arange(samples + 1)
    factors = np.empty((samples, n, n))
    for k in range(samples):
        found = solve_ivp(
            lambda t, y: (linearised.by_state(t) @ y.reshape(n, n)).ravel(),
            (float(times[k]), float(times[k + 1])),
            np.diag(scale).ravel(),
            method="Radau",
            jac=lambda t, _y: np.kron(linearised.by_state(t), np.eye(n)),
            rtol=_RELATIVE_TOLERANCE,
            atol=_ABSOLUTE_TOLERANCE * np.repeat(scale, n),
        )
        factors[k] = found.y[:, -1].reshape(n, n) / scale
    errors = _RELATIVE_TOLERANCE * np.abs(factors)
    return periodic_multipliers(factors, errors, scale)
