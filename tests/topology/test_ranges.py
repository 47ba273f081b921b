"""Every number has a range: what surely is a mistake is refused, what flies is not."""

import json

import numpy as np
import pytest

from birdmb.errors import TopologyError
from birdmb.topology import Bird, load_bird

from .conftest import TOPOLOGIES

TAILED = load_bird(TOPOLOGIES / "ibis_tail.toml")
HINGED = load_bird(TOPOLOGIES / "ibis_hinged_feathers.toml")
SPRUNG = load_bird(TOPOLOGIES / "ibis_compliant_shoulder.toml")

NUMBERS = {
    name: bird
    for bird in (TAILED, HINGED, SPRUNG)
    for name in bird.value_names()
    if type(bird.value(name)) in (float, int) and not name.endswith(".position")
}
# Where 0 is an ordinary number, next to nothing is, too.
ZERO_IS_ORDINARY = (
    *("root.x", "root.z", "apex.x", "apex.z", "offset", "amplitude", "phase", "rest", "rest_angle"),
    *("_deg", "incidence", "opening", "inertia_xz", "zero_lift_angle", "moment_coefficient"),
)


def refused(bird, name, value):
    try:
        changed = bird.with_values({name: value})
    except TopologyError as error:
        text = str(error)
        assert text.startswith(f"{bird.name} (with {name} = ")
        assert f": {name}: must be " in text
        assert "\n" not in text
        return True
    assert np.isfinite(changed.value(name))
    return False


@pytest.mark.parametrize("name", NUMBERS)
def test_the_absurd_is_refused(name):
    bird = NUMBERS[name]
    for value in (1e300, -1e20, float("nan"), 10**5000):
        assert refused(bird, name, value), value
    ordinary = name.endswith(ZERO_IS_ORDINARY) or ".shares." in name
    assert refused(bird, name, 5e-324) != ordinary


def test_the_sentence_says_what_would_be_right_and_why(ibis):
    with pytest.raises(TopologyError) as caught:
        ibis.with_values({"air.density": 1e300})
    assert str(caught.value) == (
        "ibis (with air.density = 1e+300): air.density: must be 0 or 1e-09 to 100000, not 1e+300 "
        "(density of the air, kg/m3; air has 1.2 kg/m3, water 1000)"
    )
    with pytest.raises(TopologyError, match=r"amplitude_deg: must be -1000 to 1000, not 1e\+30 "):
        ibis.with_values({"shoulder.flap.amplitude_deg": 1e30})
    with pytest.raises(TopologyError, match="discretisation: must be 2 to 1024, not 20000"):
        ibis.with_values({"wing.discretisation": 20_000})


def similar(bird, length):
    """The bird whose lengths are `length` times as long, similar in Froude number and density."""
    dimensions = {
        "mass": 3, "inertia": 5, "inertia_xx": 5, "inertia_yy": 5, "inertia_zz": 5, "x": 1, "y": 1,
        "z": 1, "half_thickness": 1, "length": 1, "centre_of_mass": 1, "frequency": -0.5,
        "stiffness": 4, "damping": 4.5, "chord": 1, "kinematic_viscosity": 1.5,
        "side_area": 2, "volume": 3,
    }  # fmt: skip
    values = {}
    for name in bird.value_names():
        power = dimensions.get(name.rpartition(".")[2])
        if power is not None and bird.value(name) is not None:
            values[name] = (np.array(bird.value(name)) * length**power).tolist()
    return bird.with_values(values)


@pytest.mark.parametrize("mass", [1e-9, 1e-6, 150.0, 1e5])
@pytest.mark.parametrize("bird", [TAILED, HINGED, SPRUNG], ids=lambda bird: bird.name)
def test_similar_birds_from_a_microgram_to_a_hundred_tonnes_are_birds(bird, mass):
    scaled = similar(bird, (mass / bird.total_mass) ** (1 / 3))
    assert scaled.total_mass == pytest.approx(mass)
    assert scaled.air.density == bird.air.density
    assert Bird.model_validate(scaled.model_dump()) == scaled


@pytest.mark.parametrize("density", [0.0, 1.225, 1000.0, 13_500.0])
def test_vacuum_water_and_mercury_are_media(ibis, density):
    assert ibis.with_values({"air.density": density}).air.density == density


def test_massless_wings_are_wings(ibis):
    light = ibis.with_values({f"segments.{bone}.mass": 1e-10 for bone in ("forearm", "hand")})
    none = ibis.with_values(
        {"segments.hand.mass": 0.0, "segments.hand.inertia": [0.0, 0.0, 0.0]},
    )
    assert light.total_mass > none.total_mass - 0.02


def test_an_inertia_of_next_to_nothing_is_none(ibis):
    with pytest.raises(TopologyError, match="next to nothing; 0 makes the segment a point mass"):
        ibis.with_values({"segments.hand.inertia": [5e-324, 5e-324, 5e-324]})
    tilted = 1e-6 * np.eye(3)
    tilted[0, 1] = tilted[1, 0] = 1e-45  # round-off of a rotation
    assert ibis.with_values({"segments.hand.inertia": tilted}).segments.hand.inertia[0][1] == 1e-45


BAD_NAMES = {
    "line break": ("a\nb", "has a control character"),
    "NUL": ("a\0b", "has a control character"),
    "escape": ("\x1b[31mred", "has a control character"),
    "bidirectional": ("a\u202eb", "has a control character"),
    "lone surrogate": ("a\ud800", "has a control character"),
    "empty": ("", "is no name"),
    "blank": ("  ", "is no name"),
    "long": ("x" * 101, "has 101 characters; it must have 100 or less"),
}


@pytest.mark.parametrize(("name", "says"), BAD_NAMES.values(), ids=BAD_NAMES)
def test_names_are_one_short_line(ibis, name, says):
    with pytest.raises(TopologyError) as caught:
        ibis.with_values({"name": name})
    assert says in str(caught.value)
    assert str(caught.value).isprintable()
    document = json.loads(ibis.model_dump_json())
    document["feathers"][0]["name"] = name
    with pytest.raises(ValueError, match="feathers"):
        Bird.model_validate(document)


@pytest.mark.parametrize("name", ["[/oops]", "a$b", "Θρησκιόρνις", "ibis, 4 Hz: {1}"])
def test_other_names_are_names(ibis, name):
    assert ibis.with_values({"name": name}).name == name
