"""Writing files so that each is whole or as it was before, whatever happens meanwhile.

Everything that the project writes goes through `write_whole`: reports, figures, topologies,
datasets and branches; compiled kernels, whose loss costs time alone, through `replace_file`. A
study's store is SQLite, which has its own transactions.
"""

from __future__ import annotations

import errno
import os
import re
import stat
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from birdmb.errors import OutputError

if TYPE_CHECKING:
    import xarray as xr

_NO_SPACE = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}
_DRAFT = re.compile(r"\.(?P<name>.+)\.(?P<process>\d+)\.draft")


def write_whole(path: str | os.PathLike[str], content: bytes) -> Path:
    """Write a file that is put in its place only once all of it is on the disk.

    What was there before stays until then, and if anything fails. Symbolic links stay links; into
    a device or pipe it is written directly.

    Returns:
        The path.

    Raises:
        OutputError: the file cannot be written, with the reason.
    """
    path = Path(path)
    try:
        target = path.resolve()
        if target.exists() and not target.is_file():
            _write_into(target, content)
        else:
            replace_file(target, content)
    except (OSError, ValueError) as error:  # ValueError: a name with a null character
        raise OutputError(f"{path} cannot be written ({_reason(error)}).") from error
    return path


def replace_file(target: Path, content: bytes) -> None:
    """Put a file in its place once all of it is on the disk; raise `OSError` where that fails.

    Drafts that killed processes left of it are removed.
    """
    _remove_stale_drafts(target)
    draft = _draft(target)
    try:
        with draft.open("wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        draft.replace(target)
        _sync_directory(target.parent)
    finally:
        draft.unlink(missing_ok=True)


def make_directory(directory: Path) -> None:
    """Make a directory and see that files can be written there, before hours of computing.

    Raises:
        OutputError: it cannot be made, or not be written into.
    """
    try:
        directory.mkdir(parents=True, exist_ok=True)
        probe = _draft(directory / "probe")
        probe.touch()
        probe.unlink()
    except (OSError, ValueError) as error:
        raise OutputError(f"{directory} cannot be written ({_reason(error)}).") from error


def remove_drafts(directory: Path) -> None:
    """Remove what this process has begun to write in a directory, as it is ending at once."""
    for draft in directory.glob(f".*.{os.getpid()}.draft"):
        draft.unlink(missing_ok=True)


def netcdf_bytes(dataset: xr.Dataset) -> bytes:
    """A dataset as the content of a NetCDF file.

    Not written to the disk by the HDF5 library itself, which crashes when the disk is full.
    """
    return bytes(dataset.to_netcdf(engine="h5netcdf"))


def _write_into(target: Path, content: bytes) -> None:
    if stat.S_ISDIR(target.stat().st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    with target.open("wb", buffering=0) as file:
        file.write(content)


def _sync_directory(directory: Path) -> None:
    """Make a rename survive a power failure, where the system can."""
    with suppress(OSError):
        descriptor = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _draft(path: Path) -> Path:
    return path.with_name(f".{path.name}.{os.getpid()}.draft")


def _remove_stale_drafts(target: Path) -> None:
    """Remove drafts of the same file that processes left which were killed."""
    for entry in target.parent.glob("*.draft"):
        found = _DRAFT.fullmatch(entry.name)
        if found and found["name"] == target.name and not _is_alive(int(found["process"])):
            entry.unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    if os.name != "posix":
        return True  # there, the same call would end the process
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


def _reason(error: OSError | ValueError) -> str:
    if not isinstance(error, OSError):
        return str(error)
    reason = (error.strerror or str(error)).lower()
    return f"{reason}; free some space and try again" if error.errno in _NO_SPACE else reason
