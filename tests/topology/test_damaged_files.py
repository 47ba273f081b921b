"""Files that are no topology files, and any damage to one: one sentence each."""

import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from birdmb.errors import TopologyError
from birdmb.topology import load_bird
from birdmb.topology.bird import Bird
from birdmb.topology.messages import validated

from .conftest import TOPOLOGIES

IBIS = (TOPOLOGIES / "ibis.toml").read_text(encoding="utf-8")


def test_missing_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(TopologyError) as caught:
        load_bird("ibis.toml")
    assert str(caught.value) == (
        "ibis.toml: cannot be read (no such file or directory); it must be a topology file"
    )


def test_directory(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(TopologyError) as caught:
        load_bird(".")
    assert str(caught.value) == ".: cannot be read (is a directory); it must be a topology file"


def test_toml_syntax(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ibis.toml").write_text('name = "ibis"\ngravity 9.81\n')
    with pytest.raises(TopologyError) as caught:
        load_bird("ibis.toml")
    assert str(caught.value) == (
        "ibis.toml: is not valid TOML: Expected '=' after a key in a key/value pair "
        "(at line 2, column 9)"
    )


# What a file holds, and what the sentence must say.
BAD_FILES = {
    "UTF-16": ("name = 1".encode("utf-16"), "is no text in UTF-8"),
    "NUL": (b"name = \0", "is not valid TOML"),
    "digits": (b"gravity = " + b"9" * 5000, "a number has thousands of digits"),
    "brackets": (b"name = " + b"[" * 100_000, "brackets are nested too deep"),
    "tables": (b"name = " + b"{a=" * 100_000, "brackets are nested too deep"),
    "large": (b"#" * 1_000_001, "is larger than 1 MB"),
    "key twice": (b"name = 1\nname = 2", "is not valid TOML"),
    "dotted keys in conflict": (b"air = 1\nair.density = 2", "is not valid TOML"),
    "no date": (b"name = 2026-13-45", "is not valid TOML"),
    "empty": (b"", "name: missing"),
    "hexadecimal digits": (IBIS.replace("9.81", "0x" + "f" * 5000).encode(), "gravity: must be"),
}


@pytest.mark.parametrize(("content", "says"), BAD_FILES.values(), ids=BAD_FILES)
def test_bad_files(tmp_path, content, says):
    path = tmp_path / "bird.toml"
    path.write_bytes(content)
    with pytest.raises(TopologyError) as caught:
        load_bird(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert says in str(caught.value)
    assert len(str(caught.value)) < 500


def test_a_mark_of_byte_order_is_no_mistake(tmp_path):
    path = tmp_path / "bird.toml"
    path.write_bytes(b"\xef\xbb\xbf" + IBIS.encode())
    assert load_bird(path).name == "ibis"


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="reads /dev/zero")
def test_a_file_without_an_end():
    with pytest.raises(TopologyError, match="is larger than 1 MB"):
        load_bird("/dev/zero")


def test_not_a_text(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "ibis.toml").write_bytes(b"\xff\xfe")
    with pytest.raises(TopologyError) as caught:
        load_bird("ibis.toml")
    assert str(caught.value) == "ibis.toml: is no text in UTF-8; a topology file must be"


def _places(table, place=()):
    for key, value in table.items() if isinstance(table, dict) else enumerate(table):
        yield (*place, key)
        if isinstance(value, dict | list):
            yield from _places(value, (*place, key))


SCALARS = (
    st.floats()
    | st.integers()
    | st.booleans()
    | st.text(max_size=5)
    | st.dates()
    | st.just(10**400)
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=10,
)
PLACES = sorted(_places(tomllib.loads(IBIS)), key=str)


@given(place=st.sampled_from(PLACES), value=VALUES)
def test_any_damage_is_one_sentence_or_a_bird(place, value):
    document = tomllib.loads(IBIS)
    table = document
    for part in place[:-1]:
        table = table[part]
    table[place[-1]] = value
    try:
        validated(Bird, document, "ibis.toml")
    except TopologyError as error:
        text = str(error)
        assert text.startswith("ibis.toml: ")
        assert "\n" not in text
        assert "nput should" not in text
        assert "dictionary" not in text
        assert "tuple" not in text
