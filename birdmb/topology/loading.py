"""Reading a bird from a topology file."""

from __future__ import annotations

import tomllib
from os import PathLike
from pathlib import Path
from typing import Any

from birdmb.errors import TopologyError
from birdmb.topology.bird import Bird
from birdmb.topology.messages import validated

_LARGEST = 1_000_000  # bytes


def load_bird(path: str | PathLike[str]) -> Bird:
    """Read and validate a topology file (TOML).

    Raises `TopologyError`, one sentence naming file, key, value and what would be right, if the
    file cannot be read or does not describe a possible bird.
    """
    return validated(Bird, read_document(path), str(path))


def read_document(path: str | PathLike[str]) -> dict[str, Any]:
    """Read the tables of a file about a bird (TOML).

    Raises:
        TopologyError: it cannot be read.
    """
    origin = str(path)
    try:
        with Path(path).open("rb") as file:
            content = file.read(_LARGEST + 1)  # not all that a device has to give
        if len(content) > _LARGEST:
            raise TopologyError(f"{origin}: is larger than 1 MB; a topology file has a few kB")
        return tomllib.loads(content.decode("utf-8-sig"))
    except OSError as error:
        reason = (error.strerror or "unknown reason").lower()
        raise TopologyError(
            f"{origin}: cannot be read ({reason}); it must be a topology file"
        ) from error
    except UnicodeDecodeError as error:
        raise TopologyError(f"{origin}: is no text in UTF-8; a topology file must be") from error
    except tomllib.TOMLDecodeError as error:
        raise TopologyError(f"{origin}: is not valid TOML: {error}") from error
    except (ValueError, RecursionError) as error:  # which the parser lets through
        raise TopologyError(
            f"{origin}: cannot be read as TOML; a number has thousands of digits, or brackets are "
            "nested too deep"
        ) from error
