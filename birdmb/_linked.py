"""Kernels as their callers need them: code to be linked into theirs, and none of its own.

Numba compiles a function that a kernel calls as if Python called it, too: optimised, and turned
into machine code behind a wrapper for Python's objects, with all that it calls in turn. Where
kernels call kernels that is most of the time of compilation, and nothing ever runs it: the caller's
code holds a copy, which is optimised there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from llvmlite import binding
from numba.core import codegen, compiler

_Library: Any = codegen.JITCodeLibrary


class LinkedLibrary(_Library):
    """Code of one function and of all that it calls, which is only ever linked into others."""

    def _optimize_final_module(self) -> None:
        """Nothing: it is optimised with its callers, which know its arguments."""

    def _finalize_final_module(self) -> None:
        """Numba's own step, without machine code."""
        self._finalize_dynamic_globals()
        self._verify_declare_only_symbols()
        self._finalized = True

    def serialize_using_object_code(self) -> tuple[str, bytes]:
        """Name and LLVM bitcode: there is no object code."""
        self._ensure_finalized()
        return self.name, self._final_module.as_bitcode()


def compiled(dispatcher: Any, arguments: tuple[Any, ...]) -> Any:
    """Compile result of a dispatcher's function, as its callers need it."""
    flags: Any = compiler.Flags()
    dispatcher.targetdescr.options.parse_as_flags(flags, dispatcher.targetoptions)
    flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
    function = dispatcher.py_func
    result = compiler.compile_extra(
        dispatcher.typingctx,
        dispatcher.targetctx,
        function,
        args=arguments,
        return_type=None,
        flags=flags,
        locals=dispatcher.locals,
        library=LinkedLibrary(dispatcher.targetctx.codegen(), function.__qualname__),
    )
    result.library._ensure_finalized()
    return result


def rebuilt(
    target_context: Any,
    library: tuple[str, bytes],
    fndesc: Any,
    environment: Any,
    signature: Any,
    _objectmode: bool,
    _lifted: Any,
    _annotation: str,
    reload_init: Iterable[Callable[[], object]],
    referenced_envs: Any,
) -> Any:
    """Of what `CompileResult._reduce` made of a result, as much as callers need."""
    for initialise in reload_init:
        initialise()
    name, bitcode = library
    linked = LinkedLibrary(target_context.codegen(), name)
    linked._final_module = binding.parse_bitcode(bitcode)
    linked._finalize_final_module()
    return compiler.compile_result(
        library=linked,
        fndesc=fndesc,
        signature=signature,
        environment=environment,
        referenced_envs=referenced_envs,  # numba finds those that somebody keeps
    )
