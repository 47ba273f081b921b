"""The page that describes topology files, made of their schema."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic.json_schema import JsonSchemaValue

from birdmb.topology.schema import DEFINITIONS, topology_schema

_INTRODUCTION = """\
# The format of topology files

<!-- Made by `birdmb schema --markdown --out docs/format.md`, of the models' descriptions. -->

A topology file is [TOML](https://toml.io) in UTF-8. It describes one bird and its gait; `birdmb
check FILE` says what it describes, and what is odd about it. Everything has a dotted name, for
`--set`, for studies and in Python: `body.mass`, `wing.root.x`, `segments.hand.length`; a joint
goes by its own name (`shoulder.flap.amplitude_deg`), all else in a list by its list and its name
(`feathers.5.length`).

- **Units** are SI: m, kg, s, N. Angles are in rad, or in degrees under the same key ending in
  `_deg`; one of the two.
- **Body frame**, at the body's centre of mass: x forward, y to the right, z down. **Segment
  frame**, at a segment's root with the wing stretched out: the same directions, y along the bone
  outwards.
- **Signs**: values are of the right wing, and the left one is its mirror image. An axis turns by
  the right-hand rule: about `[0, 1, 0]` the leading edge goes up, about `[-1, 0, 0]` the wing,
  about `[0, 0, -1]` the tip goes forward.
- **Numbers** must be in the ranges below, which hold all that flies with a wide margin. A key
  without a default must be given; one that is "left out" by default may be. A key that is not
  listed is an error.

## In an editor

`birdmb schema --out birdmb.schema.json` writes the JSON schema (draft 4) of these files. It is no
file of the package, but made by the version that is installed, and so never that of another one.
With it, editors complete keys, show their meaning and mark mistakes: those that use
[Taplo](https://taplo.tamasfe.dev), as Even Better TOML for VS Code, if the topology file begins
with

```toml
#:schema ./birdmb.schema.json
```

A schema knows each value by itself. What they must be to each other (a joint on a segment there
is, moments of inertia that a body can have) `birdmb check` tells.
"""


_CHOICES = ("allOf", "anyOf", "oneOf")


def format_page() -> str:
    """All keys of a topology file in Markdown: kinds, ranges, defaults and meaning of values."""
    return f"{_INTRODUCTION}\n{page_of(topology_schema())}"


def page_of(schema: JsonSchemaValue) -> str:
    """A table of keys for each part that a schema knows, after one for all of the file."""
    parts: JsonSchemaValue = schema["definitions"]
    lines = ["## The whole file", "", *_table(schema, parts)]
    for name, places in _places(schema, parts).items():
        about, *more = parts[name].get("description", "").split("\n\n")
        lines += ["", f"## {name}", "", f"{', '.join(places)}. {_on_one_line(about)}", ""]
        for paragraph in more:
            lines += [_on_one_line(paragraph), ""]
        lines += _table(parts[name], parts)
    return "\n".join(lines) + "\n"


def _on_one_line(paragraph: str) -> str:
    return " ".join(paragraph.split())


def _places(whole: JsonSchemaValue, parts: JsonSchemaValue) -> dict[str, list[str]]:
    """Where in a file each part stands, in the order in which the parts are met."""
    places: dict[str, list[str]] = {}

    def walk(owner: JsonSchemaValue, within: str) -> None:
        for key, value in owner["properties"].items():
            for name, form in _parts_in(value, parts):
                place = f"`{form.format(key)}`" if not within else f"`{key}` of {within}"
                met = name in places
                places.setdefault(name, []).append(place)
                if not met:
                    walk(parts[name], place)

    walk(whole, "")
    return places


def _parts_in(
    value: JsonSchemaValue, parts: JsonSchemaValue, form: str = "[{}]"
) -> Iterator[tuple[str, str]]:
    """Names of the parts that a value may be made of, each with how its tables are headed."""
    if "$ref" in value:
        name = value["$ref"].removeprefix(DEFINITIONS)
        if "properties" in parts[name]:
            yield name, form
        else:  # of parts by names of the user's
            yield from _parts_in(parts[name], parts)
    for key in _CHOICES:
        for choice in value.get(key, ()):
            yield from _parts_in(choice, parts, form)
    for key, heading in (("items", "[[{}]]"), ("additionalProperties", "[{}.NAME]")):
        if isinstance(value.get(key), dict):
            yield from _parts_in(value[key], parts, heading)


def _table(part: JsonSchemaValue, parts: JsonSchemaValue) -> list[str]:
    lines = ["| key | value | default | meaning |", "|---|---|---|---|"]
    properties = part["properties"]
    for key, value in properties.items():
        if key.endswith("_deg") and key.removesuffix("_deg") in properties:
            continue  # told beside the angle in rad
        keys = [name for name in (key, f"{key}_deg") if name in properties]
        cells = (
            " or ".join(f"`{name}`" for name in keys),
            _kind(value, parts),
            _required(part, keys) or _default(value),
            value.get("description", ""),
        )
        lines.append(f"| {' | '.join(cell.replace('|', '/') for cell in cells)} |")
    return lines


def _required(part: JsonSchemaValue, keys: list[str]) -> str:
    """That one of these keys of a part must be given, or another one instead; empty if not."""
    for group in (part, *part.get("allOf", ())):
        names = [name for choice in group.get("oneOf", ()) for name in choice["required"]]
        if any(key in names for key in keys):
            return " or ".join(["**required**", *(f"`{n}`" for n in names if n not in keys)])
    return "**required**" if any(key in part.get("required", ()) for key in keys) else ""


def _default(value: JsonSchemaValue) -> str:
    return f"`{_typed(value['default'])}`" if "default" in value else "left out"


def _typed(value: bool | float | str) -> str:
    """A value as it is typed in a file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    return f"{value:.7g}".replace("e-0", "e-").replace("e+0", "e").replace("e+", "e")


def _kind(value: JsonSchemaValue, parts: JsonSchemaValue, plural: str = "") -> str:
    """What a value, or with the ending `plural` each of several, may be, in words."""
    if "$ref" in value:
        name = value["$ref"].removeprefix(DEFINITIONS)
        if "properties" not in parts[name]:
            return _kind(parts[name], parts, plural)
        return f"[{name}](#{name.lower()})"
    if "enum" in value:
        return " or ".join(f"`{_typed(choice)}`" for choice in value["enum"])
    if value.get("type") == "array":
        return _list_kind(value, parts, plural)
    if value.get("type") == "object":
        return f"table{plural} of {_kind(value['additionalProperties'], parts, 's')} by name"
    words = {"integer": "whole number", "number": "number", "string": "text"}
    word = words.get(value.get("type", ""), "")
    kinds = [f"{word}{plural}"] if word else []
    if value.get("type") == "boolean":
        kinds = ["true or false"]
    choices = [_kind(choice, parts, plural) for key in _CHOICES for choice in value.get(key, ())]
    if "minimum" in value and "maximum" in value:
        choices.append(f"{_typed(value['minimum'])} to {_typed(value['maximum'])}")
    return ", ".join([*kinds, *([" or ".join(choices)] if choices else [])])


def _list_kind(value: JsonSchemaValue, parts: JsonSchemaValue, plural: str) -> str:
    items, count = value["items"], value.get("minItems")
    if isinstance(items, list):
        return f"list{plural} of {', '.join(_kind(item, parts) for item in items)}"
    several = f"{count} " if count is not None and count == value.get("maxItems") else ""
    return f"list{plural} of {several}{_kind(items, parts, 's')}"
