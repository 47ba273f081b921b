"""The decorator of compiled kernels: as numba's, but for the cache and for calls among them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from numba.core import event, sigutils
from numba.core.registry import CPUDispatcher
from numba.core.typing.templates import make_concrete_template

from birdmb import _linked
from birdmb._boxing import make_named_tuples_safe
from birdmb._kernel_files import LEVEL, KernelFiles, config

KernelT = TypeVar("KernelT", bound=Callable[..., Any])
_Dispatcher: Any = CPUDispatcher  # whose types are those of one kind of overload

make_named_tuples_safe()


def kernel(function: KernelT) -> KernelT:
    """A function compiled by numba at its first call, and kept for later processes."""
    return _Kernel(function, targetoptions={"nopython": True})


class _Kernel(_Dispatcher):
    """Numba's dispatcher of a function, which has two kinds of overloads.

    Those for Python are numba's own. Kernels that call this one get those of `birdmb._linked`.
    """

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._cache: KernelFiles = KernelFiles(self.py_func)  # where numba has its own
        self._compiler: Any = _LightCompiler(self._compiler)
        self._linked: dict[tuple[Any, ...], tuple[object, Any]] = {}

    def get_call_template(
        self, args: Any, kws: Any
    ) -> tuple[type[Any], Any, tuple[Any, ...], dict[str, Any]]:
        """Template of a call from a kernel, its signature, and the types of its arguments."""
        pysig, arguments = self._compiler.fold_argument_types(args, kws)
        arguments = tuple(arguments)
        if arguments not in self._linked:
            self._linked[arguments] = self._to_link(arguments)
        name = self.py_func.__name__
        signature = self._linked[arguments][1].signature
        template = make_concrete_template(f"CallTemplate({name})", name, [signature])
        return template, pysig, arguments, {}

    def get_overload(self, sig: Any) -> object:
        """What the code that a kernel calls by this signature is registered under."""
        arguments, _ = sigutils.normalize_signature(sig)
        return self._linked[tuple(arguments)][0]

    def _to_link(self, arguments: tuple[Any, ...]) -> tuple[object, Any]:
        result: Any = self._cache.load_linked(arguments, self.targetctx)
        if result is None:
            data = {"dispatcher": self, "args": arguments, "return_type": None}
            with event.trigger_event("numba:compile", data), self._compiling_counter:
                result = _linked.compiled(self, arguments)
            self._cache.save_linked(arguments, result)
        key = object()  # where numba has the function that Python calls
        self.targetctx.insert_user_function(key, result.fndesc, [result.library])
        return key, result


class _LightCompiler:
    """Numba's compiler of a function, with LLVM's optimisation turned down while it works."""

    def __init__(self, compiler: Any) -> None:
        self._compiler = compiler

    def __getattr__(self, name: str) -> Any:
        return getattr(self._compiler, name)

    def compile(self, *arguments: Any) -> Any:
        """Result of numba's own method; what it calls finds its environment in it."""
        level = config.OPT
        config.OPT = type(level)(min(LEVEL, level))
        try:
            result = self._compiler.compile(*arguments)
        finally:
            config.OPT = level
        for environment in result._find_referenced_environments():
            result.codegen.set_env(environment.env_name, environment)
        return result
