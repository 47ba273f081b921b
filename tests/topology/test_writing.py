"""What is written reads as the same bird, whatever stands in its comment."""

import tomllib

import pytest

import birdmb
from birdmb.errors import OutputError
from birdmb.topology.writing import bird_text, write_bird


def test_no_line_of_the_comment_becomes_a_value(ibis):
    about = ["from a $bird$\n[body]\nmass = 99.0", "\r[gait]", "nul \0, delete \x7f", "\u2028x = 1"]
    text = bird_text(ibis, about)
    assert tomllib.loads(text) == tomllib.loads(bird_text(ibis))
    assert text.splitlines()[0] == "# from a $bird$ [body] mass = 99.0"
    assert len([line for line in text.splitlines() if line.startswith("#")]) == len(about)


def test_a_written_bird_is_the_same_bird(ibis, tmp_path):
    path = write_bird(ibis, tmp_path / "bird.toml", ["one\ntwo"])
    assert birdmb.load_bird(path).fingerprint() == ibis.fingerprint()
    assert [file.name for file in tmp_path.iterdir()] == ["bird.toml"]


def test_a_place_that_cannot_be_written_is_said(ibis, tmp_path):
    with pytest.raises(OutputError, match="cannot be written"):
        write_bird(ibis, tmp_path)
