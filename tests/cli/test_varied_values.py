"""`--set`, `--vary` and `--trim` in any order, and refused where they cannot be meant."""

import itertools

import pytest

from birdmb.cli.birds import requested_bird
from birdmb.cli.outcome import InputError
from birdmb.studies.sweeps import Finished

from .conftest import COMPLIANT, HINGED, IBIS

STIFFNESS, DAMPING = "shoulder.flap.stiffness", "shoulder.flap.damping"


def refused(run, tmp_path, *arguments, topology=IBIS):
    store = tmp_path / "study.db"
    result = run("sweep", topology, *arguments, "--store", str(store))
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 1
    assert not store.exists()
    return result.stderr


def test_the_order_of_assignments_is_of_no_consequence():
    texts = [
        f"{STIFFNESS}=20",
        f"{DAMPING}=0.2",
        "shoulder.flap.cubic_stiffness=3",
        "body.mass=1.3",
    ]
    birds = [requested_bird(IBIS, order) for order in itertools.permutations(texts)]
    assert all(bird == birds[0] for bird in birds)
    assert [joint.name for joint in birds[0].compliant_joints] == ["shoulder.flap"]


@pytest.mark.parametrize(("assigned", "varied"), [(STIFFNESS, DAMPING), (DAMPING, STIFFNESS)])
def test_what_is_varied_completes_what_is_set(assigned, varied):
    bird = requested_bird(IBIS, [f"{assigned}=0.5"], {varied: 0.25})
    flap = bird.with_values({varied: 2.0}).joint("shoulder.flap")
    assert flap.mode == "compliant"
    assert {STIFFNESS: flap.stiffness, DAMPING: flap.damping} == {assigned: 0.5, varied: 2.0}


@pytest.fixture
def begun(run, monkeypatch):
    """Give a sweep, which ends before its first point; returns the bird and the lines it told."""
    birds = []

    def sweep(bird, _variations, **options):
        birds.append(bird)
        options["on_point"](Finished({}, None, 0, 1))
        raise InputError("enough")

    monkeypatch.setattr("birdmb.cli.sweep.sweep", sweep)

    def begin(*arguments):
        told = run("sweep", *arguments, "--store", "none").stderr.splitlines()
        assert told[-1] == "Error: enough"
        return birds[-1], told

    return begin


def test_a_sweep_over_the_stiffness_takes_a_damping(begun):
    bird, _ = begun(IBIS, "--set", f"{DAMPING}=0.2", "--vary", f"{STIFFNESS}=60,50")
    assert bird.joint("shoulder.flap").damping == 0.2
    assert bird.with_values({STIFFNESS: 50}).joint("shoulder.flap").mode == "compliant"


def test_the_rigid_model_says_whose_springs_it_ignores(begun):
    note = "The rigid model ignores the springs of shoulder.flap."
    vary = ("--vary", "body.mass=1.2,1.3")
    assert begun(COMPLIANT, *vary, "--model", "rigid")[1][0] == note
    assert len(begun(COMPLIANT, *vary)[1]) == 1
    assert len(begun(IBIS, *vary, "--model", "rigid")[1]) == 1


def test_a_damper_without_a_spring_is_told():
    with pytest.raises(Exception, match="a compliant joint needs a stiffness"):
        requested_bird(IBIS, [f"{DAMPING}=0.2"], {"body.mass": 1.0})
    with pytest.raises(InputError, match=r"cubic_stiffness has no effect: .* is prescribed"):
        requested_bird(IBIS, ["shoulder.flap.cubic_stiffness=3"])


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--vary", "body.mass=nan,1"), "body.mass cannot be nan"),
        (("--vary", "body.mass=1,-inf"), "body.mass cannot be -inf"),
        (("--vary", "body.mass=1:inf:5"), "must read NAME=FIRST:LAST:COUNT"),
        (("--vary", "body.mass=1:2:1000000000"), "values or fewer"),
        (
            ("--vary", "body.mass=1:2:100000", "--vary", "wing.root.x=0:0.1:100000"),
            "1e+10 points are asked for",
        ),
        (("--vary", "body.mass=1,1.0"), "body.mass is to be 1 twice"),
        (("--vary", "body.mass=1,2", "--vary", "body.mass=3"), "--vary gives body.mass twice"),
        (
            ("--vary", "tail.opening=0.1", "--vary", "tail.opening_deg=5"),
            "no value is called",
        ),
        (
            ("--vary", "shoulder.flap.phase=0.1", "--vary", "shoulder.flap.phase_deg=5"),
            "are one value",
        ),
        (
            ("--vary", "wing.discretisation=8", "--vary", "wing.discretisation.elements=5"),
            "are one value",
        ),
        (
            ("--vary", "forearm.roll.offset=0.1", "--trim", "forearm.roll.offset_deg=-9:9"),
            "cannot be both varied (as forearm.roll.offset) and trimmed",
        ),
        (("--vary", "body.mass=1", "--trim", "wing.root.x=0:inf"), "must read NAME=LOWEST:HIGHEST"),
        (
            (
                *("--vary", "body.mass=1", "--speed", "9"),
                *("--trim", "wing.root.x=0:1", "--trim", "wing.root.x=0:2"),
            ),
            "--trim gives wing.root.x twice",
        ),
        *(
            (
                (
                    *("--vary", "body.mass=1", "--speed", speed),
                    *("--trim", "wing.root.x=0:1", "--trim", "gait.frequency=3:5"),
                ),
                "--speed must be 0.001 to 1000",
            )
            for speed in ("0", "-1", "nan", "inf")
        ),
        (("--vary", "body.mass=1", "--tolerance", "nan"), "--tolerance must be 1e-15 to 0.01"),
        (("--vary", "body.mass=1", "--workers", "1000"), "1000 workers are asked for"),
        (("--vary", "name=a,b"), "name cannot be varied, it has no effect: it is a label"),
        (("--vary", "shoulder.flap.cubic_stiffness=1,2"), "shoulder.flap is prescribed"),
    ],
)
def test_what_cannot_be_meant_is_told_before_anything_is_computed(run, tmp_path, arguments, says):
    assert says in refused(run, tmp_path, *arguments)


@pytest.mark.parametrize(
    ("topology", "name"),
    [(COMPLIANT, STIFFNESS), (HINGED, "feathers.5.hinge.stiffness"), (IBIS, "segments.hand.mass")],
)
def test_the_rigid_model_refuses_what_it_ignores(run, tmp_path, topology, name):
    told = refused(
        run, tmp_path, "--vary", f"{name}=0.02,0.01", "--model", "rigid", topology=topology
    )
    assert f"{name} cannot be varied, it has no effect: the " in told
    assert "take the multibody model" in told
