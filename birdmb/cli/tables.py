"""Tables that a narrow terminal can show: where the columns have no room, row below row."""

from __future__ import annotations

from collections.abc import Iterator

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

# A column of words may get so narrow before the table is no longer one.
_NARROWEST_WORDS = 18
_GAP = 3  # between columns


class FittingTable(Table):
    """A table whose rows are written one below the other where its columns do not fit."""

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table, or its rows."""
        if self._least_width() <= options.max_width:
            yield from super().__rich_console__(console, options)
        else:
            yield from self._stacked()

    def _least_width(self) -> int:
        """How wide the table is at least, with no number cut and no word broken."""
        widths = []
        for column in self.columns:
            texts = [str(column.header), *map(str, column.cells)]
            pieces = [
                p for text in texts for p in (text.split("\n") if column.no_wrap else text.split())
            ]
            widths.append(max(column.min_width or 0, *map(cell_len, pieces), 0))
        return sum(widths) + _GAP * (len(widths) - 1)

    def _stacked(self) -> Iterator[Text | Padding]:
        if self.title:
            yield Text(str(self.title), "bold")
        headings = [" ".join(str(column.header).split()) for column in self.columns]
        rows = zip(*(column.cells for column in self.columns), strict=True)
        for row, cells in zip(self.rows, rows, strict=True):
            first, *lines = _lines(headings, [str(cell) for cell in cells])
            yield Text(first, row.style or "")
            for line in lines:
                yield Padding(Text(line, row.style or ""), (0, 0, 0, 4))
        if self.caption:
            yield Text(str(self.caption), "italic")


def _lines(headings: list[str], cells: list[str]) -> list[str]:
    """A row: first its name, with the value where that is the next column, then what is left."""
    # A heading says what a number is, but not what the name of a row is.
    first = cells[0].strip() if _is_name(cells[0]) else f"{headings[0]} {cells[0]}".strip()
    below: list[tuple[str, str]] = []
    for heading, cell in zip(headings[1:], cells[1:], strict=True):
        if not cell:
            continue
        if heading == "value" and not below:
            first = f"{first}: {cell}"
        elif heading == "unit" and not below:
            first += f" {cell}"
        elif heading == "unit":
            below[-1] = (below[-1][0], f"{below[-1][1]} {cell}")
        else:
            below.append((heading, cell))
    width = max((len(heading) for heading, _ in below), default=0)
    return [first, *(f"{heading:<{width}}  {cell}".strip() for heading, cell in below)]


def _is_name(cell: str) -> bool:
    return any(character.isalpha() for character in cell)


def table_of(title: str, *columns: str, numbers: tuple[int, ...] = ()) -> FittingTable:
    """An empty table; the columns whose positions are among `numbers` are set flush right."""
    table = FittingTable(
        title=title,
        title_justify="left",
        title_style="bold",
        caption_justify="left",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
    )
    for i, column in enumerate(columns):
        words = i != 0 and i not in numbers
        table.add_column(
            column,
            justify="right" if i in numbers else "left",
            no_wrap=not words,
            min_width=_NARROWEST_WORDS if words and not column else None,
        )
    return table
