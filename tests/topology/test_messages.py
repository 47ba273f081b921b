"""Whatever is wrong with a file is told in one sentence: file, key, value, what would be right."""

import pytest

from birdmb.errors import TopologyError
from birdmb.topology import load_bird

from .conftest import TOPOLOGIES

IBIS = (TOPOLOGIES / "ibis.toml").read_text(encoding="utf-8")

HAND = "inertia = [6.13e-6, 5.0e-7, 6.13e-6]"
FLAP = 'axis = [-1, 0, 0]\nmode = "prescribed"'
TIP = 'name = "1"\nbone = "hand"\nposition = 1.0'
CHOICE = (
    'must be "converged" or "published", a whole number of elements per wing, '
    "or a table of scheme, elements and rounding"
)
FINENESS = "(how finely the wing's loads are computed)"
INERTIA = (
    "(inertia about the segment's centre of mass, kg m2: three moments about x, y, z or a "
    "3x3 tensor)"
)
TABLE = 'discretisation = { scheme = "orthogonal", elements = 32'

# what is edited in ibis.toml, and the sentence after "ibis.toml: "
MISTAKES = {
    "unknown key": (
        "mass = 1.2",
        "mass = 1.2\nmas = 1",
        "body.mas: unknown key; the nearest known: mass",
    ),
    "unknown key of a joint": (
        FLAP,
        f"{FLAP}\noffset_degg = 3",
        "shoulder.flap.offset_degg: unknown key; the nearest known: offset_deg, offset, phase_deg",
    ),
    "unknown table": ("[air]", "[aire]", "aire: unknown key; the nearest known: air"),
    "missing key": (
        "mass = 1.2",
        "",
        "body.mass: missing; it should give the mass of the body without its wings, kg",
    ),
    "missing table": (
        "[gait]\nfrequency = 4.0",
        "",
        "gait: missing; it should give the gait, a table",
    ),
    "missing place": (
        "root = { x = 0.05, y = 0.05, z = 0.0 }",
        "root = { y = 0.05, z = 0.0 }",
        "wing.root.x: missing; it should give how far the shoulder is ahead of the centre of mass, "
        "m",
    ),
    "segment without a name": (
        "[segments.hand]",
        '[segments.""]',
        'segments: "" is no name; it must have a letter or digit',
    ),
    "missing name": (
        'name = "elbow.sweep"',
        "",
        'joints #4.name: missing; it should give the name of the joint, "place.motion" such as '
        '"shoulder.flap"',
    ),
    "wrong type": (
        "mass = 1.2",
        'mass = "1.2"',
        'body.mass: must be a number, not "1.2" (mass of the body without its wings, kg)',
    ),
    "truth for a number": (
        "density = 1.225",
        "density = true",
        "air.density: must be a number, not true (density of the air, kg/m3)",
    ),
    "number for a truth": (
        "twist = true",
        "twist = 1",
        "forearm.roll.twist: must be true or false, not 1 "
        "(whether the angle grows along the segment from none at its root)",
    ),
    "number for a text": (
        'name = "ibis"',
        "name = 3",
        "name: must be a text in quotes, not 3 (short label of the bird)",
    ),
    "number for a table": (
        "root = { x = 0.05, y = 0.05, z = 0.0 }",
        "root = 0.05",
        "wing.root: must be a table, not 0.05 "
        "(position of the right shoulder, a table of x, y and z in m)",
    ),
    "negative mass": (
        "mass = 1.2",
        "mass = -1.2",
        "body.mass: must be more than 0, not -1.2 (mass of the body without its wings, kg)",
    ),
    "negative segment mass": (
        f"mass = 0.01\n{HAND}",
        f"mass = -0.01\n{HAND}",
        "segments.hand.mass: must be 0 or more, not -0.01 (mass of the segment of one wing, kg)",
    ),
    "nan": (
        "frequency = 4.0",
        "frequency = nan",
        "gait.frequency: must be a finite number, not nan (wingbeats per second, Hz)",
    ),
    "infinite angle in degrees": (
        "amplitude_deg = 42",
        "amplitude_deg = -inf",
        "shoulder.flap.amplitude_deg: must be a finite number, not -inf "
        "(amplitude; rad, degrees as amplitude_deg)",
    ),
    "no number in degrees": (
        "amplitude_deg = 42",
        'amplitude_deg = "42"',
        'shoulder.flap.amplitude_deg: must be a number, not "42" '
        "(amplitude; rad, degrees as amplitude_deg)",
    ),
    "angle twice": (
        "amplitude_deg = 42",
        "amplitude_deg = 42\namplitude = 0.7",
        "shoulder.flap.amplitude_deg: given twice, as amplitude and amplitude_deg; keep one",
    ),
    "axis of two numbers": (
        FLAP,
        'axis = [-1, 0]\nmode = "prescribed"',
        "shoulder.flap.axis: must be a list of 3 entries, not [-1, 0] "
        "(direction of the axis, [x, y, z] in the parent's frame)",
    ),
    "axis of four numbers": (
        FLAP,
        'axis = [-1, 0, 0, 0]\nmode = "prescribed"',
        "shoulder.flap.axis: must be a list of 3 entries, not [-1, 0, 0, 0] "
        "(direction of the axis, [x, y, z] in the parent's frame)",
    ),
    "axis without direction": (
        FLAP,
        'axis = [0, 0, 0]\nmode = "prescribed"',
        "shoulder.flap.axis: [0, 0, 0] has no direction; for instance [0, 1, 0] is outwards",
    ),
    "axis with a text": (
        FLAP,
        'axis = [-1, "y", 0]\nmode = "prescribed"',
        'shoulder.flap.axis #2: must be a number, not "y" '
        "(direction of the axis, [x, y, z] in the parent's frame)",
    ),
    "axis that is no list": (
        FLAP,
        'axis = "x"\nmode = "prescribed"',
        'shoulder.flap.axis: must be a list, not "x" '
        "(direction of the axis, [x, y, z] in the parent's frame)",
    ),
    "unknown mode": (
        FLAP,
        'axis = [-1, 0, 0]\nmode = "free"',
        'shoulder.flap.mode: must be "prescribed" or "compliant", not "free" '
        "(whether the joint follows its driver or a spring)",
    ),
    "compliant without stiffness": (
        FLAP,
        'axis = [-1, 0, 0]\nmode = "compliant"\ndamping = 0.2',
        "shoulder.flap.stiffness: missing; a compliant joint needs a stiffness of 0 or more",
    ),
    "compliant without damping": (
        FLAP,
        'axis = [-1, 0, 0]\nmode = "compliant"\nstiffness = 20',
        "shoulder.flap.damping: missing; a compliant joint needs a damping of 0 or more",
    ),
    "joint name": (
        'name = "shoulder.flap"',
        'name = "flap"',
        'flap.name: must read "<place>.<motion>", such as "wrist.sweep", not "flap"',
    ),
    "joint named after a table": (
        'name = "shoulder.flap"',
        'name = "wing.flap"',
        'joints: "wing.flap" must not start with wing, a table of the file',
    ),
    "joint twice": (
        'name = "shoulder.flap"',
        'name = "shoulder.pitch"',
        'joints: two joints are called "shoulder.pitch"; each needs a name of its own',
    ),
    "joints out of order": (
        'name = "shoulder.flap"\nsegment = "humerus"',
        'name = "shoulder.flap"\nsegment = "hand"',
        'joints: "shoulder.sweep" (on the humerus) is listed after "shoulder.flap" (on the hand); '
        "joints must be listed from the body outwards",
    ),
    "joint on an unknown segment": (
        'name = "shoulder.flap"\nsegment = "humerus"',
        'name = "shoulder.flap"\nsegment = "ulna"',
        'shoulder.flap.segment: no segment is called "ulna"; the nearest: hand, humerus, forearm',
    ),
    "feather on an unknown bone": (
        TIP,
        'name = "1"\nbone = "thumb"\nposition = 1.0',
        'feathers.1.bone: no segment is called "thumb"; the nearest: humerus, hand, forearm',
    ),
    "feather beyond its bone": (
        TIP,
        'name = "1"\nbone = "hand"\nposition = 1.5',
        "feathers.1.position: must be 1 or less, not 1.5 "
        "(place of the root along the bone, 0 at its root to 1 at its end)",
    ),
    "no feather at the tip": (
        TIP,
        'name = "1"\nbone = "hand"\nposition = 0.9',
        "feathers: none is at the hand's tip; one must be (bone hand, position 1)",
    ),
    "no feather at the shoulder": (
        'bone = "humerus"\nposition = 0.0',
        'bone = "humerus"\nposition = 0.1',
        "feathers: none is at the shoulder; one must be (bone humerus, position 0)",
    ),
    "feathers at one place": (
        'bone = "forearm"\nposition = 1.0',
        'bone = "forearm"\nposition = 0.0',  # the elbow, which is the end of the humerus too
        'feathers: "5" and "3" have the same place; each feather needs a place of its own',
    ),
    "feather twice": (
        TIP,
        TIP.replace('"1"', '"3"'),
        'feathers: two feathers are called "3"; each needs a name of its own',
    ),
    "feather name": (
        TIP,
        TIP.replace('"1"', '"1.5"'),
        'feathers.1.5.name: must be of letters, digits, _ and - only, not "1.5" '
        '(name of the feather, such as "1")',
    ),
    "share of an unknown joint": (
        '"wrist.sweep" = 0.5 }\n\n',
        '"wrist.swep" = 0.5 }\n\n',
        'feathers.3.shares: no joint is called "wrist.swep"; the nearest: wrist.sweep',
    ),
    "share without quotes": (
        '"wrist.sweep" = 0.5 }\n\n',
        "wrist.sweep = 0.5 }\n\n",
        'feathers.3.shares.wrist: must be a number, not {"sweep": 0.5} '
        "(shares of joint angles, each under the joint's name in quotes)",
    ),
    "triangle inequality": (
        HAND,
        "inertia = [1e-5, 1e-6, 1e-6]",
        "segments.hand.inertia: principal moments 1e-05, 1e-06, 1e-06 kg m2 break the triangle "
        "inequality (no body has them); each must be at most the sum of the other two",
    ),
    "negative moment": (
        HAND,
        "inertia = [1e-5, 1e-5, -1e-6]",
        "segments.hand.inertia: principal moments 1e-05, 1e-05, -1e-06 kg m2 must not be negative",
    ),
    "asymmetric inertia": (
        HAND,
        "inertia = [[1e-5, 1e-6, 0], [0, 1e-5, 0], [0, 0, 1e-5]]",
        "segments.hand.inertia: [[1e-05, 1e-06, 0.0], [0.0, 1e-05, 0.0], [0.0, 0.0, 1e-05]] is not "
        "symmetric; an inertia tensor must be",
    ),
    "two moments": (
        HAND,
        "inertia = [1e-5, 1e-5]",
        "segments.hand.inertia: must be three moments or a 3x3 tensor, not [1e-05, 1e-05]",
    ),
    "two rows": (
        HAND,
        "inertia = [[1e-5, 0, 0], [0, 1e-5, 0]]",
        "segments.hand.inertia: must be a list of 3 entries, not [[1e-05, 0, 0], [0, 1e-05, 0]] "
        + INERTIA,
    ),
    "unknown preset": (
        'discretisation = "converged"',
        'discretisation = "coarse"',
        f'wing.discretisation: {CHOICE}, not "coarse" {FINENESS}',
    ),
    "half an element": (
        'discretisation = "converged"',
        "discretisation = 8.5",
        f"wing.discretisation: {CHOICE}, not 8.5 {FINENESS}",
    ),
    "one element": (
        'discretisation = "converged"',
        "discretisation = 1",
        f"wing.discretisation: must be 2 or more, not 1 {FINENESS}",
    ),
    "too round": (
        'discretisation = "converged"',
        f"{TABLE}, rounding = 1.5 }}",
        "wing.discretisation.rounding: must be 1 or less, not 1.5 "
        "(rounding of the edges' corners, a fraction above 0 up to 1)",
    ),
    "table without rounding": (
        'discretisation = "converged"',
        f"{TABLE} }}",
        "wing.discretisation.rounding: missing; it should give the rounding of the edges' corners, "
        "a fraction above 0 up to 1",
    ),
    "several, the first in the file": (
        "[gait]\nfrequency = 4.0",
        "[gait]\nfrequency = 0\nfrequence = 4.0\n[[feathers]]\nname = '8'",
        "gait.frequency: must be more than 0, not 0 (wingbeats per second, Hz) (and 4 more)",
    ),
}


@pytest.mark.parametrize(("old", "new", "sentence"), MISTAKES.values(), ids=MISTAKES)
def test_sentence(tmp_path, monkeypatch, old, new, sentence):
    assert old in IBIS
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ibis.toml").write_text(IBIS.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(TopologyError) as caught:
        load_bird("ibis.toml")
    assert str(caught.value) == f"ibis.toml: {sentence}"
