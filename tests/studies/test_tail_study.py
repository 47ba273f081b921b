"""The study of tail opening and gait, on a coarse wing."""

from functools import partial

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb.figures import (
    plot_envelope,
    plot_manifold,
    plot_pareto,
    plot_stability_openings,
)
from birdmb.studies import tail as study
from birdmb.studies.tail import AMPLITUDE, OPENING, ROLL, SWEEP


@pytest.fixture(scope="module")
def bird(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation.elements": 8})


@pytest.fixture(scope="module")
def flights(bird, tmp_path_factory):
    """A study of 2 x 3 x 4 flights."""
    store = tmp_path_factory.mktemp("study") / "tail.db"
    return study.tail_study(bird, store, every=12, workers=2)


def test_it_covers_the_ranges_of_the_thesis():
    every = {}

    def noted(_bird, vary, **_options):
        every.update(vary)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(study, "sweep", noted)
        study.tail_study(None, "")
    assert [len(values) for values in every.values()] == [13, 33, 46]
    assert np.prod([len(values) for values in every.values()]) == 19734
    ends = {name: sorted((values[0], values[-1])) for name, values in every.items()}
    assert ends == {SWEEP: [-15, -9], AMPLITUDE: [29, 45], OPENING: [0, 45]}


def test_flights_are_level(flights):
    data = flights.to_xarray()
    assert (data.status == "found").sum() > 12
    found = data.mean_climb_rate.values[(data.status == "found").values]
    np.testing.assert_allclose(found, 0.0, atol=1e-6)
    assert np.isfinite(data[ROLL].values[(data.status == "found").values]).all()


def test_a_point_agrees_with_a_trim_of_its_own(bird, flights):
    data = flights.to_xarray()
    at = {SWEEP: -15.0, AMPLITUDE: 45.0, OPENING: 12.0}
    alone = birdmb.trim_flight(
        bird.with_values(at),
        {ROLL: (-30.0, 30.0)},
        model=partial(birdmb.RigidModel, steps_per_beat=30),
    )
    assert float(data[ROLL].sel(at)) == pytest.approx(alone.values[ROLL], abs=1e-4)
    modulus = np.abs(alone.cycle.multipliers).max()
    assert float(data.largest_modulus.sel(at)) == pytest.approx(modulus, abs=1e-6)


def test_a_study_that_was_begun_goes_on(bird, flights):
    again = study.tail_study(bird, flights.path, every=12, workers=1)
    xr.testing.assert_identical(again.to_xarray(), flights.to_xarray())


def test_rules(flights):
    data = flights.to_xarray()
    allowed = study.within_rules(data)
    kept = data.where(allowed)
    assert float(np.abs(np.degrees(kept.mean_pitch)).max()) <= 6
    assert float(np.abs(kept[ROLL]).max()) <= 12
    left_out = data.where(~allowed & (data.status == "found"))
    beyond = (np.abs(np.degrees(left_out.mean_pitch)) > 6) | (np.abs(left_out[ROLL]) > 12)
    assert int(beyond.sum()) == int((~allowed & (data.status == "found")).sum())


def test_pareto_front():
    cost = np.array([1.0, 2.0, 1.5, np.nan, 1.5, 3.0, 1.0])
    modulus = np.array([1.3, 1.0, 1.1, 0.5, 1.2, 1.0, 1.4])
    assert study.pareto_front(cost, modulus).tolist() == [0, 2, 1]
    assert study.pareto_front(np.array([np.nan]), np.array([1.0])).size == 0


def test_price_of_stability():
    """Two ranges of speed: in the first stability costs a tenth, in the second there is none."""
    dims = (SWEEP, OPENING)
    grid = {
        "cost_of_transport": [[1.0, 1.1], [2.0, 0.1]],
        "mean_speed": [[10.2, 10.9], [11.5, 11.6]],
        "stability": [["unstable", "stable"], ["undecided", "stable"]],
        "mean_pitch": [[0.0, 0.0], [0.0, 0.5]],  # rad; the last one is excluded
        ROLL: [[0.0, 0.0], [0.0, 0.0]],
    }
    data = xr.Dataset(
        {name: (dims, np.array(values)) for name, values in grid.items()},
        coords={SWEEP: [-15.0, -14.0], OPENING: [0.0, 30.0]},
    )
    slow, fast = study.price_of_stability(data)
    assert (slow.slowest, slow.cheapest, slow.cheapest_stable, slow.opening) == (10, 1.0, 1.1, 30)
    assert (fast.slowest, fast.cheapest) == (11, 2.0)
    assert np.isnan([fast.cheapest_stable, fast.opening]).all()


@pytest.mark.long
def test_stability_openings(bird):
    """Each point of the curve: a level flight whose leading multiplier is on the unit circle."""
    (found,) = study.stability_openings(bird, [-13.0], amplitudes=(36.0, 40.0), seeds=1)
    (curve,) = found.curves
    assert (np.diff(curve.points[:, 0]) != 0).all()
    for amplitude, opening in curve.points[:: len(curve.points) // 2]:
        trim = birdmb.trim_flight(
            bird.with_values({SWEEP: -13.0, AMPLITUDE: amplitude, OPENING: opening}),
            {ROLL: (-30.0, 30.0)},
            model=partial(birdmb.RigidModel, steps_per_beat=30),
        )
        assert np.abs(trim.cycle.multipliers).max() == pytest.approx(1.0, abs=1e-4)
        assert trim.cycle.mean_climb_rate == pytest.approx(0.0, abs=1e-6)
    figure = plot_stability_openings([found], "bird")
    assert len(figure.axes) == 1


@pytest.mark.parametrize("draw", [plot_manifold, plot_envelope, plot_pareto])
def test_figures(flights, draw):
    assert draw(flights.to_xarray()).axes


def test_every_must_be_positive(bird, tmp_path):
    with pytest.raises(birdmb.BirdmbError, match="every"):
        study.tail_study(bird, tmp_path / "x.db", every=0)
