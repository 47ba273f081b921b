"""Any periodic motion of a joint: one law, however it is given."""

import math

import numpy as np
import pytest

import birdmb
from birdmb.topology import Joint
from birdmb.topology.unused import unused_values
from birdmb.topology.writing import bird_text
from birdmb.wing.arrays import wing_arrays

FLAP = "shoulder.flap"
EVEN = np.arange(24) / 24
FINE = np.arange(5000) / 5000


def joint(**keys):
    return Joint.model_validate({"name": FLAP, "segment": "humerus", "axis": [-1, 0, 0]} | keys)


def driver(**keys):
    return joint(**keys).driver


def refusal(bird, **keys):
    with pytest.raises(birdmb.TopologyError) as caught:
        bird.with_joint(FLAP, **keys)
    return str(caught.value).partition(f"): {FLAP}.")[2]


def test_the_flap_of_a_measured_robot_is_exact():
    """Yeo et al. 2011: a series of sines and cosines up to the fourth harmonic."""
    flap = driver(
        offset=0.0354,
        amplitude=0.3793,
        harmonics=[
            {"order": 2, "cosine": -0.0322},
            {"order": 3, "sine": -0.0035},
            {"order": 4, "amplitude": 0.00046, "phase_deg": 90},
        ],
    )
    angle = 2 * np.pi * FINE
    expected = (
        0.0354
        + 0.3793 * np.sin(angle)
        - 0.0322 * np.cos(2 * angle)
        - 0.0035 * np.sin(3 * angle)
        + 0.00046 * np.cos(4 * angle)
    )
    np.testing.assert_allclose(flap.at(FINE), expected, atol=1e-15)
    assert flap.mean == 0.0354
    assert flap.fit is None


def test_one_motion_given_in_four_ways_has_the_same_arrays(ibis):
    sines = {"order": 2, "amplitude_deg": 4.0, "phase_deg": 25.0}
    both = {
        "order": 2,
        "cosine_deg": 4.0 * math.sin(math.radians(25.0)),
        "sine_deg": 4.0 * math.cos(math.radians(25.0)),
    }
    first = {"order": 1, "sine_deg": -42.0}
    cases = [ibis.with_joint(FLAP, harmonics=[sines]), ibis.with_joint(FLAP, harmonics=[both])]
    cases.append(ibis.with_joint(FLAP, amplitude=0.0, phase=0.0, harmonics=[both, first]))
    angles = cases[0].joint(FLAP).driver.at(EVEN)
    still = {"amplitude": 0.0, "phase": 0.0}
    cases.append(ibis.with_joint(FLAP, samples=angles, **still))
    uneven = np.delete(EVEN, [3, 9, 10])
    angles = cases[0].joint(FLAP).driver.at(uneven)
    cases.append(ibis.with_joint(FLAP, samples=angles, sample_phases=uneven, **still))
    expected = wing_arrays(cases[0])
    assert expected.cosine.shape == (6, 2)
    for bird in cases[1:]:
        for name in ("offset", "cosine", "sine"):
            found = getattr(wing_arrays(bird), name)
            np.testing.assert_allclose(found, getattr(expected, name), atol=1e-14)


@pytest.mark.parametrize("fraction", [0.3, 0.42, 0.5, 0.65, 0.7])
def test_the_downstroke_takes_its_part_of_the_beat(fraction):
    """From the largest to the smallest angle, about t = 0 where the plain sine's is."""
    uneven = driver(offset=0.1, amplitude=0.6, phase=math.pi, downstroke_fraction=fraction)
    ends = np.array([-fraction / 2, fraction / 2])
    np.testing.assert_allclose(uneven.at(ends), [0.7, -0.5], atol=1e-14)
    # The angle falls between these, and rises over all the rest of the beat.
    falling = uneven.at(np.linspace(*ends, 400))
    rising = uneven.at(np.linspace(ends[1], ends[0] + 1, 400))
    assert (np.diff(falling) < 0).all()
    assert (np.diff(rising) > 0).all()
    assert uneven.mean == 0.1
    assert uneven.at(np.zeros(1)) == pytest.approx(0.1, abs=1e-15)


def test_an_even_downstroke_is_the_plain_sine():
    plain = driver(amplitude=0.6, phase=0.3)
    even = driver(amplitude=0.6, phase=0.3, downstroke_fraction=0.5)
    np.testing.assert_allclose(even.at(FINE), plain.at(FINE), atol=1e-15)


