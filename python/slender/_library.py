"""libslender: where it is, its functions and structures as include/slender.h declares them, and OpenBLAS beneath it."""
from __future__ import annotations

import ctypes
import os
import re
import threading
import warnings
from ctypes import CFUNCTYPE, POINTER, Structure, byref, c_char, c_char_p, c_double, c_int, c_void_p
from operator import index
from pathlib import Path
from typing import Any

from ._errors import DONE, SlenderWarning, error_of

VERSION = "0.1.0"  # of the library that this package is for


# ---- As the header has it ----

class CError(Structure):
    _fields_ = [("status", c_int), ("text", c_char * 1024)]


STEP = CFUNCTYPE(None, c_void_p, c_int, c_int, c_char_p)
SENTENCE = CFUNCTYPE(None, c_void_p, c_char_p)
STOP = CFUNCTYPE(c_int, c_void_p)
FRAME = CFUNCTYPE(None, c_void_p, c_double, c_int, POINTER(c_double))


class CHost(Structure):
    _fields_ = [("self", c_void_p), ("step", STEP), ("say", SENTENCE), ("warn", SENTENCE), ("stop", STOP),
                ("frame", FRAME)]


class CRun(Structure):
    _fields_ = [("output", c_char_p), ("threads", c_int), ("resume", c_int), ("force", c_int),
                ("no_journal", c_int), ("host", CHost)]


class CModelInfo(Structure):
    _fields_ = [(name, c_int) for name in ("cases", "terms", "blocks", "points", "dofs", "params", "faces",
                                           "memory")] + [
                ("rest", c_void_p), ("face", c_void_p), ("warnings", c_char_p)]


class CBlock(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("offset", c_int), ("count", c_int), ("width", c_int),
                ("per_case", c_int)]


class CStateInfo(Structure):
    _fields_ = [("dofs", c_int), ("memory_count", c_int), ("x", c_void_p), ("v", c_void_p),
                ("memory", c_void_p), ("time", c_void_p), ("status", c_char_p), ("energy", c_double),
                ("newton_iterations", c_int)]


class CMotionDef(Structure):
    _fields_ = [("steps", c_int), ("step", c_double), ("flux", c_void_p), ("memory", c_double),
                ("host", CHost)]


class CArray(Structure):
    _fields_ = [("type", c_int), ("rank", c_int), ("dims", c_int * 3), ("unit", c_char_p), ("data", c_void_p),
                ("name", c_char_p)]


_P, _E, _I, _D, _S = c_void_p, POINTER(CError), c_int, c_double, c_char_p
FUNCTIONS: dict[str, tuple[Any, list[Any]]] = {  # what is returned, what is given
    "version": (_S, []),
    "versions": (_P, []),
    "schema": (_P, []),
    "free": (None, [_P]),
    "scene_read": (_P, [_S, POINTER(_S), _I, _E]),
    "scene_parse": (_P, [_S, POINTER(_S), _I, _E]),
    "scene_text": (_P, [_P]),
    "scene_destroy": (None, [_P]),
    "run": (_I, [_P, POINTER(CRun), _E]),
    "model_create": (_P, [_P, _I, _E]),
    "model_destroy": (None, [_P]),
    "model_info": (CModelInfo, [_P]),
    "model_case": (_S, [_P, _I]),
    "model_term": (_S, [_P, _I]),
    "model_block": (CBlock, [_P, _I]),
    "model_params": (_P, [_P, _I]),
    "state_create": (_P, [_P, _I, _E]),
    "state_copy": (_P, [_P]),
    "state_destroy": (None, [_P]),
    "state_info": (CStateInfo, [_P]),
    "equilibrium": (_I, [_P, _I, _P, POINTER(CHost), _E]),
    "energy": (_D, [_P, _I, _P, _P, _P, _E]),
    "vjp": (_I, [_P, _I, _P, _P, _P, _E]),
    "jvp": (_I, [_P, _I, _P, _P, _P, _E]),
    "simulate": (_P, [_P, _I, _P, POINTER(CMotionDef), POINTER(_I), _E]),
    "motion_destroy": (None, [_P]),
    "motion_steps": (_I, [_P]),
    "motion_state": (_P, [_P, _I, _E]),
    "motion_met": (_I, [_P, _I, POINTER(CArray), _E]),
    "motion_vjp": (_I, [_P, _I, _P, _P, _P, _P, _P, _P, _P, _E]),
    "motion_jvp": (_I, [_P, _P, _P, _P, _P, _P, _E]),
    "result_open": (_P, [_S, _E]),
    "result_close": (None, [_P]),
    "result_name": (_S, [_P, _I]),
    "result_frames": (_I, [_P]),
    "result_read": (_I, [_P, _S, _I, POINTER(CArray), _E]),
    "array_free": (None, [POINTER(CArray)]),
}


