"""Arguments of public functions against their annotations: one sentence for what does not fit.

Nothing is converted. What an annotation says beyond kinds, as that a number is positive, is left
to the function; so is a kind that is not known here.
"""

from __future__ import annotations

import functools
import inspect
import math
import numbers
import types
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import is_dataclass
from os import PathLike, fspath
from typing import (
    Any,
    Literal,
    NamedTuple,
    TypeAlias,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

import numpy as np

from birdmb.errors import ArgumentTypeError
from birdmb.text import nearest

Checked = TypeVar("Checked", bound=Callable[..., Any])
_Test: TypeAlias = Callable[[Any], bool]

# What makes an object of a kind, or is one.
_MADE_BY = {
    "a Bird": 'birdmb.load_bird("ibis") reads one',
    "a model": "birdmb.RigidModel(bird) or birdmb.MultibodyModel(bird) makes one of a bird",
    "a FlightCycle": "birdmb.find_limit_cycle(birdmb.RigidModel(bird)) finds one",
    "a LimitCycle": "birdmb.find_limit_cycle(model) finds one",
    "a FloquetResult": "birdmb.find_limit_cycle(model) finds one",
    "a Branch": "birdmb.continue_branch or birdmb.load_branch gives one",
    "a Trimming": 'for instance birdmb.Trimming({"forearm.roll.offset_deg": (-20, 20)})',
    "a PlaneWing": "for instance birdmb.PlaneWing.rectangular(1.0, 0.1)",
    "a WingMotion": "for instance birdmb.WingMotion(heave=[0, 0.06])",
    "an Executor": "for instance concurrent.futures.ProcessPoolExecutor()",
}
_OF_PARAMETER = {
    ("gust", "a function"): "for instance birdmb.GaussianGust(vertical=1.0)",
    ("model", "a function"): "for instance birdmb.RigidModel",
}
_KINDS: dict[Any, str] = {
    bool: "True or False",
    str: "a text",
    int: "a whole number",
    float: "a number",
    complex: "a number",
}
_OF_ARRAYS = "a list or an array of numbers"
_LONGEST = 40
_PAIR = 2


def checked(function: Checked) -> Checked:
    """A function, or a class by its constructor, that refuses arguments of the wrong kind.

    Raises, where it is called:
        ArgumentTypeError: an argument is not of the kind that its annotation says, is NaN, has an
            unknown name, or is missing.
    """
    if isinstance(function, type):
        kind: Any = function  # its constructor is replaced before there is a subclass
        kind.__init__ = _checking(kind.__init__, kind if is_dataclass(kind) else kind.__init__)
        return function
    return _checking(function, function)


def _checking(function: Callable[..., Any], annotated: Any) -> Any:
    signature = inspect.signature(function)
    parameters = signature.parameters

    # Hints are slow to look up by, so each has its test beside it.
    @functools.cache
    def wanted() -> dict[str, tuple[Any, _Test]]:
        hints = get_type_hints(annotated)
        return {name: (hints[name], _test(hints[name])) for name in hints if name in parameters}

    @functools.wraps(function)
    def checking(*args: Any, **options: Any) -> Any:
        given = _bound(function, signature, args, options)
        known = wanted()
        for name, value in given.items():
            if name not in known:
                continue
            hint, holds = known[name]
            if not holds(value):
                problem = _problem(name, hint, value)
                raise ArgumentTypeError(f"{_called(function, args)}: {problem}.")
        return function(*args, **options)

    return checking


def _called(function: Callable[..., Any], args: Sequence[Any]) -> str:
    """What the user calls; of a constructor the class, which may be a subclass."""
    if function.__name__ == "__init__" and args:
        return type(args[0]).__name__
    return function.__qualname__


def _bound(
    function: Callable[..., Any],
    signature: inspect.Signature,
    args: Sequence[Any],
    options: Mapping[str, Any],
) -> dict[str, Any]:
    """Arguments by name; raises `ArgumentTypeError` where they do not fit the signature."""
    try:
        return signature.bind(*args, **options).arguments
    except TypeError as error:
        names = [name for name in signature.parameters if name != "self"]
        unknown = [name for name in options if name not in names]
        # As "missing a required argument: 'bird'".
        reason = str(error).replace(": '", " ").replace("'", "")
        if unknown:
            reason = f"there is no argument {unknown[0]}; the nearest: {nearest(unknown[0], names)}"
        raise ArgumentTypeError(f"{_called(function, args)}: {reason}.") from None


def _problem(name: str, hint: Any, value: Any) -> str | None:
    """What is wrong with an argument, without a full stop; `None` if nothing is."""
    if _test(hint)(value):
        return None
    options = _alternatives(hint)
    for option in options:
        for part, inner, item in _parts(name, option, value):
            if problem := _problem(part, inner, item):
                return problem
    kinds = list(dict.fromkeys(filter(None, map(_kind, options))))
    made = next((text for kind in kinds if (text := _made_by(name, kind, value))), "")
    choices = any(get_origin(option) is Literal for option in options)
    given = f'"{_shortened(value)}"' if choices and isinstance(value, str) else _shown(value)
    return f"{name} must be {' or '.join(kinds)}, not {given}{made and f'; {made}'}"


@functools.cache
def _alternatives(hint: Any) -> tuple[Any, ...]:
    """The members of a union; an array of numbers, a union of many by itself, is one of them."""
    members = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    if any(getattr(get_origin(m), "__name__", "") == "_SupportsArray" for m in members):
        return (np.ndarray, *(m for m in members if m is type(None) or _is_own(m)))
    return members


def _is_own(member: Any) -> bool:
    return isinstance(member, type) and member.__module__.startswith("birdmb.")


@functools.cache
def _test(hint: Any) -> _Test:
    """A function of a value: whether it is what is wanted."""
    tests = [functools.partial(_rule(option).fits, option) for option in _alternatives(hint)]
    return tests[0] if len(tests) == 1 else lambda value: any(fits(value) for fits in tests)


def _kind(hint: Any) -> str:
    """What is wanted, with its article; empty for None."""
    return _rule(hint).text(hint)


def _is_of_kind(kind: Any, value: Any) -> bool:
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item"):
        value = value.item()  # of numpy or xarray
    if kind in (bool, str):
        return isinstance(value, kind)
    if isinstance(value, bool):
        return False
    if kind is int:
        return isinstance(value, numbers.Integral)
    if kind is complex:
        return isinstance(value, numbers.Complex)
    return isinstance(value, numbers.Real) and not math.isnan(value)


def _is_numeric(value: Any) -> bool:
    """Whether numpy takes it for an array of numbers; of which shape, the function says."""
    if value is None or isinstance(value, str | bytes | bool | Mapping):
        return False
    try:
        return np.asarray(value).dtype.kind in "iufc"
    except (TypeError, ValueError):
        return False


def _is_container(origin: type, value: Any) -> bool:
    if issubclass(origin, Mapping):
        return isinstance(value, Mapping)
    if isinstance(value, str | bytes | Mapping) or not hasattr(value, "__iter__"):
        return False
    return origin is Iterable or (hasattr(value, "__len__") and hasattr(value, "__getitem__"))


def _parts(name: str, hint: Any, value: Any) -> Iterator[tuple[str, Any, Any]]:
    """What is inside a container of the right kind: its name, annotation and value."""
    origin, inner = get_origin(hint), get_args(hint)
    if not (inner and _is_container_type(origin) and _is_container(origin, value)):
        return
    if issubclass(origin, Mapping):
        for key, item in value.items():
            yield f"a name in {name}", inner[0], key
            yield f'{name}["{key}"]', inner[1], item
    elif hasattr(value, "__len__") and not isinstance(value, np.ndarray):
        each = (inner[0],) * len(value) if origin is not tuple or inner[1:] == (...,) else inner
        if len(each) != len(value):
            yield name, _Pair, value
            return
        for i, (item_hint, item) in enumerate(zip(each, value, strict=True)):
            yield f"{name}[{i}]", item_hint, item


def _is_container_type(origin: Any) -> bool:
    general = getattr(origin, "__module__", "") in {"builtins", "collections.abc"}
    return general and isinstance(origin, type) and issubclass(origin, tuple | Iterable)


def _is_checkable(origin: Any) -> bool:
    """Whether `isinstance` takes it, which it does not of every protocol."""
    protocol = getattr(origin, "_is_protocol", False)
    return isinstance(origin, type) and (
        not protocol or getattr(origin, "_is_runtime_protocol", False)
    )


class _Pair:
    """What nothing is: stands for a list that is too long or too short."""


def _fits_container(hint: Any, value: Any) -> bool:
    return _is_container(_origin(hint), value) and all(
        _test(inner)(item) for _, inner, item in _parts("", hint, value)
    )


def _container_text(hint: Any) -> str:
    origin, inner = _origin(hint), get_args(hint)
    if issubclass(origin, Mapping):
        return "a dict or another mapping"
    return "a pair" if origin is tuple and len(inner) == _PAIR and ... not in inner else "a list"


def _class_text(hint: Any) -> str:
    name = getattr(_origin(hint), "__name__", str(hint))
    return "a model" if name == "Model" else _with_article(name)


def _literal_text(hint: Any) -> str:
    *others, last = (f'"{choice}"' for choice in get_args(hint))
    return f"{', '.join(others)} or {last}" if others else last


def _fits_literal(hint: Any, value: Any) -> bool:
    return any(isinstance(value, type(each)) and value == each for each in get_args(hint))


class _Rule(NamedTuple):
    """What annotations of a kind ask for.

    Attributes:
        holds_for: whether it is for an annotation of this origin.
        text: what such an annotation wants.
        fits: whether a value is that.
    """

    holds_for: Callable[[Any], bool]
    text: Callable[[Any], str]
    fits: Callable[[Any, Any], bool]


_FUNCTION = get_origin(Callable[..., Any])
# The first that holds counts; the last takes anything.
_RULES = (
    _Rule(lambda o: o is type(None), lambda _: "", lambda _, v: v is None),
    _Rule(lambda o: o is _Pair, lambda _: "a pair (lowest, highest)", lambda *_: False),
    _Rule(lambda o: o is Literal, _literal_text, _fits_literal),
    _Rule(lambda o: o is Any, str, lambda *_: True),
    _Rule(lambda o: o in _KINDS, lambda h: _KINDS[h], _is_of_kind),
    _Rule(lambda o: o is np.ndarray, lambda _: _OF_ARRAYS, lambda _, v: _is_numeric(v)),
    _Rule(
        lambda o: getattr(o, "_is_protocol", False) and "__call__" in vars(o),
        lambda _: "a function",
        lambda _, v: callable(v),
    ),
    _Rule(lambda o: o is _FUNCTION, lambda _: "a function", lambda _, v: callable(v)),
    _Rule(lambda o: o is PathLike, lambda _: "a path", lambda _, v: isinstance(v, PathLike)),
    _Rule(_is_container_type, _container_text, _fits_container),
    _Rule(_is_checkable, _class_text, lambda h, v: isinstance(v, _origin(h))),
    _Rule(lambda _: True, str, lambda *_: True),
)


def _origin(hint: Any) -> Any:
    return type(None) if hint is None else get_origin(hint) or hint


@functools.cache
def _rule(hint: Any) -> _Rule:
    return next(rule for rule in _RULES if rule.holds_for(_origin(hint)))


def _made_by(name: str, kind: str, value: Any) -> str:
    if kind == "a Bird" and isinstance(value, str | PathLike):
        return f'birdmb.load_bird("{_shortened(str(fspath(value)))}") reads one'
    return _MADE_BY.get(kind) or _OF_PARAMETER.get((name, kind), "")


def _shown(value: Any) -> str:
    for kind, text in _SHOWN:
        if isinstance(value, kind):
            return text(value)
    return _with_article(type(value).__name__)


_SHOWN: tuple[tuple[Any, Callable[[Any], str]], ...] = (
    (str, lambda v: f'the text "{_shortened(v)}"'),
    ((type(None), bool, numbers.Number), lambda v: _shortened(str(v))),
    (type, lambda v: f"the class {v.__name__}"),
    (types.FunctionType, lambda v: f"the function {v.__name__}"),
    (PathLike, lambda v: f"the path {_shortened(str(fspath(v)))}"),
    ((list, tuple), lambda v: _shortened(repr(v))),
)


def _with_article(name: str) -> str:
    return f"an {name}" if name[:1].lower() in "aeiou" else f"a {name}"


def _shortened(text: str) -> str:
    text = " ".join(text.split())
    return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."
