"""The files that compiled kernels are kept in, which no damage to them can hurt.

Numba's own cache (`njit(cache=True)`) loads whatever its files hold, and truncated machine code
ends the process; it does not see that a kernel called from another module has changed; and without
a folder to write to it refuses to import. Here each compiled kernel is a file of its own, named
after a digest of all that its code depends on, and read only if its checksum is right.
Whatever cannot be read is compiled again; what cannot be kept is announced once.
"""

from __future__ import annotations

import hashlib
import inspect
import pickle
import platform
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import cache, cached_property
from importlib.metadata import version
from pathlib import Path
from types import CodeType
from typing import Any

from numba.core import config as numba_config
from numba.core import types
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps
from numba.misc.appdirs import AppDirs

from birdmb._linked import rebuilt
from birdmb.files import replace_file

LEVEL = 1
"""LLVM's level of optimisation; numba's own makes nothing faster."""

_SUFFIX = ".kernel"
_PACKAGE = Path(__file__).parent
config: Any = numba_config  # sets its attributes when it is imported
_DIGEST = hashlib.sha256
_FORMAT = "6"  # changes with `birdmb._boxing` and `birdmb._linked`, which compiled code holds
_VERSIONS = (
    platform.python_version(),
    *(version(p) for p in ("numba", "llvmlite", "numpy")),
    _FORMAT,
)


class KernelCacheWarning(UserWarning):
    """Compiled kernels cannot be kept, so that the next process compiles them again."""


def cache_folders() -> list[Path]:
    """Folders that compiled kernels are read from, and written to, the first that can be written.

    The one that the environment variable `NUMBA_CACHE_DIR` names if it is set, else the package's
    own and the user's.
    """
    # Each installation has a folder of its own, or two would remove each other's kernels as stale.
    name = f"birdmb-{_DIGEST(str(_PACKAGE).encode()).hexdigest()[:8]}"
    if config.CACHE_DIR:
        return [Path(config.CACHE_DIR) / name]
    users = Path(AppDirs(name, appauthor=False).user_cache_dir)
    # Without a home it is relative: a folder "~" wherever the process happens to be.
    return [_PACKAGE / "__pycache__", *([users] if users.is_absolute() else [])]


def any_cached() -> bool:
    """Whether kernels were compiled before, by this version or another one."""
    return any(any(folder.glob(f"*{_SUFFIX}")) for folder in cache_folders())


