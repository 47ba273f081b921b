"""Following a branch of periodic orbits through its folds."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import numpy as np
import numpy.typing as npt

from birdmb.arguments import checked
from birdmb.errors import ArgumentError
from birdmb.orbits.branch import Branch
from birdmb.orbits.branch_points import Bifurcation, BranchPoint
from birdmb.orbits.cycle import LimitCycle, OrbitMethod
from birdmb.orbits.errors import BranchStopped, NotSmoothError, SingularJacobianError
from birdmb.orbits.extended import ExtendedEquations, Family
from birdmb.orbits.extended_collocation import ExtendedCollocation
from birdmb.orbits.extended_shooting import ExtendedShooting
from birdmb.orbits.search import (
    ACCURACY,
    TOLERANCE,
    SearchMethod,
    find_limit_cycle,
    most_nodes,
)
from birdmb.orbits.segments import choose_jacobian
from birdmb.orbits.tracer import Observables, Steps, Tracer
from birdmb.orbits.trigonometric import resampled
from birdmb.provenance import software

_DEFAULT_STEPS = Steps()


@checked
def continue_branch(
    family: Family,
    parameter_range: tuple[float, float],
    guess: npt.ArrayLike | None = None,
    *,
    parameter_name: str = "parameter",
    period_guess: float | None = None,
    method: SearchMethod = "auto",
    accuracy: float = ACCURACY,
    segments: int | None = None,
    start_time: float = 0.0,
    steps: Steps = _DEFAULT_STEPS,
    max_points: int = 200,
    max_bifurcations: int | None = None,
    tolerance: float = TOLERANCE,
    jacobian: Literal["auto", "variational", "finite-differences"] = "auto",
    observables: Observables | None = None,
    resume: Branch | None = None,
    store: str | Path | None = None,
    settings: Mapping[str, str | float] | None = None,
    executor: Executor | None = None,
    callback: Callable[[BranchPoint | Bifurcation], None] | None = None,
) -> Branch:
    """Follow periodic orbits in one parameter by pseudo-arclength continuation.

    Predictor along the tangent, corrector on the plane across it (Keller 1977; Kuznetsov 2004,
    chapter 10), by the method of `find_limit_cycle` that found the orbit at the start of the range.
    Steps are adapted to the corrector's iterations and to the turn of the tangent, the nodes of
    collocation to the error of each orbit. Folds are passed. Between points, sign changes of test
    functions (fold, branch point, period doubling) and what they leave unexplained of a change in
    the number of multipliers outside the unit circle are located by Brent's method along the
    arclength. Crossings between two neighbouring points that cancel, the one outwards and the other
    inwards, leave no trace there: take shorter steps.

    Args:
        family: function of the parameter that returns the model. It may raise a `BirdmbError` where
            there is none.
        parameter_range: from where to where. A branch that turns may also end where it began.
        guess: orbit at the start of the range, as for `find_limit_cycle`.
        parameter_name: name for labels.
        period_guess: as for `find_limit_cycle`.
        method: "collocation", "shooting" or "auto", as for `find_limit_cycle`. Where orbits become
            too rough for collocation, "auto" goes on by shooting over one segment from there, and
            "collocation" stops.
        accuracy: largest error of the states accepted by collocation, in units of their scale.
        segments: number M of shooting segments; given, it makes "auto" choose shooting.
        start_time: time of the first state, in s.
        steps: step sizes.
        max_points: number of points allowed, those resumed from included.
        max_bifurcations: end at the first point after so many bifurcations; `None`: go on.
        tolerance: closure error accepted, in units of the state scale.
        jacobian: as for `find_limit_cycle`.
        observables: functions of the `LimitCycle`, by name, whose values are kept at every point.
        resume: a branch of the same family over the same range to go on with from its last point,
            the way it would have gone; `guess`, `period_guess`, `segments` and `start_time` are
            then its own, and so is the method at its last point.
        store: file in which the branch is saved after every point, so that nothing is lost.
        settings: texts and numbers to keep with the branch.
        executor: spreads flows over workers; results do not depend on it.
        callback: called with every point and every bifurcation as it is found.

    Returns:
        The branch. If it ended before an end of the range, `stopped` says why; it can be raised.

    Raises:
        ArgumentError: an argument contradicts another, a name cannot be saved, or `resume` was
            computed by another version of birdmb.
        OutputError: `store` cannot be written; it keeps what it held before.
        ConvergenceError: no orbit at the start of the range (other errors of `find_limit_cycle`
            likewise). Later failures end the branch instead.
    """
    first, last = map(float, parameter_range)
    if first == last:
        raise ArgumentError("parameter_range must have two different ends.")
    versions = software() if resume is None else _continued(resume.software)
    _reject_names(parameter_name, observables or {}, settings or {})
    family = functools.lru_cache(maxsize=8)(family)
    begin = first if resume is None else resume.points[-1].parameter
    model = family(begin)
    _reject_texts(model.state_names)
    if resume is None:
        cycle = find_limit_cycle(
            model,
            guess,
            method=method,
            accuracy=accuracy,
            period_guess=period_guess,
            segments=segments,
            start_time=start_time,
            tolerance=tolerance,
            jacobian=jacobian,
            executor=executor,
        )
        scale, period, taken = cycle.state_scale, cycle.period, _followed_by(cycle, begin)
        # Multipliers may have taken more instants than the orbit has nodes.
        orbit = resampled(cycle.points, cycle.nodes or len(cycle.points))
    else:
        start_time, scale, taken = resume.start_time, resume.state_scale, resume.points[-1].method
        orbit, period = resume.points[0].points, resume.points[0].period
    nowhere = np.zeros(orbit.size + (model.period is None) + 1)
    ends = min(first, last), max(first, last)
    place = family, ends, scale, start_time, period, nowhere, nowhere, 0.0
    equations: ExtendedEquations
    equations = shooting = ExtendedShooting(*place, choose_jacobian(model, jacobian), executor)
    if taken == "collocation":
        equations = ExtendedCollocation(*place, len(orbit), accuracy, most_nodes(model, method))
        equations = equations.with_sound_derivatives(equations.unknowns(first, orbit, period))
    instead = shooting if taken == "collocation" and method == "auto" else None
    tracer = Tracer(equations, steps, tolerance, observables or {}, instead)
    if resume is None:
        with _one_branch_alone(f"{parameter_name} = {begin:.8g}", cycle):
            points = [tracer.first_point(begin, orbit, period, last - first)]
        bifurcations: list[Bifurcation] = []
    else:
        points = list(resume.points)
        # What lay beyond the last point is found again on the way there.
        bifurcations = [b for b in resume.bifurcations if b.after < len(points) - 1]

    def kept(stopped: BranchStopped | None) -> Branch:
        branch = Branch(
            parameter_name=parameter_name,
            state_names=tuple(model.state_names),
            state_scale=scale,
            start_time=start_time,
            points=tuple(points),
            bifurcations=tuple(bifurcations),
            stopped=stopped,
            settings=dict(settings or {}),
            software=versions,
        )
        if store is not None:
            branch.save(store)
        return branch

    if resume is None:
        kept(BranchStopped("the run was interrupted", begin))
        if callback is not None:
            callback(points[0])
    known = tuple(points), tuple(bifurcations)
    for item in tracer.follow(*known, max_points, max_bifurcations):
        if isinstance(item, BranchPoint):
            points.append(item)
            kept(BranchStopped("the run was interrupted", item.parameter))
        else:
            bifurcations.append(item)
        if callback is not None:
            callback(item)
    return kept(tracer.stopped)


@contextmanager
def _one_branch_alone(where: str, cycle: LimitCycle) -> Iterator[None]:
    """Say so if no tangent of the branch can be found."""
    try:
        yield
    except np.linalg.LinAlgError as error:
        raise SingularJacobianError(
            f"The orbit at {where} is one of a continuous family, or a bifurcation to the last "
            f"digit: no single branch leads on; try another start.",
            cycle.x0,
            cycle.residual,
        ) from error


def _continued(before: Mapping[str, str]) -> dict[str, str]:
    """Versions of a branch that was begun with some versions and is resumed with those here.

    Raises:
        ArgumentError: birdmb itself is of another version, so that orbits may be others.
    """
    versions = {}
    for name, now in software().items():
        then = before.get(name, "unknown")
        if name == "birdmb" and then != now:
            raise ArgumentError(
                f"the branch to resume was computed by birdmb {then}, this is {now}: resume it "
                f"with that version, or follow the branch anew."
            )
        versions[name] = then if then.rpartition(", ")[2] == now else f"{then}, {now}"
    return versions


def _reject_names(
    parameter_name: str, observables: Observables, settings: Mapping[str, str | float]
) -> None:
    """Refuse before any computing what no file could keep afterwards."""
    _reject_texts([parameter_name, *observables, *settings, *settings.values()])
    for name in observables:
        if "/" in name:
            raise ArgumentError(f"the observable {name} cannot have a slash in its name.")


def _reject_texts(texts: Iterable[object]) -> None:
    for text in texts:
        if isinstance(text, str) and not _can_be_stored(text):
            raise ArgumentError(
                f"{text!a} cannot be kept in a file: it has a null character, or characters "
                f"that are none."
            )


def _can_be_stored(text: str) -> bool:
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return "\0" not in text


def _followed_by(cycle: LimitCycle, parameter: float) -> OrbitMethod:
    """How a branch goes on from an orbit; raises `NotSmoothError` for one that needs a mesh."""
    if cycle.pieces is not None:
        raise NotSmoothError(
            f"The orbit at parameter {parameter:.8g} is too rough for Fourier collocation, by "
            f'which branches are followed; take method="shooting".',
            cycle.x0,
            cycle.state_error,
            cycle.iterations,
        )
    return cycle.method
