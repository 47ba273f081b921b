"""What an object shows of itself in a console, on one line, and in a notebook, as a table."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from html import escape
from typing import Any, NamedTuple

import numpy as np

from birdmb.errors import BirdmbError
from birdmb.quantities import BY_NAME
from birdmb.text import on_one_line, spelled_out

LONGEST = 400
"""Characters that a representation stays below."""

_LONGEST_VALUE = 80
_FEW = 4
_CELL = "text-align: {}"


class Fact(NamedTuple):
    """A line of a summary; without a label, the value says what it is."""

    label: str
    value: str
    unit: str = ""

    @property
    def text(self) -> str:
        """The line as a few words."""
        return " ".join(filter(None, (self.label, self.value, self.unit)))


class Summarised:
    """An object whose representation says what matters, and stays short.

    A dataclass needs `repr=False` as well: its generated representation would go before this one.
    """

    def _summary(self) -> Iterable[Fact]:
        """What matters, the most important first; by default all attributes that were given."""
        return _attributes(self)

    def _title(self) -> str:
        """What the object is of, as a bird's name; by default nothing."""
        return ""

    def _heading(self) -> str:
        """What stands before the facts."""
        return on_one_line(f"{type(self).__name__} {self._title()}".strip())

    def __repr__(self) -> str:
        """Return a line of less than `LONGEST` characters, but for names in ASCII."""
        heading = shortened(self._heading(), LONGEST // 2)
        text = f"<{heading}"
        for i, fact in enumerate(_computed(self._summary)):
            more = f"{', ' if i else ': '}{spelled_out(on_one_line(fact.text))}"
            if len(text) + len(more) + len(", ...>") >= LONGEST:
                return f"{text}, ...>"
            text += more
        return f"{text}>"

    def _repr_html_(self) -> str:
        rows = (
            f'<tr><th style="{_CELL.format("left")}">{escape(on_one_line(label))}</th>'
            f'<td style="{_CELL.format("right")}">{escape(on_one_line(value))}</td>'
            f'<td style="{_CELL.format("left")}">{escape(unit)}</td></tr>'
            for label, value, unit in _computed(self._summary)
        )
        return (
            f'<table><caption style="{_CELL.format("left")}">{escape(self._heading())}</caption>'
            f"<tbody>{''.join(rows)}</tbody></table>"
        )


def facts_of(owner: object, *names: str) -> Iterator[Fact]:
    """Quantities of the table in `birdmb.quantities` that `owner` has; those that are NaN not."""
    for name in names:
        quantity = BY_NAME[name]
        value = quantity.of(owner)
        if not np.isnan(value):
            yield Fact(quantity.label, quantity.text(value), quantity.shown_unit)


def with_error(value: float, error: float) -> str:
    """A number with its error bar."""
    return f"{value:.6g} ± {error:.0e}"


def shortened(text: str, longest: int = _LONGEST_VALUE) -> str:
    """A text cut short if it is long."""
    text = on_one_line(text)
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


def brief(value: object) -> str:
    """A value in a few words: of arrays and lists that are long how many there are."""
    for kind, text in _BRIEF:
        if isinstance(value, kind):
            return text(value)
    if is_dataclass(value) or callable(value):
        return str(getattr(value, "__name__", type(value).__name__))
    return shortened(str(value))


def _brief_array(array: np.ndarray) -> str:
    if array.size <= _FEW and array.dtype.kind in "iufc":
        return " ".join(np.array2string(array, precision=4, separator=", ").split())
    return f"{' x '.join(map(str, array.shape))} array"


def _brief_container(container: Any) -> str:
    text = repr(container) if len(container) <= _FEW else ""
    return text if 0 < len(text) <= _LONGEST_VALUE else f"{len(container)} entries"


_BRIEF: tuple[tuple[Any, Callable[[Any], str]], ...] = (
    (Summarised, Summarised._heading),
    (np.ndarray, _brief_array),
    (float, "{:.6g}".format),
    (str, shortened),
    ((Mapping, Sequence), _brief_container),
)


def _computed(summary: Callable[[], Iterable[Fact]]) -> Iterator[Fact]:
    """The facts up to one that cannot be computed: what is shown must not fail."""
    try:
        yield from summary()
    except (BirdmbError, ArithmeticError, LookupError) as error:
        yield Fact("", f"not computed: {shortened(str(error))}")


def _attributes(owner: Any) -> Iterator[Fact]:
    names = [f.name for f in fields(owner) if f.repr] if is_dataclass(owner) else []
    for name in names:
        value = getattr(owner, name)
        if value is not None:
            yield Fact(name, brief(value))
