"""What is written reads as the same bird, whatever stands in its comment."""

import math
import tomllib

import pytest

import birdmb
from birdmb.errors import OutputError, TopologyError
from birdmb.topology.writing import bird_text, edited_text

from .conftest import TOPOLOGIES

SHIPPED = sorted(TOPOLOGIES.glob("*.toml"))
TAILED = TOPOLOGIES / "ibis_tail.toml"


@pytest.fixture(scope="module")
def tailed():
    return birdmb.load_bird(TAILED)


def changed_lines(before, after):
    """Lines that are only in the one, and only in the other text, without what is around."""
    old, new = before.splitlines(), after.splitlines()
    return [x for x in old if x not in new], [x for x in new if x not in old]


def test_no_line_of_the_comment_becomes_a_value(ibis):
    about = ["from a $bird$\n[body]\nmass = 99.0", "\r[gait]", "nul \0, delete \x7f", "\u2028x = 1"]
    text = bird_text(ibis, about)
    assert tomllib.loads(text) == tomllib.loads(bird_text(ibis))
    assert text.splitlines()[0] == "# from a $bird$ [body] mass = 99.0"
    assert len([line for line in text.splitlines() if line.startswith("#")]) == len(about)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_saved_bird_is_the_same_bird(path, tmp_path):
    bird = birdmb.load_bird(path)
    saved = bird.save(tmp_path / "bird.toml", about=["one\ntwo"])
    assert birdmb.load_bird(saved).fingerprint() == bird.fingerprint()
    assert [file.name for file in tmp_path.iterdir()] == ["bird.toml"]


def test_angles_are_in_degrees_where_these_are_short(ibis):
    text = bird_text(ibis.with_values({"shoulder.pitch.offset": 0.2, "elbow.sweep.offset_deg": 7}))
    assert "offset = 0.2\n" in text
    assert "offset_deg = 7.0\n" in text


def test_tables_of_a_new_file(tailed):
    bird = tailed.with_values(
        {"shoulder.flap.left.stiffness": 20.0, "shoulder.flap.right.stiffness": 30.0}
    )
    text = bird_text(bird)
    for line in (
        "root = {x = 0.05, y = 0.05, z = 0.0}",
        "[segments.humerus]",
        "[[joints]]",
        "left = {stiffness = 20.0}",
        'shares = {"elbow.sweep" = 0.5}',
    ):
        assert line in text.splitlines()
    assert birdmb.topology.Bird.model_validate(tomllib.loads(text)) == bird


