"""Named tuples that kernels return to Python, made so that a signal cannot end the process.

Python's handler of a signal that arrives while compiled code runs is called when the next Python
code begins: that of a named tuple's class, with which numba makes the kernel's result. What the
handler raises there, numba (0.68) does not look for: it goes on with a tuple that has a hole.
"""

from __future__ import annotations

from typing import Any

from numba.core import boxing as _its_own  # before it is replaced
from numba.core import cgutils, pythonapi, types

_code: Any = cgutils
_OWN = _its_own.box_namedtuple


def _boxed(kind: Any, value: Any, context: Any) -> Any:
    """Code that makes a named tuple of a native one; no object where a part of it raised."""
    builder, api = context.builder, context.pyapi
    result = _code.alloca_once_value(builder, api.get_null_object())
    parts = api.tuple_new(kind.count)
    sound = _code.alloca_once_value(builder, _code.true_bit)
    for i, part in enumerate(kind):
        # None after one that raised: more of Python's code would lose what was raised.
        with builder.if_then(builder.load(sound)):
            made = context.box(part, builder.extract_value(value, i))
            builder.store(_code.is_not_null(builder, made), sound)
            api.tuple_setitem(parts, i, made)
    nothing_raised = _code.is_null(builder, api.err_occurred())
    with builder.if_then(builder.and_(builder.load(sound), nothing_raised)):
        # Where it was not known yet, Python code finds it, too.
        factory = api.unserialize(api.serialize_object(kind.instance_class))
        with builder.if_then(_code.is_not_null(builder, factory)):
            builder.store(api.call(factory, parts), result)
            api.decref(factory)
    api.decref(parts)
    return builder.load(result)


def make_named_tuples_safe() -> None:
    """Have numba make named tuples so, in this process."""
    for kind in (types.NamedTuple, types.NamedUniTuple):
        if pythonapi._boxers.functions[kind] is _OWN:
            pythonapi._boxers.functions[kind] = _boxed
