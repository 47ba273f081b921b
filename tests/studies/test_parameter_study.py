"""Parameter studies against single searches; failures and leaving validity are kept as texts."""

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb.figures import plot_multiplier_locus, plot_performance
from birdmb.studies import parameter_study

AMPLITUDE = "shoulder.flap.amplitude_deg"


@pytest.fixture(scope="module")
def study(coarse, quick):
    return parameter_study(coarse, AMPLITUDE, [38.0, 42.0, 46.0], quick)


def test_each_value_is_what_a_search_of_its_own_finds(coarse, quick, study):
    for value in (38.0, 46.0):
        cycle = birdmb.find_limit_cycle(quick(coarse.with_values({AMPLITUDE: value})))
        at = study.sel({AMPLITUDE: value})
        np.testing.assert_allclose(at.x0, cycle.x0, atol=1e-7)
        found = at.multiplier_real.values + 1j * at.multiplier_imag.values
        np.testing.assert_allclose(
            np.sort_complex(found), np.sort_complex(cycle.multipliers), atol=1e-6
        )
        assert at.mean_speed == pytest.approx(cycle.mean_speed, abs=1e-7)
        assert at.mean_climb_rate == pytest.approx(cycle.mean_climb_rate, abs=1e-7)
        assert at.path_angle == pytest.approx(cycle.path_angle, abs=1e-8)
        assert at.power == pytest.approx(cycle.power, abs=1e-6)
    assert (study.failure == "").all()
    assert list(study.x0.state.values) == ["u", "w", "q", "theta"]


def test_wider_wingbeats_fly_faster_and_climb(study):
    """Thesis, chapter 5."""
    assert (np.diff(study.mean_speed) > 0).all()
    assert (np.diff(study.mean_climb_rate) > 0).all()
    assert (np.diff(study.path_angle) > 0).all()


def test_unstable_multiplier_grows_with_the_longitudinal_margin(coarse, quick):
    """Thesis, chapter 5."""
    study = parameter_study(coarse, "wing.root.x", 0.15 * np.array([0.31, 0.33, 0.35]), quick)
    assert (np.diff(study.multiplier_real[:, 0]) > 0.02).all()
    assert (study.multiplier_real[:, 0] > 1).all()


def test_values_that_fail_stand_as_nan_with_their_reason(coarse, quick, study):
    failing = parameter_study(coarse, AMPLITUDE, [38.0, -400.0, "wide", 46.0], quick)
    np.testing.assert_array_equal(np.isnan(failing.mean_speed), [False, True, True, False])
    assert np.isnan(failing.x0[1]).all()
    assert all(failing.failure.values[1:3])
    np.testing.assert_allclose(failing.mean_speed[[0, 3]], study.mean_speed[[0, 2]], atol=1e-7)


def test_unknown_name_is_not_a_failure_of_every_value(coarse):
    with pytest.raises(birdmb.TopologyError, match="nearest"):
        parameter_study(coarse, "shoulder.flop", [1.0])


def test_leaving_validity_is_a_warning(ibis):
    """With the shoulders far aft the cycle that is found mushes at 70 deg to the wind."""
    study = parameter_study(ibis, "wing.root.x", [0.05, 0.03, 0.015])
    assert study.warning.values[0] == ""
    assert "no stall" in study.warning.values[2]
    assert (study.failure == "").all()


def test_dataset_survives_a_file(study, tmp_path):
    study.to_netcdf(tmp_path / "study.nc", engine="h5netcdf")
    xr.testing.assert_allclose(xr.load_dataset(tmp_path / "study.nc"), study)


def test_figures_show_every_value(study):
    performance = plot_performance(study)
    assert [len(axes.lines[0].get_xdata()) for axes in performance.axes] == [3, 3, 3, 3]
    locus = plot_multiplier_locus(study)
    assert len(locus.axes[1].collections[0].get_offsets()) == 12
