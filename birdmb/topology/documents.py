"""Reading the text of a topology file."""

from __future__ import annotations

import tomllib
from os import PathLike
from pathlib import Path
from typing import Any

from birdmb.errors import TopologyError
from birdmb.topology.driver_files import with_driver_files

_LARGEST = 1_000_000  # bytes


def read_document(path: str | PathLike[str], kind: str = "topology") -> tuple[str, dict[str, Any]]:
    """The text of a topology file and its values, with the samples of files, not validated.

    `kind` is what errors call the file.

    Raises:
        TopologyError: the file, or one of samples that it names, cannot be read.
    """
    origin = str(path)
    try:
        with Path(path).open("rb") as file:
            content = file.read(_LARGEST + 1)  # not all that a device has to give
        if len(content) > _LARGEST:
            raise TopologyError(f"{origin}: is larger than 1 MB; a {kind} file has a few kB")
        text = content.decode("utf-8-sig")
        values = tomllib.loads(text)
    except OSError as error:
        reason = (error.strerror or "unknown reason").lower()
        raise TopologyError(
            f"{origin}: cannot be read ({reason}); it must be a {kind} file"
        ) from error
    except UnicodeDecodeError as error:
        raise TopologyError(f"{origin}: is no text in UTF-8; a {kind} file must be") from error
    except tomllib.TOMLDecodeError as error:
        raise TopologyError(f"{origin}: is not valid TOML: {error}") from error
    except (ValueError, RecursionError) as error:  # which the parser lets through
        raise TopologyError(
            f"{origin}: cannot be read as TOML; a number has thousands of digits, or brackets are "
            "nested too deep"
        ) from error
    return text, with_driver_files(values, Path(path))
