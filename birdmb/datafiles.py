"""The family of NetCDF files: limit cycles, branches and sweeps, told apart by an attribute."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, get_args

from birdmb.errors import DataFileError
from birdmb.seal import unsealed
from birdmb.text import on_one_line

if TYPE_CHECKING:
    import xarray as xr

Kind = Literal["limit cycle", "branch", "sweep"]

_KIND = "birdmb_file"
_HDF5 = b"\x89HDF\r\n\x1a\n"


def family_attributes(
    kind: Kind, title: str, history: str, packages: Mapping[str, str]
) -> dict[str, Any]:
    """Attributes that name the kind of a file and, by the CF conventions, what it holds.

    `packages` are the versions, by name, of what computed it.
    """
    return {
        _KIND: kind,
        "Conventions": "CF-1.11",
        "title": title,
        "source": ", ".join(f"{name} {version}" for name, version in packages.items()),
        "history": history,
    }


def kind_of(data: xr.Dataset) -> Kind | None:
    """The kind of a dataset of the family; `None` of any other."""
    found = data.attrs.get(_KIND)
    return next((kind for kind in get_args(Kind) if kind == found), None)


def is_netcdf(path: Path) -> bool:
    """Whether a file begins as those of NetCDF-4 do; false where it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(len(_HDF5)) == _HDF5
    except (OSError, ValueError):
        return False


def read_dataset(path: Path) -> xr.Dataset:
    """All of a NetCDF file, whose checksum, if there is one at its end, is compared.

    Raises:
        DataFileError: it cannot be read, is no NetCDF, or is damaged.
    """
    import xarray as xr  # noqa: PLC0415 - slow to import

    try:
        file = path.read_bytes()
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise DataFileError(f"{path} cannot be read ({reason.lower()}).") from error
    if not file.startswith(_HDF5):
        raise DataFileError(f"{path} is no NetCDF-4 file, as birdmb writes.")
    try:
        content = unsealed(file)
        with xr.open_dataset(
            io.BytesIO(file if content is None else content), engine="h5netcdf"
        ) as stored:
            return stored.load()
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RuntimeError) as error:
        reason = on_one_line(str(error)) or type(error).__name__
        raise DataFileError(
            f"{path} is damaged ({reason}); restore it from a copy, or compute it anew."
        ) from error
