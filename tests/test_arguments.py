"""Wrong arguments are refused by one sentence that says what would be right."""

import inspect
import math
import subprocess
import sys
from types import SimpleNamespace
from typing import get_type_hints

import numpy as np
import pytest
import xarray as xr

import birdmb
from birdmb.arguments import checked
from birdmb.errors import ArgumentTypeError

# Of exceptions and of what only the program makes, nobody gives the arguments.
MADE_BY_THE_PROGRAM = {
    *("Beat", "Bird", "Branch", "Flight", "FlightCycle", "FloquetResult", "JointMotion"),
    *("KinematicsFit", "LimitCycle", "Loads", "MemoryEffect", "MovingWingLoads", "ScaledBird"),
    *("Study", "Trim", "Validity"),
}
WITHOUT_ARGUMENTS = {"bird_names"}


def public():
    for name in birdmb.__all__:
        thing = getattr(birdmb, name)
        if not (isinstance(thing, type) and issubclass(thing, Exception)):
            yield name, thing


@pytest.fixture(scope="module")
def bird():
    return birdmb.load_bird("ibis")


@pytest.fixture(scope="module")
def model(bird):
    return birdmb.RigidModel(bird)


def test_every_public_function_and_constructor_checks_its_arguments():
    unchecked = {
        name
        for name, thing in public()
        if not hasattr(thing.__init__ if inspect.isclass(thing) else thing, "__wrapped__")
    }
    assert unchecked == MADE_BY_THE_PROGRAM | WITHOUT_ARGUMENTS


def test_every_first_argument_is_refused_where_nothing_fits():
    class Nothing:
        """No argument of any function."""

    for name, thing in public():
        if name in MADE_BY_THE_PROGRAM | WITHOUT_ARGUMENTS:
            continue
        parameters = list(inspect.signature(thing).parameters.values())
        needed = [p for p in parameters if p.default is p.empty and p.kind is not p.VAR_KEYWORD]
        for parameter in {p.name: p for p in (*parameters[:1], *needed)}.values():
            assert parameter.name in get_type_hints(
                thing if inspect.isfunction(thing) else thing.__init__
            )
        values = {p.name: Nothing() for p in needed or parameters[:1]}
        with pytest.raises(ArgumentTypeError, match=rf"^{name}: .* must be .*, not a Nothing"):
            thing(**values)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (
            lambda _: birdmb.RigidModel("x.toml"),
            'RigidModel: bird must be a Bird, not the text "x.toml"; '
            'birdmb.load_bird("x.toml") reads one.',
        ),
        (
            lambda at: birdmb.MultibodyModel(at.model),
            "MultibodyModel: bird must be a Bird, not a RigidModel; "
            'birdmb.load_bird("ibis") reads one.',
        ),
        (
            lambda at: birdmb.find_limit_cycle(at.bird),
            "find_limit_cycle: model must be a model, not a Bird; birdmb.RigidModel(bird) or "
            "birdmb.MultibodyModel(bird) makes one of a bird.",
        ),
        (
            lambda at: birdmb.find_limit_cycle(at.model, method="foo"),
            'find_limit_cycle: method must be "auto", "collocation" or "shooting", not "foo".',
        ),
        (
            lambda at: birdmb.find_limit_cycle(at.model, tolerance=math.nan),
            "find_limit_cycle: tolerance must be a number, not nan.",
        ),
        (
            lambda at: birdmb.find_limit_cycle(at.model, metod="auto"),
            "find_limit_cycle: there is no argument metod; the nearest: method, model.",
        ),
        (
            lambda _: birdmb.find_limit_cycle(),
            "find_limit_cycle: missing a required argument model.",
        ),
        (
            lambda at: birdmb.trim_flight(at.bird, {"forearm.roll.offset_deg": 3}),
            'trim_flight: parameters["forearm.roll.offset_deg"] must be a pair, not 3.',
        ),
        (
            lambda at: birdmb.trim_flight(at.bird, {"forearm.roll.offset_deg": (1, 2, 3)}),
            'trim_flight: parameters["forearm.roll.offset_deg"] must be a pair (lowest, highest), '
            "not (1, 2, 3).",
        ),
        (
            lambda at: birdmb.trim_flight(at.bird, model=at.model),
            "trim_flight: model must be a function, not a RigidModel; "
            "for instance birdmb.RigidModel.",
        ),
        (
            lambda at: birdmb.gust_response(at.model, 1.0),
            "gust_response: cycle must be a FlightCycle, not a RigidModel; "
            "birdmb.find_limit_cycle(birdmb.RigidModel(bird)) finds one.",
        ),
        (
            lambda at: birdmb.RigidModel(at.bird, gust=1.0),
            "RigidModel: gust must be a function, not 1.0; "
            "for instance birdmb.GaussianGust(vertical=1.0).",
        ),
        (
            lambda at: birdmb.sweep(at.bird, {"body.mass": [1.0]}, store="s", workers=1.5),
            "sweep: workers must be a whole number, not 1.5.",
        ),
        (
            lambda at: birdmb.plot_gust_response(at.model),
            "plot_gust_response: data must be a Dataset, not a RigidModel.",
        ),
        (
            lambda at: at.bird.with_values("body.mass"),
            'Bird.with_values: values must be a dict or another mapping, not the text "body.mass".',
        ),
    ],
)
def test_a_sentence_says_what_would_be_right(bird, model, call, sentence):
    with pytest.raises(birdmb.ArgumentError) as refused:
        call(SimpleNamespace(bird=bird, model=model))
    assert str(refused.value) == sentence
    assert isinstance(refused.value, TypeError)


