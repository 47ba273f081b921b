"""The dimensionless numbers of a bird, and where they are outside the theory."""

from dataclasses import replace

import numpy as np
import pytest

from birdmb.studies.flight_regime import (
    FlightRegime,
    flight_regime,
    lift_excess,
    regime_warnings,
    wake_deficiency,
)
from birdmb.wing.outline import span_and_area


@pytest.fixture(scope="module")
def regime(ibis):
    return flight_regime(ibis)


def test_numbers_of_the_ibis(ibis, regime):
    span, area = span_and_area(ibis)
    chord, weight = area / span, 1.26 * 9.81
    assert regime.aspect_ratio == pytest.approx(span / chord)
    assert 0.5 * 0.5 * 1.225 * regime.speed**2 * area == pytest.approx(weight)
    assert regime.reynolds_number == pytest.approx(regime.speed * chord / 1.5e-5)
    assert regime.reduced_frequency == pytest.approx(2 * np.pi * 4.0 * chord / 2 / regime.speed)
    assert 0.15 < regime.strouhal_number < 0.4  # of an animal that cruises
    assert list(regime_warnings(regime)) == []


def test_what_is_not_carried_or_does_not_flap_has_no_such_numbers(ibis):
    for values in ({"gravity": 0.0}, {"air.density": 0.0}):
        regime = flight_regime(ibis.with_values(values))
        assert np.isnan([regime.speed, regime.reynolds_number, regime.reduced_frequency]).all()
        assert list(regime_warnings(regime)) == []
    still = {f"{joint}.amplitude": 0.0 for joint in ibis.joint_names}
    regime = flight_regime(ibis.with_values(still))
    assert np.isnan([regime.reduced_frequency, regime.strouhal_number]).all()
    assert regime.speed > 0


@pytest.mark.parametrize(
    ("values", "says"),
    [
        (
            {"span": 0.6, "area": 0.12},
            "the aspect ratio of the wings is 3, below 4: a lifting line",
        ),
        ({"reynolds_number": 9e3}, "the Reynolds number of the mean chord is 9e+03 at 14.9 m/s"),
        ({"reynolds_number": 2e7}, "nothing that flaps flies above 1e+07"),
        ({"reduced_frequency": 0.25}, "the reduced frequency is 0.25 at 14.9 m/s"),
    ],
)
def test_limits(regime: FlightRegime, values, says):
    (warning,) = regime_warnings(replace(regime, **values))
    assert says in warning
    assert "Check" in warning


def test_lift_excess_from_slender_to_endless_wings():
    """A slender wing's lift slope is pi A/2 (R. T. Jones), that of a lifting line pi A there."""
    assert lift_excess(1e-6) == pytest.approx(1.0, abs=1e-5)
    assert lift_excess(1e6) == pytest.approx(0.0, abs=1e-5)
    assert lift_excess(4.0) == pytest.approx(0.079, abs=5e-4)


@pytest.mark.parametrize(
    ("k", "real", "imaginary"),
    [(0.1, 0.8319, -0.1723), (0.2, 0.7276, -0.1886), (0.5, 0.5979, -0.1507)],
)
def test_theodorsens_function_is_that_of_the_tables(k, real, imaginary):
    assert wake_deficiency(k) == pytest.approx(complex(real, imaginary), abs=2e-4)
