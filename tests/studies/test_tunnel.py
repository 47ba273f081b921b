"""Loads of a held and of a free body."""

import numpy as np
import pytest

import birdmb
from birdmb.figures import plot_tunnel_and_free_flight
from birdmb.studies import tunnel_and_free_flight


def heavy_cycle(bird, quick, factor):
    """A body of the same weight that hardly moves: its mass times a factor, gravity over it."""
    heavy = bird.with_values(
        {
            "body.mass": factor * bird.body.mass,
            "body.inertia_yy": factor * bird.body.inertia_yy,
            "gravity": bird.gravity / factor,
        }
    )
    return birdmb.find_limit_cycle(quick(heavy), tolerance=1e-12)


def difference(cycle):
    data = tunnel_and_free_flight(cycle)
    return float(np.abs(data.force.sel(mount="free") - data.force.sel(mount="tunnel")).max())


def test_free_flight_balances_the_weight_on_average(coarse_cycle):
    """Of a rigid bird: change of momentum over a beat is none."""
    free = tunnel_and_free_flight(coarse_cycle).sel(mount="free").isel(time=slice(0, -1))
    assert float(free.thrust.mean()) == pytest.approx(0.0, abs=1e-3)
    assert float(free.lift.mean()) == pytest.approx(1.2 * 9.81, abs=1e-3)
    assert float(free.pitching_moment.mean()) == pytest.approx(0.0, abs=1e-4)
    assert float(free.wing_power.mean()) == pytest.approx(coarse_cycle.power)


def test_tunnel_holds_the_mean_state(coarse_cycle):
    data = tunnel_and_free_flight(coarse_cycle)
    held = data.body_state.sel(mount="tunnel")
    assert (held.std("time") < 1e-12).all()
    assert (held.sel(state="q") == 0).all()
    mean = coarse_cycle.beat.states[:-1].mean(axis=0)
    np.testing.assert_allclose(held[0].sel(state=["u", "w", "theta"]), mean[[0, 1, 3]])
    t, x = coarse_cycle.beat.times[4], np.array([mean[0], mean[1], 0.0, mean[3]])
    force = coarse_cycle.model.loads(t, x).force
    np.testing.assert_allclose(data.force.sel(mount="tunnel")[4], force)
    c, s = np.cos(mean[3]), np.sin(mean[3])
    world = data.sel(mount="tunnel").isel(time=4)
    assert [world.thrust, world.lift] == pytest.approx(
        [c * force[0] + s * force[2], s * force[0] - c * force[2]]
    )


def test_body_too_heavy_to_move_feels_the_same_in_both(coarse, quick):
    """The difference goes as one over the mass."""
    light, heavy = (difference(heavy_cycle(coarse, quick, factor)) for factor in (1e2, 1e3))
    assert heavy < 2e-3
    assert light / heavy == pytest.approx(10, rel=0.05)


def test_figure_shows_both(coarse_cycle):
    panels = plot_tunnel_and_free_flight(coarse_cycle).axes
    assert len(panels) == 4
    assert all(len(axes.get_legend().get_texts()) == 2 for axes in panels)
