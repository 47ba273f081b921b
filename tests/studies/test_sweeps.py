"""Sweeps: one set of bits whatever computes them, stores that resume and grow, datasets."""

import re
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb.figures import plot_sweep
from birdmb.studies.sweeps import Study, SweepError, sweep
from birdmb.studies.sweeps.grid import Grid, parent
from birdmb.studies.sweeps.point import described
from birdmb.studies.sweeps.run import _Filling
from birdmb.studies.sweeps.tasks import KEPT_FOR_NEIGHBOURS, Outcome
from birdmb.studies.sweeps.verdicts import verdict_lines

from .sweeping import AMPLITUDE, GRID, IMPOSSIBLE, MASS, QUICK, Inline, coarse_bird

FLAP = "shoulder.flap"


@pytest.fixture(scope="module")
def inline(tmp_path_factory):
    """The grid, swept in this process."""
    store = tmp_path_factory.mktemp("inline") / "study.db"
    return sweep(coarse_bird(), GRID, store=store, executor=Inline(), model=QUICK)


def test_points_are_limit_cycles(inline):
    data = inline.to_xarray()
    for amplitude, mass in ((42.0, 1.1), (38.0, 1.3)):
        values = {AMPLITUDE: amplitude, MASS: mass}
        cycle = birdmb.find_limit_cycle(QUICK(coarse_bird().with_values(values)))
        at = data.sel(values)
        np.testing.assert_allclose(at.x0, cycle.x0, atol=1e-7)
        np.testing.assert_allclose(at.multiplier_real, cycle.multipliers.real, atol=1e-6)
        np.testing.assert_allclose(at.monodromy, cycle.monodromy, atol=1e-5)
        assert at.largest_modulus == pytest.approx(np.abs(cycle.multipliers[0]), abs=1e-6)
        assert at.time_constant == pytest.approx(1 / abs(cycle.exponents[0].real), rel=1e-5)
        assert at.power == pytest.approx(cycle.power, abs=1e-6)
        assert at.mean_climb_rate == pytest.approx(cycle.mean_climb_rate, abs=1e-7)
        assert at.residual < 1e-7
        assert at.stability == cycle.stability


def test_verdicts_count_the_error_bars(inline):
    values = {AMPLITUDE: 42.0, MASS: 1.1}
    cycle = birdmb.find_limit_cycle(QUICK(coarse_bird().with_values(values)))
    unsure = replace(cycle, multiplier_errors=np.abs(cycle.multipliers))
    kept = described(unsure)
    assert (described(cycle)["stability"], kept["stability"]) == ("unstable", "undecided")
    assert kept["multiplier_error"] == unsure.verdict_errors.tolist()
    data = inline.to_xarray(timings=True)
    data["stability"] = data.stability.astype("U9")
    data["stability"].loc[values] = "undecided"
    assert [line.split(":")[0] for line in verdict_lines(data)] == ["17 unstable", "1 undecided"]
    texts = [text.get_text() for text in plot_sweep(data, "power", {}).legends[0].texts]
    assert "undecided" in texts


def test_failing_points_are_outcomes_with_a_reason(inline):
    data = inline.to_xarray()
    failed = data[AMPLITUDE] == IMPOSSIBLE
    assert (data.status.sel({AMPLITUDE: IMPOSSIBLE}) == "failed").all()
    assert (data.status.sel({AMPLITUDE: ~failed}) == "found").all()
    assert all(
        "the wings swing through one another" in text
        for text in data.failure.sel({AMPLITUDE: IMPOSSIBLE}).values
    )
    assert np.isnan(data.x0.sel({AMPLITUDE: IMPOSSIBLE})).all()
    assert len(inline.failures) == 6
    # What comes after a failed point starts from what came before it.
    assert data.start.sel({AMPLITUDE: 38.0, MASS: 1.1}) == "[1, 0]"
    assert data.start.sel({AMPLITUDE: 42.0, MASS: 1.1}) == "cold"


def test_impossible_values_fail_alone(tmp_path):
    study = sweep(
        coarse_bird(),
        {MASS: [-1.0, 1.2, "heavy"]},
        store=tmp_path / "s.db",
        executor=Inline(),
        model=QUICK,
    )
    assert list(study.to_xarray().status.values) == ["failed", "found", "failed"]
    assert "body.mass: must be more than 0" in study.failures[0][1]


def test_bits_depend_neither_on_workers_nor_on_what_finishes_first(inline, tmp_path):
    with ThreadPoolExecutor(3) as threads:
        study = sweep(coarse_bird(), GRID, store=tmp_path / "t.db", executor=threads, model=QUICK)
    assert study.to_xarray().identical(inline.to_xarray())
    assert list(study.outcomes) == list(inline.outcomes)


