"""A checksum at the end of a file, by which damage shows before anything in it is believed.

Readers of HDF5 pass over what follows the end that the file itself names.
"""

from __future__ import annotations

import hashlib

_MARK = b"\nbirdmb sha256 "
_SIZE = len(_MARK) + 64 + 1


def sealed(content: bytes) -> bytes:
    """The content, followed by its checksum."""
    return content + _MARK + hashlib.sha256(content).hexdigest().encode() + b"\n"


def unsealed(file: bytes) -> bytes | None:
    """The content of a file that was `sealed`; `None` if it has no checksum at its end.

    Raises:
        ValueError: the content is not what the checksum was made of.
    """
    content, seal = file[:-_SIZE], file[-_SIZE:]
    if not seal.startswith(_MARK):
        return None
    if sealed(content) != file:
        raise ValueError("its checksum is another")
    return content
