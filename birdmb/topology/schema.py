"""The JSON schema of topology files: for editors, and for the page that describes the format.

Of the models' own schema, with what only files have. It keeps to what all drafts of JSON Schema
have in common, since editors of TOML know draft 4.
"""

from __future__ import annotations

import math

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from birdmb.topology.bird import Bird
from birdmb.topology.parts import Part

DEFINITIONS = "#/definitions/"
_DRAFT = "http://json-schema.org/draft-04/schema#"
_MODELS_DEFINITIONS = "$defs"
_BOUNDS = ("minimum", "maximum")


def topology_schema() -> JsonSchemaValue:
    """The JSON schema (draft 4) that a topology file, read as TOML, is valid by.

    It tells keys, kinds, ranges and choices of values; what values must be to each other, as in
    a chain of joints, only `load_bird` tells.
    """
    return schema_of(Bird)


def schema_of(part: type[Part]) -> JsonSchemaValue:
    """The JSON schema of a file that holds such a part."""
    schema = part.model_json_schema(
        ref_template=f"{DEFINITIONS}{{model}}", schema_generator=_OfFiles
    )
    parts = schema.pop(_MODELS_DEFINITIONS)
    whole: JsonSchemaValue = {"$schema": _DRAFT, **schema, "definitions": parts}
    return _in_draft_4(whole)


class _OfFiles(GenerateJsonSchema):
    """What TOML files have in place of Python's values."""

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        """A part, with its angles in degrees, too."""
        of_part = super().model_schema(schema)
        angles = schema["cls"].angles if issubclass(schema["cls"], Part) else ()
        for angle in angles:
            _tell_of_degrees(of_part, angle)
        return of_part

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """What may be None in Python is left out of a file."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """A default, if it is a single value: that of a part is told by its own keys."""
        found = super().default_schema(schema)
        if not isinstance(found.get("default"), bool | int | float | str):
            found.pop("default", None)
        return found

    def tuple_schema(self, schema: core_schema.TupleSchema) -> JsonSchemaValue:
        """A list of items of one kind; pairs of a name and a value are a table."""
        found = super().tuple_schema(schema)
        items = found.pop("prefixItems", [])
        if items and all(item == items[0] for item in items):
            return {**found, "items": items[0]}
        if items:
            return {**found, "items": items}
        pair = found["items"].get("items", [])
        if isinstance(pair, list) and [item.get("type") for item in pair[:1]] == ["string"]:
            return {"type": "object", "additionalProperties": pair[1]}
        return found

    def field_title_should_be_set(self, schema: object) -> bool:  # noqa: ARG002
        """Never: a field's title is but its key."""
        return False


def _tell_of_degrees(of_part: JsonSchemaValue, angle: str) -> None:
    """Put beside an angle's key the one that gives it in degrees."""
    properties = of_part["properties"]
    in_degrees = f"{angle}_deg"
    of_angle = properties[angle]
    meaning = of_angle["description"].removesuffix(f"; rad, degrees as {in_degrees}")
    keys = list(properties)
    properties[in_degrees] = {**_scaled(of_angle), "description": f"{meaning}, degrees"}
    # Right behind it, in editors' lists as well.
    for key in keys[keys.index(angle) + 1 :]:
        properties[key] = properties.pop(key)
    both = [{"required": [angle]}, {"required": [in_degrees]}]
    if angle in of_part.get("required", ()):
        of_part["required"].remove(angle)
        of_part.setdefault("allOf", []).append({"oneOf": both})
    else:
        of_part.setdefault("allOf", []).append({"not": {"required": [angle, in_degrees]}})


def _scaled(schema: JsonSchemaValue) -> JsonSchemaValue:
    """Bounds and defaults in rad, at whatever depth, in degrees."""
    found: JsonSchemaValue = {}
    for key, value in schema.items():
        if key in (*_BOUNDS, "default") and isinstance(value, float | int):
            found[key] = float(f"{math.degrees(value):.12g}")
        elif isinstance(value, dict):
            found[key] = _scaled(value)
        elif isinstance(value, list):
            found[key] = [_scaled(item) if isinstance(item, dict) else item for item in value]
        else:
            found[key] = value
    return found


def _in_draft_4(schema: JsonSchemaValue) -> JsonSchemaValue:
    """The same by the words of draft 4, in which what stands beside a reference does not count."""
    found: JsonSchemaValue = {}
    for key, value in schema.items():
        if isinstance(value, dict):
            found[key] = _in_draft_4(value)
        elif isinstance(value, list):
            found[key] = [_in_draft_4(item) if isinstance(item, dict) else item for item in value]
        elif key == "const":
            found["enum"] = [value]
        else:
            found[key] = value
    if "$ref" in found and len(found) > 1:
        found["allOf"] = [{"$ref": found.pop("$ref")}]
    return found
