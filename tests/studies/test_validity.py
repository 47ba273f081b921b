"""The report on validity: warnings where an artificial case puts them, and only there."""

import copy
import itertools
from dataclasses import replace

import numpy as np
import pytest

import birdmb
from birdmb.models.loads import LoadsAlong
from birdmb.studies import assess_validity
from birdmb.wing.outline import wing_outline


def with_circulation(cycle, changes):
    """The cycle with the effective angle (rad) put to given values at (time, element)."""
    stack = cycle.beat.loads_along.stack.right
    circulation = stack.circulation.copy()
    for at, angle in changes.items():
        circulation[at] = np.pi * stack.chord[at] * stack.speed[at] * angle
    return with_loads(cycle, circulation=circulation)


def with_loads(cycle, **changes):
    """The cycle with other loads over its beat."""
    stack = cycle.beat.loads_along.stack
    stack = stack._replace(right=stack.right._replace(**changes))
    changed = copy.copy(cycle)
    along = LoadsAlong(stack, cycle.model.aero)
    changed.__dict__["beat"] = replace(cycle.beat, loads_along=along)
    return changed


def test_reference_flight_is_within_the_limits(rigid_cycle):
    found = assess_validity(rigid_cycle)
    assert found.warnings == ()
    assert np.degrees(found.largest_angle_of_attack) < 15


def test_numbers_of_the_reference_flight(rigid_cycle):
    """k and St from the drawn wing and the mean flight, written out in another way."""
    found, model = assess_validity(rigid_cycle), rigid_cycle.model
    numbers = model.bird.wing.resolved_discretisation
    areas, spans, tips = [], [], []
    for t, x in zip(rigid_cycle.beat.times[:-1], rigid_cycle.beat.states, strict=False):
        outline = wing_outline(model.wing, model.joint_motion(t, x)[0], numbers)
        diagonals = (
            outline.panels[:, 2] - outline.panels[:, 0],
            outline.panels[:, 3] - outline.panels[:, 1],
        )
        areas.append(0.5 * np.linalg.norm(np.cross(*diagonals), axis=1).sum())
        spans.append(
            np.linalg.norm(np.diff(outline.line, axis=0), axis=1).sum() + outline.line[0, 1]
        )
        tips.append(outline.line[-1, 2])
    chord = np.mean(np.array(areas) / np.array(spans))
    assert found.reduced_frequency == pytest.approx(
        np.pi * 4 * chord / rigid_cycle.mean_speed, rel=0.02
    )
    assert found.strouhal_number == pytest.approx(
        4 * np.ptp(tips) / rigid_cycle.mean_speed, rel=1e-6
    )
    assert 0.09 < found.reduced_frequency < 0.1


def test_both_angles_by_time_and_element(rigid_cycle):
    data = assess_validity(rigid_cycle).data
    assert data.angle_of_attack.dims == ("time", "element")
    loads = rigid_cycle.beat.loads[7].right
    np.testing.assert_array_equal(data.angle_of_attack[7], loads.angle_of_attack)
    # The effective angle is what makes the lift of a section 2 pi alpha of its own wind.
    lift = loads.circulation * loads.speed
    coefficient = lift / (0.5 * loads.speed**2 * loads.chord)
    np.testing.assert_allclose(data.effective_angle_of_attack[7], coefficient / (2 * np.pi))
    assert (np.diff(data.span_position) > 0).all()
    assert data.span_fraction.values.max() <= 1.0
    assert data.phase.values[0] == 0.0


@pytest.mark.parametrize(("k", "e", "angle"), [(11, 5, 0.4), (40, 20, -0.5), (3, 0, 0.3)])
def test_warning_names_where_and_when(rigid_cycle, k, e, angle):
    found = assess_validity(with_circulation(rigid_cycle, {(k, e): angle}))
    (excess,) = found.excesses
    assert excess.value == pytest.approx(angle)
    assert excess.element == e
    assert excess.time == rigid_cycle.beat.times[k]
    assert excess.phase == pytest.approx(k / 60)
    position = rigid_cycle.beat.loads[k].right.position
    along = position[0, 1] + np.linalg.norm(np.diff(position[: e + 1], axis=0), axis=1).sum()
    assert excess.span_position == pytest.approx(along)
    assert 0 < excess.share < 0.01
    (text,) = found.warnings
    assert f"{np.degrees(angle):.1f} deg" in text
    assert f"element {e}, {along:.3g} m along the span" in text
    assert f"phase {k / 60:.2f} of the beat" in text
    assert "no stall" in text


