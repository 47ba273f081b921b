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
from birdmb.studies.tail import OPENING
from birdmb.studies.tail_price import price_of_stability

SWEEP = "shoulder.sweep.offset_deg"
AMPLITUDE = "shoulder.flap.amplitude_deg"
ROLL = "forearm.roll.offset_deg"
RULES = {"mean_pitch": np.radians(6.0), ROLL: 12.0}
GRID = {
    SWEEP: [-15.0, -9.0],
    AMPLITUDE: [45.0, 39.0, 33.0],
    OPENING: [0.0, 12.0, 24.0, 36.0],
}


@pytest.fixture(scope="module")
def bird(ibis_tail):
    return ibis_tail.with_values({"wing.discretisation.elements": 8})


@pytest.fixture(scope="module")
def flights(bird, tmp_path_factory):
    """A study of 2 x 3 x 4 flights."""
    store = tmp_path_factory.mktemp("study") / "tail.db"
    return study.tail_study(bird, store, GRID, workers=2)


def test_its_ranges_are_told_from_the_bird(ibis_tail, ibis):
    ranges = study.tail_ranges(ibis_tail)
    assert list(ranges) == [SWEEP, AMPLITUDE, OPENING]
    assert (ranges[SWEEP][0], ranges[SWEEP][-1]) == pytest.approx((-17.5, -11.5))
    assert (ranges[AMPLITUDE][0], ranges[AMPLITUDE][-1]) == pytest.approx((46.2, 29.4))
    assert (ranges[OPENING][0], ranges[OPENING][-1]) == (0.0, 45.0)
    with pytest.raises(birdmb.TopologyError, match="no tail"):
        study.tail_ranges(ibis)


def test_any_bird_with_a_tail_can_be_studied(tmp_path):
    """A robot with one joint a wing, whose flap is a Fourier series; levelled by its tail."""
    bird = birdmb.load_bird("flapping_robot").with_values({"wing.discretisation": 8})
    trim = {"tail.incidence_deg": (-15.0, 15.0)}
    found = study.tail_study(bird, tmp_path / "x.db", trim=trim, every=8, workers=1)
    data = found.to_xarray()
    assert study.gait_parameters(data) == ["shoulder.flap.gain"]
    level = (data.status == "found").values
    assert level.any()
    np.testing.assert_allclose(data.mean_climb_rate.values[level], 0.0, atol=1e-5)
    for draw in (plot_manifold, plot_pareto):
        assert draw(data, {}).axes


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
    again = study.tail_study(bird, flights.path, GRID, workers=1)
    xr.testing.assert_identical(again.to_xarray(), flights.to_xarray())


def test_limits(flights):
    data = flights.to_xarray()
    allowed = study.within_limits(data, RULES)
    kept = data.where(allowed)
    assert float(np.abs(np.degrees(kept.mean_pitch)).max()) <= 6
    assert float(np.abs(kept[ROLL]).max()) <= 12
    left_out = data.where(~allowed & (data.status == "found"))
    beyond = (np.abs(np.degrees(left_out.mean_pitch)) > 6) | (np.abs(left_out[ROLL]) > 12)
    assert int(beyond.sum()) == int((~allowed & (data.status == "found")).sum())
    furled = study.within_limits(data, study.VALID).sel({OPENING: 0.0})
    assert (furled == (data.status == "found").sel({OPENING: 0.0})).all()
    with pytest.raises(birdmb.ArgumentError, match="mean_yaw"):
        study.within_limits(data, {"mean_yaw": 1.0})


def test_pareto_front():
    cost = np.array([1.0, 2.0, 1.5, np.nan, 1.5, 3.0, 1.0])
    modulus = np.array([1.3, 1.0, 1.1, 0.5, 1.2, 1.0, 1.4])
    assert study.pareto_front(cost, modulus).tolist() == [0, 2, 1]
    assert study.pareto_front(np.array([np.nan]), np.array([1.0])).size == 0


def priced(stability, **changes):
    """Prices at 10 and 11 m/s of flights at two sweeps and two openings, of linear cost."""
    dims = (SWEEP, OPENING)
    grid = {
        "cost_of_transport": [[1.0, 1.2], [1.4, 1.8]],
        "mean_speed": [[9.0, 9.5], [11.0, 11.5]],
        "stability": stability,
        "status": [["found"] * 2] * 2,
        "largest_tail_angle": [[0.0, 0.0], [0.0, 0.0]],
    } | changes
    data = xr.Dataset(
        {name: (dims, np.array(values)) for name, values in grid.items()}
        | {"sheet_jump": ((*dims, "along"), np.zeros((2, 2, 2), dtype=bool))},
        coords={SWEEP: [-15.0, -14.0], OPENING: [0.0, 30.0], "along": list(dims)},
    )
    # Whatever the order in which the values were flown.
    return price_of_stability(data.isel({SWEEP: [1, 0]}), speeds=[10.0, 12.0])


def test_price_of_stability_is_at_one_speed():
    """10 m/s lies half-way at the furled tail and a quarter of the way at the open one."""
    (row,) = priced([["unstable", "stable"], ["unstable", "stable"]])
    assert row.speed == 10.0
    assert row.cheapest == pytest.approx(1.2)
    assert row.cheapest_stable == pytest.approx(1.35)
    assert row.opening == pytest.approx(30.0)
    assert row.price == pytest.approx(0.125)


def test_what_is_unstable_or_beyond_the_limits_is_not_interpolated():
    (row,) = priced([["unstable", "stable"], ["unstable", "unstable"]])
    assert np.isnan([row.cheapest_stable, row.opening, row.price]).all()
    (row,) = priced([["stable"] * 2] * 2, largest_tail_angle=[[0.0, 0.0], [0.1, 0.0]])
    assert row.cheapest == pytest.approx(1.35)


def test_price_of_a_study(flights):
    rows = price_of_stability(flights.to_xarray(), limits={})
    assert rows
    for row in rows:
        assert row.speed % 0.5 == 0.0
        assert not row.cheapest_stable < row.cheapest


@pytest.mark.long
def test_stability_openings(bird):
    """Each point of the curve: a level flight whose leading multiplier is on the unit circle."""
    (found,) = birdmb.stability_openings(bird, {AMPLITUDE: (36.0, 40.0)}, {SWEEP: [-13.0]}, seeds=1)
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


def test_stability_openings_are_over_one_parameter(bird):
    with pytest.raises(birdmb.ArgumentError, match="one parameter"):
        birdmb.stability_openings(bird, {AMPLITUDE: (36.0, 40.0), SWEEP: (-15.0, -9.0)})


@pytest.mark.parametrize("draw", [plot_manifold, plot_envelope, plot_pareto])
def test_figures(flights, draw):
    assert draw(flights.to_xarray(), limits=RULES).axes


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"every": 0}, "every"),
        ({"vary": {AMPLITUDE: [40.0, 42.0]}}, "tail.opening_deg"),
        ({"vary": {OPENING: [0.0, 10.0]}}, "one or two other"),
    ],
)
def test_impossible_studies(bird, tmp_path, options, sentence):
    with pytest.raises(birdmb.ArgumentError, match=sentence):
        study.tail_study(bird, tmp_path / "x.db", **options)
