"""Neighbours on different sheets of flights are marked, no others; verdicts name the speed."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb.figures import plot_sweep
from birdmb.studies.sweeps import Trimming, sweep
from birdmb.studies.sweeps.grid import Grid
from birdmb.studies.sweeps.jumps import jumps, neighbours_apart
from birdmb.studies.sweeps.point import described
from birdmb.studies.sweeps.tasks import Guess
from birdmb.studies.sweeps.verdicts import jump_lines, verdict_lines

from .sweeping import AMPLITUDE, MASS, QUICK, Inline, coarse_bird

MASSES = [1.1, 1.2, 1.3, 1.35]
# The coarse ibis at 1.2 kg falls tail first at 4.4 m/s, where it also flies at 18 m/s.
FALLING = {"u": -0.97749751, "w": -4.18085694, "q": -0.32614878, "theta": 1.21899655}
NO_TURNS = np.array([np.inf])


class Derailed(Inline):
    """Starts one point from another flight than its neighbour's."""

    def __init__(self, mass):
        self._mass = mass

    def submit(self, function, /, task):
        if task.values[MASS] == self._mass and task.guess is not None:
            model = task.model(task.bird.with_values(task.values))
            falling = birdmb.find_limit_cycle(model, list(FALLING.values()))
            flight = described(falling) | {"trimmed": {}, "sensitivity": {}}
            guess = Guess(task.guess.place, task.guess.values, flight)
            task = replace(task, guess=guess)
        return super().submit(function, task)


@pytest.fixture(scope="module")
def derailed(tmp_path_factory):
    """A sweep of which the second last point is on another sheet."""
    store = tmp_path_factory.mktemp("derailed") / "study.db"
    vary = {MASS: MASSES, AMPLITUDE: [42.0]}
    return sweep(coarse_bird(), vary, store=store, executor=Derailed(1.3), model=QUICK)


def test_neighbours_on_different_sheets_are_marked_and_no_others(derailed):
    data = derailed.to_xarray()
    here, there = {MASS: 1.2, AMPLITUDE: 42.0}, {MASS: 1.3, AMPLITUDE: 42.0}
    assert data.mean_speed.sel(here) > 17
    assert data.mean_speed.sel(there) < 5
    assert neighbours_apart(data) == [(here, there)]
    (count, pair) = jump_lines(data)
    assert count.startswith("1 pair of neighbours lies on different flights")
    assert "body.mass = 1.2, shoulder.flap.amplitude_deg = 42 (unstable, 17.96 m/s" in pair
    # What falls tail first is not resolved by so few steps: its verdict is left open.
    assert verdict_lines(data) == [
        "2 unstable: 17.81 to 17.96 m/s, climbing -0.062 to +0.031 m/s",
        "2 undecided: 4.621 to 4.751 m/s, climbing +0.52 to +0.54 m/s, 2 of them backwards",
    ]
    assert data.flight.values.ravel().tolist() == ["forwards"] * 2 + ["backwards"] * 2


def test_jumps_survive_a_file_and_are_drawn(derailed, tmp_path):
    data = derailed.to_xarray()
    data.to_netcdf(tmp_path / "study.nc", engine="h5netcdf")
    xr.testing.assert_equal(xr.load_dataset(tmp_path / "study.nc"), data)
    figure = derailed.plot("mean_speed")
    (axes,) = figure.axes
    assert [line.get_xdata()[0] for line in axes.lines[-2:-1]] == [pytest.approx(1.25)]
    assert "2 undecided: 4.621 to 4.751 m/s" in figure.get_suptitle()
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert texts == ["unstable", "undecided", "flies backwards", "neighbours on different flights"]


def test_maps_draw_a_line_between_the_cells(derailed):
    """Over two values of the amplitude, of which the second has the same flights."""
    data = derailed.to_xarray(timings=True)
    wide = xr.concat([data, data.assign_coords({AMPLITUDE: [44.0]})], AMPLITUDE)
    plane = wide.transpose(MASS, AMPLITUDE, ...)
    plane.attrs = data.attrs
    axes = plot_sweep(plane, "mean_speed", {}).axes[0]
    drawn = [line.get_xydata().tolist() for line in axes.lines if len(line.get_xdata()) == 2]
    assert drawn == [[[1.25, 41.0], [1.25, 43.0]], [[1.25, 43.0], [1.25, 45.0]]]


