"""Figures of a cycle: what they show, read back from the artists."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.text import Text

import birdmb
from birdmb import figures
from birdmb.figures.style import downstrokes, holds_still, stroke_speed
from birdmb.figures.wing import BEHIND, OBLIQUE, TOP

ALL = (
    figures.plot_states,
    figures.plot_multipliers,
    figures.plot_loads_and_power,
    figures.plot_wing_phases,
    figures.plot_overview,
)


@pytest.fixture(scope="module")
def cycle(ibis_compliant):
    bird = ibis_compliant.with_values({"wing.discretisation": 8})
    model = birdmb.MultibodyModel(bird, steps_per_beat=32)
    return birdmb.find_limit_cycle(model, tolerance=1e-7)


@pytest.fixture(scope="module")
def gliding(ibis):
    values = {f"{joint}.amplitude": 0 for joint in ibis.joint_names}
    return birdmb.find_limit_cycle(
        birdmb.RigidModel(ibis.with_values(values | {"wing.discretisation": 8}))
    )


@pytest.mark.long
@pytest.mark.parametrize("draw", ALL)
def test_every_figure_shows_something_and_nothing_sticks_out(cycle, draw):
    figure = draw(cycle)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    picture = np.asarray(canvas.buffer_rgba())[..., :3]
    assert picture.std() > 5
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert (border == 255).all()


@pytest.mark.parametrize("draw", ALL)
def test_a_glider_can_be_drawn(gliding, draw):
    FigureCanvasAgg(draw(gliding)).draw()


def test_states_are_in_degrees_beside_their_drivers(cycle):
    figure = figures.plot_states(cycle)
    by_label = {axes.get_ylabel(): axes for axes in figure.axes}
    assert list(by_label) == [
        "u (m/s)",
        "w (m/s)",
        "θ (°)",
        "q (°/s)",
        "shoulder\nflap (°)",
        "shoulder\nflap rate (°/s)",
    ]
    curves = {line.get_label(): line for line in by_label["shoulder\nflap (°)"].get_lines()}
    times = cycle.beat.times
    driver = -42 * np.sin(2 * np.pi * 4 * times)
    assert np.allclose(curves["driver"].get_ydata(), driver, atol=1e-9)
    flap = np.degrees(cycle.beat.states[:, cycle.state_names.index("shoulder.flap")])
    assert np.allclose(curves["state"].get_ydata(), flap)
    rates = {line.get_label(): line for line in figure.axes[-1].get_lines()}
    slope = np.gradient(driver, times)
    assert np.allclose(rates["driver"].get_ydata()[1:-1], slope[1:-1], rtol=0.01, atol=5)


def test_downstroke(cycle):
    """t = 0 is the middle of the driver's downstroke; the wing follows its driver a little late."""
    (_, end), (start, _) = downstrokes(cycle)
    assert end == pytest.approx(cycle.period / 4, abs=0.02 * cycle.period)
    # the sweep and the fanned feathers shift the upper turn by a little more
    assert start == pytest.approx(0.75 * cycle.period, abs=0.06 * cycle.period)
    assert stroke_speed(cycle)[0] > 3


def test_multipliers_are_labelled(cycle):
    (axes,) = figures.plot_multipliers(cycle).axes
    texts = [text.get_text() for text in axes.texts]
    assert texts[0] == (
        f"|Λ| = {abs(cycle.multipliers[0]):.3f}\ndoubles in {cycle.doubling_times[0]:.2g} s"
    )
    assert texts[-1] == "2 × |Λ| < $10^{-4}$"
    assert len(texts) == 4  # a pair and the two tiny ones share one each
    boxes = [
        text.get_window_extent(FigureCanvasAgg(axes.figure).get_renderer()) for text in axes.texts
    ]
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])


def test_means_stand_in_the_loads(cycle):
    figure = figures.plot_loads_and_power(cycle)
    texts = [axes.get_title(loc="right") for axes in figure.axes]
    assert f"mean {cycle.power:.3g} W".replace("-", "−") in texts
    texts = [text.get_text() for text in figure.findobj(Text)]
    for name, power in cycle.joint_powers.items():
        shown = name.replace(".", " ")
        assert f"{shown}  {power:+.2f} W".replace("-", "−") in texts


def test_wings_are_drawn_to_one_scale_with_their_circulation(cycle):
    figure = figures.plot_wing_phases(cycle)
    FigureCanvasAgg(figure).draw()
    axes = figure.axes[0]
    origin, right, up = axes.transData.transform([[0, 0], [1, 0], [0, 1]])
    assert right[0] - origin[0] == pytest.approx(up[1] - origin[1])
    wings = [c for c in axes.collections if isinstance(c, PolyCollection)]
    assert len(wings) == 12
    circulation = cycle.beat.loads[0].right.circulation
    assert np.allclose(np.sort(wings[0].get_array()), np.sort(np.tile(circulation, 2)))
    (_, front, top) = (np.vstack([p.vertices for p in wings[i].get_paths()]) for i in (0, 4, 8))
    assert np.ptp(front[:, 0]) == pytest.approx(np.ptp(top[:, 0]))
    assert [text.get_text() for text in axes.texts if text.get_text().startswith("t =")] == [
        "t = 0, downstroke",
        "t = T/4, lower turn",
        "t = T/2, upstroke",
        "t = 3T/4, upper turn",
    ]


def test_views_show_right_on_the_right_and_up_upwards():
    right, forward, up = np.array([0, 1, 0]), np.array([1, 0, 0]), np.array([0, 0, -1])
    for view in (OBLIQUE, BEHIND, TOP):
        assert view(right)[0] > 0.5
    assert np.allclose(BEHIND(up), [0, 1])
    assert np.allclose(TOP(forward), [0, 1])
    assert OBLIQUE(up)[1] > 0
    assert OBLIQUE(forward)[1] > 0


def test_plot_is_the_overview(cycle):
    assert len(cycle.plot().axes) == len(figures.plot_overview(cycle).axes)


def test_figures_import_no_model():
    script = (
        "import sys; from birdmb.figures import plot_orbit, plot_overview; "
        "print([m for m in sys.modules if m.startswith('birdmb.models') or m == 'exudyn' "
        "or m == 'matplotlib.pyplot'])"
    )
    assert subprocess.check_output([sys.executable, "-c", script], text=True) == "[]\n"


@pytest.mark.parametrize(
    ("doubt", "says"),
    [
        ({"failed_checks": ("the energy is off",)}, ": undecided, for the program's own checks"),
        ({"why_no_flight": "it moves backwards"}, ": not a flight, "),
    ],
)
def test_the_overview_says_first_what_speaks_against_the_numbers(cycle, doubt, says):
    doubtful = replace(cycle)
    vars(doubtful).update(doubt)
    titles = [part.get_suptitle() for part in figures.plot_overview(doubtful).subfigs]
    assert any(says in title for title in titles)


def test_a_glide_on_springs_has_no_downstroke():
    """The spring settles to the orbit's round-off, which is no stroke."""
    bird = birdmb.load_bird("gull_glider").with_joint("shoulder.flap", stiffness=40.0, damping=0.5)
    cycle = birdmb.find_limit_cycle(birdmb.MultibodyModel(bird))
    assert holds_still(cycle)
    assert downstrokes(cycle) == []
    labels = {axes.get_xlabel() for axes in cycle.plot().axes}
    assert "time (s)" in labels
    assert "time (s), downstroke shaded" not in labels
