"""In a console and a notebook each object says what matters, and stays short."""

import io
import pickle
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from html.parser import HTMLParser
from importlib.metadata import version

import numpy as np
import pytest
from pydantic import BaseModel

import birdmb
from birdmb.orbits import BranchPoint, ConvergenceError, Trajectory
from birdmb.summary import LONGEST, Fact, Summarised
from birdmb.topology import Harmonic

MANY = 500


@pytest.fixture(scope="module")
def bird():
    return birdmb.load_bird("ibis").with_values({"wing.discretisation": 8})


@pytest.fixture(scope="module")
def cycle(bird):
    return birdmb.find_limit_cycle(birdmb.RigidModel(bird))


@pytest.fixture(scope="module")
def objects(bird, cycle, tmp_path_factory):
    """One of each public class, with as much in it as it may have."""
    model = cycle.model
    ode = birdmb.OdeModel(lambda _, x: -x, ["x", "v"], 1.0)
    many = np.linspace(0.0, 1.0, MANY)
    point = BranchPoint(
        1.0, 0.25, np.ones((MANY, 4)), 1e-12, cycle.multipliers, cycle.multiplier_errors,
        None, "stable", many, 0.1,
    )  # fmt: skip
    branch = birdmb.Branch(
        "body.mass", cycle.state_names, cycle.state_scale, 0.0, (point,) * MANY, (), None
    )
    motion = birdmb.JointMotion(0.1, many, many, 0.01, many, many, 0.02)
    fit = birdmb.KinematicsFit(
        bird, bird, "points.csv", 4.0, 0.01, dict.fromkeys(bird.joint_names, motion), (),
        "shoulder.flap", 0.0, {}, 12, 3000, ("Beware.",), many, many[:, None], many[:, None],
    )  # fmt: skip
    wing, moves = birdmb.PlaneWing.elliptic(1.0, 8.0), birdmb.WingMotion(heave=many.tolist())
    rigid = partial(birdmb.RigidModel, steps_per_beat=60)
    with ThreadPoolExecutor(1) as executor:
        study = birdmb.sweep(
            bird, {"body.mass": [1.2, 1.21]},
            store=tmp_path_factory.mktemp("study") / "s.sqlite", executor=executor, model=rigid,
        )  # fmt: skip
    plain = birdmb.LimitCycle.of(cycle, cycle.iterations)
    found = [
        bird, model, birdmb.MultibodyModel(bird), ode, cycle, plain, cycle.beat,
        cycle.beat.loads[0], model.trajectory(cycle.x0, 0.0, 0.25), branch, fit, motion, study,
        birdmb.floquet(ode, [0.0, 0.0]),
        birdmb.assess_validity(cycle), birdmb.MemoryEffect(cycle, cycle), wing, moves,
        birdmb.moving_wing_loads(birdmb.PlaneWing.rectangular(1.0, 0.2),
                                 birdmb.WingMotion(heave=[0.0, 0.01]), speed=10.0, instants=9,
                                 elements=8),
        birdmb.scale_bird(bird, 1.0), birdmb.Trim(bird, cycle, {"body.mass": 1.0}, 1e-9, 3, True),
        birdmb.Trimming({"body.mass": (1.0, 2.0)}), birdmb.CosineGust(), birdmb.GaussianGust(),
        birdmb.StepGust(),
    ]  # fmt: skip
    return {type(each).__name__: each for each in found}


def texts_of(html):
    found = []
    parser = HTMLParser()
    parser.handle_data = found.append
    parser.feed(html)
    return found


def test_of_every_public_class_there_is_one_here(objects):
    classes = {
        name
        for name in birdmb.__all__
        if isinstance(kind := getattr(birdmb, name), type) and not issubclass(kind, Exception)
    }
    assert classes == objects.keys()


def test_no_representation_is_long(objects):
    lengths = {name: len(repr(each)) for name, each in objects.items()}
    assert {name: n for name, n in lengths.items() if not n < LONGEST} == {}
    assert {name: len(str(o)) for name, o in objects.items() if not len(str(o)) < 2 * LONGEST} == {}


