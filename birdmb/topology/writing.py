"""Writing a bird as a topology file, a new one or one like another with its comments."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path

import tomlkit

from birdmb.errors import TopologyError
from birdmb.files import write_whole
from birdmb.text import on_one_line
from birdmb.topology.documents import read_document
from birdmb.topology.driver_files import move_driver_files, with_driver_files
from birdmb.topology.editing import edit
from birdmb.topology.messages import validated
from birdmb.topology.parts import Part
from birdmb.topology.tables import keyed_item, table_of

_EMPTY_LINES, _ONE_OF_THEM = re.compile("\n{3,}"), "\n\n"


def bird_text(bird: Part, about: Sequence[str] = ()) -> str:
    """A bird as TOML that `load_bird` reads as the same bird; what it left to defaults is left out.

    `about` are lines of comment to put before it, each on one line whatever it holds. Angles
    are in degrees where that is exact.
    """
    document = tomlkit.document()
    for key, value in table_of(bird).items():
        document.append(*keyed_item(key, value, heading=True))
    return f"{_comments(about)}\n{_EMPTY_LINES.sub(_ONE_OF_THEM, tomlkit.dumps(document))}"


def edited_text(
    bird: Part,
    like: str | PathLike[str],
    about: Sequence[str] = (),
    path: str | PathLike[str] | None = None,
) -> str:
    """The text of the topology file `like` with the values of a bird where they differ.

    Comments, order, and values that are the same stay as they are typed; an angle stays in the unit
    it is typed in. `about` as for `bird_text`. Files of samples are named from the folder of
    `path`, where the text is to be written, or of `like`.

    Raises:
        TopologyError: the file is none of a bird, or its text cannot be kept with these values.
    """
    text, values = read_document(like)
    before = validated(type(bird), values, str(like))
    document = tomlkit.parse(text)
    target = Path(like if path is None else path)
    move_driver_files(document, Path(like), target)
    edit(document, table_of(before), table_of(bird))
    edited = tomlkit.dumps(document)
    if not _is_read_as(bird, edited, target):
        raise TopologyError(
            f"{like}: the text of this file cannot be kept with these values; write them into a "
            "new file, without it"
        )
    return _comments(about) + edited


def write_bird(
    bird: Part,
    path: str | PathLike[str],
    about: Sequence[str] = (),
    like: str | PathLike[str] | None = None,
) -> Path:
    """Write `bird_text`, or `edited_text` where there is a file `like`, into a file.

    Returns:
        The path.

    Raises:
        OutputError: the file cannot be written.
        TopologyError: as `edited_text`.
    """
    text = bird_text(bird, about) if like is None else edited_text(bird, like, about, path)
    return write_whole(path, text.encode())


def _comments(about: Sequence[str]) -> str:
    return "".join(f"# {on_one_line(line)}".rstrip() + "\n" for line in about)


def _is_read_as(bird: Part, text: str, path: Path) -> bool:
    try:
        values = with_driver_files(tomllib.loads(text), path)
        read = validated(type(bird), values, "the edited text")
    except (tomllib.TOMLDecodeError, TopologyError):
        return False
    return _in_order(read.model_dump()) == _in_order(bird.model_dump())


def _in_order(document: object) -> object:
    """A document to compare: the order of keys counts, as that of a wing's segments."""
    if isinstance(document, Mapping):
        return [(key, _in_order(value)) for key, value in document.items()]
    if isinstance(document, list | tuple):
        return [_in_order(value) for value in document]
    return document
