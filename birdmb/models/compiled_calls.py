"""Calls of compiled code that calls back into Python, as Exudyn does.

No exception may pass through such code: it rewraps it, prints a banner or crashes the process. What
a callback raises is therefore carried past it, and so are signals, whose Python handlers raise
wherever the interpreter happens to be, at the entry of a callback too. Python runs them in the main
thread alone: it is there that they are kept back while only compiled code would receive what they
raise. They run in the body of the next callback, or after the call.

One such call is made at a time in a process, for a system of Exudyn's is integrated in place.
Nothing is lost by this: the code holds Python's global lock.
"""

from __future__ import annotations

import functools
import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any, Concatenate, ParamSpec, TypeVar

import numpy as np

from birdmb._typing import FloatArray

P = ParamSpec("P")
T = TypeVar("T")

COMPILED = threading.RLock()
_SIGNALS = tuple(sorted(int(number) for number in signal.valid_signals()))


class _SignalGate:
    """Stands between signals and their Python handlers; shut, it keeps the signals."""

    def __init__(self) -> None:
        self._handlers: dict[int, Callable[[int, FrameType | None], Any]] = {}
        self._kept: list[int] = []
        self._shut = False
        self.in_place = False
        # One object: the identity of a bound method would change with every access.
        self._gate = self._arrived

    def put(self) -> None:
        """Put the gate, open, before all Python handlers."""
        self.in_place, self._shut = True, False
        for number in _SIGNALS:
            handler = signal.getsignal(number)
            if callable(handler) and handler is not self._gate:
                self._handlers[number] = handler
                signal.signal(number, self._gate)

    def take_away(self) -> None:
        """Leave the handlers as they were.

        One of them may raise in the middle of it. Others then stay behind the gate, which lets
        signals through, until the next time.
        """
        self.in_place, self._shut = False, False
        while self._handlers:
            number, handler = next(iter(self._handlers.items()))
            if signal.getsignal(number) is self._gate:  # a callback may have set its own
                signal.signal(number, handler)
            del self._handlers[number]
        while self._kept:
            signal.raise_signal(self._kept.pop(0))

    def shut(self) -> None:
        """Keep signals from now on."""
        self._shut = True

    def open(self) -> None:
        """Let signals through, and first those that were kept; raises what their handlers raise."""
        self._shut = False
        while self._kept:
            self._arrived(self._kept.pop(0), None)

    def _arrived(self, number: int, frame: FrameType | None) -> None:
        if self._shut:
            self._kept.append(number)
            return
        # A second signal must not raise while what the first one raised is being caught.
        self._shut = True
        self._handlers[number](number, frame)
        self._shut = False


_gate = _SignalGate()


def calls_compiled_code(function: Callable[P, T]) -> Callable[P, T]:
    """A function that makes calls through a `Carrier`, or many of them at less cost.

    It waits until no other thread is in such a function.
    """

    @functools.wraps(function)
    def guarded(*args: P.args, **kwargs: P.kwargs) -> T:
        with COMPILED:
            if threading.current_thread() is not threading.main_thread() or _gate.in_place:
                return function(*args, **kwargs)
            try:
                _gate.put()
                return function(*args, **kwargs)
            except SystemError as error:
                raise behind(error) from None
            finally:
                _gate.take_away()

    return guarded


def behind(error: BaseException) -> BaseException:
    """What the handler of a signal raised in a kernel, if this is how it came out of it.

    Kernels made by numba call Python to make their results, and return them nevertheless.
    """
    while isinstance(error, SystemError) and error.__cause__ is not None:
        error = error.__cause__
    return error


class Carrier:
    """Carries what callbacks raise past the compiled code between them and the call of it."""

    def __init__(self) -> None:
        self._raised: BaseException | None = None

    def callback(
        self, function: Callable[P, FloatArray], shape: tuple[int, ...]
    ) -> Callable[Concatenate[object, P], FloatArray]:
        """A callback that returns NaN of a `shape` once a callback of this carrier has raised.

        The first argument, the system, is not passed on.
        """

        def guarded(_system: object, /, *args: P.args, **kwargs: P.kwargs) -> FloatArray:
            if self._raised is None:
                try:
                    try:
                        _gate.open()
                        return function(*args, **kwargs)
                    finally:
                        _gate.shut()
                except BaseException as error:
                    self._raised = error
            return np.full(shape, np.nan)

        return guarded

    @calls_compiled_code
    def call(self, compiled: Callable[..., T], *args: Any, **kwargs: Any) -> T:
        """What `compiled` returns; raises what its callbacks or the handlers of signals raised."""
        self._raised = None
        try:
            _gate.shut()
            result = compiled(*args, **kwargs)
        except Exception:
            # What a callback raised is why, if one did.
            if self._raised is None:
                raise
        finally:
            _gate.open()
        raised, self._raised = self._raised, None
        if raised is not None:
            raise raised
        return result