@pytest.mark.long
def test_compliant_birds_have_the_same_bits_here_and_in_two_processes(ibis_compliant, tmp_path):
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 4})
    grid = {f"{FLAP}.stiffness": [60.0, 50.0, 40.0]}
    model = partial(birdmb.MultibodyModel, steps_per_beat=60)
    here, there = (
        sweep(bird, grid, store=tmp_path / f"{i}.db", workers=2, executor=executor, model=model)
        for i, executor in enumerate((Inline(), None))
    )
    assert not here.failures
    assert here.to_xarray().identical(there.to_xarray())


@pytest.mark.long
def test_warm_points_that_are_shot_need_few_flows(ibis_compliant, tmp_path, monkeypatch):
    """About seven steps, 12 flows for the Jacobian, 7 for its errors, 1 for each parameter."""
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 4})
    counts, flow = [], birdmb.MultibodyModel.flow

    def counted(model, *arguments):
        counts[-1] += 1
        return flow(model, *arguments)

    def begun(_point):
        counts.append(0)

    monkeypatch.setattr(birdmb.MultibodyModel, "flow", counted)
    study = sweep(
        bird,
        {f"{FLAP}.stiffness": [30.0, 27.0, 24.0, 21.0]},
        store=tmp_path / "s.db",
        executor=Inline(),
        model=partial(birdmb.MultibodyModel, steps_per_beat=60),
        method="shooting",
        on_point=begun,
    )
    data = study.to_xarray()
    assert (data.status == "found").all()
    # Two flows are those of the error of the integration; what it does to the multipliers takes a
    # Newton step or two on the orbit of twice the steps, and a Jacobian there by 12.
    assert max(counts[1:4]) <= 1 + 8 + 12 + 7 + 2 + 1 + 3 + 12
    for place in range(1, 4):
        model = partial(birdmb.MultibodyModel, steps_per_beat=60)(
            bird.with_joint("shoulder.flap", stiffness=float(data[f"{FLAP}.stiffness"][place]))
        )
        cold = birdmb.find_limit_cycle(model, method="shooting")
        warm = data.isel({f"{FLAP}.stiffness": place})
        np.testing.assert_allclose(warm.monodromy, cold.monodromy, atol=1e-6)
        assert np.abs(warm.largest_modulus - np.abs(cold.multipliers[0])) < 1e-8


def test_running_again_computes_what_is_missing(inline, tmp_path):
    class StopError(Exception):
        pass

    def stop(point):
        if point.done == 10:
            raise StopError

    store, computed = tmp_path / "s.db", []
    options = {"store": store, "executor": Inline(), "model": QUICK}
    with pytest.raises(StopError):
        sweep(coarse_bird(), GRID, **options, on_point=stop)
    half = Study.open(store)
    assert len(half.outcomes) == 10
    assert (half.to_xarray().status == "missing").sum() == 14
    assert half.plot().axes
    whole = sweep(coarse_bird(), GRID, **options, on_point=computed.append)
    assert [point.done for point in computed] == list(range(10, 25))
    assert whole.to_xarray().identical(inline.to_xarray())
    sweep(coarse_bird(), GRID, **options, on_point=computed.append)
    assert len(computed) == 15


def test_values_may_be_appended(inline, tmp_path):
    options = {"store": tmp_path / "s.db", "executor": Inline(), "model": QUICK}
    computed = []
    sweep(coarse_bird(), {AMPLITUDE: GRID[AMPLITUDE][:2], MASS: GRID[MASS][:5]}, **options)
    grown = sweep(coarse_bird(), GRID, **options, on_point=computed.append)
    assert len(computed) == 1 + 24 - 10
    assert grown.to_xarray().identical(inline.to_xarray())


def test_long_grids_are_no_square_of_work():
    """Which would take hours."""
    grid = Grid.of(coarse_bird(), {MASS: np.linspace(1.0, 2.0, 300_000)})
    assert grid.size == 300_000


def test_points_after_many_that_fail_are_found_their_neighbour_at_once():
    class Failing(Executor):
        def submit(self, _function, task):
            future = Future()
            found = task.values[MASS] == 1.0
            result = dict.fromkeys(KEPT_FOR_NEIGHBOURS) if found else None
            future.set_result(Outcome(result, "none", "cold", 0.0))
            starts.append(task.guess and task.guess.place)
            return future

    class Nowhere:
        class contents:  # noqa: N801
            points = {}  # noqa: RUF012

        def add(self, *_):
            pass

    starts = []
    grid = Grid.of(coarse_bird(), {MASS: np.linspace(1.0, 2.0, 20_000)})
    _Filling(coarse_bird(), QUICK, None, None, grid, Nowhere(), None).run(Failing(), None)
    assert starts == [None] + ["[0]"] * 19_999


