"""A guess from a file: a cycle that was saved, or one of a branch (`birdmb cycle --guess`)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from birdmb._typing import FloatArray
from birdmb.cli.outcome import InputError
from birdmb.datafiles import kind_of
from birdmb.orbits import load_branch
from birdmb.orbits.collocation_search import FEWEST_INSTANTS
from birdmb.orbits.trigonometric import along_path
from birdmb.text import on_one_line
from birdmb.topology.joints import split_side

if TYPE_CHECKING:
    from birdmb.models.multibody import MultibodyModel
    from birdmb.models.rigid import RigidModel

_BODY = ("u", "w", "q", "theta")
_NODES = 65


@dataclass(frozen=True)
class SavedGuess:
    """States along a cycle from a file.

    Attributes:
        about: what it is, for a line of progress.
        state_names: names of the m states in the file.
        states: (K, m) at K even instants of the period, the first at t = 0.
    """

    about: str
    state_names: tuple[str, ...]
    states: FloatArray

    def states_for(self, model: RigidModel | MultibodyModel, segments: int | None) -> FloatArray:
        """States (K, n) to start a model's search from; those not in the file are the model's.

        `segments` is the number of shooting segments, if that is given.
        """
        states = self.states
        if len(states) >= FEWEST_INSTANTS:
            phases = np.arange(_NODES if segments is None else segments)
            states = along_path(states, phases / len(phases))
        elif segments not in {None, len(states)}:
            states = states[:1]
        times = model.bird.period * np.arange(len(states)) / len(states)
        found = model.guess_along(times)
        for i, name in enumerate(model.state_names):
            # A flight in which both wings move alike tells of each of them.
            angle, rate = name.removesuffix(".rate"), name.endswith(".rate")
            of_both = split_side(angle)[0] + ".rate" * rate
            known = [each for each in (name, of_both) if each in self.state_names]
            if known:
                found[:, i] = states[:, self.state_names.index(known[0])]
        return found if len(found) > 1 else found[0]


def requested_guess(path: Path | None, point: int | None) -> SavedGuess | None:
    """The guess that the options --guess and --point ask for; errors as of `load_guess`."""
    if path is not None:
        return load_guess(path, point)
    if point is not None:
        raise InputError("--point says which flight of a branch; give its file with --guess.")
    return None


def load_guess(path: Path, point: int | None) -> SavedGuess:
    """The cycle in a file of `birdmb cycle --out`, or that `point` of a branch.

    Points are counted from 1, or from the end by negative numbers.

    Raises:
        InputError: the file holds neither, or has no such point.
        BranchFileError: it holds a branch that is damaged.
    """
    if not path.is_file():
        raise InputError(f"--guess: {path}: no such file.")
    try:
        with xr.open_dataset(path, engine="h5netcdf") as stored:
            data = stored.load()
    except (OSError, ValueError, RuntimeError, LookupError, TypeError, AttributeError) as error:
        raise InputError(
            f"--guess: {path} cannot be read as NetCDF "
            f"({on_one_line(str(error)) or type(error).__name__}); give the cycle.nc of "
            f"`birdmb cycle --out`, or the file of a branch."
        ) from error
    kind = kind_of(data)
    if kind == "sweep":
        raise InputError(
            f"--guess: {path} holds a sweep, which keeps no paths of cycles; give the cycle.nc of "
            f"`birdmb cycle --out`, or the file of a branch."
        )
    if kind == "branch":
        return _of_branch(path, point)
    if point is not None:
        raise InputError(f"--point is of a branch; {path} holds none.")
    try:
        return _of_cycle(path, data)
    except (KeyError, ValueError, TypeError) as error:
        raise InputError(
            f"--guess: {path} holds no limit cycle of a bird "
            f"({on_one_line(str(error)) or type(error).__name__}); give the cycle.nc of "
            f"`birdmb cycle --out`, or the file of a branch."
        ) from error


def _of_cycle(path: Path, data: xr.Dataset) -> SavedGuess:
    names = tuple(str(name) for name in data["state"].values)
    states = np.asarray(data["trajectory"].transpose("time", "state").values, float)
    start = float(data.attrs["start_time"]) / float(data.attrs["period"])
    _require(names, states)
    if len(states) <= FEWEST_INSTANTS:
        raise ValueError(f"trajectory has {len(states)} instants")
    states = states[:-1]
    return SavedGuess(
        f"the cycle in {path}",
        names,
        along_path(states, np.arange(len(states)) / len(states) - start),
    )


def _of_branch(path: Path, point: int | None) -> SavedGuess:
    branch = load_branch(path)
    count = len(branch.points)
    values = branch.parameters
    if point is None or not (1 <= point <= count or -count <= point <= -1):
        asked = "say which with --point" if point is None else f"there is no --point {point}"
        raise InputError(
            f"--guess: {path} holds {count} flights, {branch.parameter_name} = {values[0]:g} to "
            f"{values[-1]:g}; {asked}: 1 is the first, {count} or -1 the last."
        )
    index = point - 1 if point > 0 else count + point
    chosen = branch.points[index]
    _require(branch.state_names, chosen.points)
    about = f"flight {index + 1} of {path}, {branch.parameter_name} = {chosen.parameter:g}"
    return SavedGuess(about, branch.state_names, chosen.points)


def _require(names: tuple[str, ...], states: FloatArray) -> None:
    missing = [name for name in _BODY if name not in names]
    if missing:
        raise ValueError(f"the states {', '.join(names)} lack {', '.join(missing)}")
    if not np.isfinite(states).all():
        raise ValueError("its states are not finite")
