"""A page for each public name of `birdmb`, of its docstring and the examples that use it.

What its rooms give besides, as `birdmb.orbits.Steps`, is on one page a room.
"""

from __future__ import annotations

import importlib
import inspect
import re
from pathlib import Path
from typing import TYPE_CHECKING, get_overloads

from made_pages import write_if_changed
from sphinx.pycode import ModuleAnalyzer

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


def untyped_signature(function: object) -> str:
    """The signature of a function with overloads, of which only the types differ."""
    if not (inspect.isfunction(function) and get_overloads(function)):
        return ""
    signature = inspect.signature(function)
    empty = inspect.Signature.empty
    plain = [each.replace(annotation=empty) for each in signature.parameters.values()]
    return str(signature.replace(parameters=plain, return_annotation=empty))


def members(cls: type) -> list[str]:
    """Options of a class's directive: its own members, and its bases where readers know them."""
    known = [getattr(birdmb, name) for name in birdmb.__all__]
    lines = ["   :members:", "   :exclude-members: model_config"]
    if any(base in known or base in (ValueError, Exception) for base in cls.__bases__):
        lines += ["   :show-inheritance:"]
    return lines


def page(name: str) -> str:
    """The page of one name."""
    thing = getattr(birdmb, name)
    is_class = inspect.isclass(thing)
    lines = [name, "=" * len(name), "", ".. currentmodule:: birdmb", ""]
    lines += [f".. auto{'class' if is_class else 'function'}:: {name}{untyped_signature(thing)}"]
    lines += members(thing) if is_class else []
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
            lines += [f".. autoclass:: {name}", *members(thing), ""]
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


def plain_prose(
    app: Sphinx,  # noqa: ARG001 - Sphinx calls it so
    what: str,
    name: str,  # noqa: ARG001
    obj: object,  # noqa: ARG001
    options: object,  # noqa: ARG001
    lines: list[str],
) -> None:
    """Keep what a docstring means: bars of moduli are no substitutions, and no word is a type."""
    if what in {"attribute", "property", "data"}:
        lines.insert(0, "")  # else napoleon takes what is before a colon for a type
    text = re.split(r"(`[^`]*`)", "\n".join(lines))
    text[::2] = [part.replace("|", r"\|") for part in text[::2]]
    lines[:] = "".join(text).split("\n")


def name_aliases(app: Sphinx, what: str, name: str, *_: object) -> None:  # noqa: ARG001
    """Show an alias of a type in a union by its name, where Sphinx shows how it holds it."""
    annotations = app.env.current_document.autodoc_annotations.get(name, {})
    for key, text in annotations.items():
        annotations[key] = re.sub(r"TypeAliasForwardRef\('(\w+)'\)", r"\1", text)


def write_pages(app: Sphinx) -> None:
    """Write the index and the pages, and take away those of names that have gone."""
    for name in birdmb.__all__:
        if untyped_signature(getattr(birdmb, name)):
            analyzer = ModuleAnalyzer.for_module(getattr(birdmb, name).__module__)
            analyzer.analyze()
            analyzer.overloads.clear()  # of which Sphinx would show each
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
    app.connect("autodoc-process-docstring", plain_prose, priority=100)
    app.connect("autodoc-process-signature", name_aliases, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
