"""What goes wrong at the command line is one sentence on standard error and an exit status."""

import json

import pytest
import typer

from birdmb.cli.outcome import reported

from .conftest import COMPLIANT, IBIS, QUICK

# values that no bird has, or no name leads to, and what the sentence must say
MISTAKES = {
    "no equals sign": ("body.mass", 'Error: "body.mass" must read NAME=VALUE'),
    "no value": ("body.mass=", "must read NAME=VALUE"),
    "unknown name": ("bdy.mass=1", 'no value is called "bdy.mass"; the nearest: body.mass'),
    "negative mass": ("body.mass=-1", "body.mass: must be more than 0, not -1"),
    "text for a number": ("body.mass=heavy", 'body.mass: must be a number, not "heavy"'),
    "not a number": ("body.mass=nan", "body.mass:"),
    "impossible inertia": (
        "segments.hand.inertia=[1, 0.1, 0.1]",
        "segments.hand.inertia: principal moments 1, 0.1, 0.1 kg m2 break the triangle inequality",
    ),
    "negative inertia": ("segments.hand.inertia=[1, -1, 1]", "must not be negative"),
    "unknown discretisation": ("wing.discretisation=fine", 'must be "converged" or "published"'),
    "share of no joint": ('feathers.5.shares={ "knee.flap" = 0.5 }', "no joint is called"),
    "feather on no bone": ("feathers.5.bone=thigh", "feathers.5.bone:"),
    "negative stiffness": ("shoulder.flap.stiffness=-1", "shoulder.flap.stiffness:"),
}


def sentence(result):
    """The one line of standard error that tells the error."""
    errors = [line for line in result.stderr.splitlines() if line.startswith("Error: ")]
    assert len(errors) == 1, result.stderr
    assert "Traceback" not in result.stderr
    assert result.stderr.splitlines()[-1] == errors[0]
    return errors[0]


@pytest.mark.parametrize("command", ["cycle", "check"])
@pytest.mark.parametrize(("assignment", "says"), MISTAKES.values(), ids=MISTAKES)
def test_values_that_no_bird_has(run, command, assignment, says):
    result = run(command, IBIS, "--set", assignment)
    assert result.exit_code == 2
    assert says in sentence(result)
    assert result.stdout == ""


# what is edited in ibis.toml, and what the sentence must say
WRONG_FILES = {
    "unknown key": ("mass = 1.2", "mass = 1.2\nmas = 1", "body.mas: unknown key"),
    "missing key": ("mass = 1.2", "", "body.mass: missing; it should give the mass"),
    "not TOML": ("[body]", "[body", "is not valid TOML"),
}


@pytest.mark.parametrize(("old", "new", "says"), WRONG_FILES.values(), ids=WRONG_FILES)
def test_wrong_files(run, tmp_path, old, new, says):
    path = tmp_path / "bird.toml"
    with open(IBIS, encoding="utf-8") as original:  # noqa: PTH123
        path.write_text(original.read().replace(old, new), encoding="utf-8")
    result = run("cycle", str(path), "--json")
    assert result.exit_code == 2
    assert f"{path}: " in sentence(result)
    assert says in sentence(result)
    assert says in json.loads(result.stdout)["error"]


def test_a_missing_file(run, tmp_path):
    result = run("check", str(tmp_path / "dodo.toml"))
    assert result.exit_code == 2
    assert "dodo.toml: cannot be read (no such file or directory)" in sentence(result)


def test_a_value_given_twice(run):
    result = run("check", IBIS, "--set", "body.mass=1", "--set", "body.mass=2")
    assert result.exit_code == 2
    assert "--set gives body.mass twice" in sentence(result)


def test_an_unknown_option(run):
    result = run("cycle", IBIS, "--bogus")
    assert result.exit_code == 2
    assert "No such option: --bogus" in result.stderr


def test_a_tolerance_of_nothing(run):
    result = run("cycle", IBIS, "--tolerance", "0")
    assert result.exit_code == 2
    assert "--tolerance must be 1e-15 to 0.01, not 0" in sentence(result)


@pytest.mark.parametrize("place", ["file", "file/below"])
def test_a_directory_that_cannot_be(run, tmp_path, place):
    (tmp_path / "file").touch()
    result = run("cycle", IBIS, *QUICK, "--out", str(tmp_path / place))
    assert result.exit_code == 2
    assert f"--out: {tmp_path / place} cannot be written" in sentence(result)
    assert "iteration" not in result.stderr


# birds that no flight carries, under either model
GROUNDED = {
    "too heavy": ("body.mass=60",),
    "flaps too fast": ("gait.frequency=1000",),
    "no air": ("air.density=0",),
}


@pytest.mark.long
@pytest.mark.parametrize("model", ["rigid", "multibody"])
@pytest.mark.parametrize("values", GROUNDED.values(), ids=GROUNDED)
def test_a_bird_that_cannot_fly(run, model, values):
    options = [option for value in values for option in ("--set", value)]
    options += [
        "--model",
        model,
        "--steps-per-beat",
        "24",
        "--set",
        "wing.discretisation=6",
        "--json",
    ]
    result = run("cycle", COMPLIANT, *options, "--max-iterations", "3")
    assert result.exit_code == 1
    assert sentence(result) == f"Error: {json.loads(result.stdout)['error']}"


def test_no_convergence_keeps_what_it_had(run):
    result = run("cycle", IBIS, *QUICK, "--max-iterations", "1", "--json")
    assert result.exit_code == 1
    assert "used up after 1 iterations" in sentence(result)
    kept = json.loads(result.stdout)
    assert set(kept) == {"error", "bird", "model", "x", "residual", "iterations"}
    assert list(kept["x"]) == ["u", "w", "q", "theta"]
    assert 1e-9 < kept["residual"] < 1
    assert kept["iterations"] == 1


def test_nothing_is_written_without_a_cycle(run, tmp_path):
    result = run("cycle", IBIS, *QUICK, "--max-iterations", "1", "--out", str(tmp_path))
    assert result.exit_code == 1
    assert list(tmp_path.iterdir()) == []


def test_keyboard_interrupt_is_one_line(capsys):
    with pytest.raises(typer.Exit) as ended, reported():
        raise KeyboardInterrupt
    assert ended.value.exit_code == 130
    assert capsys.readouterr().err == "Interrupted.\n"
