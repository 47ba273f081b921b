"""Texts of others, such as the name of a bird, within texts of our own; names like another."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

# How a character is written where there are but those of ASCII.
SPELLED_OUT = {
    **{"Λ": "Lambda", "Γ": "Gamma", "θ": "theta", "Δ": "Delta", "Φ": "Phi", "φ": "phi"},
    **{"°": "deg", "±": "+-", "−": "-", "–": "-", "—": "-", "×": "x", "·": "*", "…": "..."},
    **{"²": "2", "³": "3", "≤": "<=", "≥": ">=", "≈": "~", "∞": "inf", "→": "->", "←": "<-"},
    **{"“": '"', "”": '"', "„": '"', "’": "'", "‘": "'", "µ": "u", "•": "*"},
}
_ASCII = str.maketrans(SPELLED_OUT)


def on_one_line(text: str) -> str:
    """A text on one line, its other control characters replaced by U+FFFD.

    Fit for a comment of a file that ends with the line.
    """
    line = " ".join(text.split())
    return "".join(c if c.isprintable() else "\ufffd" for c in line)


def in_figure(text: str) -> str:
    """A text as matplotlib draws it letter by letter: a dollar sign begins no formula."""
    return on_one_line(text).replace("$", r"\$")


def spelled_out(text: str) -> str:
    """A text with the signs and Greek letters of our own written in ASCII."""
    return text.translate(_ASCII)


def nearest(word: str, known: Iterable[str]) -> str:
    """Up to three known words like `word`, the most similar first."""
    known = list(known)
    similar = difflib.get_close_matches(word, known)
    return ", ".join(similar or difflib.get_close_matches(word, known, cutoff=0.0))
