"""A page for each public name of `birdmb`, of its docstring and the examples that use it.

What its rooms give besides, as `birdmb.orbits.Steps`, is on one page a room.
"""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING

from made_pages import write_if_changed

import birdmb

if TYPE_CHECKING:
    from sphinx.application import Sphinx

# The rooms of the package in the order of a study, with what readers call their subjects.
SUBJECTS = {
    "topology": "Birds",
    "morphology": "Birds",
    "kinematics": "Measured gaits",
    "models": "Models, flights, gusts",
    "orbits": "Orbits of any system",
    "studies": "Studies",
    "figures": "Figures",
}
OTHERS = "Errors and files"
ROOMS = ("topology", "morphology", "models", "orbits", "studies", "figures")

INDEX = """The Python package
==================

.. currentmodule:: birdmb

What ``import birdmb`` gives. Each page has the docstring that ``help(birdmb.NAME)`` prints, and the
examples in which the name is at work.
"""


def subject_of(name: str) -> str:
    """The heading under which a name is listed."""
    thing = getattr(birdmb, name)
    if inspect.isclass(thing) and issubclass(thing, BaseException):
        return OTHERS
    return SUBJECTS.get(thing.__module__.split(".")[1], OTHERS)


def page(name: str) -> str:
    """The page of one name."""
    is_class = inspect.isclass(getattr(birdmb, name))
    lines = [name, "=" * len(name), "", ".. currentmodule:: birdmb", ""]
    lines += [f".. auto{'class' if is_class else 'function'}:: {name}"]
    lines += ["   :members:", "   :show-inheritance:"] if is_class else []
    lines += ["", f".. minigallery:: birdmb.{name}", "   :add-heading: Examples", ""]
    return "\n".join(lines)


def room_page(room: str) -> str:
    """The page of what a room gives besides the names of `birdmb` itself."""
    module = importlib.import_module(f"birdmb.{room}")
    known = [getattr(birdmb, name) for name in birdmb.__all__]
    title = f"birdmb.{room}"
    lines = [title, "=" * len(title), "", f".. currentmodule:: birdmb.{room}", ""]
    lines += [inspect.getdoc(module) or "", ""]
    for name in module.__all__:
        thing = getattr(module, name)
        if inspect.isclass(thing) and thing not in known:
            lines += [f".. autoclass:: {name}", "   :members:", "   :show-inheritance:", ""]
        elif inspect.isfunction(thing) and thing not in known:
            lines += [f".. autofunction:: {name}", ""]
    return "\n".join(lines)


def index() -> str:
    """The list of all names by subject."""
    lines = [INDEX]
    for subject in [*dict.fromkeys(SUBJECTS.values()), OTHERS]:
        names = [name for name in birdmb.__all__ if subject_of(name) == subject]
        lines += [subject, "-" * len(subject), "", ".. autosummary::", "   :nosignatures:", ""]
        lines += [*(f"   {name}" for name in names), ""]
    lines += [".. toctree::", "   :hidden:", ""]
    lines += [f"   {name} <python/{name}>" for name in sorted(birdmb.__all__, key=str.lower)]
    lines += ["", "Names of the rooms", "------------------", ""]
    lines += [
        "What fewer need, as ``birdmb.orbits.Steps``.",
        "",
        ".. toctree::",
        "   :maxdepth: 1",
        "",
    ]
    lines += [f"   python/in_{room}" for room in ROOMS]
    return "\n".join([*lines, ""])


def escape_moduli(
    app: Sphinx,  # noqa: ARG001 - Sphinx calls it so
    what: str,  # noqa: ARG001
    name: str,  # noqa: ARG001
    obj: object,  # noqa: ARG001
    options: object,  # noqa: ARG001
    lines: list[str],
) -> None:
    """Keep the bars of moduli in a docstring from being reST's substitutions."""
    text = re.split(r"(`[^`]*`)", "\n".join(lines))
    text[::2] = [part.replace("|", r"\|") for part in text[::2]]
    lines[:] = "".join(text).split("\n")


def write_pages(app: Sphinx) -> None:
    """Write the index and the pages, and take away those of names that have gone."""
    source = Path(app.srcdir)
    pages = {source / "python" / f"{name}.rst": page(name) for name in birdmb.__all__}
    pages |= {source / "python" / f"in_{room}.rst": room_page(room) for room in ROOMS}
    for path in (source / "python").glob("*.rst"):
        if path not in pages:
            path.unlink()
    for path, text in {source / "python.rst": index(), **pages}.items():
        write_if_changed(path, text)


def setup(app: Sphinx) -> dict[str, bool]:
    """Write them before pages are read."""
    app.connect("builder-inited", write_pages, priority=100)
    app.connect("autodoc-process-docstring", escape_moduli)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
