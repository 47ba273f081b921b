"""The JSON schema and the page of the format say what `load_bird` takes."""

import copy
import tomllib
from pathlib import Path
from typing import ClassVar

import jsonschema
import pytest
from pydantic import Field, RootModel

from birdmb.errors import TopologyError
from birdmb.topology import Bird, load_bird
from birdmb.topology.format_page import format_page, page_of
from birdmb.topology.numbers import Angle, Length
from birdmb.topology.parts import Part
from birdmb.topology.schema import schema_of, topology_schema

from .conftest import TOPOLOGIES

PAGE = Path(__file__).parents[2] / "docs" / "format.md"
SHIPPED = sorted(TOPOLOGIES.glob("*.toml"))
IBIS = (TOPOLOGIES / "ibis.toml").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def validator():
    return jsonschema.Draft4Validator(topology_schema())


def test_it_is_a_schema_of_the_draft_that_editors_know_and_of_the_newest():
    schema = topology_schema()
    jsonschema.Draft4Validator.check_schema(schema)
    del schema["$schema"]
    jsonschema.Draft202012Validator.check_schema(schema)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_birds_are_valid(validator, path):
    document = tomllib.loads(path.read_text(encoding="utf-8"))
    assert list(validator.iter_errors(document)) == []


# what is edited in ibis.toml, all of which `load_bird` takes
OTHER_FORMS = {
    "all moments of inertia": ("inertia_yy = 0.1", "inertia = [0.02, 0.1, 0.11]"),
    "a tensor": ("inertia_yy = 0.1", "inertia = [[0.02, 0, 0], [0, 0.1, 0], [0, 0, 0.11]]"),
    "a number of elements": ('discretisation = "converged"', "discretisation = 12"),
    "a discretisation": (
        'discretisation = "converged"',
        'discretisation = { scheme = "orthogonal", elements = 12, rounding = 0.5 }',
    ),
    "no air": ("density = 1.225", "density = 0"),
    "one side": ("twist = true", "twist = true\nleft = { offset_deg = 5, phase = 1.0 }"),
    "a whole number": ("gravity = 9.81", "gravity = 10"),
}


@pytest.mark.parametrize(("old", "new"), OTHER_FORMS.values(), ids=OTHER_FORMS)
def test_what_files_may_have_besides(validator, tmp_path, old, new):
    assert old in IBIS
    text = IBIS.replace(old, new, 1)
    (tmp_path / "bird.toml").write_text(text, encoding="utf-8")
    load_bird(tmp_path / "bird.toml")
    assert list(validator.iter_errors(tomllib.loads(text))) == []


# what is edited in ibis.toml, all of which `load_bird` refuses
MISTAKES = {
    "unknown key": ("mass = 1.2", "mass = 1.2\nmas = 1"),
    "unknown table": ("[air]", "[aire]"),
    "missing key": ("mass = 1.2", ""),
    "text for a number": ("mass = 1.2", 'mass = "1.2"'),
    "number for a truth": ("twist = true", "twist = 1"),
    "negative": ("mass = 1.2", "mass = -1.2"),
    "out of range": ("density = 1.225", "density = 1e300"),
    "next to nothing": ("density = 1.225", "density = 1e-300"),
    "no choice": ('mode = "prescribed"', 'mode = "presscribed"'),
    "two numbers": ("axis = [0, 1, 0]", "axis = [0, 1]"),
    "both units": ("offset_deg = -19", "offset_deg = -19\noffset = 0.1"),
    "an angle out of range": ("offset_deg = -19", "offset_deg = -1e6"),
    "no moment": ("inertia_yy = 0.1", ""),
    "moments twice": ("inertia_yy = 0.1", "inertia_yy = 0.1\ninertia = [0.02, 0.1, 0.11]"),
    "preset": ('discretisation = "converged"', 'discretisation = "coarse"'),
    "one element": ('discretisation = "converged"', "discretisation = 1"),
    "share": ('shares = { "wrist.sweep" = 0.5 }', 'shares = { "wrist.sweep" = "half" }'),
    "half a tail": ("[gait]", "[tail]\napex = { x = -0.3 }\nchord = 0.3\n[gait]"),
    "inside out": ("[gait]", "[tail]\napex.x = -0.3\nchord = 0.3\nopening_deg = -1\n[gait]"),
}


