"""Results of jobs: datasets, frames and histories as numpy arrays."""
from __future__ import annotations

import os
from ctypes import byref
from typing import Any, Iterator, Mapping, Sequence, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _library as c
from ._handle import Array, Handle, lent

DOUBLE, INT, TEXT = 0, 1, 2


class Read:
    """A dataset's memory: freed with the last view of it."""

    def __init__(self) -> None:
        self.array = c.CArray()

    def __del__(self, free: Any = c.lib.slender_array_free, byref: Any = byref) -> None:
        free(byref(self.array))  # when Python ends, globals are gone


class Result(Mapping[str, Any]):
    """A result file: r["slender/design/young"], or r["design/young"] for short, is a numpy array, or a str where it is a text.
    It is read when it is asked for, from the file as it was when it was opened."""

    def __init__(self, path: Union[str, "os.PathLike[str]"]) -> None:
        self.path = os.fspath(path)
        self._handle = Handle(c.made(c.lib.slender_result_open, os.fsencode(self.path)), c.lib.slender_result_close)
        self._frames: int = c.lib.slender_result_frames(self._handle.pointer)
        self.names: list[str] = []  # all datasets, by their whole paths
        while name := c.lib.slender_result_name(self._handle.pointer, len(self.names)):
            self.names.append(name.decode())
        self._known = set(self.names)

    def _read(self, name: str, frame: int = -1) -> Read:
        read = Read()
        self._handle.do(c.lib.slender_result_read, name.encode(), frame, byref(read.array))
        return read

    def _find(self, name: str) -> str:
        for path in ("slender/" + name, name):
            if path in self._known:
                return path
        raise KeyError(f"{self.path} has no {name!r}; .names lists what it has")

    def __getitem__(self, name: str) -> Any:
        return _value(self._read(self._find(name)))

    def __iter__(self) -> Iterator[str]:
        """Short names."""
        return (name[len("slender/"):] if name.startswith("slender/") else name for name in self.names)

    def __len__(self) -> int:
        return len(self.names)

    def unit(self, name: str) -> str:
        read = self._read(self._find(name))  # which frees the text
        return (read.array.unit or b"").decode()

    @property
    def status(self) -> str:
        """How the job ended: "converged", "max_iterations", .. (docs/result.md)."""
        return str(_value(self._read("slender/status")))

    @property
    def history(self) -> Mapping[str, Array]:
        """Of every evaluation, iteration or step: r.history["objective"]."""
        start = "slender/history/"
        return {name[len(start):]: self[name] for name in self.names if name.startswith(start)}

    @property
    def frames(self) -> Frames:
        return Frames(self)

    def __repr__(self) -> str:
        return f"<slender.Result {self.path!r}: {self.status}, {self._frames} frames>"


class Frame:
    """frame.x [points, 3] in m; frame["magnetization"]: numbers per cell or point; frame.time."""

    def __init__(self, result: Result, number: int) -> None:
        self._result, self.number = result, number

    @property
    def x(self) -> Array:
        return array_of(self._result._read("Points", self.number))

    @property
    def time(self) -> float:
        return float(self._result["VTKHDF/Steps/Values"][self.number])

    def keys(self) -> list[str]:
        starts = ("VTKHDF/CellData/", "VTKHDF/PointData/")
        return [name.rsplit("/", 1)[1] for name in self._result.names if name.startswith(starts)]

    def __getitem__(self, name: str) -> NDArray[Any]:
        for kind in ("CellData", "PointData"):
            if f"VTKHDF/{kind}/{name}" in self._result._known:
                return array_of(self._result._read(f"{kind}/{name}", self.number))
        raise KeyError(f"frames have no {name!r}; they have {', '.join(self.keys()) or 'places alone'}")


class Frames(Sequence[Frame]):
    def __init__(self, result: Result) -> None:
        self._result = result

    def __len__(self) -> int:
        return self._result._frames

    @overload
    def __getitem__(self, n: int) -> Frame: ...

    @overload
    def __getitem__(self, n: slice) -> list[Frame]: ...

    def __getitem__(self, n: Union[int, slice]) -> Union[Frame, list[Frame]]:
        numbers = range(len(self))[n]
        return [Frame(self._result, k) for k in numbers] if isinstance(numbers, range) else Frame(self._result, numbers)


def array_of(read: Read) -> NDArray[Any]:
    a = read.array
    return lent(a.data, tuple(a.dims[: a.rank]), read, kind="<i4" if a.type == INT else "<f8")


def _value(read: Read) -> Any:
    a = read.array
    if a.type == TEXT:
        length = int(np.prod(a.dims[: a.rank]))
        return bytes(lent(a.data, (length,), read, kind="|u1")).rstrip(b"\0").decode(errors="replace")
    return array_of(read)


def open(path: Union[str, "os.PathLike[str]"]) -> Result:
    """A result file, NAME.vtkhdf, whole: its check sum is tested."""
    return Result(path)
