"""The birds that come with the package."""

from __future__ import annotations

from itertools import takewhile
from os import PathLike, fspath
from pathlib import Path

from birdmb.errors import TopologyError
from birdmb.text import nearest
from birdmb.topology.messages import shown

_PACKAGE = Path(__file__).parents[1]
_SUFFIX = ".toml"


def bird_names() -> tuple[str, ...]:
    """Names of the birds that come with the package, as `load_bird` takes them."""
    return tuple(sorted(path.stem for path in _folder().glob(f"*{_SUFFIX}")))


def topology_file(name: str | PathLike[str]) -> Path:
    """The topology file of a bird that comes with the package, or the file of that path.

    Raises:
        TopologyError: the name is that of no bird and of no file.
    """
    path = Path(name)
    if path.suffix or path.name != fspath(name) or path.is_file():
        return path
    known = bird_names()
    if path.name not in known:
        raise TopologyError(
            f"{shown(path.name)} is no file, and no bird of this package; the nearest: "
            f"{nearest(path.name, known)} (`birdmb birds` lists all)"
        )
    return _folder() / f"{path.name}{_SUFFIX}"


def summary(path: Path) -> str:
    """What a topology file says of its bird: the first paragraph of the comment at its top."""
    lines = path.read_text(encoding="utf-8").splitlines()
    comment = takewhile(lambda line: line.startswith("#"), lines)
    words = [line.removeprefix("#").strip() for line in comment]
    return " ".join(takewhile(bool, words))


def _folder() -> Path:
    """In the package where it is installed, at the top level in a checkout."""
    installed = _PACKAGE / "topologies"
    return installed if installed.is_dir() else _PACKAGE.parent / "topologies"