def test_both_signs_are_told_and_the_worst_of_each(rigid_cycle):
    changes = {(11, 5): 0.4, (12, 5): 0.41, (40, 20): -0.5, (41, 20): -0.3}
    found = assess_validity(with_circulation(rigid_cycle, changes))
    assert [(x.value, x.element) for x in found.excesses] == [
        (pytest.approx(0.41), 5),
        (pytest.approx(-0.5), 20),
    ]


def test_just_within_the_limit_is_silent(rigid_cycle):
    limit = np.radians(15)
    assert not assess_validity(with_circulation(rigid_cycle, {(11, 5): 0.999 * limit})).warnings
    assert assess_validity(with_circulation(rigid_cycle, {(11, 5): 1.001 * limit})).warnings


def test_geometric_angle_alone_does_not_warn(rigid_cycle):
    """The section meets the wind after the downwash."""
    geometric = rigid_cycle.beat.loads_along.stack.right.angle_of_attack.copy()
    geometric[11] += 0.5
    changed = with_loads(rigid_cycle, angle_of_attack=geometric)
    assert assess_validity(changed).warnings == ()


def test_outermost_hundredth_of_the_area_is_not_judged(rigid_cycle):
    data = assess_validity(rigid_cycle).data
    area = data.area.values
    left_out = np.where(data.judged, 0.0, area).sum(axis=1) / area.sum(axis=1)
    assert (left_out < 0.02).all()
    assert (~data.judged.values[:, -1]).all()
    # There the angle is large already, and tells nothing.
    assert np.degrees(np.abs(data.effective_angle_of_attack[:, -1]).max()) > 20
    assert assess_validity(with_circulation(rigid_cycle, {(11, 31): 2.0})).warnings == ()


def test_verdict_does_not_depend_on_the_discretisation(ibis, rigid_cycle):
    """At the last element the angle grows by 5 deg with each doubling; what is judged does not."""
    angles = [assess_validity(rigid_cycle).largest_angle_of_attack]
    for elements in (16, 64):
        bird = ibis.with_values({"wing.discretisation.elements": elements})
        cycle = birdmb.find_limit_cycle(birdmb.RigidModel(bird))
        angles.append(assess_validity(cycle).largest_angle_of_attack)
    assert np.degrees(np.ptp(angles)) < 0.6


def test_reduced_frequency_warns_beyond_its_limit(rigid_cycle):
    found = assess_validity(rigid_cycle, largest_reduced_frequency=0.09)
    (excess,) = found.excesses
    assert excess.quantity == "reduced frequency"
    assert excess.value == found.reduced_frequency
    local = found.data.reduced_frequency.values[:-1]
    k, e = np.unravel_index(np.argmax(local), local.shape)
    assert (excess.time, excess.element) == (rigid_cycle.beat.times[k], e)
    assert "unsteady wake" in str(excess)


def test_overlap_of_the_wings_is_told_beyond_its_limit(rigid_cycle):
    """Feather 7 reaches across the plane of symmetry while the arm is swept back, at T/2."""
    assert 0 < assess_validity(rigid_cycle).largest_overlap < 0.01
    found = assess_validity(rigid_cycle, largest_overlap=1e-4)
    (excess,) = found.excesses
    assert excess.quantity == "overlap of the wings"
    assert excess.value == found.largest_overlap
    assert excess.phase == pytest.approx(0.5, abs=0.02)
    # The area by fine points of each panel, each of them on one side or the other.
    model = rigid_cycle.model
    numbers = model.bird.wing.resolved_discretisation
    at = rigid_cycle.beat.times.tolist().index(excess.time)
    angles, _ = model.joint_motion(excess.time, rigid_cycle.beat.states[at])
    chords = wing_outline(model.wing, angles, numbers).chords
    a, b = np.meshgrid(*2 * [(np.arange(100) + 0.5) / 100], indexing="ij")
    across = whole = 0.0
    for inner, outer in itertools.pairwise(chords):
        along = [p[None, None] + a[..., None] * (q - p) for p, q in zip(inner, outer, strict=True)]
        y = (along[0] + b[..., None] * (along[1] - along[0]))[..., 1]
        area = np.linalg.norm(np.cross(outer[1] - inner[0], outer[0] - inner[1])) / 2
        across, whole = across + area * np.mean(y < 0), whole + area
    assert excess.value == pytest.approx(across / whole, rel=0.1)
    assert "across the plane of symmetry at t = " in str(excess)


def test_figure_shows_both_angles(rigid_cycle):
    geometric, effective, bar = assess_validity(rigid_cycle).plot().axes
    assert geometric.get_title() == "geometric"
    assert effective.get_title().startswith("effective")
    assert bar.get_ylabel() == "angle of attack (°)"
