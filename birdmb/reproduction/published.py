"""Printed numbers, each beside what is computed here, and the verdict on the two."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

from birdmb.errors import BirdmbError

Verdict = Literal["pass", "differs", "contradicts"]


@dataclass(frozen=True)
class Published:
    """A printed number.

    Attributes:
        quantity: name among the quantities that its case computes.
        unit: unit, empty for a pure number.
        value: the number as printed.
        tolerance: half a unit of the last printed digit, or more for a cause that `reason` states.
        expected: verdict that is known; "pass" is what should agree.
        reason: cause of a wider tolerance, or of a verdict other than "pass".
    """

    quantity: str
    unit: str
    value: float
    tolerance: float
    expected: Verdict = "pass"
    reason: str = ""


@dataclass(frozen=True)
class Case:
    """One computation that gives several of the printed numbers.

    Attributes:
        chapter: number of the chapter, or letter of the appendix.
        source: where the numbers are printed, and what was computed for them.
        command: shell command that computes the same.
        compute: function that returns the quantities by name.
        published: the printed numbers.
        long: whether it takes more than some seconds, and is left out unless asked for.
    """

    chapter: str
    source: str
    command: str
    compute: Callable[[], Mapping[str, float]]
    published: tuple[Published, ...]
    long: bool = False


@dataclass(frozen=True)
class Comparison:
    """A printed number beside the computed one.

    Attributes:
        computed: the computed number, `None` where nothing was computed.
        failure: why nothing was computed, else empty.

    The others are those of `Case` and `Published`.
    """

    chapter: str
    source: str
    quantity: str
    unit: str
    published: float
    computed: float | None
    tolerance: float
    command: str
    expected: Verdict = "pass"
    reason: str = ""
    failure: str = ""

    @property
    def difference(self) -> float | None:
        """Computed minus printed number, `None` where nothing was computed."""
        return None if self.computed is None else self.computed - self.published

    @property
    def verdict(self) -> Verdict:
        """Verdict on the two numbers.

        "pass" within the tolerance; outside, "contradicts" where the thesis disagrees with itself
        or with its program, else "differs".
        """
        difference = self.difference
        if difference is not None and abs(difference) <= self.tolerance:
            return "pass"
        return "contradicts" if self.expected == "contradicts" else "differs"

    @property
    def fails(self) -> bool:
        """Whether the two should agree and do not."""
        return self.expected == "pass" and self.verdict != "pass"


def compare(case: Case) -> tuple[Comparison, ...]:
    """Compute a case and compare each of its printed numbers; one without an orbit says so."""
    computed: Mapping[str, float] = {}
    failure = ""
    try:
        computed = case.compute()
    except BirdmbError as error:
        failure = " ".join(str(error).split())
    return tuple(
        Comparison(
            case.chapter,
            case.source,
            each.quantity,
            each.unit,
            each.value,
            None if failure else float(computed[each.quantity]),
            each.tolerance,
            case.command,
            each.expected,
            each.reason,
            failure,
        )
        for each in case.published
    )
