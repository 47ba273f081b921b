"""Flight after a disturbance along each mode of a limit cycle, in its states and in the world."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.interpolate import make_interp_spline

from birdmb._typing import FloatArray
from birdmb.arguments import checked
from birdmb.models import FlightCycle
from birdmb.models.motion import PLANAR, Motion, heading_rate, heading_velocity
from birdmb.orbits import mode_disturbance, perturbed_response


@checked
def perturbed_flight(
    cycle: FlightCycle, *, amplitude: float = 0.05, periods: int = 5, samples: int = 100
) -> xr.Dataset:
    """Follow the flight after a disturbance along each mode of the cycle, by the full model.

    Of a conjugate pair of modes, the one with the multiplier above the real axis is taken; the
    disturbance is its real part (`birdmb.orbits.mode_disturbance`). The model integrates the
    flight: what its steps err by (`FlightCycle.flown_closure`) disturbs it, too, and should be far
    less.

    Args:
        cycle: limit cycle of a bird.
        amplitude: size of the disturbance in units of the state scale (10 m/s, 2 m/s, 1 rad/s and
            0.2 rad for the body): the largest entry of the mode is disturbed by that much.
        periods: beats to follow it.
        samples: times per beat.

    Returns:
        By `mode` (position among the cycle's multipliers) and `time` (s): `states` and their
        `deviation` from the cycle (by `state`), path `X` and height `h` (m, from where the body is
        when disturbed); by `time` alone the undisturbed `orbit`, `orbit_X`, `orbit_h`; by `mode`
        and `beat` the deviation `linear` that the monodromy matrix predicts, by `mode`
        `multiplier_real` and `multiplier_imag`, and `failure`: empty, or why the flight ended
        early, its states then being NaN.

    Raises:
        ArgumentError: numbers that are not positive.
    """
    motion = cycle.model.motion
    modes = np.flatnonzero(cycle.multipliers.imag >= 0)
    start, beats = cycle.start_time, np.arange(periods + 1)
    responses = [
        perturbed_response(
            cycle,
            mode_disturbance(cycle, int(mode), amplitude),
            periods=periods,
            samples=samples,
        )
        for mode in modes
    ]
    times = np.concatenate(
        [
            [start],
            *(start + cycle.period * (k + np.arange(1, samples + 1) / samples) for k in beats[:-1]),
        ]
    )
    orbit = cycle.trajectory(times).states
    states = np.full((modes.size, *orbit.shape), np.nan)
    linear = np.full((modes.size, beats.size, orbit.shape[1]), np.nan)
    path = np.full((modes.size, times.size, 2), np.nan)
    for i, response in enumerate(responses):
        reached = len(response.times)
        states[i, :reached] = response.states
        linear[i, : len(response.linear)] = response.linear
        path[i, :reached] = flight_path(response.times, response.states, motion)[:, :2]
    orbit_path = flight_path(times, orbit, motion)
    metres = {"units": "m"}
    by_mode = ("mode", "time", "state")
    return xr.Dataset(
        {
            "states": (by_mode, states),
            "deviation": (by_mode, states - orbit),
            "X": (("mode", "time"), path[:, :, 0], metres),
            "h": (("mode", "time"), path[:, :, 1], metres),
            "orbit": (("time", "state"), orbit),
            "orbit_X": ("time", orbit_path[:, 0], metres),
            "orbit_h": ("time", orbit_path[:, 1], metres),
            "linear": (("mode", "beat", "state"), linear),
            "multiplier_real": ("mode", cycle.multipliers[modes].real),
            "multiplier_imag": ("mode", cycle.multipliers[modes].imag),
            "failure": ("mode", np.array([r.failure or "" for r in responses], dtype=str)),
        },
        coords={
            "mode": modes,
            "time": ("time", times, {"units": "s"}),
            "beat": beats,
            "state": list(cycle.state_names),
        },
        attrs={"bird": cycle.model.bird.name, "amplitude": amplitude, "period": cycle.period},
    )


def flight_path(times: FloatArray, states: FloatArray, motion: Motion = PLANAR) -> FloatArray:
    """Path X, height h and, in space, Y to the right, m, from the first place on; (K, 2) or (K, 3).

    X is along the first heading. Of states (K, n), the first of which are the body's in `motion`.
    Rates are integrated by cubic splines: errors of fourth order in the distance of four or more
    times.
    """
    columns = 3 if motion.lateral.any() else 2
    return path_in_space(times, motion.in_space(states))[0][:, :columns]


def path_in_space(times: FloatArray, space: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Path (K, 3) m as of `flight_path`, X, height and Y, and heading (K,) rad, right positive.

    Of states in space (K, 8) at `times` (K,) s. Both begin at zero.
    """
    if times.size == 1:  # a flight that failed within its first beat
        return np.zeros((1, 3)), np.zeros(1)

    def integrated(rates: FloatArray) -> FloatArray:
        integral = make_interp_spline(times, rates, k=min(3, times.size - 1)).antiderivative()
        return np.asarray(integral(times) - integral(times[0]))

    forward, right, up = heading_velocity(space).T
    heading = integrated(heading_rate(space))
    c, s = np.cos(heading), np.sin(heading)
    velocity = np.column_stack([forward * c - right * s, up, forward * s + right * c])
    return integrated(velocity), heading
