"""Names of others in our files and figures."""

import tomllib
import warnings

import pytest
from matplotlib.figure import Figure

from birdmb.text import in_figure, on_one_line

NAMES = [
    "ibis",
    "$",
    "a $ b",
    "$x^$ and $\\frac",
    "\\$5",
    "[/oops] [bold]",
    "two\nlines\r\nthree\u2028four",
    "nul\0 bell\a escape\x1b[31m delete\x7f",
    "lone \ud800",
]


@pytest.mark.parametrize("name", NAMES)
def test_names_are_drawn_letter_by_letter(name):
    figure = Figure()
    axes = figure.subplots()
    texts = [
        figure.suptitle(in_figure(name)),
        axes.set_xlabel(f"{in_figure(name)} (°)"),
        axes.set_title(f"$F_x$ of {in_figure(name)}"),
    ]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure.draw_without_rendering()
    for text in texts[:2]:
        shown, math = text._preprocess_math(text.get_text())
        assert math is False
        assert shown.removesuffix(" (°)") == on_one_line(name)


@pytest.mark.parametrize("name", NAMES)
def test_a_comment_ends_with_its_line(name):
    comment = on_one_line(f"{name}\nkey = 1")
    assert tomllib.loads(f"# {comment}\n") == {}
    assert comment.encode().decode() == comment
