"""What a search is doing, line by line on standard error."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from numba.core import event
from rich.console import Console
from rich.text import Text

from birdmb._kernel_files import any_cached
from birdmb.cli.interrupt import tidied
from birdmb.cli.streams import only_results_on_stdout
from birdmb.files import remove_drafts

if TYPE_CHECKING:
    from birdmb.orbits.iteration import Iteration

# Of a narrow terminal's lines, what is left out first.
_LEAST_WANTED = ("damping", "step", "nodes")


class Progress:
    """Lines of a search as it goes; on a terminal with a line below that says what is going on."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._status = console.status("") if console.is_terminal else None
        self._began = time.monotonic()

    @contextmanager
    def shown(self) -> Iterator[None]:
        """Show progress within, and say so if kernels have to be compiled."""
        live: AbstractContextManager[object] = self._status or nullcontext()
        with live, event.install_listener("numba:compile", _Compilation(self)):
            yield

    def stop(self) -> None:
        """Take the line below away, and give the terminal its cursor back."""
        if self._status is not None:
            self._status.stop()

    def line(self, text: str, style: str = "") -> None:
        """Write a line that stays."""
        self._console.print(text, style=style, highlight=False, markup=False, soft_wrap=True)

    def doing(self, text: str) -> None:
        """Say what is going on now, with the time so far; only a terminal shows it."""
        if self._status is not None:
            self._status.update(_Doing(text, self._began))

    def iteration(self, step: Iteration) -> None:
        """Write a line on an accepted step of the search."""
        # A larger number of nodes begins with the orbit of the one before.
        moved = step.step_length != 0.0
        begun = "guess" if step.number == 0 else ""
        values = {
            "iteration": str(step.number),
            "residual": f"{step.residual:.2e}",
            "step": f"{step.step_length:.2e}" if moved else begun,
            "damping": f"{step.damping:.3g}" if moved else "",
            "nodes": str(step.nodes or ""),
        }
        if not step.nodes:
            del values["nodes"]
        columns = self.fitting({name: max(9, len(name)) for name in values}, _LEAST_WANTED)
        if step.number == 0:
            self.line("  ".join(f"{name:>9}" for name in columns), style="bold")
        self.line("  ".join(f"{values[name]:>9}" for name in columns).rstrip())
        self.doing("searching")

    def fitting(self, widths: Mapping[str, int], least_wanted: Sequence[str]) -> list[str]:
        """The columns that a line has room for, those that are least wanted left out first."""
        columns = dict(widths)
        for name in least_wanted:
            if sum(columns.values()) + 2 * (len(columns) - 1) <= self._console.width:
                break
            columns.pop(name, None)
        return list(columns)


class _Doing:
    """A line that counts the seconds whenever it is drawn: a search that takes long is not dead."""

    def __init__(self, text: str, began: float) -> None:
        self._text, self._began = text, began

    def __rich__(self) -> Text:
        return Text(f"{self._text}, {time.monotonic() - self._began:.0f} s", style="dim")


class _Compilation(event.Listener):
    """Announces kernels that numba really compiles, which it reports; cached ones it does not."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._depth = 0
        self._announced = False
        self._kernels = 0
        self._started = 0.0

    def on_start(self, event: event.Event) -> None:
        """A kernel is going to be compiled, perhaps on the way to another one."""
        dispatcher = event.data["dispatcher"]
        if not dispatcher.py_func.__module__.startswith("birdmb."):
            return
        if not self._announced:
            self._announced = True
            self._progress.line(_announcement())
        if self._depth == 0:
            self._started = time.monotonic()
        self._depth += 1
        self._kernels += 1
        self._progress.doing(f"compiling kernel {self._kernels}, {dispatcher.py_func.__name__}")

    def on_end(self, event: event.Event) -> None:
        """A kernel has been compiled."""
        if not event.data["dispatcher"].py_func.__module__.startswith("birdmb."):
            return
        self._depth -= 1
        if self._depth == 0:
            self._progress.doing("searching")


def _announcement() -> str:
    """What to say before the first compilation."""
    if not any_cached():
        return "Compiling the kernels, once per installation (a minute or two) ..."
    return "Compiling kernels that are new or have changed since the last run ..."


@contextmanager
def at_work(
    progress: Progress, *folders: Path | None, farewell: Callable[[], object] = lambda: None
) -> Iterator[None]:
    """Show progress within, with only results on standard output.

    An interruption removes the drafts in the folders that are given, and calls `farewell`.
    """

    def tidy() -> None:
        progress.stop()
        for folder in folders:
            if folder is not None:
                remove_drafts(folder)
        farewell()

    with tidied(tidy), only_results_on_stdout(), progress.shown():
        yield
