"""Objects of the library's, memory that they lend, and hosts of long calls."""
from __future__ import annotations

import signal
import threading
import warnings
from ctypes import byref
from typing import Any, Callable, Optional, TypeVar

import numpy as np
from numpy.typing import NDArray

from . import _library as c
from ._errors import DONE, NO_MEMORY, Error, SlenderWarning, error_of, spoken

Array = NDArray[np.float64]
Progress = Callable[[str], object]
OnFrame = Callable[[float, Array], object]
ShieldKind = TypeVar("ShieldKind", bound="Shield")


class Handle:
    """An object of the library's. It lives as long as anybody has it, or a view of its memory; what it needs lives
    longer.

    One call at a time is at work on an object that stands alone and all that need it: calls from other threads wait,
    those from a callback of a call, which would wait for ever, are refused, and what is let go meanwhile is destroyed
    later."""

    def __init__(self, pointer: int, destroy: Callable[[int], object], needs: Optional[Handle] = None,
                 alone: bool = False) -> None:
        self._pointer, self._destroy, self._needs = pointer, destroy, needs
        self._one: _OneAtATime = needs._one if needs and not alone else _OneAtATime()
        self.lost = False
        self.lock = self._one.lock  # to be held around `use` and what is done with it

    @property
    def pointer(self) -> int:
        """Of what is at hand: to be asked for what it is, or given to a call on what it needs."""
        return self._pointer

    def use(self) -> int:
        self._one.begin()
        if self.lost or (self._needs and self._needs.lost):
            raise Error("what was called is lost: memory was not there for an earlier call", NO_MEMORY)
        return self._pointer

    def do(self, function: Callable[..., int], *args: Any, accept: tuple[int, ...] = (DONE,),
           scene: bool = False, keeps: bool = False) -> tuple[int, str]:
        """function(object, .., error): its status and sentence; raises where it is none of `accept`. keeps: what it is
        called on is not what it works on, and is not lost where memory is not there."""
        error = c.CError()
        with self.lock:
            status = function(self.use(), *args, byref(error))
            self.lost = status == NO_MEMORY and not keeps
        if status not in accept:
            raise error_of(status, error.text, scene)
        return status, spoken(error.text)

    def make(self, function: Callable[..., Optional[int]], *args: Any, scene: bool = False) -> int:
        """What function(object, .., error) makes."""
        with self.lock:
            return c.made(function, self.use(), *args, scene=scene)

    def in_callback(self, inside: bool) -> None:
        self._one.calling = inside

    def __reduce__(self) -> Any:
        raise TypeError("objects of the library's cannot be pickled or copied; State.copy copies a state")

    def __del__(self) -> None:
        if not (self.lost or (self._needs and self._needs.lost)):
            self._one.finish(self._destroy, self._pointer)


class _OneAtATime:
    def __init__(self) -> None:
        self.lock = threading.RLock()  # taken by `with` alone: no Ctrl-C comes between taking it and the block
        self.calling = False           # a callback of a call is at work
        self._later: list[tuple[Callable[[int], object], int]] = []

    def begin(self) -> None:
        if self.calling:
            raise Error("a callback cannot call what is at work on the call that called it")
        while self._later:
            destroy, pointer = self._later.pop()
            destroy(pointer)

    def finish(self, destroy: Callable[[int], object], pointer: int) -> None:
        """Now, or where a call is at work before the next one."""
        self._later.append((destroy, pointer))
        if self.lock.acquire(blocking=False):
            if not self.calling:
                self.begin()
            self.lock.release()


class _Lent:
    def __init__(self, address: int, shape: tuple[int, ...], kind: str, owner: object, writable: bool) -> None:
        self.owner = owner
        self.__array_interface__ = {"version": 3, "data": (address, not writable), "shape": shape, "typestr": kind}


def lent(address: Optional[int], shape: tuple[int, ...], owner: object, writable: bool = True,
         kind: str = "<f8") -> NDArray[Any]:
    """Memory of the library's as an array, which keeps its owner alive."""
    if not address or 0 in shape:
        return np.empty(shape, np.dtype(kind))
    return np.asarray(_Lent(address, shape, kind, owner, writable))


def address(array: Optional[NDArray[Any]]) -> Optional[int]:
    """Of an array, row by row, that stays alive during the call."""
    assert array is None or array.flags.c_contiguous
    return None if array is None else array.ctypes.data


class Shield:
    """`with` around a call that solves: OpenBLAS works in one thread, and what a handler of a signal raises (Ctrl-C), which
    would leave things half done, is raised after it. In a callback it is raised there."""

    SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGALRM", "SIGHUP", "SIGUSR1", "SIGUSR2",
                                                       "SIGVTALRM", "SIGPROF") if hasattr(signal, name))

    def __init__(self) -> None:
        self.error: Optional[BaseException] = None
        self.inside = False  # a callback is at work

    def _on_signal(self, number: int, frame: Any) -> None:
        if self.inside:
            self._handlers[number](number, frame)
            return
        try:
            self._handlers[number](number, frame)
        except BaseException as error:
            self.error = error

    def __enter__(self: ShieldKind) -> ShieldKind:
        main = threading.current_thread() is threading.main_thread()
        known = {number: signal.getsignal(number) for number in self.SIGNALS} if main else {}
        self._handlers: dict[int, Any] = {number: handler for number, handler in known.items() if callable(handler)}
        for number in self._handlers:
            signal.signal(number, self._on_signal)
        c.one_thread.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        c.one_thread.__exit__()
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        if self.error is not None:
            raise self.error from self.error.__cause__  # what the library says of the stop is no news


class Host(Shield):
    """The same of a long call on an object. Ctrl-C, and what a callback raises, makes it stop, and is raised when it
    has returned: nothing of Python's can leave a callback of C's."""

    def __init__(self, called: Handle, progress: Optional[Progress] = None,
                 on_frame: Optional[OnFrame] = None) -> None:
        super().__init__()
        self._called = called
        self.struct = c.CHost(stop=c.STOP(lambda _: self.error is not None), warn=c.SENTENCE(self._guard(_warn)))
        if progress:
            tell = progress
            self.struct.step = c.STEP(self._guard(lambda n, total, detail: tell(_step(n, total, spoken(detail)))))
            self.struct.say = c.SENTENCE(self._guard(lambda sentence: tell(spoken(sentence))))
        if on_frame:
            show = on_frame
            self.struct.frame = c.FRAME(self._guard(lambda time, points, place: show(
                time, np.ctypeslib.as_array(place, (points, 3)).copy())))

    def _guard(self, function: Callable[..., object]) -> Callable[..., None]:
        def guarded(_: object, *args: Any) -> None:
            if self.error is not None:
                return
            self._called.in_callback(True)
            try:
                self.inside = True
                function(*args)
                self.inside = False
            except BaseException as error:
                self.inside = False
                self.error = error
            self._called.in_callback(False)
        return guarded

    def __exit__(self, *_: object) -> None:
        self.struct = c.CHost()  # of which the callbacks know this object
        super().__exit__()


def _step(n: int, total: int, detail: str) -> str:
    return f"{n} of {total}: {detail}" if total > 0 else f"{n}: {detail}"


def _warn(sentence: bytes) -> None:
    warnings.warn(spoken(sentence), SlenderWarning, stacklevel=5)


