"""States: where a body is."""
from __future__ import annotations

from typing import TYPE_CHECKING

from . import _library as c
from ._errors import NO_MEMORY, Error
from ._handle import Array, Handle, lent

if TYPE_CHECKING:
    from ._model import Case, Model


class State:
    """Where a body is, and how it moves: views of the library's memory that may be written.

    x, v [points, 3] m and m/s; dofs, velocities [dofs]: of all that moves (edge angles and turns in rad after the points);
    memory: what the terms remember; time in s. Of the solve that made it: status, energy in J, newton_iterations. status
    is "converged" where an equilibrium was found; "start" where nothing was solved yet."""

    def __init__(self, handle: Handle, model: Model, case: Case) -> None:
        info = c.lib.slender_state_info(handle.pointer)
        self._handle, self.model, self.case = handle, model, case
        self.dofs: Array = lent(info.x, (info.dofs,), handle)
        self.velocities: Array = lent(info.v, (info.dofs,), handle)
        self.memory: Array = lent(info.memory, (info.memory_count,), handle)
        self._time: Array = lent(info.time, (1,), handle)
        self.x, self.v = model.places(self.dofs), model.places(self.velocities)
        self.status: str = info.status.decode()
        self.energy: float = info.energy
        self.newton_iterations: int = info.newton_iterations

    @property
    def time(self) -> float:
        return float(self._time[0])

    @time.setter
    def time(self, time: float) -> None:
        self._time[0] = time

    def copy(self) -> State:
        """Another one of the same numbers; of an equilibrium it knows the same factor."""
        return State(self._copy(), self.model, self.case)

    def __deepcopy__(self, _: object) -> State:
        return self.copy()

    def _copy(self) -> Handle:
        with self._handle.lock:
            pointer = c.lib.slender_state_copy(self._handle.use())
        if not pointer:
            raise Error("memory is not there for a state", NO_MEMORY)
        return Handle(pointer, c.lib.slender_state_destroy, self.model._handle)

    def __repr__(self) -> str:
        return f"<slender.State of {self.case.name!r}: {self.status}, {len(self.x)} points, t {self.time:g} s>"
