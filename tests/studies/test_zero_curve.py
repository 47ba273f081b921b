"""Curves of zeros against curves that are known."""

import numpy as np
import pytest

from birdmb.studies.errors import TrimError
from birdmb.studies.zero_curve import trace_zero


def test_an_ellipse_is_followed_all_the_way_round():
    """Through both its turns, until the number of points stops it."""
    curve = trace_zero(
        lambda x, y: (x / 2) ** 2 + y**2 - 1,
        (2.0, 0.01),
        ((-3.0, 3.0), (-1.5, 1.5)),
        max_points=100,
    )
    x, y = curve.points.T
    np.testing.assert_allclose((x / 2) ** 2 + y**2, 1, atol=1e-7)
    assert x.min() < -1.99
    assert y.min() < -0.99
    assert y.max() > 0.99
    assert curve.ends == ("the number of points allowed",) * 2


def test_it_goes_to_the_bounds():
    curve = trace_zero(lambda x, y: y - x**2, (0.0, 0.0), ((-1.0, 1.0), (-1.0, 2.0)), step=0.1)
    assert curve.ends == ("a bound", "a bound")
    np.testing.assert_allclose(sorted(curve.points[[0, -1], 0]), [-1, 1], atol=0.01)
    np.testing.assert_allclose(curve.points[:, 1], curve.points[:, 0] ** 2, atol=1e-7)


def test_it_ends_where_the_function_does():
    def function(x, y):
        if x > 0.5:
            raise TrimError("no flight here", {}, {})
        return y - np.sqrt(abs(0.6 - x))

    curve = trace_zero(function, (0.0, np.sqrt(0.6)), ((-1.0, 1.0), (-1.0, 2.0)))
    assert "no flight here" in curve.ends
    assert 0.45 < curve.points[:, 0].max() <= 0.5


def test_a_start_far_from_any_zero():
    with pytest.raises(ValueError, match="curve"):
        trace_zero(lambda x, y: x**2 + y**2 + 1, (0.1, 0.2), ((-1.0, 1.0), (-1.0, 1.0)))