def test_a_place_that_cannot_be_written_is_said(ibis, tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        ibis.save(tmp_path)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_bird_without_changes_keeps_its_file_to_the_letter(path):
    assert edited_text(birdmb.load_bird(path), path) == path.read_text(encoding="utf-8")


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_the_file_of_another_bird_becomes_that_of_this_one(path, tmp_path):
    """Whatever of tails, hinges, springs and numbers both have or have not."""
    bird = birdmb.load_bird(path)
    for like in SHIPPED:
        saved = bird.save(tmp_path / "bird.toml", like=like)
        assert birdmb.load_bird(saved) == bird
        first = like.read_text(encoding="utf-8").splitlines()[0]
        assert saved.read_text(encoding="utf-8").startswith(first)


def test_only_what_is_another_value_is_typed_anew(tailed):
    values = {
        "gravity": 3.7,
        "wing.root.x": 0.06,
        "forearm.roll.offset_deg": -7.5,
        "shoulder.pitch.offset": 0.3,
        "shoulder.flap.left.amplitude_deg": 33,
        "body.side_area": 0.01,
        "segments.hand.mass": 0.02,
    }
    before, after = TAILED.read_text(), edited_text(tailed.with_values(values), TAILED)
    gone, new = changed_lines(before, after)
    assert new == [
        "gravity = 3.7  # m/s2",
        "side_area = 0.01",
        "root = { x = 0.06, y = 0.05, z = 0.0 }  # right shoulder, from the body's centre of mass",
        "mass = 0.02",
        "offset = 0.3       # rad, 11.46 degrees",
        "left = {amplitude_deg = 33.0}",
        "offset_deg = -7.5  # levels the flight",
    ]
    assert len(gone) == 4  # a segment's mass is that of others, too
    # A new key is at the end of its table, before the remark on what follows.
    lines = after.splitlines()
    assert lines[lines.index("side_area = 0.01") + 1 :][:2] == ["", "[wing]"]
    assert lines[lines.index("left = {amplitude_deg = 33.0}") - 1] == "phase_deg = 180"


def test_an_angle_keeps_its_unit_with_all_its_digits(tailed):
    turned = tailed.with_values(
        {"forearm.roll.offset_deg": -100 / 7, "shoulder.pitch.amplitude": 0.1 / 7}
    )
    text = edited_text(turned, TAILED)
    assert f"offset_deg = {-100 / 7!r}  # levels the flight" in text
    assert f"amplitude = {0.1 / 7!r}  # rad, 0.8 degrees" in text


def test_an_angle_that_no_number_of_degrees_is_goes_to_radians(tailed):
    def in_degrees(angle):
        near = [degrees := math.degrees(angle)]
        near += [math.nextafter(degrees, 0.0), math.nextafter(degrees, 90.0)]
        return angle in map(math.radians, near)

    angle = next(x for k in range(1000) if not in_degrees(x := 0.9 + k * 2**-53))
    turned = tailed.with_values({"wrist.sweep.offset": angle})
    text = edited_text(turned, TAILED).split('name = "wrist.sweep"')[1].split("[[")[0]
    assert f"offset = {angle!r}" in text
    assert "offset_deg" not in text


def test_what_is_taken_off_leaves_the_remark_on_what_follows(tailed):
    text = edited_text(tailed.with_values({"tail": None}), TAILED)
    assert "[tail]" not in text
    assert "\n[drag]  # besides the induced drag" in text
    document = tailed.model_dump(exclude_unset=True)
    del document["drag"]
    without = type(tailed).model_validate(document)
    text = edited_text(without, TAILED)
    assert "[drag]" not in text
    assert "\n\n# Segments. Frame with the wing stretched out" in text


def test_moments_in_one_tensor_become_keys_where_one_changes(tmp_path):
    like = tmp_path / "like.toml"
    typed = TAILED.read_text().replace("inertia_yy = 0.1 ", "inertia = [0.02, 0.1, 0.11] ")
    for key in ("inertia_xx", "inertia_zz"):
        typed = "\n".join(line for line in typed.splitlines() if not line.startswith(key))
    like.write_text(typed, encoding="utf-8")
    bird = birdmb.load_bird(like)
    assert edited_text(bird, like) == typed
    heavier = bird.with_values({"body.inertia_yy": 0.2})
    saved = heavier.save(like, like=like)
    assert birdmb.load_bird(saved) == heavier
    assert "inertia =" not in like.read_text().split("[wing]")[0]


def test_dotted_keys_and_tables_in_any_order(ibis, tmp_path):
    like = tmp_path / "like.toml"
    text = (TOPOLOGIES / "ibis.toml").read_text()
    body = text.split("[body]")[1].split("\n[wing]")[0]
    text = text.replace(f"[body]{body}", "").replace("[gait]\n", "")
    text = text.replace("frequency = 4.0", "").replace(
        "gravity = 9.81", "gait.frequency = 4.0  # dotted\ngravity = 9.81"
    )
    hand = "[segments.hand]" + text.split("[segments.hand]")[1].split("\n\n")[0]
    like.write_text(text.replace(hand, "") + f"\n[body]{body}\n{hand}\n", encoding="utf-8")
    assert birdmb.load_bird(like) == ibis
    other = ibis.with_values(
        {"gait.frequency": 5.0, "segments.hand.mass": 0.02, "segments.humerus.mass": 0.03}
    )
    other.save(like, like=like)
    assert birdmb.load_bird(like) == other
    assert "gait.frequency = 5.0  # dotted" in like.read_text()


def test_feathers_are_known_by_their_names(ibis, tmp_path):
    like = tmp_path / "like.toml"
    head, *feathers = (TOPOLOGIES / "ibis.toml").read_text().split("[[feathers]]")
    like.write_text("[[feathers]]".join([head, *(f"{f}\n" for f in feathers[::-1])]))
    other = ibis.with_values({"feathers.5.length": 0.16, "feathers.1.length": 0.26})
    other.save(like, like=like)
    assert birdmb.load_bird(like) == other
    fewer = type(ibis).model_validate(
        {**ibis.model_dump(), "feathers": [f.model_dump() for f in ibis.feathers if f.name != "3"]}
    )
    fewer.save(like, like=like)
    assert birdmb.load_bird(like) == fewer
    assert like.read_text().startswith(head[:100])


def test_a_file_that_cannot_be_kept_is_said_and_left(ibis, tmp_path):
    with pytest.raises(TopologyError, match="cannot be read"):
        ibis.save(tmp_path / "new.toml", like=tmp_path / "none.toml")
    wrong = tmp_path / "wrong.toml"
    wrong.write_text("name = 3\n")
    with pytest.raises(TopologyError, match=r"wrong\.toml: name: must be a text"):
        ibis.save(tmp_path / "new.toml", like=wrong)
    assert [file.name for file in tmp_path.iterdir()] == ["wrong.toml"]


def test_drivers_of_any_kind_are_kept(tmp_path):
    (tmp_path / "flap.csv").write_text("angle_deg\n0\n40\n0\n-40.5\n")
    like = tmp_path / "like.toml"
    text = (TOPOLOGIES / "ibis.toml").read_text()
    joints = text.split("[[joints]]")
    joints[2] = joints[2].replace("amplitude_deg = 42", 'file = "flap.csv"  # measured')
    joints[2] = joints[2].replace("phase_deg = 180\n", "")
    joints[3] = joints[3].replace(
        "phase_deg = 90", "phase_deg = 90\nharmonics = [{ order = 2, sine_deg = 3 }]  # second"
    )
    like.write_text("[[joints]]".join(joints))
    bird = birdmb.load_bird(like)
    assert edited_text(bird, like) == like.read_text()
    other = bird.with_values(
        {"shoulder.flap.gain": 1.5, "shoulder.sweep.harmonics.2.sine_deg": 4, "gravity": 9.8}
    )
    folder = tmp_path / "folder"
    folder.mkdir()
    for place in (tmp_path / "new.toml", folder / "new.toml"):
        assert birdmb.load_bird(other.save(place, like=like)) == other
        assert birdmb.load_bird(other.save(place)) == other
    text = other.save(folder / "new.toml", like=like).read_text()
    assert 'file = "../flap.csv"  # measured' in text
    assert "harmonics = [{ order = 2, sine_deg = 4.0 }]  # second" in text
    sampled = bird.with_values({"shoulder.flap.samples_deg": [0, 30, 0, -30]})
    assert birdmb.load_bird(sampled.save(like, like=like)) == sampled
    assert "samples_deg = [0.0, 30.0, 0.0, -30.0]" in like.read_text()
    assert "flap.csv" not in like.read_text()