# ---- Where it is ----

def _find() -> str:
    """SLENDER_LIBRARY, beside the package (a wheel), in the build folder of a clone, or the system's."""
    said = os.environ.get("SLENDER_LIBRARY")
    if said:
        return said
    here = Path(__file__).resolve().parent
    for path in (here / "libslender.so", here.parents[1] / "build" / "libslender.so"):
        if path.exists():
            return str(path)
    return f"libslender.so.{VERSION.split('.')[0]}"


def _open(path: str) -> ctypes.CDLL:
    try:
        library = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"libslender cannot be loaded ({error}): build it with `./do build` in a clone, or name it "
                          "by SLENDER_LIBRARY") from None
    if not hasattr(library, "slender_version"):
        raise ImportError(f"{path} is no libslender")
    library.slender_version.restype = c_char_p
    found = library.slender_version().decode()
    if found != VERSION:
        raise ImportError(f"{path} is libslender {found}; this package is for {VERSION}: take both from one build")
    for name, (returns, takes) in FUNCTIONS.items():
        function = getattr(library, "slender_" + name)
        function.restype, function.argtypes = returns, takes
    return library


# ---- OpenBLAS ----

def blas_is_loaded() -> bool:
    try:
        return "openblas" in Path("/proc/self/maps").read_text()
    except OSError:
        return True  # nobody knows: leave the environment alone


def _load() -> ctypes.CDLL:
    """OpenBLAS takes its kernels when it is loaded, from the environment. Where ours is the one that loads it and the
    library says that others suit this processor, it is put back, the environment told, and loaded again; where it was
    there before (numpy's), that is for the user to do."""
    path = _find()
    ours = not blas_is_loaded()
    library = _open(path)
    advice = re.search(r"OPENBLAS_CORETYPE=(\w+)", _text_of(library, library.slender_versions()))
    if not advice:
        return library
    if ours:
        ctypes.CDLL(None).dlclose(c_void_p(library._handle))
        if not blas_is_loaded():
            os.environ["OPENBLAS_CORETYPE"] = advice[1]
        return _open(path)
    warnings.warn(f"OpenBLAS was loaded before slender with kernels that are slow on this processor: import slender "
                  f"before numpy, or set OPENBLAS_CORETYPE={advice[1]} in the environment", SlenderWarning,
                  stacklevel=4)
    return library


def _text_of(library: ctypes.CDLL, pointer: int | None) -> str:
    if not pointer:
        raise MemoryError("slender: memory is not there for a text")
    text = ctypes.string_at(pointer).decode()
    library.slender_free(pointer)
    return text


class _OneThread:
    """OpenBLAS works in one thread while any call is at work, so that numbers are the same bits every time, and with as
    many as before after the last one."""

    def __init__(self, blas: ctypes.CDLL) -> None:
        self._get, self._set = blas.openblas_get_num_threads, blas.openblas_set_num_threads
        self._lock, self._inside, self._before = threading.Lock(), 0, 1

    def __enter__(self) -> None:
        with self._lock:
            if self._inside == 0:
                self._before = self._get()
                if self._before != 1:
                    self._set(1)
            self._inside += 1

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._inside -= 1
            if self._inside == 0 and self._before != 1:
                self._set(self._before)


lib = _load()
one_thread = _OneThread(lib)  # a symbol of the library's is looked for in what it needs, too


# ---- Calls ----

def whole(value: Any, what: str) -> int:
    """A whole number that an int of C's holds: ctypes would cut it."""
    number = index(value)
    if not -2**31 <= number < 2**31:
        raise ValueError(f"{what} is {number}, which is out of all bounds")
    return number


def words(value: str) -> bytes:
    """A text for C, which ends at a NUL."""
    if "\0" in value:
        raise ValueError(f"there is a NUL in {value!r}")
    return value.encode(errors="surrogateescape")


def text(pointer: int | None) -> str:
    """A text that the library hands over."""
    return _text_of(lib, pointer)


def made(function: Any, *args: Any, scene: bool = False) -> int:
    """What a function makes; raises where it is refused."""
    error = CError()
    pointer: int | None = function(*args, byref(error))
    if not pointer:
        raise error_of(error.status, error.text, scene)
    return pointer


def done(function: Any, *args: Any, scene: bool = False) -> None:
    error = CError()
    if function(*args, byref(error)) != DONE:
        raise error_of(error.status, error.text, scene)
