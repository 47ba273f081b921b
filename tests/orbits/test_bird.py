"""What holds for shooting with any system holds for the bird."""

import numpy as np
import pytest

import birdmb
from birdmb.orbits import find_limit_cycle, floquet


class OtherUnits:
    """A model with its states in other units: x / unit."""

    def __init__(self, model, unit):
        self._model, self._unit = model, np.array(unit)
        self.state_names, self.period = model.state_names, model.period

    def flow(self, x0, t0, t1):
        return self._model.flow(x0 * self._unit, t0, t1) / self._unit

    def flow_jacobian(self, x0, t0, t1):
        end, jacobian = self._model.flow_jacobian(x0 * self._unit, t0, t1)
        return end / self._unit, jacobian * self._unit / self._unit[:, None]

    def initial_guess(self):
        return self._model.initial_guess() / self._unit


@pytest.fixture(scope="module")
def rigid(ibis):
    return birdmb.RigidModel(ibis, steps_per_beat=60)


@pytest.fixture(scope="module")
def compliant(ibis_compliant):
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 6})
    return birdmb.MultibodyModel(bird, steps_per_beat=60, integrator="explicit")


@pytest.fixture(scope="module")
def rigid_orbit(rigid):
    return find_limit_cycle(rigid, method="shooting")


@pytest.fixture(scope="module")
def compliant_orbit(compliant):
    return find_limit_cycle(compliant, method="shooting")


def rotated(orbit, steps):
    """State of an orbit some of its 60 steps on."""
    time = steps / 60 * orbit.period
    return orbit.model.flow(orbit.x0, 0.0, time), time


@pytest.mark.parametrize("segments", [2, 5, 10])
def test_multipliers_do_not_depend_on_the_segments(rigid, rigid_orbit, segments):
    cut = find_limit_cycle(rigid, segments=segments)
    assert cut.multipliers == pytest.approx(rigid_orbit.multipliers, abs=1e-8)
    assert cut.x0 == pytest.approx(rigid_orbit.x0, abs=1e-8)


@pytest.mark.parametrize("segments", [2, 5, 10])
def test_nor_do_those_of_the_compliant_bird(compliant, compliant_orbit, segments):
    states = [rotated(compliant_orbit, 60 // segments * k)[0] for k in range(segments)]
    cut = floquet(compliant, states, segments=segments)
    assert cut.multipliers == pytest.approx(compliant_orbit.multipliers, abs=1e-6)


@pytest.mark.parametrize("steps", [15, 38])
def test_multipliers_do_not_depend_on_the_starting_phase(rigid, rigid_orbit, steps):
    state, time = rotated(rigid_orbit, steps)
    later = find_limit_cycle(rigid, start_time=time, method="shooting")
    assert later.x0 == pytest.approx(state, abs=1e-8)
    assert later.multipliers == pytest.approx(rigid_orbit.multipliers, abs=1e-8)


def test_nor_do_those_of_the_compliant_bird_on_the_phase(compliant, compliant_orbit):
    state, time = rotated(compliant_orbit, 23)
    later = floquet(compliant, state, start_time=time)
    assert later.multipliers == pytest.approx(compliant_orbit.multipliers, abs=1e-6)


def test_multipliers_do_not_depend_on_the_units(rigid, rigid_orbit):
    # km/h, mm/s, deg/s, deg
    unit = [1 / 3.6, 1e-3, np.radians(1), np.radians(1)]
    other = find_limit_cycle(OtherUnits(rigid, unit))
    assert other.x0 * unit == pytest.approx(rigid_orbit.x0, abs=1e-8)
    assert other.multipliers == pytest.approx(rigid_orbit.multipliers, abs=1e-8)
    assert other.participation == pytest.approx(rigid_orbit.participation, abs=1e-6)


def test_a_known_orbit_of_the_bird(rigid, rigid_orbit):
    known = floquet(rigid, rigid_orbit.x0)
    assert known.multipliers == pytest.approx(rigid_orbit.multipliers, abs=1e-12)
    assert known.jacobian_method == "variational"
    by_differences = floquet(rigid, rigid_orbit.x0, jacobian="finite-differences")
    errors = np.abs(by_differences.multipliers - known.multipliers)
    assert (errors < by_differences.multiplier_errors).all()
    assert errors.max() < 1e-6


def test_two_beats_square_the_multipliers(rigid, rigid_orbit):
    twice = floquet(rigid, rigid_orbit.x0, 2 * rigid.period)
    squares = np.sort_complex(rigid_orbit.multipliers**2)
    assert np.sort_complex(twice.multipliers) == pytest.approx(squares, abs=1e-8)


def test_modes_and_participation(compliant_orbit):
    orbit = compliant_orbit
    assert orbit.monodromy @ orbit.modes == pytest.approx(orbit.modes * orbit.multipliers, abs=1e-6)
    assert orbit.participation.sum(axis=0) == pytest.approx(1)
    # the body grows unstable; what dies out at once is the joint's own motion
    assert orbit.participation[:4, 0].sum() > 0.9
    assert orbit.participation[4:, -2:].sum() > 1.8


def test_only_dear_jacobians_are_reused(rigid_orbit, compliant_orbit):
    assert len(rigid_orbit.iterations) <= 5
    assert not any(step.jacobian_reused for step in rigid_orbit.iterations)
    assert any(step.jacobian_reused for step in compliant_orbit.iterations)


def monodromy_of_high_order(model, x0, step=1e-3):
    """Differences of eighth order, over a step so long that the noise of the flow is nothing."""
    weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
    columns = []
    for h in np.diag(step * model.state_scale):
        ends = [
            w * (model.flow(x0 + i * h, 0.0, model.period) - model.flow(x0 - i * h, 0.0, 0.25))
            for i, w in weights.items()
        ]
        columns.append(sum(ends) / h.max())
    return np.column_stack(columns)


def test_error_bounds_cover_what_differences_leave(compliant):
    orbit = find_limit_cycle(compliant, tolerance=1e-12, method="shooting")
    exact = np.linalg.eigvals(monodromy_of_high_order(compliant, orbit.x0))
    exact = exact[np.lexsort((-exact.imag, -np.abs(exact)))]
    errors = np.abs(orbit.multipliers - exact)
    assert (errors < orbit.multiplier_errors).all()
    assert errors.max() < 2e-9
    assert orbit.multiplier_errors.max() < 1e-7
