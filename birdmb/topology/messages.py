"""One sentence, in the user's own names, for whatever is wrong with a topology document."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, RootModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails, PydanticCustomError

from birdmb.errors import TopologyError
from birdmb.text import nearest
from birdmb.topology.numbers import OUT_OF_RANGE

Location = tuple[str | int, ...]
ModelT = TypeVar("ModelT", bound=BaseModel)

# Marks the branches of a tagged union, which pydantic reports as if they were keys of the document.
BRANCH = "branch:"

# Follows a table's key where not the value but the key is wrong.
_OF_KEY = "[key]"

_EXPECTED = {
    "dict_type": "must be a table",
    "float_type": "must be a number",
    "int_type": "must be a whole number",
    "string_type": "must be a text in quotes",
    "bool_type": "must be true or false",
    "string_pattern_mismatch": "must be of letters, digits, _ and - only",
    "tuple_type": "must be a list",
    "missing": "must be a list of 3 entries",
    "too_long": "must be a list of 3 entries",
    "model_type": "must be a table",
    "greater_than": "must be more than {gt:g}",
    "less_than": "must be less than {lt:g}",
    "greater_than_equal": "must be {ge:g} or more",
    "less_than_equal": "must be {le:g} or less",
    OUT_OF_RANGE: "must be {wanted}",
}


# Descriptions that take no article before them.
_CLAUSES = ("how ", "its ", "what ", "whether ")


def problem(text: str, *keys: str | int) -> PydanticCustomError:
    """Return the error a validator raises to have `text` shown as it is.

    `keys` lead from the validated table or list to what is to blame, if it is not all of it.
    """
    return PydanticCustomError("problem", "{text}", {"text": text, "keys": keys})


def shown(value: object) -> str:
    """Return `value` as it would stand in a TOML file, cut short if it is long."""
    try:
        text = json.dumps(value, default=str)
    except (TypeError, ValueError, RecursionError):  # of thousands of digits, or brackets
        return "what is too long to show"
    text = {"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}.get(text, text)
    return text if len(text) <= 80 else text[:77] + "..."


def validated(
    model: type[ModelT], document: Mapping[str, Any], origin: str | Callable[[], str]
) -> ModelT:
    """Return `document`, in which models may stand for tables, as a valid `model`.

    Raises `TopologyError`, starting with `origin` (a file, say), for the problem that stands first
    in the document. An `origin` that takes time to tell may be a function.
    """
    try:
        return model.model_validate(document)
    except ValidationError as error:
        found = [
            (_location(detail, document), detail)
            for detail in error.errors(include_url=False)
            # A default that waits for a key that is itself wrong is no second mistake.
            if detail["type"] != "default_factory_not_called"
        ]
    found.sort(key=lambda item: _file_order(item[0], document))
    location, detail = found[0]
    more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
    key = _dotted(location, document)
    # An angle in degrees was in radians when it was found to be wrong.
    given = detail["input"]
    if any(str(part).endswith("_deg") for part in location):
        given = _at(location, document)
    told = origin if isinstance(origin, str) else origin()
    raise TopologyError(f"{told}: {key}: {_explanation(model, location, detail, given)}{more}")


def _explanation(
    model: type[BaseModel], location: Location, detail: ErrorDetails, given: object
) -> str:
    kind = detail["type"]
    if kind == "problem":
        return str(detail["ctx"]["text"])
    owner, field = _field(model, location)
    if kind == "extra_forbidden":
        return f"unknown key; the nearest known: {nearest(str(location[-1]), _keys_of(owner))}"
    meaning = field.description if field else None
    if kind == "missing" and isinstance(detail["loc"][-1], str):
        article = "" if str(meaning).startswith(_CLAUSES) else "the "
        return f"missing; it should give {article}{meaning}"
    if kind in _EXPECTED:
        expected = _EXPECTED[kind].format(**detail.get("ctx", {}))
    else:
        expected = detail["msg"].replace("Input should be", "must be").replace("'", '"')
    if kind == OUT_OF_RANGE:
        why = detail["ctx"]["why"]
        meaning = f"{meaning}; {why}" if meaning else why
    return f"{expected}, not {shown(given)}" + (f" ({meaning})" if meaning else "")


def _location(detail: ErrorDetails, document: object) -> Location:
    """Return where in the document the user finds the error."""
    parts = [p for p in detail["loc"] if not (isinstance(p, str) and p.startswith(BRANCH))]
    if detail["type"] == "missing" and isinstance(parts[-1], int):
        parts.pop()
    if parts and parts[-1] == _OF_KEY:  # the sentence tells the key
        parts = parts[:-2]
    parts += detail.get("ctx", {}).get("keys", ())
    for i, part in enumerate(parts):
        # An angle given in degrees is reported under the key that the user wrote.
        if isinstance(document, Mapping) and part not in document and f"{part}_deg" in document:
            parts[i] = f"{part}_deg"
        document = _inside(document, parts[i])
    return tuple(parts)


def _at(location: Location, document: object) -> object:
    for part in location:
        document = _inside(document, part)
    return document


def _inside(document: object, part: str | int) -> object:
    if isinstance(document, Mapping):
        return document.get(part)
    if isinstance(document, BaseModel) and isinstance(part, str):
        return getattr(document, part, None)
    if isinstance(document, list | tuple) and isinstance(part, int) and part < len(document):
        return document[part]
    return None


def _file_order(location: Location, document: object) -> list[int]:
    order = []
    for part in location:
        if isinstance(document, Mapping):
            keys = list(document)
            order.append(keys.index(part) if part in document else len(keys))
        else:
            order.append(part if isinstance(part, int) else 0)
        document = _inside(document, part)
    return order


def _dotted(location: Location, document: object) -> str:
    """Return the dotted name of a place; an entry of a list goes by its name or its number."""
    name = ""
    for part in location:
        document = _inside(document, part)
        if isinstance(part, str):
            name += f".{part}"
        elif isinstance(label := _inside(document, "name"), str):
            name = f".{label}" if name == ".joints" else f"{name}.{label}"
        elif isinstance(order := _inside(document, "order"), int):
            name += f".{order}"
        else:
            name += f" #{part + 1}"
    return name.removeprefix(".")


def _field(model: type[BaseModel], location: Location) -> tuple[type[BaseModel], FieldInfo | None]:
    """Return the field that a location ends in, or the last one known, and the model it is in."""
    owner, field = model, None
    for part in location:
        if isinstance(part, str):
            if issubclass(model, RootModel):  # a table of parts by names of the user's
                model = next(_models_in(model.model_fields["root"].annotation), model)
                continue
            owner = model
            known = model.model_fields.get(part) or model.model_fields.get(
                part.removesuffix("_deg")
            )
            if known is None:
                break
            field = known
            model = next(_models_in(field.annotation), model)
    return owner, field


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models_in(argument)


def _keys_of(model: type[BaseModel]) -> list[str]:
    angles = getattr(model, "angles", ())
    return [*model.model_fields, *(f"{angle}_deg" for angle in angles)]
