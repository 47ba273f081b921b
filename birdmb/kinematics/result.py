"""A gait fitted to a measured motion."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from birdmb._typing import FloatArray
from birdmb.summary import Fact, Summarised, shortened, with_error
from birdmb.topology import Bird

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_DECIMALS = 6
_OF_THE_DRIVER = (
    *("gain", "harmonics", "downstroke_fraction"),
    *("samples", "sample_phases", "sample_harmonics"),
)


@dataclass(frozen=True, repr=False)
class JointMotion(Summarised):
    """The driver of a joint: offset + sum over m of amplitude_m sin(m w t + phase_m).

    Attributes:
        offset: mean angle, rad.
        amplitudes: of the harmonics 1 to H, rad.
        phases: at t = 0, rad.
        offset_error, amplitude_errors, phase_errors: standard errors, rad.
        scatter: rms of the angles of single beats from the mean beat's, rad, measuring noise
            included; NaN where there are no two whole beats.
    """

    offset: float
    amplitudes: FloatArray
    phases: FloatArray
    offset_error: float
    amplitude_errors: FloatArray
    phase_errors: FloatArray
    scatter: float

    def at(self, phases: FloatArray) -> FloatArray:
        """Angles (P,) rad at `phases` (P,), parts of a beat."""
        orders = np.arange(1, len(self.amplitudes) + 1)
        argument = 2.0 * np.pi * np.outer(phases, orders) + self.phases
        return np.asarray(self.offset + np.sin(argument) @ self.amplitudes)


@dataclass(frozen=True)
class MarkerFit:
    """How well a marker, or a column of angles, is met.

    Attributes:
        residual: standard deviation of measured from fitted along one axis, the freedom that the
            fit left counted; m, of angles rad.
        samples: in how many frames it was seen.
        missing: in how many it was not.
    """

    residual: float
    samples: int
    missing: int


@dataclass(frozen=True, repr=False)
class KinematicsFit(Summarised):
    """A bird with the gait of a measured motion, and how sure that gait is.

    Attributes:
        bird: the bird, joints that the data tell and frequency as measured.
        like: the bird whose chain was fitted.
        source: the file that was read, or what stands for it.
        frequency: wingbeat frequency, Hz.
        frequency_error: its standard error, Hz; 0 where it was given.
        joints: the joints that were solved for, with offsets, harmonics and errors.
        undetermined: names of the joints that the data do not tell; they keep their drivers.
        reference: the joint whose phase gives the beat its beginning, as in `like`.
        start: time in the file at which a beat begins (t = 0 of the gait), s.
        markers: residuals by marker or joint.
        beats: whole beats that were averaged.
        frames: how many frames were used.
        remarks: what to beware of, in sentences.
        phases: phase (N,) of each frame from the beginning of a beat, in beats.
        measured, fitted: columns (N, R): x, y, z (m) from the shoulder in body axes of each marker,
            then angles (rad), in the order of `markers`; where nothing was measured, NaN. What the
            body moved is taken off the measured ones, as far as it was not known.
        like_file: the file of `like`, whose comments `write` keeps.
    """

    bird: Bird
    like: Bird
    source: str
    frequency: float
    frequency_error: float
    joints: Mapping[str, JointMotion]
    undetermined: tuple[str, ...]
    reference: str
    start: float
    markers: Mapping[str, MarkerFit]
    beats: int
    frames: int
    remarks: tuple[str, ...]
    phases: FloatArray = field(repr=False)
    measured: FloatArray = field(repr=False)
    fitted: FloatArray = field(repr=False)
    like_file: Path | None = None

    def _title(self) -> str:
        return self.bird.name

    def _summary(self) -> Iterator[Fact]:
        yield Fact("wingbeat", with_error(self.frequency, self.frequency_error), "Hz")
        yield Fact("beats", str(self.beats))
        yield Fact("frames", str(self.frames))
        for name, motion in self.joints.items():
            mean, error = math.degrees(motion.offset), math.degrees(motion.offset_error)
            largest = math.degrees(float(motion.amplitudes[0]))
            yield Fact(name, f"{mean:.1f} ± {error:.1f}, amplitude {largest:.1f}", "°")
        for name in self.undetermined:
            yield Fact(name, "not told by the data")
        yield from (Fact("", shortened(remark)) for remark in self.remarks)

    def column(self, name: str) -> int:
        """Place of a marker's x, or of a joint's angle, among the columns."""
        sizes = [1 if each in self.like.joint_names else 3 for each in self.markers]
        return sum(sizes[: list(self.markers).index(name)])

    def write(self, path: str | PathLike[str]) -> Path:
        """Write the bird as a topology file; comments of the file it was made like are kept.

        Raises:
            OutputError: the file cannot be written.
        """
        about = [
            f"Gait fitted to {Path(self.source).name}: {self.beats} beats, {self.frames} frames.",
            *(f"Not told by it, and as before: {name}." for name in self.undetermined),
        ]
        return self.bird.save(path, like=self.like_file, about=about)

    def plot(self) -> Figure:
        """Draw measured beside fitted over the beat."""
        from birdmb.figures.kinematics import plot_kinematics  # noqa: PLC0415 - it draws

        return plot_kinematics(self)


def bird_with_gait(like: Bird, frequency: float, joints: Mapping[str, JointMotion]) -> Bird:
    """A bird whose joints move so; angles are rounded to a millionth of a degree."""
    values: dict[str, Any] = {"gait.frequency": round(frequency, _DECIMALS)}
    for name, motion in joints.items():
        joint = like.joint(name)
        # Whatever else its driver was given by would go before, or beside, the new motion.
        for key in _OF_THE_DRIVER:
            default = type(joint).model_fields[key].default
            if getattr(joint, key) != default:
                values[f"{name}.{key}"] = default
        first, *higher = zip(motion.amplitudes, motion.phases, strict=True)
        values |= {f"{name}.{key}": value for key, value in _harmonic(*first).items()}
        values[f"{name}.offset_deg"] = _degrees(motion.offset)
        if higher:
            values[f"{name}.harmonics"] = [
                {"order": order, **_harmonic(*each)} for order, each in enumerate(higher, 2)
            ]
    return like.with_values(values)


def _harmonic(amplitude: float, phase: float) -> dict[str, float]:
    return {"amplitude_deg": _degrees(amplitude), "phase_deg": _degrees(phase)}


def _degrees(angle: float) -> float:
    return round(math.degrees(angle), _DECIMALS)
