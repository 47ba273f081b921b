"""Limit cycles of birds from files, with the model that computed them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from birdmb.arguments import checked
from birdmb.datafiles import kind_of, read_dataset
from birdmb.errors import BirdmbError, DataFileError
from birdmb.models.flight_cycle import FlightCycle
from birdmb.models.multibody import MultibodyModel
from birdmb.models.rigid import RigidModel
from birdmb.orbits.cycle import CYCLE_FORMAT
from birdmb.orbits.cycle_dataset import restored
from birdmb.text import on_one_line
from birdmb.topology import Bird

_MODELS: Mapping[str, type[RigidModel | MultibodyModel]] = {
    "rigid": RigidModel,
    "multibody": MultibodyModel,
}


@checked
def load_cycle(path: str | PathLike[str]) -> FlightCycle:
    """The limit cycle in a NetCDF file, with its bird and its model.

    It equals the cycle that was saved to the last bit in all that the search computed; nothing is
    searched again. What a cycle computes on demand (beat, power, checks) is computed on demand.
    Reads what `cycle.save(path)`, `cycle.to_xarray().to_netcdf(path)`, `birdmb cycle --out` and
    `birdmb flights --out` write.

    Raises:
        DataFileError: there is no such file, it holds no limit cycle of a bird, is damaged, of
            another format, or of a bird that this version cannot describe.
    """
    path = Path(path)
    data = read_dataset(path)
    require_cycle(path, data)
    if "topology" not in data:
        raise DataFileError(
            f"{path} holds a limit cycle of a model that is no bird, whose right-hand side no file "
            f"can hold; xarray.open_dataset reads its numbers, and find_limit_cycle starts from "
            f"its trajectory."
        )
    try:
        settings = json.loads(data.attrs["model_settings"])
        if settings.pop("gust"):
            raise DataFileError(
                f"{path} holds a limit cycle in a gust, a function that no file can hold; "
                f"xarray.open_dataset reads its numbers."
            )
        bird = _bird(path, data)
        model = _MODELS[data.attrs["model"]](bird, **_options(settings))
        fields = restored(data)
        if fields["state_names"] != tuple(model.state_names):
            raise ValueError("its states are not those of its model")
        return FlightCycle(model=model, **fields)
    except DataFileError:
        raise
    except (BirdmbError, LookupError, TypeError, ValueError, AttributeError) as error:
        reason = on_one_line(str(error)) or type(error).__name__
        raise DataFileError(
            f"{path} is damaged ({reason}); restore it from a copy, or compute it anew."
        ) from error


def require_cycle(path: Path, data: xr.Dataset) -> None:
    """Refuse a dataset that is no limit cycle of this format; raises `DataFileError`."""
    kind = kind_of(data)
    if kind == "branch":
        raise DataFileError(f"{path} holds a branch; read it with birdmb.load_branch.")
    if kind == "sweep":
        raise DataFileError(f"{path} holds a sweep, which keeps no whole cycles; draw it instead.")
    if kind is None:
        raise DataFileError(
            f"{path} holds no limit cycle of birdmb; give the file of cycle.save or the cycle.nc "
            f"of `birdmb cycle --out`."
        )
    form = data.attrs.get("format")
    if form != CYCLE_FORMAT:
        raise DataFileError(
            f"{path} is of format {form}; birdmb {version('birdmb')} reads cycles of format "
            f"{CYCLE_FORMAT}: read it with the version that wrote it "
            f"({data.attrs.get('source', 'unknown')}), or compute it anew."
        )


def _bird(path: Path, data: xr.Dataset) -> Bird:
    text = str(data["topology"].values)
    try:
        bird = Bird.model_validate(json.loads(text))
    except ValueError as error:  # pydantic's, too
        raise DataFileError(
            f"{path} holds a bird that birdmb {version('birdmb')} cannot describe; read it with "
            f"the version that wrote it ({data.attrs.get('source', 'unknown')})."
        ) from error
    if bird.fingerprint() != data.attrs["fingerprint"]:
        raise DataFileError(
            f"{path} holds a bird that is not as it was written, or whose preset "
            f'wing.discretisation = "{bird.wing.discretisation}" meant other numbers then; read it '
            f"with the version that wrote it ({data.attrs.get('source', 'unknown')})."
        )
    return bird


def _options(settings: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of a model from its settings."""
    state = settings.get("body_state")
    return {**settings, **({} if state is None else {"body_state": np.array(state, float)})}