def test_the_series_of_an_uneven_stroke_is_its_law():
    d, phase, tau = 0.35, 0.4, 2 * np.pi * FINE + 0.4 - np.pi
    uneven = driver(amplitude=0.6, phase=phase, downstroke_fraction=d)
    b = np.pi * (0.5 - d) / np.sin(np.pi * d)
    np.testing.assert_allclose(uneven.at(FINE), -0.6 * np.sin(tau + b * np.sin(tau)), atol=1e-15)


@pytest.mark.parametrize(
    "keys",
    [
        {"amplitude": 0.6, "phase": 0.2, "harmonics": [{"order": 3, "cosine": 0.1}]},
        {"amplitude": 0.6, "phase": 0.2, "downstroke_fraction": 0.4},
        {"samples": [0.1, 0.5, 0.4, -0.2, -0.3]},
    ],
)
def test_gain_enlarges_the_motion_about_its_mean(keys):
    plain, larger = driver(offset=0.2, **keys), driver(offset=0.2, gain=1.5, **keys)
    assert larger.mean == plain.mean
    swing = plain.at(FINE) - plain.mean
    np.testing.assert_allclose(larger.at(FINE) - larger.mean, 1.5 * swing, atol=1e-15)
    assert driver(offset=0.2, gain=0.0, **keys).is_still


def test_as_many_harmonics_as_the_samples_need():
    angle = 2 * np.pi * EVEN
    sine = driver(samples_deg=list(30 * np.sin(angle)))
    assert sine.fit.harmonics == 1
    assert sine.sine == pytest.approx([math.radians(30)], abs=1e-15)
    assert sine.fit.largest_residual < 1e-15
    two = 0.5 * np.sin(angle) + 0.01 * np.cos(5 * angle)
    assert driver(samples=list(two)).fit.harmonics == 5
    # 0.0005 is below 0.1 % of the range, 1.
    small = 0.5 * np.sin(angle) + 0.0005 * np.cos(5 * angle)
    fit = joint(samples=list(small)).driver_fit
    assert fit.harmonics == 1
    assert fit.largest_residual == pytest.approx(0.0005)
    assert fit.rms_residual == pytest.approx(0.0005 / math.sqrt(2))
    assert fit.truncation == pytest.approx(0.0005, rel=0.1)


def test_samples_of_one_angle_stand_still():
    still = driver(samples=[0.7] * 9)
    assert still.is_still
    assert still.mean == pytest.approx(0.7, abs=1e-15)
    assert still.fit.harmonics == 1


def triangle(phases):
    return 1 - 4 * np.abs(np.mod(phases, 1.0) - 0.5)


def sharp(phases):
    return np.exp(8 * (np.cos(2 * np.pi * phases) - 1))


@pytest.mark.parametrize("function", [triangle, sharp])
@pytest.mark.parametrize("count", [32, 65, 200])
@pytest.mark.parametrize("begin", [0.0, 0.4])
def test_the_truncation_error_is_known_within_a_factor_of_two(function, count, begin):
    """Of five samples or more a period of the last harmonic, wherever they begin."""
    phases = (np.arange(count) + begin) / count
    for harmonics in (1, 2, 3, 4, 6):
        series = driver(samples=list(function(phases)), sample_harmonics=harmonics)
        true = np.abs(series.at(FINE) - function(FINE + begin / count)).max()
        assert 0.5 < series.fit.truncation / true < 2.0
        assert series.fit.harmonics == harmonics == len(series.sine)


def test_uneven_samples_of_few_harmonics_are_met_exactly():
    phases = np.sort(np.random.default_rng(3).random(60))
    known = driver(offset=0.3, amplitude=0.5, harmonics=[{"order": 3, "sine": 0.2}])
    series = driver(samples=list(known.at(phases)), sample_phases=list(phases))
    np.testing.assert_allclose(series.at(FINE), known.at(FINE), atol=1e-13)


