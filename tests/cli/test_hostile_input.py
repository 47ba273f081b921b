"""Whatever a command line asks for: an answer or a sentence, soon."""

import pytest

from .conftest import COMPLIANT, HINGED, IBIS, QUICK

TAILED = IBIS.replace("ibis.toml", "ibis_tail.toml")
ALONG = ("--parameter", "gait.frequency")
BRANCH = ("branch", IBIS, *ALONG, "--from", "4", "--to", "5")
LEVEL = ("--by", "forearm.roll.offset_deg=-30:30")

# Command lines that cannot be meant, and what their sentence must say.
REFUSED = {
    "tolerance of everything": (("cycle", IBIS, "--tolerance", "1"), "--tolerance must be"),
    "no tolerance": (("cycle", IBIS, "--tolerance", "nan"), "--tolerance must be"),
    "tolerance below round-off": ((*BRANCH, "--tolerance", "1e-300"), "--tolerance must be"),
    "segments": (("cycle", IBIS, "--segments", "100000"), "--segments"),
    "steps": (("cycle", IBIS, "--steps-per-beat", "1000000"), "--steps-per-beat"),
    "steps along a branch": ((*BRANCH, "--steps-per-beat", "1000000"), "--steps-per-beat"),
    "digits": (("cycle", IBIS, "--segments", "9" * 5000), "--segments"),
    "step of nothing": ((*BRANCH, "--longest-step", "nan"), "--longest-step must be"),
    "from nan": (("branch", IBIS, *ALONG, "--from", "nan", "--to", "5"), "--from must be"),
    "to infinity": (("branch", IBIS, *ALONG, "--from", "4", "--to", "inf"), "--to must be"),
    "standing still": (("trim", TAILED, "--speed", "0"), "--speed must be 0.001 to 1000, not 0"),
    "backwards": (("trim", TAILED, "--speed", "-1"), "--speed must be 0.001 to 1000, not -1"),
    "climb": (("trim", TAILED, "--climb-rate", "inf"), "--climb-rate must be"),
    "same parameter": (
        ("trim", TAILED, *LEVEL, *LEVEL, "--speed", "13"),
        "--by gives forearm.roll.offset_deg twice",
    ),
    "mass": (("scale", "--mass", "nan"), "--mass must be 1e-09 to 100000, not nan"),
    "store": (("plot", "x" * 5000), "file name too long"),
    "elements": (("check", IBIS, "--set", "wing.discretisation=1000000000"), "must be 2 to 1024"),
    "two lines": (("check", IBIS, "--set", "body.mass=1.3\nname=2"), "must read NAME=VALUE"),
    "control characters": (("check", IBIS, "--set", r'name="a\u001b[31m"'), "control character"),
}


@pytest.mark.parametrize(("command", "says"), REFUSED.values(), ids=REFUSED)
def test_refused(run, command, says):
    result = run(*command)
    assert isinstance(result.exception, SystemExit), result.exception
    assert result.exit_code == 2
    assert says in " ".join(result.stderr.replace("│", " ").split())
    assert result.stdout == ""


# Values at the ends of their ranges.
EXTREME = [
    (IBIS, "air.density=0"),
    (IBIS, "air.density=100000"),
    (IBIS, "gravity=0"),
    (IBIS, "gravity=10000"),
    (IBIS, "gait.frequency=1000000"),
    (IBIS, "body.mass=1e-20"),
    (IBIS, "segments.hand.length=10000"),
    (IBIS, "feathers.3.length=1e-9"),
    (IBIS, "feathers.3.shares.elbow.sweep=1000"),
    (IBIS, "shoulder.flap.amplitude=1000"),
    (IBIS, "wing.half_thickness=10000"),
    (IBIS, "wing.discretisation.rounding=1e-6"),
    (COMPLIANT, "shoulder.flap.stiffness=1e12"),
    (COMPLIANT, "shoulder.flap.stiffness=0"),
    (HINGED, "feathers.5.hinge.mass=1e-20"),
    (TAILED, "tail.opening=3.141592653589793"),
    (TAILED, "drag.profile_coefficient=1000"),
]


@pytest.mark.parametrize(("topology", "value"), EXTREME, ids=[value for _, value in EXTREME])
def test_checked(run, topology, value):
    result = run("check", topology, "--set", value)
    assert result.exit_code in (0, 2), result.exception
    assert "Error" not in result.stdout
    assert isinstance(result.exception, SystemExit | None), result.exception


@pytest.mark.parametrize("name", ["[/oops]", "[bold]x", ":smile:", "a\\\\b", "a$b_{"])
def test_a_name_is_no_markup(run, name):
    result = run("check", IBIS, "--set", f'name="{name}"')
    assert result.exit_code == 0, result.exception
    assert result.stdout.splitlines()[1].strip() == name.replace("\\\\", "\\")


@pytest.mark.parametrize("value", ["air.density=1e-9", "body.inertia_yy=1e-30", "gravity=10000"])
def test_flown(run, value):
    result = run(
        *("cycle", IBIS, *QUICK, "--steps-per-beat", "24", "--max-iterations", "3"),
        *("--set", value, "--set", 'name="[/oops]"'),
    )
    assert result.exit_code in (0, 1)
    assert isinstance(result.exception, SystemExit | None), result.exception
