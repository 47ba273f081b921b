"""Every error that birdmb raises on purpose: one clear sentence each, for people."""

from __future__ import annotations


class BirdmbError(Exception):
    """Base of all deliberate errors; its text is fit to be shown to a user as it is."""


class ArgumentError(BirdmbError, ValueError):
    """An argument has the wrong shape or value, or two arguments contradict each other."""


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
