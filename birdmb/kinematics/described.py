"""A fitted gait as it is told to people and written into topologies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from birdmb._typing import FloatArray
from birdmb.kinematics.errorbars import ErrorBars, amplitude_gradient, error_bars, phase_gradient
from birdmb.kinematics.observations import Observations
from birdmb.kinematics.reference import lead_of, reference_joint
from birdmb.kinematics.result import JointMotion, KinematicsFit, MarkerFit, bird_with_gait
from birdmb.kinematics.series import Gait, Solved, marker_scatter
from birdmb.topology import Bird

_ROUND_OFF = 1e-9
_UNKNOWN_PHASE = math.pi / math.sqrt(3.0)  # standard deviation of a phase that may be any
_MISFIT = 3.0  # times the noise, from which on a residual is not of it alone


def described(
    seen: Observations,
    like: Bird,
    solved: Solved,
    noise: FloatArray,
    *,
    like_file: Path | None,
    remarks: tuple[str, ...],
    missing: Mapping[str, int],
) -> KinematicsFit:
    """The result of a fit; `noise` (R,) is what a series of its own leaves of each column."""
    gait = solved.gait
    bars = error_bars(solved, seen.times)
    reference = reference_joint(like, gait)
    lead = lead_of(like, gait)
    names = [like.joint_names[j] for j in gait.joints]
    own = gait.joints.index(reference)
    joints = {
        name: _motion(gait, bars, row, lead, own) for row, name in enumerate(names)
    }  # fmt: skip
    markers = _markers(seen, solved, missing)
    span = float(seen.times[-1] - seen.times[0])
    phases = gait.phases(seen.times)
    fitted = seen.predicted(gait.angles(seen, phases)[0])
    return KinematicsFit(
        bird=bird_with_gait(like, gait.frequency, joints),
        like=like,
        source=seen.origin,
        frequency=gait.frequency,
        frequency_error=bars.error(np.eye(len(bars.covariance))[-1]) / span,
        joints=joints,
        undetermined=tuple(name for name in like.joint_names if name not in names),
        reference=like.joint_names[reference],
        start=_first_beat(gait, lead, float(seen.times[0])),
        markers=markers,
        beats=bars.beats,
        frames=len(seen.times),
        remarks=(*remarks, *_remarks(seen, like, joints, markers, bars, noise)),
        phases=phases + lead,
        measured=np.where(np.isfinite(seen.values), fitted + solved.residuals, np.nan),
        fitted=fitted,
        like_file=like_file,
    )


def _first_beat(gait: Gait, lead: float, begin: float) -> float:
    """The first time from `begin` on at which a beat begins."""
    phase = gait.frequency * (begin - gait.middle) + lead
    return begin + (math.ceil(phase) - phase) / gait.frequency


def _motion(gait: Gait, bars: ErrorBars, row: int, lead: float, reference: int) -> JointMotion:
    """A joint's driver, its phases from t = 0, with the errors that those of the reference make."""
    rows, places = gait.unknowns
    at = {(int(r), int(p)): i for i, (r, p) in enumerate(zip(rows, places, strict=True))}
    unit = np.eye(len(bars.covariance))
    by_reference = (
        phase_gradient(*gait.coefficients[reference, 1:3])
        @ unit[[at[reference, 1], at[reference, 2]]]
    )
    found = []
    for order in range(1, gait.orders[row] + 1):
        columns = (2 * order - 1, 2 * order)
        own = unit[[at[row, column] for column in columns]]
        cosine, sine = gait.coefficients[row, columns]
        size = math.hypot(cosine, sine)
        phase = math.atan2(cosine, sine) - 2.0 * math.pi * order * lead
        turned = _UNKNOWN_PHASE
        if size > 0.0:
            gradient = phase_gradient(cosine, sine) @ own - order * by_reference
            turned = min(turned, bars.error(gradient))
        error = bars.error(amplitude_gradient(cosine, sine) @ own)
        found.append((size, _wrapped(phase), error, turned))
    sizes, phases, errors, turns = np.array(found).T
    return JointMotion(
        offset=float(gait.coefficients[row, 0]),
        amplitudes=sizes,
        phases=phases,
        offset_error=bars.error(unit[at[row, 0]]),
        amplitude_errors=errors,
        phase_errors=turns,
        scatter=float(bars.scatter[row]),
    )


def _wrapped(phase: float) -> float:
    """A phase from -pi, excluded, to pi; what is next to -pi by round-off is pi."""
    inside = math.remainder(phase, 2.0 * math.pi)
    return inside + 2.0 * math.pi if inside < -math.pi + _ROUND_OFF else inside


def _markers(
    seen: Observations, solved: Solved, missing: Mapping[str, int]
) -> dict[str, MarkerFit]:
    there, scatter = np.isfinite(seen.values), marker_scatter(seen, solved)
    found = {}
    for group, name in enumerate(seen.names):
        own = seen.group == group
        samples = int(there[:, own].all(axis=1).sum())
        found[name] = MarkerFit(
            residual=float(scatter[group]),
            samples=samples,
            missing=missing[name],
        )
    return found


def _remarks(
    seen: Observations,
    like: Bird,
    joints: Mapping[str, JointMotion],
    markers: Mapping[str, MarkerFit],
    bars: ErrorBars,
    noise: FloatArray,
) -> list[str]:
    remarks = []
    points = len(seen.markers.names)
    scatter = float(np.median(noise[seen.is_point])) if points else 0.0
    off = [
        name
        for i, (name, fit) in enumerate(markers.items())
        if i < points and fit.residual > _MISFIT * scatter
    ]
    if off:
        remarks.append(
            f"{', '.join(off)}: further from the fitted wing than the markers' own scatter; the "
            "topology's lengths, or the markers' places, are not quite those of the bird"
        )
    if bars.beats < 2:
        remarks.append("there are no two whole beats, so that nothing is said of their scatter")
    compliant = [one.name for one in like.compliant_joints if one.name in joints]
    if compliant:
        remarks.append(
            f"{', '.join(compliant)}: compliant, with the measured motion as its driver's, from "
            "which the spring will let it deviate"
        )
    return remarks
