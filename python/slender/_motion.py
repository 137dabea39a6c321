"""Stored motions, and their derivatives."""
from __future__ import annotations

from ctypes import byref
from typing import TYPE_CHECKING, Literal, Mapping, NamedTuple, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _library as c
from ._errors import DONE
from ._handle import Array, Handle, Shield, address
from ._result import Read, array_of
from ._state import State

if TYPE_CHECKING:
    from ._model import Model


Seeds = Mapping[int, ArrayLike]


class Start(NamedTuple):
    """dF/dx and dF/dv of a motion's start."""

    x: Array
    v: Array


class Motion:
    """A motion that Model.simulate made: `steps` were reached; states[n] after n of them. status: "done", or "not converged"
    with a sentence in message."""

    def __init__(self, handle: Handle, model: Model, case: int, asked: int, status: int, message: str,
                 given: bool) -> None:
        self._handle, self.model, self._case, self._asked, self._given = handle, model, case, asked, given
        self.status, self.message = "done" if status == DONE else "not converged", message
        self.steps: int = c.lib.slender_motion_steps(handle.pointer)

    @property
    def states(self) -> States:
        return States(self)

    @property
    def history(self) -> Mapping[str, Array]:
        """What the body met in each step, as in a simulation's history: contacts, contact_force [steps, obstacles, 3], .."""
        found: dict[str, Array] = {}
        while (read := self._met(len(found))).array.name:
            found[read.array.name.decode()] = array_of(read)
        return found

    def _met(self, number: int) -> Read:
        read = Read()
        self._handle.do(c.lib.slender_motion_met, number, byref(read.array))
        return read

    @overload
    def vjp(self, dF: Seeds, dv: Optional[Seeds] = None, *, start: Literal[False] = False) -> tuple[
        dict[str, Array], Optional[Array]]: ...

    @overload
    def vjp(self, dF: Seeds, dv: Optional[Seeds] = None, *, start: Literal[True], dofs: bool = False) -> tuple[
        dict[str, Array], Optional[Array], Start]: ...

    def vjp(self, dF: Seeds, dv: Optional[Seeds] = None, *, start: bool = False, dofs: bool = False) -> Union[
            tuple[dict[str, Array], Optional[Array]], tuple[dict[str, Array], Optional[Array], Start]]:
        """dF/dp by blocks and dF/dfield [steps, 3], from {n: dF/dx of the state after n steps}, [points, 3] or [dofs], and dF/dv
        alike. Exact. The field's is None where the motion had the scene's; where it had its own, flux_density in dF/dp is 0.
        With start=True dF/dx and dF/dv of the start come too, [points, 3] or of all dofs: motions can be chained."""
        m = self.model
        frames = np.array([c.whole(n, "a step") for n in dict.fromkeys([*dF, *(dv or {})])], dtype=np.int32)
        of_x = self._seeds(dF, frames, "dF")
        of_v = self._seeds(dv, frames, "dv") if dv else None
        dp, dfield = np.empty(m.size), np.zeros((self._asked, 3)) if self._given else None
        x, v = (np.empty(m.dofs), np.empty(m.dofs)) if start else (None, None)
        with Shield():
            self._handle.do(c.lib.slender_motion_vjp, len(frames), address(frames), address(of_x), address(of_v),
                            address(dp), address(dfield), address(x), address(v))
        if x is None or v is None:
            return m.blocks_of(dp), dfield
        return m.blocks_of(dp), dfield, Start(x, v) if dofs else Start(m.places(x), m.places(v))

    def _seeds(self, seeds: Seeds, frames: NDArray[np.int32], what: str) -> Array:
        rows = np.zeros((len(frames), self.model.dofs))
        for row, n in zip(rows, frames.tolist()):
            if n in seeds:
                row[:] = self.model.dofs_of(seeds[n], f"{what}[{n}]")
        return rows

    def jvp(self, dp: Optional[Mapping[str, ArrayLike]] = None, dfield: Optional[ArrayLike] = None,
            dx: Optional[ArrayLike] = None, dv: Optional[ArrayLike] = None, *, dofs: bool = False) -> Array:
        """dx [steps + 1, points, 3] of all states (or of all dofs) for changes of blocks, of the field [steps, 3], and of
        the start's x and v."""
        m = self.model
        p = m.vector_of(dp or {})
        field = None if dfield is None else np.array(np.broadcast_to(dfield, (self._asked, 3)), dtype=np.float64, order="C")
        x, v = (None if d is None else m.dofs_of(d, what) for d, what in ((dx, "dx"), (dv, "dv")))
        out = np.empty((self.steps + 1, m.dofs))
        with Shield():
            self._handle.do(c.lib.slender_motion_jvp, address(p), address(field), address(x), address(v), address(out))
        return out if dofs else m.places(out)

    def __repr__(self) -> str:
        return f"<slender.Motion: {self.status}, {self.steps} of {self._asked} steps>"


class States(Sequence[State]):
    """Each is made when it is asked for, and is the asker's."""

    def __init__(self, motion: Motion) -> None:
        self._motion = motion

    def __len__(self) -> int:
        return self._motion.steps + 1

    @overload
    def __getitem__(self, n: int) -> State: ...

    @overload
    def __getitem__(self, n: slice) -> list[State]: ...

    def __getitem__(self, n: Union[int, slice]) -> Union[State, list[State]]:
        numbers = range(len(self))[n]
        return [self._state(k) for k in numbers] if isinstance(numbers, range) else self._state(numbers)

    def _state(self, n: int) -> State:
        pointer = self._motion._handle.make(c.lib.slender_motion_state, n)
        return self._motion.model._state(pointer, self._motion._case)