def test_what_numpy_and_xarray_make_is_a_number():
    gust = birdmb.GaussianGust(vertical=np.float32(2.0), time=xr.DataArray(0.5), width=np.int64(1))
    assert gust(0.5)[1] == 2.0


def test_the_signature_stays_and_an_error_within_is_its_own():
    @checked
    def half(value: float, *, times: int = 1) -> float:
        raise TypeError(f"of its own, {value} {times}")

    assert list(inspect.signature(half).parameters) == ["value", "times"]
    with pytest.raises(TypeError, match="of its own, 1 1"):
        half(1)


def test_nothing_of_a_bird_can_be_changed_and_the_sentence_says_how_to_vary(bird):
    for change, text in (
        (lambda: setattr(bird.body, "mass", 1), '{"body.mass": 1}'),
        (lambda: setattr(bird, "gravity", 1.6), '{"gravity": 1.6}'),
        (lambda: setattr(bird.joints[0], "offset", 0.5), '{"shoulder.pitch.offset": 0.5}'),
        (lambda: setattr(bird.feathers["1"], "length", 0.5), '{"feathers.1.length": 0.5}'),
        (lambda: delattr(bird.body, "mass"), '{"body.mass": VALUE}'),
    ):
        with pytest.raises(birdmb.ArgumentError) as refused:
            change()
        assert str(refused.value).endswith(f"bird.with_values({text}).")
        assert isinstance(refused.value, AttributeError)


def test_rooms_are_imported_at_their_first_use():
    """In a process of its own: here all of them are imported already."""
    script = "import birdmb; birdmb.figures.paper; assert not hasattr(birdmb, 'figure')"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


def test_a_misspelt_name_is_answered_with_the_nearest(bird):
    for ask, near in (
        (lambda: birdmb.find_limitcycle, "birdmb has no find_limitcycle; the nearest: find_limit"),
        (lambda: bird.joins, "Bird has no joins; the nearest: joints"),
        (lambda: bird.body.mas, "Body has no mas; the nearest: mass"),
        (lambda: bird.segments.hnad, "Segments has no hnad; the nearest: hand"),
    ):
        with pytest.raises(AttributeError) as refused:
            ask()
        assert str(refused.value).startswith(near)
        assert isinstance(refused.value, birdmb.BirdmbError)
    assert not hasattr(bird, "no_such_thing")
    assert not hasattr(birdmb, "no_such_thing")


def test_joints_and_feathers_are_had_by_name(bird):
    assert bird.joints["shoulder.flap"] is bird.joints[1]
    assert bird.feathers["1"].length == bird.value("feathers.1.length")
    with pytest.raises(KeyError) as refused:
        bird.joints["shoulder.flop"]
    assert str(refused.value).startswith('none is called "shoulder.flop"; the nearest: shoulder.f')
    with pytest.raises(KeyError, match="nearest: hand"):
        bird.segments["hnad"]
