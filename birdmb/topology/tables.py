"""A bird as the tables of a topology file: what it leaves to defaults is left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TypeAlias

import tomlkit
from pydantic import RootModel
from tomlkit.items import AoT, Array, InlineTable, Item
from tomlkit.items import Table as Heading

from birdmb.topology.parts import Part

Value: TypeAlias = "str | bool | int | float | list[Value] | dict[str, Value]"
Table: TypeAlias = "dict[str, Value]"

_FEW, _ALL = 12, 17  # digits; the latter tell any two numbers apart
_OFF_DIAGONAL = [(i, j) for i in range(3) for j in range(3) if i != j]


class Radians(float):
    """An angle, rad, whose key in a file says its unit."""


def table_of(part: Part) -> Table:
    """The values that a part of a bird was given, under their keys without a unit."""
    dumped = part.model_dump(exclude_unset=True)
    return {
        key: _value(key, value, plain, key in part.angles)
        for key, plain in dumped.items()
        if (value := getattr(part, key)) is not None
    }


def _value(key: str, value: object, plain: object, is_angle: bool) -> Value:
    if isinstance(value, RootModel):
        value = value.root
    if isinstance(value, Part):
        return table_of(value)
    if isinstance(plain, Mapping):
        # Not in every part is a table of the file one in Python, too.
        values = value if isinstance(value, Mapping) else plain
        return {name: _value(name, values[name], item, is_angle) for name, item in plain.items()}
    if isinstance(value, list | tuple) and isinstance(plain, list | tuple):
        if key == "inertia" and all(plain[i][j] == 0.0 for i, j in _OFF_DIAGONAL):
            return [plain[i][i] for i in range(3)]
        return [_value("", *both, is_angle) for both in zip(value, plain, strict=True)]
    assert isinstance(plain, str | bool | int | float)
    return Radians(plain) if is_angle else plain


def is_angle(value: Value | None) -> bool:
    """Whether a value is an angle, or a list of them."""
    return isinstance(value, Radians) or (
        isinstance(value, list) and bool(value) and isinstance(value[0], Radians)
    )


def is_tables(value: Value | None) -> bool:
    """Whether a value is a list of tables."""
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def keyed_item(
    key: str, value: Value, *, heading: bool, unit: str | None = None
) -> tuple[str, Item]:
    """A key with its unit, and a value as it is written.

    Args:
        key: without a unit.
        value: to be written.
        heading: whether tables are written below a `[heading]` of their own.
        unit: "_deg" for an angle in degrees, "" for rad, None for what has few digits. Where no
            number of degrees is read as the very angle, it is in rad.
    """
    if unit != "" and is_angle(value):
        degrees = _in_degrees(value, _ALL if unit else _FEW)
        if degrees is not None:
            return f"{key}_deg", tomlkit.item(degrees)
    return key, _item(value, heading)


def inline_table(table: Table) -> InlineTable:
    """A table as it is written within a line."""
    inline = tomlkit.inline_table()
    for key, value in table.items():
        inline.append(*keyed_item(key, value, heading=False))
    return inline


def headed_table(table: Table) -> Heading:
    """A table as it is written below a heading; one of tables alone gives each its heading."""
    of_tables = bool(table) and all(isinstance(value, dict) for value in table.values())
    headed = tomlkit.table(is_super_table=of_tables)
    for key, value in table.items():
        headed.append(*keyed_item(key, value, heading=of_tables))
    return headed


def _item(value: Value, heading: bool) -> Item:
    if isinstance(value, dict):
        return headed_table(value) if heading else inline_table(value)
    if isinstance(value, list) and is_tables(value):
        items: AoT | Array = tomlkit.aot() if heading else tomlkit.array()
        for table in value:
            assert isinstance(table, dict)
            items.append(headed_table(table) if heading else inline_table(table))
        return items
    return tomlkit.item(value)


def _in_degrees(value: Value, most: int) -> float | list[float] | None:
    if not isinstance(value, list):
        assert isinstance(value, float)
        return _exact_degrees(value, most)
    each = [_exact_degrees(angle, most) for angle in value if isinstance(angle, float)]
    exact = [angle for angle in each if angle is not None]
    return exact if len(exact) == len(value) else None


def _exact_degrees(angle: float, most: int) -> float | None:
    """The degrees of an angle (rad), with the fewest digits that are read as it, if any are."""
    for digits in range(_FEW, most + 1):
        degrees = float(f"{math.degrees(angle):.{digits}g}")
        if math.radians(degrees) == angle:
            return degrees
    return None
