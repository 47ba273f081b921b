"""Branches of limit cycles of a bird."""

from functools import partial

import numpy as np
import pytest

import birdmb
from birdmb.errors import ArgumentError
from birdmb.figures import plot_bird_branch
from birdmb.orbits import Steps
from birdmb.studies.branch import OBSERVABLE_UNITS, bird_branch

STIFFNESS = "shoulder.flap.stiffness"
AMPLITUDE = "shoulder.flap.amplitude_deg"
LONG = Steps(first=0.3, longest=0.5)


@pytest.mark.parametrize(
    ("name", "ends"),
    [
        (AMPLITUDE, (42.0, 44.0)),
        ("gait.frequency", (4.0, 4.2)),
        ("wing.root.x", (0.05, 0.045)),
        ("body.inertia_yy", (0.1, 0.12)),
        ("segments.hand.length", (0.084, 0.09)),
    ],
)
def test_numbers_of_the_bird_are_followed(coarse, quick, name, ends):
    branch = bird_branch(coarse, name, ends, quick, steps=LONG)
    assert branch.stopped is None
    assert tuple(branch.parameters[[0, -1]]) == pytest.approx(ends)
    assert branch.parameter_name == name
    cycle = birdmb.find_limit_cycle(quick(coarse.with_values({name: ends[1]})))
    last = branch.points[-1]
    assert last.points[0] == pytest.approx(cycle.x0, abs=1e-7)
    assert last.multipliers == pytest.approx(cycle.multipliers, abs=1e-7)
    for observable in ("mean_speed", "mean_climb_rate", "power"):
        assert last.observables[observable] == pytest.approx(getattr(cycle, observable), rel=1e-6)
    assert set(last.observables) == set(OBSERVABLE_UNITS)


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "ends", "steps_per_beat", "method"),
    [
        (STIFFNESS, (20.0, 19.0), None, "collocation"),
        (STIFFNESS, (20.0, 19.0), 60, "shooting"),
        ("shoulder.flap.damping", (0.2, 0.19), None, "collocation"),
    ],
)
def test_springs_and_dampers_are_followed(ibis_compliant, name, ends, steps_per_beat, method):
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 6})
    branch = bird_branch(bird, name, ends, steps_per_beat=steps_per_beat, steps=LONG)
    assert {point.method for point in branch.points} == {method}
    model = birdmb.MultibodyModel(bird.with_values({name: ends[1]}), steps_per_beat=steps_per_beat)
    cycle = birdmb.find_limit_cycle(model, method=method)
    # either orbit is known to 1e-7 of the state scale, which is 10 and more for fast states
    assert branch.points[-1].points[0] / cycle.state_scale == pytest.approx(
        cycle.x0 / cycle.state_scale, abs=2e-7
    )
    flap = cycle.beat.states[:, 4]
    seen = branch.points[-1].observables
    assert (seen["lowest_flap"], seen["highest_flap"]) == pytest.approx((flap.min(), flap.max()))


@pytest.mark.long
@pytest.mark.parametrize("options", [{"steps_per_beat": 60}, {}])
def test_the_flight_ends_in_a_fold_as_the_shoulder_softens(ibis_compliant, options):
    # that of a fine wing is at 5.91 (docs/stiffness_branch.md)
    bird = ibis_compliant.with_values({"wing.discretisation.elements": 6})
    branch = bird_branch(
        bird, STIFFNESS, (6.6, 5.8), max_bifurcations=1, steps=Steps(0.1, 1e-5, 0.2), **options
    )
    (fold,) = branch.bifurcations
    assert fold.kind == "fold"
    assert fold.parameter == pytest.approx(6.19916, abs=1e-5)
    assert np.abs(fold.point.multipliers - 1).min() < 1e-4
    assert branch.parameters.min() > fold.parameter - fold.parameter_error
    assert [branch.points[i].stability for i in (0, -1)] == ["unstable", "stable"]


def test_one_number_of_steps_for_the_whole_range(coarse):
    class Choosy(birdmb.RigidModel):
        @property
        def steps_per_beat(self):
            return self._steps_wanted or (50 if self.bird.body.mass > 1.22 else 20)

    branch = bird_branch(coarse, "body.mass", (1.2, 1.25), Choosy, segments=3, steps=LONG)
    assert branch.settings["steps_per_beat"] == 51
    assert branch.settings["model"] == "Choosy"


@pytest.mark.parametrize("name", ["name", "wing.discretisation.elements", "forearm.roll.twist"])
def test_what_is_no_number_is_refused(coarse, quick, name):
    with pytest.raises(ArgumentError, match=f"{name} is not a real number"):
        bird_branch(coarse, name, (1.0, 2.0), quick)


def test_other_mistakes_are_told(coarse, quick):
    with pytest.raises(birdmb.TopologyError, match=r"the nearest: body\.mass"):
        bird_branch(coarse, "body.mas", (1.0, 2.0), quick)
    with pytest.raises(birdmb.TopologyError, match="must be more than 0"):
        bird_branch(coarse, "body.mass", (-1.0, 2.0), quick)
    with pytest.raises(ArgumentError, match="two different ends"):
        bird_branch(coarse, "body.mass", (1.2, 1.2), quick)


def test_only_the_same_branch_is_resumed(coarse, quick, tmp_path):
    def follow(bird=coarse, ends=(42.0, 44.0), model=quick, **options):
        return bird_branch(bird, AMPLITUDE, ends, model, steps=LONG, **options)

    path = tmp_path / "branch.nc"
    follow(store=path, max_points=2)
    kept = birdmb.load_branch(path)
    with pytest.raises(ArgumentError, match=r"of another ibis: a value other than shoulder.flap"):
        follow(coarse.with_values({"body.mass": 1.3}), resume=kept)
    with pytest.raises(ArgumentError, match="computed with to 44, not 45"):
        follow(ends=(42.0, 45.0), resume=kept)
    with pytest.raises(ArgumentError, match="steps per beat 30, not 40"):
        follow(model=partial(birdmb.RigidModel, steps_per_beat=40), resume=kept)
    # the bird's own value of the parameter is none of the branch's business
    whole = follow(coarse.with_values({AMPLITUDE: 10.0}), resume=kept)
    assert whole.stopped is None
    assert np.array_equal(whole.parameters, follow().parameters)


def test_the_picture_says_what_is_drawn(coarse, quick):
    branch = bird_branch(coarse, AMPLITUDE, (42.0, 44.0), quick, steps=LONG)
    figure = plot_bird_branch(branch)
    speed, moduli, attack = figure.axes
    assert speed.get_ylabel() == "speed (m/s)"
    assert moduli.get_ylabel() == r"$|\Lambda|$"
    assert attack.get_xlabel() == r"$A_{\mathrm{flap}}$ (°)"
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["unstable"]