@pytest.mark.parametrize(("old", "new"), MISTAKES.values(), ids=MISTAKES)
def test_mistakes(validator, tmp_path, old, new):
    assert old in IBIS
    text = IBIS.replace(old, new, 1)
    (tmp_path / "bird.toml").write_text(text, encoding="utf-8")
    with pytest.raises(TopologyError):
        load_bird(tmp_path / "bird.toml")
    assert list(validator.iter_errors(tomllib.loads(text)))


def test_every_key_says_what_it_means():
    schema = topology_schema()
    for part in (schema, *schema["definitions"].values()):
        for key, value in part.get("properties", {}).items():
            assert value.get("description"), key


def test_the_page_is_what_the_models_give_now():
    assert PAGE.read_text(encoding="utf-8") == format_page(), (
        "make it anew: birdmb schema --markdown --out docs/format.md"
    )


def test_the_page_has_every_key_of_every_bird():
    page = format_page()
    # The segments are tables by name, and no table themselves.
    tables = [d for d in topology_schema()["definitions"].values() if "properties" in d]
    assert page.count("| key |") == len(tables) + 1
    for key in Bird.model_fields:
        assert f"| `{key}` |" in page


class Harmonic(Part):
    """A harmonic of a motion."""

    angles: ClassVar[tuple[str, ...]] = ("amplitude",)

    order: int = Field(ge=2, description="its order")
    amplitude: Angle = Field(description="its amplitude; rad, degrees as amplitude_deg")


class Bar(Part):
    """A bar."""

    angles: ClassVar[tuple[str, ...]] = ("samples",)

    length: Length = Field(default=1.0, description="its length, m")
    samples: tuple[Angle, ...] | None = Field(
        default=None, description="angles; rad, degrees as samples_deg"
    )
    harmonics: tuple[Harmonic, ...] = Field(default=(), description="harmonics")


class Bars(RootModel[dict[str, Bar]]):
    """Bars by name."""


class Robot(Part):
    """A robot."""

    bars: Bars = Field(description="its bars")
    payload: Bar | None = Field(default=None, description="what it carries")


def test_parts_of_any_kind_are_told():
    """Of names of the user's, in lists, left out or not, with lists of angles."""
    schema = schema_of(Robot)
    validator = jsonschema.Draft4Validator(schema)
    document = {
        "bars": {
            "inner": {"samples_deg": [0, 10.5], "harmonics": [{"order": 2, "amplitude_deg": 1}]},
            "outer": {"length": 2},
        },
        "payload": {},
    }
    assert list(validator.iter_errors(document)) == []
    for place, wrong in (
        (("bars", "inner", "harmonics", 0), {"order": 2}),
        (("bars", "inner", "harmonics", 0), {"order": 1, "amplitude": 0.1}),
        (("bars", "inner", "samples_deg", 0), 1e6),
        (("bars", "outer"), {"lenght": 2}),
        (("payload",), 3),
    ):
        other = copy.deepcopy(document)
        *parents, last = place
        owner = other
        for part in parents:
            owner = owner[part]
        owner[last] = wrong
        assert list(validator.iter_errors(other)), place
    page = page_of(schema)
    for line in (
        "| `bars` | table of [Bar](#bar) by name | **required** | its bars |",
        "| `payload` | [Bar](#bar) | left out | what it carries |",
        "`[bars.NAME]`, `[payload]`. A bar.",
        "| `length` | number, 1e-9 to 10000 | `1` | its length, m |",
        "| `samples` or `samples_deg` | list of numbers, -1000 to 1000 | left out | angles; rad, "
        "degrees as samples_deg |",
        "| `harmonics` | list of [Harmonic](#harmonic) | left out | harmonics |",
        "`harmonics` of `[bars.NAME]`. A harmonic of a motion.",
    ):
        assert line in page.splitlines()


def test_drivers_by_files_and_harmonics(validator):
    for new in (
        'file = "flap.csv"',
        "samples_deg = [0, 40, 0, -40]",
        "harmonics = [{ order = 2, amplitude_deg = 1.8, phase_deg = 90 }]",
        'left = { file = "left.csv" }',
    ):
        document = tomllib.loads(IBIS.replace("amplitude_deg = 42", new, 1))
        assert list(validator.iter_errors(document)) == [], new
