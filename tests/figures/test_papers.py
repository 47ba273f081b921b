"""Figures for papers: every one of them at the width of a column, and files of all formats."""

import subprocess
import sys

import matplotlib as mpl
import matplotlib.image
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import birdmb
from birdmb.figures import paper
from birdmb.figures.labels import parameter_label, setting
from birdmb.figures.page import inches
from birdmb.figures.saving import formats_of, save_figure
from birdmb.figures.showing import ShownFigure
from birdmb.figures.style import SERIES, VERDICT_LINES

from . import gallery
from .seeing import alike, confusable, covered, unlabelled, unreadable


@pytest.mark.long  # all together
@pytest.mark.parametrize("name", gallery.GALLERY)
def test_every_figure_in_a_column(name):
    with paper(width="90mm"):
        figure = gallery.GALLERY[name]()
    assert figure.get_figwidth() == pytest.approx(90 / 25.4)
    assert unreadable(figure) == []  # drawn outside of the context
    assert unlabelled(figure) == []
    assert confusable(figure) == []
    assert covered(figure) == []


def test_the_check_of_legends_can_fail():
    figure = Figure()
    axes = figure.subplots()
    axes.plot([0.0, 1.0], [0.0, 1.0], label="up")
    axes.legend(loc="lower left")
    assert len(covered(figure)) == 1
    axes.legend(loc="upper left")
    assert covered(figure) == []


def test_all_about_a_cycle_fits_on_a_page():
    with paper(width="90mm"):
        figure = gallery.GALLERY["overview"]()
    assert figure.get_figheight() < 9.7


def test_the_check_of_lines_can_fail():
    red, green, blue = (Line2D([], [], color=f"tab:{name}") for name in ("red", "green", "blue"))
    assert alike(red, Line2D([], [], color="#8a6d1f"))
    assert not alike(green, blue)
    assert not alike(red, Line2D([], [], color="tab:red", ls="--"))


def test_lines_of_one_kind_differ_in_grey():
    dashes = [str(style["linestyle"]) for style in SERIES]
    assert len(set(dashes)) == len(dashes)
    assert len({str(style["ls"]) for style in VERDICT_LINES.values()}) == 3


def test_a_figure_keeps_its_style_after_the_context():
    with paper(width="90mm"):
        figure = gallery.oscillation().plot()
    before = mpl.rcParams["font.size"]
    figure.draw_without_rendering()
    sizes = [tick.get_fontsize() for tick in figure.axes[0].get_xticklabels()]
    assert sizes == pytest.approx([8 * 0.833] * len(sizes))
    assert mpl.rcParams["font.size"] == before


@pytest.mark.parametrize(
    ("text", "wide"), [("90mm", 90 / 25.4), ("3.5 in", 3.5), ("9cm", 9 / 2.54)]
)
def test_widths(text, wide):
    assert inches(text) == pytest.approx(wide)


@pytest.mark.parametrize("text", ["90", "wide", "-90mm", "1mm", "2000cm", "", "nanmm"])
def test_what_is_no_width(text):
    with pytest.raises(birdmb.ArgumentError, match="width"), paper(width=text):
        pass


def test_formats(tmp_path):
    assert formats_of("pdf, SVG,png,pdf") == ("pdf", "svg", "png")
    with pytest.raises(birdmb.ArgumentError, match="'gif' is no format of figures"):
        formats_of("png,gif")
    with paper(width="90mm"):
        figure, again = gallery.oscillation().plot(), gallery.oscillation().plot()
    files = [save_figure(figure, tmp_path / f"orbit.{kind}") for kind in formats_of("pdf,svg,png")]
    pdf, svg, _ = (file.read_bytes() for file in files)
    assert pdf.startswith(b"%PDF")
    assert b"/FontFile2" in pdf  # TrueType, which journals take
    assert b"<svg" in svg
    assert matplotlib.image.imread(files[2]).shape[1] == pytest.approx(300 * 90 / 25.4, abs=2)
    assert save_figure(again, files[0]).read_bytes() == pdf  # no date in it