def test_parents_are_near_known_before_and_independent_of_the_size():
    big, small = (Grid({"a": tuple(range(n)), "b": tuple(range(n))}) for n in (30, 7))
    parents = {place: parent(place) for place in big.places()}
    assert [place for place, before in parents.items() if before is None] == [(0, 0)]
    assert {place: parents[place] for place in small.places()} == {
        place: parent(place) for place in small.places()
    }
    depth = {(0, 0): 0}
    for place, before in parents.items():
        if before is not None:
            assert sum(abs(i - j) for i, j in zip(place, before, strict=True)) in (1, 4)
            depth[place] = depth[before] + 1
    assert max(depth.values()) == 18  # so that 900 points keep 40 workers busy


def test_texts_are_values_too_and_states_may_come_and_go(ibis_compliant, tmp_path):
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 4})
    study = sweep(
        bird,
        {f"{FLAP}.mode": ["prescribed", "compliant"]},
        store=tmp_path / "s.db",
        executor=Inline(),
        model=partial(birdmb.MultibodyModel, steps_per_beat=60),
    )
    data = study.to_xarray()
    assert list(data.state.values) == ["u", "w", "q", "theta", FLAP, f"{FLAP}.rate"]
    assert np.isnan(data.x0.sel({f"{FLAP}.mode": "prescribed"})).sum() == 2
    assert np.isfinite(data.monodromy.sel({f"{FLAP}.mode": "compliant"})).all()
    assert (data.start == "cold").all()
    labels = [text.get_text() for text in study.plot().axes[-1].get_xticklabels()]
    assert labels == ["prescribed", "compliant"]


def test_dataset_survives_a_file(inline, tmp_path):
    data = inline.to_xarray(timings=True)
    assert (data.seconds > 0).all()
    data.to_netcdf(tmp_path / "study.nc", engine="h5netcdf")
    xr.testing.assert_equal(xr.load_dataset(tmp_path / "study.nc"), data)


def test_stored_bird_varies_like_the_one_swept(inline):
    """Also where a default follows what is varied, as the middle of a bone does."""
    longer = {"segments.humerus.length": 0.2}
    again = inline.bird.with_values(longer)
    assert again.fingerprint() == coarse_bird().with_values(longer).fingerprint()


def test_maps_show_failures_and_quantities(inline):
    figure = inline.plot()
    assert [axes.get_ylabel() for axes in figure.axes[6:]] == [
        r"$|\Lambda|_\mathrm{max}$",
        "speed (m/s)",
        "climb rate (m/s)",
        "growth (s)",
        "wing power (W)",
        "cost of transport",
    ]
    assert [len(axes.patches) for axes in figure.axes[:6]] == [6] * 6
    assert re.search(r"18 unstable: \S+ to \S+ m/s, climbing \S+ to \S+ m/s", figure.get_suptitle())
    single = inline.plot("mean_speed")
    assert single.axes[0].get_xlabel() == r"$A_{\mathrm{flap}}$ (°)"
    with pytest.raises(SweepError, match=r"No quantity is called speed; there are .*mean_speed"):
        inline.plot("speed")


def test_maps_dot_flights_beyond_the_models_validity(inline):
    data = inline.to_xarray(timings=True)
    data["warning"][...] = ""
    axes = plot_sweep(data, "power", {}).axes[0]
    assert not any(len(line.get_xdata()) for line in axes.lines if line.get_marker() == "x")
    data["warning"].loc[{AMPLITUDE: 40.0, MASS: 1.15}] = "beyond"
    figure = plot_sweep(data, "power", {})
    (dots,) = (line for line in figure.axes[0].lines if line.get_marker() == "x")
    assert (list(dots.get_xdata()), list(dots.get_ydata())) == ([40.0], [1.15])
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert texts == ["computed flight", "no limit cycle found", "beyond the model's validity"]


def test_lines_where_one_parameter_is_left(inline):
    figure = inline.plot("power", at={MASS: 1.2})
    (axes,) = figure.axes
    assert axes.get_xlabel() == r"$A_{\mathrm{flap}}$ (°)"
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), sorted(GRID[AMPLITUDE]))
    assert list(axes.lines[-1].get_xdata()) == [IMPOSSIBLE]
    with pytest.raises(SweepError, match=r"does not take the value 1.21: 1.1, 1.15"):
        inline.plot(at={MASS: 1.21})
    with pytest.raises(SweepError, match="no parameter"):
        inline.plot(at={"body.mas": 1.21})
    with pytest.raises(SweepError, match="All parameters are fixed"):
        inline.plot(at={MASS: 1.2, AMPLITUDE: 42.0})


def test_more_than_two_parameters_must_be_fixed_for_a_picture(tmp_path):
    grid = {AMPLITUDE: [42.0, 40.0], MASS: [1.2, 1.3], "gait.frequency": [4.0, 4.1]}
    study = sweep(coarse_bird(), grid, store=tmp_path / "s.db", executor=Inline(), model=QUICK)
    with pytest.raises(SweepError, match="fix all but two"):
        study.plot()
    assert len(study.plot(at={"gait.frequency": 4.1}).axes) == 12
