"""The page of the command line, made of the commands themselves by typer's own generator."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import typer
from made_pages import write_if_changed
from typer.cli import get_docs_for_click

from birdmb.cli.app import app as commands

if TYPE_CHECKING:
    from sphinx.application import Sphinx

INTRODUCTION = """What `birdmb COMMAND --help` says of each command. `python -m birdmb` is the same.

"""


def page() -> str:
    """The page in Markdown."""
    command = typer.main.get_command(commands)
    context = command.make_context("birdmb", [], resilient_parsing=True)
    text = get_docs_for_click(obj=command, ctx=context, name="birdmb", title="The command line")
    heading, _, rest = text.partition("\n\n")
    # Of its list of commands the sentences end in dots; the site has one at the side.
    rest = re.sub(r"\*\*Commands\*\*:\n\n(\* .*\n)+", "", rest)
    rest = re.sub(r"^(Example: )?(birdmb .*)$", r"\1`\2`", rest, flags=re.M)
    return f"{heading}\n\n{INTRODUCTION}{rest.strip()}\n"


def setup(app: Sphinx) -> dict[str, bool]:
    """Write it before pages are read."""
    app.connect(
        "builder-inited",
        lambda app: write_if_changed(Path(app.srcdir) / "command_line.md", page()),
        priority=100,
    )
    return {"parallel_read_safe": True, "parallel_write_safe": True}
