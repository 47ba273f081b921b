"""Polars and stall in topology files: what is refused, and what is written and read again."""

import pytest

from birdmb import TopologyError, load_bird

POLAR = {
    "angle_deg": [-90, -12, -8, 0, 8, 12, 90],
    "lift": [0, -0.9, -0.87, 0, 0.87, 0.9, 0],
    "drag": [1.9, 0.03, 0.01, 0.01, 0.01, 0.03, 1.9],
}


def changed(**lists):
    return {"wing.profile.polar": {**POLAR, **lists}}


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"wing.profile.stall": {"width_deg": 3}}, "without a polar it tells when flow separates"),
        ({"wing.profile.stall": {"angle_deg": 0}}, "must be more than 0, not 0"),
        (changed(lift=[0, -0.9, -0.87, 0, 1.2, 0.9, 0]), r"lift_slope of 8\.594 or more"),
        (changed(lift=[0, -0.9, -0.87, 0.2, 0.87, 0.9, 0]), "the zero_lift_angle of its polar"),
        (changed(lift=[0, 1]), "2 entries for 7 angles"),
        (changed(drag=[1.9, 0.03, 0.01, -0.01, 0.01, 0.03, 1.9]), "must be 0 or more, not -0.01"),
        (changed(angle_deg=[-90, -12, -8, 0, 8, 8, 90]), "must ascend from angle to angle"),
        (changed(angle_deg=[-90, -12, -8, 0, 8, 12, 190]), "must be -3.14159 to 3.14159, not 190"),
        ({**changed(), "drag.profile_coefficient": 0.02}, "keep one of the two"),
    ],
)
def test_what_makes_no_section_is_refused_in_a_sentence(ibis, values, sentence):
    with pytest.raises(TopologyError, match=sentence):
        ibis.with_values(values)


def test_a_polar_and_a_stall_angle_do_not_go_together(ibis):
    bird = ibis.with_values({"wing.profile.stall": {"angle_deg": 12}})
    with pytest.raises(TopologyError, match=r"wing\.profile\.stall\.angle.*given beside a polar"):
        bird.with_values(changed())


def test_a_bird_that_stalls_is_written_and_read_again(ibis, tmp_path):
    bird = ibis.with_values(changed()).with_values({"wing.profile.stall": {"time_constant": 6.0}})
    read = load_bird(bird.save(tmp_path / "bird.toml"))
    assert read.fingerprint() == bird.fingerprint()
    assert read.stalls
    assert not ibis.stalls
    assert read.with_values({"wing.profile.stall.time_constant": 3.0}).value(
        "wing.profile.stall.time_constant"
    ) == pytest.approx(3.0)