def test_every_part_of_these_is_short_too(objects, bird):
    parts = [getattr(bird, name) for name in type(bird).model_fields]
    parts += [*bird.joints, *bird.feathers, *bird.segments.items(), bird.segments]
    parts += [objects["Branch"].points[0], objects["Validity"].excesses, objects["Loads"].right]
    parts += [Trajectory(np.zeros(9), np.zeros((9, 2))), objects["Study"].outcomes]
    assert [repr(part) for part in parts if not len(repr(part)) < LONGEST] == []


def test_a_console_that_knows_ascii_alone_shows_them_all(objects):
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    for each in objects.values():
        print(each, repr(each), file=stream)


def test_a_flight_says_whether_it_is_stable_how_sure_that_is_and_how_fast_it_flies(cycle):
    largest = np.abs(cycle.multipliers).max()
    text = repr(cycle)
    assert text.startswith(
        f"<FlightCycle ibis: verdict {cycle.stability}, |Lambda|max {largest:.6g} +- "
    )
    assert f"{cycle.multiplier_errors[0]:.0e}" in text
    assert f"speed {cycle.mean_speed:.3f} m/s" in text
    cells = texts_of(cycle._repr_html_())
    assert cells[cells.index("speed") + 1 :][:2] == [f"{cycle.mean_speed:.3f}", "m/s"]
    assert "|Λ|max" in cells


def test_a_study_and_a_branch_say_how_much_they_hold(objects):
    assert "finished points 2 of 2" in repr(objects["Study"])
    assert "body.mass 1.2 to 1.21, 2 values" in repr(objects["Study"])
    assert repr(objects["Branch"]).startswith("<Branch in body.mass: points 500, from 1, to 1")


def test_tables_hold_names_as_text_not_as_markup():
    class Named(Summarised):
        def _title(self):
            return "<script>alert(1)</script>"

        def _summary(self):
            yield Fact("<b>", "a & b", "<i>")

    html = Named()._repr_html_()
    assert texts_of(html) == ["Named <script>alert(1)</script>", "<b>", "a & b", "<i>"]
    assert "<script>" not in html


def test_what_cannot_be_computed_does_not_fail_a_representation():
    class Broken(Summarised):
        def _summary(self):
            yield Fact("points", "3")
            raise birdmb.StateError("the flight diverged")

    assert repr(Broken()) == "<Broken: points 3, not computed: the flight diverged>"


def test_facts_that_no_longer_fit_are_left_out_whole():
    class Full(Summarised):
        def _summary(self):
            return (Fact(f"fact {i}", "1") for i in range(MANY))

    text = repr(Full())
    assert LONGEST - 20 < len(text) < LONGEST
    assert text.endswith(" 1, ...>")


def test_an_error_does_not_show_the_arrays_that_it_keeps():
    error = ConvergenceError("No orbit.", np.zeros(MANY), 1.0)
    assert repr(error) == "ConvergenceError('No orbit.')"
    assert len(repr(birdmb.StateError("x" * 1000))) < LONGEST


def test_completion_of_a_bird_offers_what_is_its_own(bird):
    offered = {name for name in dir(bird) if not name.startswith("_")}
    assert offered.isdisjoint(dir(BaseModel))
    assert {"body", "joints", "segments", "with_values", "value_names"} <= offered
    assert {"hand", "forearm"} <= set(dir(bird.segments))
    assert bird.joints._ipython_key_completions_() == list(bird.joint_names)
    assert bird.segments._ipython_key_completions_() == list(bird.segments.names)
    assert "mass" in dir(bird.body)
    assert [n for n in dir(bird.body) if n.startswith("model_")] == []


def test_parts_by_name_stay_so_through_copies_and_pickles(bird):
    for other in (
        pickle.loads(pickle.dumps(bird)),
        bird.with_values({"body.mass": 1.0}),
        bird.side("right"),
        bird.assembled,
        type(bird).model_validate(bird.model_dump()),
    ):
        assert other.joints["elbow.sweep"].name == "elbow.sweep"
        assert other.feathers["3"].bone == "forearm"
        assert other.attachments.names == ()
    sprung = bird.with_joint("elbow.sweep", harmonics=[Harmonic(order=2, amplitude=0.1)])
    assert sprung.joints["elbow.sweep"].harmonics[0].order == 2


def test_the_version_is_that_of_the_installed_package():
    assert birdmb.__version__ == version("birdmb")
    assert "__version__" in dir(birdmb)