REFUSED = {
    "samples and amplitude": (
        {"samples": [0, 1, 0]},
        "amplitude: amplitude and samples do not",
    ),
    "harmonics and samples": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 0], "harmonics": [{"order": 2, "sine": 1}]},
        "harmonics: harmonics and samples do not go together",
    ),
    "a fraction and samples": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 0], "downstroke_fraction": 0.4},
        "downstroke_fraction: downstroke_fraction and samples do not go together",
    ),
    "a fraction and harmonics": (
        {"downstroke_fraction": 0.4, "harmonics": [{"order": 2, "sine": 1}]},
        "downstroke_fraction: downstroke_fraction and harmonics do not go together",
    ),
    "a fraction of a quarter": (
        {"downstroke_fraction": 0.25},
        "downstroke_fraction: must be 0.3 to 0.7, not 0.25",
    ),
    "two first harmonics": (
        {"harmonics": [{"order": 1, "sine": 1}]},
        "harmonics: order 1 and amplitude do not go together",
    ),
    "an order twice": (
        {"harmonics": [{"order": 2, "sine": 1}, {"order": 2, "cosine": 1}]},
        "harmonics: order 2 is given twice",
    ),
    "a harmonic in two ways": (
        {"harmonics": [{"order": 2, "sine": 1, "amplitude_deg": 3}]},
        "harmonics.2.sine: amplitude and sine do not go together; keep one way",
    ),
    "a harmonic of nothing": (
        {"harmonics": [{"order": 2, "phase": 1}]},
        "harmonics.2.amplitude: missing; a harmonic needs an amplitude, or cosine or sine",
    ),
    "a harmonic without an order": (
        {"harmonics": [{"sine": 1}]},
        "harmonics #1.order: missing; it should give how many periods a beat has",
    ),
    "half an order": (
        {"harmonics": [{"order": 1.5, "sine": 1}]},
        "harmonics #1.order: must be a whole number, not 1.5",
    ),
    "two samples": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1]},
        "samples: must be 3 to 1000 angles, not 2",
    ),
    "a text among samples": (
        {"samples_deg": [0, "x", 1]},
        'samples_deg #2: must be a number, not "x"',
    ),
    "an absurd sample": (
        {"samples_deg": [0, 1e6, 1]},
        "samples_deg #2: must be -1000 to 1000, not 1000000.0",
    ),
    "phases without samples": (
        {"sample_phases": [0, 0.5]},
        "sample_phases: sample_phases without samples says nothing",
    ),
    "too few phases": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 2], "sample_phases": [0, 0.5]},
        "sample_phases: must be as many as samples, 3, not 2",
    ),
    "phases that go back": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 2], "sample_phases": [0, 0.5, 0.4]},
        "sample_phases: must ascend",
    ),
    "a phase of 1": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 2], "sample_phases": [0, 0.5, 1.0]},
        "sample_phases #3: must be less than 1, not 1.0",
    ),
    "half of the beat": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 2], "sample_phases": [0, 0.1, 0.2]},
        "sample_phases: leave half of the beat or more without samples",
    ),
    "more harmonics than samples tell": (
        {"amplitude": 0, "phase": 0, "samples": [0, 1, 2, 1, 0], "sample_harmonics": 3},
        "sample_harmonics: must be 2 or less, not 3; the samples determine no more",
    ),
    "a file in Python": ({"gain": 2.0, "left": {"file": "x.csv"}}, "left.file: is a key of"),
}


@pytest.mark.parametrize(("keys", "says"), REFUSED.values(), ids=REFUSED)
def test_what_does_not_go_together_is_refused_in_a_sentence(ibis, keys, says):
    assert refusal(ibis, **keys).startswith(says)


def test_every_value_has_a_name(ibis):
    bird = ibis.with_joint(
        FLAP, harmonics=[{"order": 2, "amplitude_deg": 3.0}, {"order": 5, "sine": 0.1}]
    )
    assert bird.value(f"{FLAP}.harmonics.2.amplitude_deg") == pytest.approx(3.0)
    more = bird.with_values(
        {f"{FLAP}.harmonics.2.amplitude_deg": 5.0, f"{FLAP}.harmonics.5.sine": 0.2}
    )
    np.testing.assert_allclose(
        more.joint(FLAP).driver.amplitudes, [np.radians(42), np.radians(5), 0, 0, 0.2]
    )
    assert ibis.value(f"{FLAP}.gain") == 1.0
    assert ibis.value(f"{FLAP}.samples_deg") is None
    assert ibis.value(f"{FLAP}.left.downstroke_fraction") is None
    assert bird.with_values({f"{FLAP}.gain": 2.0}).value(f"{FLAP}.left.gain") == 2.0
    assert bird.with_values({f"{FLAP}.harmonics": []}).fingerprint() == ibis.fingerprint()
    with pytest.raises(birdmb.TopologyError, match="no value is called"):
        bird.with_values({f"{FLAP}.harmonics.3.sine": 0.1})


