"""What a verification case is, and what is read from the program's results."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import Callable

import h5py
import numpy as np


class Result:
    """A finished run: its datasets by their paths (docs/result.md)."""

    def __init__(self, path: str):
        self._file = h5py.File(path, "r")["slender"]

    def __getitem__(self, path: str) -> np.ndarray:
        return self._file[path][()]

    @property
    def status(self) -> str:
        status = self._file.attrs["status"]
        return status.decode() if isinstance(status, bytes) else str(status)

    @property
    def x(self) -> np.ndarray:
        """Where its points are at the end, m."""
        return self["state/x"]

    def moved(self, *place: float) -> np.ndarray:
        """How far the point nearest to a place of the body at rest has moved, m."""
        rest = self["rest"]
        vertex = np.argmin(((rest - np.asarray(place)) ** 2).sum(1))
        return self.x[vertex] - rest[vertex]

    def energy(self) -> float:
        """Elastic, J."""
        terms = self._file["final/energy"]
        return sum(float(terms[name][()]) for name in ("membrane", "bending", "elastic", "strain") if name in terms)


@dataclass(frozen=True)
class Figure:
    """A number that is compared: read from the case's results, in the order of its scenes."""
    what: str
    read: Callable[..., float]
    reference: float
    tolerance: float            # of the reference, or of `scale`
    scale: float | None = None  # where the reference is 0, or small beside what it is a part of
    miss: str = ""              # why it misses, where that is known


@dataclass(frozen=True)
class Case:
    name: str
    source: str                 # author, year, equation or table
    mesh: str
    scenes: list[dict]          # the scenes, but for `slender: 1`
    figures: list[Figure]
    files: dict[str, str] = field(default_factory=dict)  # that the scenes name: text by name
    status: str = "converged"   # how runs should end; "": in any way