class KernelFiles(NullCache):
    """The compiled overloads of one kernel: machine code for Python, and code for its callers."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function = function

    @property
    def cache_path(self) -> str:
        """Folder that a compiled kernel is looked for first, as numba's statistics show it."""
        return str(cache_folders()[0])

    def load_overload(self, sig: object, target_context: Any) -> CompileResult | None:
        """Compile result for calls from Python, `None` unless a sound file holds it."""
        return self._load(
            self._key(sig, target_context.codegen()), target_context, CompileResult._rebuild
        )

    def save_overload(self, sig: object, data: Any) -> None:
        """Keep a compile result for calls from Python in a folder, or warn once."""
        self._save(self._key(sig, data.codegen), data)

    def load_linked(self, sig: object, target_context: Any) -> CompileResult | None:
        """Compile result for calls from kernels, `None` unless a sound file holds it."""
        key = self._key(sig, target_context.codegen(), "linked")
        return self._load(key, target_context, rebuilt)

    def save_linked(self, sig: object, data: Any) -> None:
        """Keep a compile result for calls from kernels in a folder, or warn once."""
        self._save(self._key(sig, data.codegen, "linked"), data)

    def _load(
        self, key: str, target_context: Any, rebuild: Callable[..., CompileResult]
    ) -> CompileResult | None:
        target_context.refresh()
        for folder in cache_folders():
            # Numba gives no list of what damaged or foreign content may raise.
            with suppress(Exception):
                name = self._file_name(key)
                content = (folder / name).read_bytes()
                size = _DIGEST().digest_size
                if _DIGEST(content[size:]).digest() != content[:size]:
                    continue
                identity, payload = pickle.loads(content[size:])
                if identity == (name, key):
                    return rebuild(target_context, *payload)
        return None

    def _save(self, key: str, data: Any) -> None:
        """Write to the first folder that can be written."""
        if data.library.has_dynamic_globals:  # addresses of this process
            return
        name = self._file_name(key)
        payload = dumps(((name, key), data._reduce()))
        content = _DIGEST(payload).digest() + payload
        reasons = []
        for folder in cache_folders():
            try:
                folder.mkdir(parents=True, exist_ok=True)
                replace_file(folder / name, content)
            except OSError as error:
                reasons.append(f"{folder} ({(error.strerror or str(error)).lower()})")
            else:
                self._remove_stale(folder)
                return
        _warn_once(" nor ".join(reasons))

    def _key(self, sig: object, codegen: Any, use: str = "executable") -> str:
        """All that the code of a signature depends on, besides the source."""
        options = (config.USING_SVML, min(LEVEL, config.OPT), config.BOUNDSCHECK)
        return repr((use, _described(sig), codegen.magic_tuple(), options))

    def _file_name(self, key: str) -> str:
        overload = _DIGEST(key.encode()).hexdigest()[:16]
        return f"{self._stem}{self._fingerprint}.{overload}{_SUFFIX}"

    @property
    def _stem(self) -> str:
        tag = sys.implementation.cache_tag
        return f"{self._function.__module__}.{self._function.__qualname__}.{tag}."

    @cached_property
    def _fingerprint(self) -> str:
        return _fingerprint(self._function)

    def _remove_stale(self, folder: Path) -> None:
        """Remove what was compiled from an older source or by other versions."""
        for old in folder.glob(f"{self._stem}*{_SUFFIX}"):
            if not old.name.startswith(f"{self._stem}{self._fingerprint}."):
                with suppress(OSError):
                    old.unlink()


@cache
def _warn_once(folders: str) -> None:
    warnings.warn(
        f"The compiled kernels cannot be kept in {folders}: every process compiles them again, "
        "which takes a minute or two; let NUMBA_CACHE_DIR name a folder that can be written.",
        KernelCacheWarning,
        stacklevel=2,
    )


def _described(kind: Any) -> str:
    """A signature with the names of the fields of named tuples, which numba leaves out."""
    if not isinstance(kind, tuple | types.BaseTuple):
        return str(kind)
    elements: Any = kind
    inner = ", ".join(map(_described, elements))
    named = getattr(kind, "instance_class", None)
    return f"{named.__qualname__}{named._fields}({inner})" if named else f"({inner})"


def _fingerprint(function: Callable[..., Any]) -> str:
    """A digest of the byte code of a kernel and of the kernels and constants that it uses."""
    parts = [repr(_VERSIONS)]
    seen: set[Callable[..., Any]] = set()

    def collect(function: Callable[..., Any]) -> None:
        if function in seen:
            return
        seen.add(function)
        parts.append(repr(function.__defaults__))
        for code in _codes(function.__code__):
            plain = [repr(c) for c in code.co_consts if not inspect.iscode(c)]
            parts.append(repr((code.co_code, code.co_varnames, plain)))
            for name in code.co_names:
                value = function.__globals__.get(name)
                if isinstance(value, Dispatcher):
                    collect(value.py_func)
                else:
                    parts.append(f"{name} = {_constant(value)}")

    collect(function)
    return _DIGEST("\n".join(parts).encode()).hexdigest()[:16]


def _codes(code: CodeType) -> Iterator[CodeType]:
    """The code of a function, and of the functions within."""
    yield code
    for constant in code.co_consts:
        if inspect.iscode(constant):
            yield from _codes(constant)


def _constant(value: object) -> str:
    """A global as machine code contains it."""
    if inspect.ismodule(value):
        return value.__name__
    if inspect.isclass(value) or inspect.isfunction(value):
        return f"{value.__module__}.{value.__qualname__} {getattr(value, '_fields', '')}"
    return repr(getattr(value, "tolist", lambda: value)())