def test_put_back_values_change_nothing(ibis):
    for keys in (
        {"harmonics": [{"order": 2, "amplitude_deg": 3.0}]},
        {"amplitude": 0, "phase": 0, "samples_deg": [0, 3, 1], "sample_phases": [0, 0.4, 0.6]},
        {"downstroke_fraction": 0.4, "left": {"gain": 1.2}},
    ):
        bird = ibis.with_joint(FLAP, **keys)
        for name in bird.value_names():
            if name.startswith(FLAP) and not name.endswith((".left", ".right")):
                own = bird.side("left").joint(FLAP).driver
                same = bird.with_values({name: bird.value(name)}).side("left").joint(FLAP).driver
                np.testing.assert_allclose(same.at(EVEN), own.at(EVEN), atol=1e-15)


def test_a_written_driver_is_the_same(ibis, tmp_path):
    samples = 40 * np.sin(2 * np.pi * EVEN) + np.cos(4 * np.pi * EVEN)
    for keys in (
        {"harmonics": [{"order": 2, "amplitude_deg": 1.8, "phase_deg": 90.0}]},
        {"amplitude": 0, "phase": 0, "samples": np.radians(samples), "sample_harmonics": 2},
        {"amplitude": 0, "phase": 0, "samples_deg": np.round(samples), "gain": 0.9},
        {"downstroke_fraction": 0.4, "left": {"harmonics": []}},
    ):
        bird = ibis.with_joint(FLAP, **keys)
        path = tmp_path / "bird.toml"
        path.write_text(bird_text(bird))
        assert birdmb.load_bird(path).fingerprint() == bird.fingerprint()
    path.write_text(bird_text(ibis.with_joint(FLAP, amplitude=0, phase=0, samples_deg=[0, 3, 5])))
    assert "samples_deg = [0.0, 3.0, 5.0]" in path.read_text()


def test_keys_that_are_as_by_default_leave_no_trace_in_the_fingerprint(ibis):
    assert ibis.with_joint(FLAP, gain=1.0, harmonics=[]).fingerprint() == ibis.fingerprint()


def test_a_side_has_a_driver_of_its_own(ibis):
    bird = ibis.with_joint(
        FLAP, harmonics=[{"order": 2, "sine": 0.1}], left={"gain": 0.5}, right={"offset": 0.2}
    )
    left, right = (bird.joint(FLAP).on(side).driver for side in ("left", "right"))
    np.testing.assert_allclose(left.amplitudes, 0.5 * right.amplitudes)
    assert (left.mean, right.mean) == (0.0, 0.2)
    own = bird.with_values({f"{FLAP}.left.harmonics": [{"order": 3, "sine_deg": 2.0}]})
    assert own.value(f"{FLAP}.left.harmonics.3.sine_deg") == pytest.approx(2.0)
    changed = own.with_values({f"{FLAP}.left.harmonics.3.sine_deg": 4.0})
    assert changed.joint(FLAP).on("left").driver.amplitudes[2] == pytest.approx(np.radians(2.0))
    assert changed.joint(FLAP).on("right").driver == right
    with pytest.raises(birdmb.TopologyError, match=r"left\.downstroke_fraction: downstroke_frac"):
        bird.with_values({f"{FLAP}.left.downstroke_fraction": 0.4})


def test_what_has_no_effect_is_known(ibis):
    only = ibis.with_joint(FLAP, amplitude=0.0, harmonics=[{"order": 2, "sine": 0.1}])
    unused = unused_values(only)
    assert {f"{FLAP}.phase", f"{FLAP}.downstroke_fraction"} <= unused.keys()
    assert f"{FLAP}.gain" not in unused
    assert f"{FLAP}.gain" in unused_values(ibis.with_joint(FLAP, amplitude=0.0))
    silent = unused_values(ibis.with_joint(FLAP, left={"gain": 0.0}))
    assert {f"{FLAP}.left.amplitude", f"{FLAP}.left.phase_deg"} <= silent.keys()
    assert f"{FLAP}.amplitude" not in silent
