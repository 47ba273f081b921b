"""Changing the values of a TOML document, and nothing else of its text."""

from __future__ import annotations

from typing import TypeAlias

from tomlkit.container import Container, OutOfOrderTableProxy
from tomlkit.items import AoT, Array, InlineTable, Item, Key, Whitespace
from tomlkit.items import Table as Heading

from birdmb.topology.tables import Table, Value, is_tables, keyed_item

Tables: TypeAlias = Container | Heading | InlineTable | OutOfOrderTableProxy
_Lines: TypeAlias = list[tuple[Key | None, Item]]


def edit(typed: Tables, before: Table, wanted: Table) -> None:
    """Change a table of a document from the values that it is read as to those `wanted`."""
    gone = [key for key in before if key not in wanted]
    changed = [key for key, value in wanted.items() if before.get(key) != value]
    if any(key in before and not _typed_key(typed, key) for key in (*gone, *changed)):
        # The values are typed in another form, as all moments of inertia in one tensor.
        for key in [key for key in typed if key.removesuffix("_deg") not in wanted]:
            del typed[key]
        gone = []
        changed += [key for key in wanted if key not in changed and not _typed_key(typed, key)]
    for key in gone:
        _remove(typed, _typed_key(typed, key))
    for key in changed:
        if name := _typed_key(typed, key):
            _change(typed, name, key, before[key], wanted[key])
        else:
            _add(typed, key, wanted[key])


def _typed_key(typed: Tables, key: str) -> str:
    """The key as it is typed, perhaps with its unit; empty if it is not."""
    return next((name for name in (key, f"{key}_deg") if name in typed), "")


def _change(typed: Tables, name: str, key: str, before: Value, wanted: Value) -> None:
    there = typed[name]
    if isinstance(there, Tables) and isinstance(before, dict) and isinstance(wanted, dict):
        edit(there, before, wanted)
    elif not (isinstance(there, AoT | Array) and _edit_list(there, before, wanted)):
        heading = isinstance(there, Heading | AoT)
        new, item = keyed_item(key, wanted, heading=heading, unit=name.removeprefix(key))
        if new == name:
            typed[name] = item
        else:  # no number of degrees is this angle
            del typed[name]
            _add(typed, key, wanted)


def _edit_list(typed: AoT | Array, before: Value, wanted: Value) -> bool:
    """Change a list of tables that stay the same by name, or in number; return whether they do."""
    if not (isinstance(before, list) and isinstance(wanted, list) and is_tables(wanted)):
        return False
    # Of a bird, they may be in another order.
    olds, news = _by_name(before), _by_name(wanted)
    tables = {table.get("name", i): table for i, table in enumerate(typed)}
    if not tables.keys() == olds.keys() == news.keys():
        return False
    for name, table in tables.items():
        edit(table, olds[name], news[name])
    return True


def _by_name(tables: list[Value]) -> dict[Value, Table]:
    each = (table for table in tables if isinstance(table, dict))
    return {table.get("name", i): table for i, table in enumerate(each)}


def _add(typed: Tables, key: str, wanted: Value) -> None:
    lines = _lines(typed)
    below = [] if isinstance(typed, Container) else _cut_comments(lines)
    name, item = keyed_item(key, wanted, heading=isinstance(typed, Container), unit="_deg")
    typed[name] = item
    lines.extend(below)


def _remove(typed: Tables, name: str) -> None:
    """Take a key off. A comment at the end of its table is about what follows, and stays."""
    lines = _lines(typed)
    places = [i for i, (key, _) in enumerate(lines) if key is not None and key.key == name]
    below = _cut_comments(_last_lines(typed[name]))
    del typed[name]
    if places:
        text = "".join(item.as_string() for _, item in below)
        lines[places[-1]] = (None, Whitespace(text.removeprefix("\n")))


def _lines(typed: Tables) -> _Lines:
    if isinstance(typed, OutOfOrderTableProxy):
        return []
    return typed.body if isinstance(typed, Container) else typed.value.body


def _last_lines(item: Item) -> _Lines:
    """The lines up to where the text of a table, or of the last table of a list, ends."""
    if isinstance(item, AoT):
        return _last_lines(item[-1])
    lines = item.value.body if isinstance(item, Heading) else []
    if lines and isinstance(lines[-1][1], Heading | AoT):
        return _last_lines(lines[-1][1])
    return lines


def _cut_comments(lines: _Lines) -> _Lines:
    """Take off what follows a table's last value from the first empty line on, and return it."""
    start = next((i for i in range(len(lines), 0, -1) if lines[i - 1][0] is not None), 0)
    while start < len(lines) and not isinstance(lines[start][1], Whitespace):
        start += 1
    below = lines[start:]
    del lines[start:]
    return below
