"""What the figures and tables of the thesis share: how they are registered and kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from birdmb.figures.saving import save_figure
from birdmb.files import write_whole

_formats: ContextVar[tuple[str, ...]] = ContextVar("formats", default=("png",))


@dataclass(frozen=True)
class Drawing:
    """A numbered figure or table.

    Attributes:
        title: what it shows.
        draw: function of a directory and of whether a coarse, quick version will do; it leaves
            its files in the directory, named by `keep_figure` and `keep_table`.
    """

    title: str
    draw: Callable[[Path, bool], None]


def keep_figure(out: Path, name: str, figure: Figure) -> None:
    """Save a figure in the formats asked for, "figure 5.12" as figure_5_12.png."""
    for kind in _formats.get():
        save_figure(figure, out / f"{_file_name(name)}.{kind}")


@contextmanager
def kept_as(formats: Sequence[str]) -> Iterator[None]:
    """Let `keep_figure` save in these formats within; PNG without."""
    token = _formats.set(tuple(formats))
    try:
        yield
    finally:
        _formats.reset(token)


def keep_table(
    out: Path, name: str, columns: Sequence[str], rows: Sequence[Sequence[object]]
) -> None:
    """Save a table as CSV, "table 6.2" as table_6_2.csv; numbers to six digits."""
    lines = [columns, *([_cell(value) for value in row] for row in rows)]
    text = "".join(",".join(line) + "\n" for line in lines)
    write_whole(out / f"{_file_name(name)}.csv", text.encode())


def _file_name(name: str) -> str:
    return name.replace(" ", "_").replace(".", "_")


def _cell(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value).replace(",", ";")
