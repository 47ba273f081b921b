"""The figure that results are drawn into, and where it shows itself."""

from __future__ import annotations

import io
import sys
from collections.abc import Mapping
from typing import Any

import matplotlib as mpl
from matplotlib._pylab_helpers import Gcf
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.registry import BackendFilter, backend_registry
from matplotlib.figure import Figure

_INLINE = "inline"  # part of the name of the backend that shows figures in a notebook's page
_DOTS_PER_INCH = 150

Style = Mapping[str, Any]
"""Settings of matplotlib."""


class ShownFigure(Figure):
    """A figure that a notebook's cell shows as its last line, and that keeps its own style.

    Matplotlib makes tick labels when it draws, and embeds fonts when it saves: both are done in the
    style in which the figure was made, wherever this happens.
    """

    def __init__(self, *args: Any, style: Style | None = None, **options: Any) -> None:
        super().__init__(*args, **options)
        self._style: Any = dict(style or {})

    def draw(self, renderer: RendererBase) -> None:
        """Draw in the figure's own style."""
        with mpl.rc_context(self._style):
            super().draw(renderer)

    def savefig(self, fname: Any, **options: Any) -> None:
        """Save in the figure's own style."""
        with mpl.rc_context(self._style):
            super().savefig(fname, **options)

    def _ipython_display_(self) -> None:
        """Leave the showing to IPython's formatters, once.

        At the end of a cell the inline backend shows what pyplot holds, which would be this figure
        for the second time.
        """
        if self._held_by_pyplot() and _INLINE in mpl.get_backend():
            _pyplot().close(self)
        raise NotImplementedError

    def _repr_png_(self) -> bytes | None:
        if self._held_by_pyplot():  # which shows it in a window or a widget
            return None
        picture = io.BytesIO()
        self.savefig(picture, format="png", dpi=_DOTS_PER_INCH)
        return picture.getvalue()

    def _held_by_pyplot(self) -> bool:
        # pyplot.figure would make another figure the current one.
        return any(manager.canvas.figure is self for manager in Gcf.get_all_fig_managers())


def shown_figure(style: Style, **options: Any) -> Figure:
    """A figure that `pyplot.show` shows, where it can show any: on a screen or in a notebook.

    Elsewhere, and where pyplot was not imported, nothing but its user holds the figure. `options`
    are those of `matplotlib.figure.Figure`.
    """
    if not _can_show():
        return ShownFigure(style=style, **options)
    pyplot = _pyplot()
    _close_the_oldest()
    return pyplot.figure(FigureClass=ShownFigure, style=style, **options)


def _pyplot() -> Any:
    from matplotlib import pyplot  # noqa: PLC0415 - chooses a backend: not for headless scripts

    return pyplot


def _can_show() -> bool:
    in_ipython = "IPython" in sys.modules and sys.modules["IPython"].get_ipython() is not None
    if "matplotlib.pyplot" not in sys.modules and not in_ipython:
        return False
    _pyplot()
    registry: Any = backend_registry
    silent = registry.list_builtin(BackendFilter.NON_INTERACTIVE)
    return mpl.get_backend().lower() not in silent


def _close_the_oldest() -> None:
    """Keep a script that never shows its figures from filling the memory with them."""
    pyplot, most = _pyplot(), int(mpl.rcParams["figure.max_open_warning"])
    if pyplot.isinteractive() or not most:  # in windows already, or as many as one likes
        return
    managers = Gcf.figs
    ours = [n for n, manager in managers.items() if isinstance(manager.canvas.figure, ShownFigure)]
    for number in sorted(ours)[: max(0, len(ours) + 1 - most)]:
        pyplot.close(number)
