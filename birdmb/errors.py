"""Every error that birdmb raises on purpose: one clear sentence each, for people."""

from __future__ import annotations

from collections.abc import Iterable

from birdmb.text import nearest

_LONGEST = 300  # characters of a sentence within the name of an error


class BirdmbError(Exception):
    """Base of all deliberate errors; its text is fit to be shown to a user as it is."""

    def __repr__(self) -> str:
        """Return the sentence within the name: arrays that an error keeps are not shown."""
        text = str(self)
        text = text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
        return f"{type(self).__name__}({text!r})"


class ArgumentError(BirdmbError, ValueError):
    """An argument has the wrong shape or value, or two arguments contradict each other."""


class ArgumentTypeError(ArgumentError, TypeError):
    """An argument is of the wrong kind."""


class UnknownNameError(ArgumentError, AttributeError):
    """Something has no such attribute; the text names those like it."""


class UnknownKeyError(ArgumentError, KeyError):
    """Something holds nothing of that name; the text names those like it."""

    def __str__(self) -> str:
        """Return the sentence, without the quotes that are put about a key."""
        return str(self.args[0])


class ImmutableError(ArgumentError, AttributeError):
    """What cannot be changed was assigned to; the text says how to get a changed one."""


class TopologyError(BirdmbError):
    """A topology file, a dotted name or a value is wrong; the text names file, key and value."""


class OrbitError(BirdmbError):
    """A computation on an orbit could not be carried through."""


class StateError(BirdmbError):
    """A flow left the states in which its model means anything (NaN, overflow, out of validity)."""


class DataFileError(BirdmbError, ValueError):
    """A file holds none of the program's results, a damaged one, or one of another format."""


class OutputError(BirdmbError):
    """A file cannot be written: the disk is full, say, or the place is not writable."""


def no_attribute(owner: str, name: str, known: Iterable[str]) -> UnknownNameError:
    """The error that `owner` has no such attribute; the nearest among the `known` are named."""
    return UnknownNameError(f"{owner} has no {name}; the nearest: {nearest(name, known)}.")
