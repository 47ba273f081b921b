"""Standard output and error as they may be: not in UTF-8, closed, full, or read by nobody."""

from __future__ import annotations

import codecs
import os
import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress

from birdmb.cli.outcome import BAD_INPUT
from birdmb.text import SPELLED_OUT

# First and last of Unicode's characters for drawing lines, filling bars, and of braille.
_BOXES, _BLOCKS, _LAST_BLOCK = "\u2500", "\u2580", "\u259f"
_BRAILLE, _LAST_BRAILLE = "\u2800", "\u28ff"
_DRAWN = dict.fromkeys("─━╌╍┄┅═╸╺╴╶", "-") | dict.fromkeys("│┃║╎╏", "|")
_NOBODY_READS = 141  # as a shell reports the signal that usually ends a program then


@contextmanager
def standard_streams() -> Iterator[None]:
    """Write to the standard streams within whatever they are.

    A character that their encoding lacks is spelled out. What is written to a closed one is lost;
    one that cannot be written ends the process with a sentence, and silently if nobody reads on.
    """
    codecs.register_error("spelled out", _spelled_out)
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115, PTH123
        getattr(sys, name).reconfigure(errors="spelled out")
    try:
        try:
            yield
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        _discard_what_is_left()
        raise SystemExit(_NOBODY_READS) from None
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        with suppress(OSError):  # standard error may be what is full
            sys.stderr.write(
                f"Error: {error.filename or 'standard output'} cannot be written ({reason}).\n"
            )
        _discard_what_is_left()
        raise SystemExit(BAD_INPUT) from None


def _spelled_out(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    lacking = error.object[error.start : error.end]
    return "".join(map(_in_ascii, lacking)), error.end


def _in_ascii(character: str) -> str:
    """A character in ASCII: spelled out, drawn, without its accent, or as a question mark."""
    if character in SPELLED_OUT:
        return SPELLED_OUT[character]
    if _BRAILLE <= character <= _LAST_BRAILLE:  # of a spinner
        return "*"
    if _BOXES <= character < _BLOCKS:
        return _DRAWN.get(character, "+")
    if _BLOCKS <= character <= _LAST_BLOCK:
        return "#"
    plain = unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode()
    return plain or "?"


def _discard_what_is_left() -> None:
    """Keep Python from trying once more, in vain, when it closes the streams."""
    null = os.open(os.devnull, os.O_WRONLY)
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            os.dup2(null, stream.fileno())


@contextmanager
def only_results_on_stdout() -> Iterator[None]:
    """Send what libraries print on the way, as Exudyn does, to standard error."""
    with redirect_stdout(sys.stderr):
        yield