def test_symbols():
    assert parameter_label("shoulder.flap.stiffness") == r"$k_{\mathrm{flap}}$ (N m/rad)"
    assert parameter_label("forearm.roll.offset_deg").startswith(r"$\theta_{0,\,\mathrm{forearm")
    assert parameter_label("tail.opening_deg") == "tail opening (°)"
    assert setting("tail.opening_deg", -5.0) == "tail opening = −5°"


SHELL = """
import sys
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
{setup}
shell.run_cell("from birdmb.figures.page import new_figure")
shell.run_cell("figure = new_figure(2, 2); axes = figure.subplots(); line = axes.plot([1, 2])")
data, metadata = shell.display_formatter.format(shell.user_ns["figure"])
plt = sys.modules["matplotlib.pyplot"]
print(sorted(data), len(plt.get_fignums()))
"""
INLINE = """shell.run_cell("import matplotlib; matplotlib.use('inline')")
shell.run_cell("import matplotlib.pyplot; from matplotlib_inline.config import InlineBackend")
from matplotlib_inline.backend_inline import configure_inline_support
configure_inline_support(shell, "inline")"""


@pytest.mark.parametrize("setup", ["", INLINE], ids=["no backend", "inline"])
def test_a_notebook_shows_the_last_line_once(setup):
    """As PNG beside the text; nothing is left for the end of the cell to show again."""
    pytest.importorskip("IPython")
    script = SHELL.format(setup=setup)
    done = subprocess.run(
        [sys.executable, "-c", script], text=True, capture_output=True, check=True,
        env={"MPLBACKEND": "agg", "PYTHONPATH": ":".join(sys.path)},
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == "['image/png', 'text/plain'] 0"


def test_showing_a_figure_leaves_the_current_one_of_pyplot():
    plt = pytest.importorskip("matplotlib.pyplot")
    first, second = plt.figure(), plt.figure()
    try:
        plt.figure(first.number)
        assert ShownFigure()._repr_png_().startswith(b"\x89PNG")
        assert plt.gcf() is first
    finally:
        plt.close(first)
        plt.close(second)


SCRIPT = """
import matplotlib, warnings
warnings.simplefilter("error")
matplotlib.use({backend!r})
import matplotlib.pyplot as plt
from birdmb.figures.page import new_figure
figures = [new_figure(2, 2) for _ in range(30)]
print(len(plt.get_fignums()), figures[-1].number if plt.get_fignums() else None)
plt.show()
"""
SCREEN = """
from matplotlib.backend_bases import FigureManagerBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
class FigureManager(FigureManagerBase):
    @classmethod
    def pyplot_show(cls, *, block=None):
        from matplotlib._pylab_helpers import Gcf
        print("shown", len(Gcf.get_all_fig_managers()))
class FigureCanvas(FigureCanvasAgg):
    manager_class = FigureManager
"""


def test_pyplot_shows_figures_on_a_screen_and_holds_none_without(tmp_path):
    (tmp_path / "screen.py").write_text(SCREEN)
    said = {}
    for backend in ("agg", "module://screen"):
        said[backend] = subprocess.run(
            [sys.executable, "-c", SCRIPT.format(backend=backend)], text=True, check=True,
            capture_output=True, env={"PYTHONPATH": ":".join([str(tmp_path), *sys.path])},
        ).stdout.splitlines()  # fmt: skip
    assert said["agg"] == ["0 None"]
    assert said["module://screen"] == ["20 30", "shown 20"]


def test_maps_mark_computed_points_and_tick_their_values():
    figure = gallery.GALLERY["sweep_map"]()
    axes = figure.axes[0]
    points = next(line for line in axes.get_lines() if line.get_marker() == ".")
    assert sorted(set(points.get_xdata())) == [40.0, 44.0]
    assert list(axes.get_xticks()) == [40.0, 44.0]
    growth = [bar.get_ylabel() for axes in figure.axes for bar in axes.child_axes]
    assert growth == ["growth (s)", "decay (s)"]
    assert np.isfinite(points.get_ydata()).all()