def test_sensitivities_are_difference_quotients_of_flights(derailed):
    result = derailed.outcomes[(1, 0)].result
    for name, value, step in ((MASS, 1.2, 1e-3), (AMPLITUDE, 42.0, 1e-2)):
        ends = [
            birdmb.find_limit_cycle(
                QUICK(coarse_bird().with_values({MASS: 1.2, AMPLITUDE: 42.0} | {name: value + h}))
            ).x0
            for h in (-step, step)
        ]
        quotient = (ends[1] - ends[0]) / (2 * step) / result["state_scale"]
        size = np.abs(quotient).max()
        np.testing.assert_allclose(result["sensitivity"][name], quotient, atol=0.05 * size)


def test_trimmed_flights_answer_with_what_trims_them(ibis_tail, tmp_path):
    """The roll that keeps the flight level follows the amplitude."""
    bird, roll = (
        ibis_tail.with_values({"wing.discretisation.elements": 8}),
        "forearm.roll.offset_deg",
    )
    study = sweep(
        bird,
        {AMPLITUDE: [44.0, 43.8, 43.6]},
        store=tmp_path / "s.db",
        executor=Inline(),
        model=QUICK,
        trim=Trimming({roll: (-30.0, 30.0)}),
    )
    data = study.to_xarray()
    z = np.column_stack([data.x0.values / [10.0, 2.0, 1.0, 0.2], data[roll].values / 60.0])
    answer = study.outcomes[(1,)].result["sensitivity"][AMPLITUDE]
    quotient = (z[0] - z[2]) / 0.4
    np.testing.assert_allclose(answer, quotient, atol=0.03 * np.abs(quotient).max())
    assert not data.sheet_jump.any()


def test_values_without_neighbours_or_numbers_have_no_jumps(tmp_path):
    study = sweep(
        coarse_bird(),
        {"shoulder.flap.phase_deg": [90.0, 0.0], "wing.discretisation": [8, 9]},
        store=tmp_path / "s.db",
        executor=Inline(),
        model=QUICK,
    )
    assert not study.to_xarray().sheet_jump.any()


def marked(z, slopes, values):
    return jumps(np.array(z)[:, None], np.array(slopes), values, 0, NO_TURNS).tolist()


def test_a_steep_sheet_is_no_jump():
    """z = 1/k over a factor of 30, given from large to small: ten times the change at each step."""
    k = [60.0, 20.0, 6.0, 2.0]
    assert marked([1 / x for x in k], [1 / x**2 for x in k], k) == [False] * 4


def test_a_fold_is_no_jump_and_what_lies_beyond_it_is():
    """z^2 = p up to the fold at p = 0, and another sheet, on which z = -3."""
    p = [0.4, 0.25, 0.1, 0.01]
    z, slopes = list(np.sqrt(p)), list(0.5 / np.sqrt(p))
    assert marked(z, slopes, p) == [False] * 4
    assert marked([*z, -3.0], [*slopes, 0.1], [*p, -0.1]) == [False, False, False, False, True]
    # Marked at the smaller value; a single point on the other sheet is apart from both neighbours.
    assert marked([1.0, -3.0, 1.2], [1.0, 0.1, 1.0], [0.0, 0.1, 0.2]) == [True, True, False]


def test_two_points_and_one_known_slope_are_enough():
    assert marked([1.0, 2.0], [1.0, np.nan], [0.0, 0.1]) == [True, False]
    assert marked([1.0, 1.1], [1.0, np.nan], [0.0, 0.1]) == [False, False]
    assert marked([1.0, 2.0], [np.nan, np.nan], [0.0, 0.1]) == [False, False]
    assert marked([1.0, np.nan], [1.0, np.nan], [0.0, 0.1]) == [False, False]
    # What no parameter moves differs by round-off.
    assert marked([1.0, 1.0 + 1e-9], [0.0, 0.0], [0.0, 0.1]) == [False, False]


def test_a_whole_turn_leaves_the_flight_what_it_is():
    z = np.array([[0.1], [0.1 - 2 * np.pi]])
    slopes, turns = np.full(2, 0.1), np.array([2 * np.pi])
    assert not jumps(z, slopes, [0.0, 1.0], 0, turns).any()
    assert jumps(z, slopes, [0.0, 1.0], 0, NO_TURNS).any()


def test_steps_do_not_depend_on_what_is_appended():
    few, more = Grid({"a": (3.0,), "b": ("x", "y")}), Grid({"a": (3.0, 2.0), "b": ("x", "y")})
    assert few.steps((0, 1)) == more.steps((0, 1)) == {"a": pytest.approx(0.03)}
    assert more.steps((1, 0)) == {"a": pytest.approx(0.01)}
    assert Grid({"a": (0.0, True)}).steps((0,)) == {}
