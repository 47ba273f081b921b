"""Samples of a driver from a CSV file beside the topology file."""

import re

import numpy as np
import pytest

import birdmb
from birdmb.topology.writing import bird_text

FLAP = "shoulder.flap"
PHASES = np.arange(20) / 20
ANGLES = 42 * np.sin(2 * np.pi * PHASES) + 3 * np.cos(4 * np.pi * PHASES)


@pytest.fixture
def load(ibis, tmp_path):
    """Loads an ibis whose flap is in a file of this text."""
    text = bird_text(ibis.with_joint(FLAP, offset=0.0, amplitude=0.0, phase=0.0))
    name = f'name = "{FLAP}"'

    def load(content, keys='file = "data/flap.csv"'):
        (tmp_path / "data").mkdir(exist_ok=True)
        (tmp_path / "data" / "flap.csv").write_text(content)
        (tmp_path / "bird.toml").write_text(text.replace(name, f"{name}\n{keys}"))
        return birdmb.load_bird(tmp_path / "bird.toml")

    return load


def table(*columns, header):
    rows = [
        header,
        *(",".join(f"{cell:.17g}" for cell in row) for row in zip(*columns, strict=True)),
    ]
    return "\n".join(rows) + "\n"


def is_the_motion(bird):
    driver = bird.joint(FLAP).driver
    np.testing.assert_allclose(np.degrees(driver.at(PHASES)), ANGLES, atol=1e-12)
    return driver.fit.harmonics == 2


def test_the_column_of_the_joint_is_read_and_the_bird_holds_it(load, tmp_path):
    bird = load(table(ANGLES, 0 * ANGLES, header=f"{FLAP}_deg, wrist.sweep_deg"))
    assert is_the_motion(bird)
    assert bird.joint(FLAP).sample_phases is None
    written = tmp_path / "elsewhere.toml"
    written.write_text(bird_text(bird))
    assert birdmb.load_bird(written).fingerprint() == bird.fingerprint()


@pytest.mark.parametrize("header", [FLAP, "angle", f"phase_of_day,{FLAP}"])
def test_columns_in_radians(load, header):
    angles = np.radians(ANGLES)
    columns = (angles, angles) if "," in header else (angles,)
    assert is_the_motion(load(table(*columns, header=header)))


def test_phases_may_be_uneven_and_end_where_they_begin(load):
    some = np.delete(np.arange(21), [4, 11])
    phases, angles = some / 20, np.append(ANGLES, ANGLES[0])[some]
    closed = load(table(phases, angles, header="phase,angle_deg"))
    assert is_the_motion(closed)
    assert len(closed.joint(FLAP).samples) == 18
    # Without its beginning, the end stands for it.
    end = load(table(phases[1:], angles[1:], header="phase,angle_deg"))
    assert is_the_motion(end)
    assert end.joint(FLAP).sample_phases == closed.joint(FLAP).sample_phases


def test_a_side_takes_its_own_column(load):
    text = table(ANGLES, 0.5 * ANGLES, header=f"{FLAP}_deg,{FLAP}.left_deg")
    bird = load(text, 'file = "data/flap.csv"\nleft = { file = "data/flap.csv" }')
    right, left = (bird.joint(FLAP).on(side).driver for side in ("right", "left"))
    np.testing.assert_allclose(left.at(PHASES), 0.5 * right.at(PHASES), atol=1e-15)


GOOD = table(PHASES, ANGLES, header="phase,angle_deg")
WRONG = {
    "not there": (GOOD, 'file = "flap.csv"', "flap.csv cannot be read (no such file or directory)"),
    "no path": (GOOD, "file = 3", "must be the path of a CSV file, not 3"),
    "samples too": (
        GOOD,
        'file = "data/flap.csv"\nsamples = [0, 1, 0]',
        "file and samples do not go together",
    ),
    "empty": ("\n\n", None, "flap.csv is empty"),
    "no column": (
        "time,flap\n0,1\n",
        None,
        "line 1: no column of angles; the header must have one of shoulder.flap_deg, "
        "shoulder.flap, angle_deg, angle",
    ),
    "times": (
        "Time_s,angle\n0,1\n0.1,2\n0.3,3\n",
        None,
        "line 1: samples have no Time_s but a phase, the part of the beat from 0 to 1",
    ),
    "semicolons": ("phase;angle_deg\n0;1\n", None, "commas must separate the columns"),
    "both units": ("angle,angle_deg\n1,2\n", None, "line 1: has both angle_deg and angle"),
    "a column twice": ("angle,angle\n1,2\n", None, "line 1: two columns are called angle"),
    "a text": (
        "angle_deg\n1\n\n2\nx\n",
        None,
        'line 5: angle_deg must be a number from -57295.8 to 57295.8, not "x"',
    ),
    "not a number": ("angle\n1\nnan\n2\n", None, "line 3: angle must be a number from -1000 to"),
    "a short row": ("phase,angle\n0,1\n0.5\n", None, "line 3: has 1 cells, the header has 2"),
    "back": (
        "phase,angle\n0,1\n0.5,2\n0.4,1\n",
        None,
        "line 4: phases must ascend from 0 to 1, not be 0.4 here",
    ),
    "in percent": ("phase,angle\n0,1\n50,2\n", None, "line 3: phase must be a number from -1 to 1"),
    "open": (
        "phase,angle\n0,1\n0.3,2\n0.6,3\n1,4\n",
        None,
        "line 5: the angle at phase 1 is 4, that at phase 0 1; a beat must end as it begins",
    ),
    "too few": ("angle\n1\n2\n", None, "shoulder.flap.samples: must be 3 to 1000 angles, not 2"),
}


@pytest.mark.parametrize(("content", "keys", "says"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_is_said_with_its_place(load, tmp_path, content, keys, says):
    with pytest.raises(birdmb.TopologyError, match=re.escape(says)) as caught:
        load(content, *([keys] if keys else []))
    text = str(caught.value)
    assert text.startswith(f"{tmp_path / 'bird.toml'}: {FLAP}.")
    assert "\n" not in text


def test_what_is_no_text_is_said(load, tmp_path):
    load(GOOD)
    (tmp_path / "data" / "flap.csv").write_bytes(b"angle\n\xff\n")
    with pytest.raises(birdmb.TopologyError, match=r"cannot be read \(no text in utf-8\)"):
        birdmb.load_bird(tmp_path / "bird.toml")
