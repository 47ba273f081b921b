"""Texts of others, such as the name of a bird, within texts of our own."""

from __future__ import annotations


def on_one_line(text: str) -> str:
    """A text on one line, its other control characters replaced by U+FFFD.

    Fit for a comment of a file that ends with the line.
    """
    line = " ".join(text.split())
    return "".join(c if c.isprintable() else "\ufffd" for c in line)


def in_figure(text: str) -> str:
    """A text as matplotlib draws it letter by letter: a dollar sign begins no formula."""
    return on_one_line(text).replace("$", r"\$")
