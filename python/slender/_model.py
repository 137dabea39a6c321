"""Models: parameters, equilibria and their derivatives, motions."""
from __future__ import annotations

import math
import warnings
from ctypes import byref, c_int
from dataclasses import dataclass
from typing import Any, Callable, Iterator, Mapping, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _library as c
from ._errors import DONE, INTERRUPTED, NO_MEMORY, NOT_CONVERGED, Error, SlenderWarning, error_of, spoken
from ._handle import Array, Handle, Host, OnFrame, Progress, Shield, address, lent
from ._motion import Motion
from ._state import State

Field = Union[Callable[[float], ArrayLike], ArrayLike, None]


@dataclass(frozen=True)
class Block:
    """Parameters of one kind: values[count, width] (of width 1: [count]) from p[offset] on."""

    name: str
    unit: str
    offset: int
    count: int
    width: int
    per_case: bool  # each load case has its own: fields, gravity, loads

    @property
    def shape(self) -> tuple[int, ...]:
        return (self.count, self.width) if self.width > 1 else (self.count,)

    @property
    def where(self) -> slice:
        return slice(self.offset, self.offset + self.count * self.width)


class Params(Mapping[str, Array]):
    """Blocks by their names: views of the model's memory. What is written there counts from the next call on."""

    def __init__(self, views: dict[str, Array], elsewhere: dict[str, str]) -> None:
        self._views, self._elsewhere = views, elsewhere

    def __getitem__(self, name: str) -> Array:
        try:
            return self._views[name]
        except KeyError:
            raise KeyError(self._elsewhere.get(name) or
                           f"there is no {name!r}; there are {', '.join(self._views) or 'none'}") from None

    def __setitem__(self, name: str, value: ArrayLike) -> None:
        self[name][...] = value

    def __iter__(self) -> Iterator[str]:
        return iter(self._views)

    def __len__(self) -> int:
        return len(self._views)

    def __repr__(self) -> str:
        return f"Params({', '.join(f'{name}{list(view.shape)}' for name, view in self._views.items())})"


class Case(NamedTuple):
    """A load case; params: the blocks that are its own."""

    name: str
    number: int
    params: Params


class Energies(dict[str, float]):
    """J, by the terms' names; total is their sum, NAN where it is not finite."""

    total: float = math.nan


class Model:
    """A scene's body made ready, with its load cases: Scene.model makes it.

    One call at a time is at work on a model; calls from other threads wait. Different models work side by side."""

    def __init__(self, scene: Handle, threads: int = 1) -> None:
        with Shield():
            made = scene.make(c.lib.slender_model_create, c.whole(threads, "threads"), scene=True)
        self._handle = Handle(made, c.lib.slender_model_destroy, scene, alone=True)
        info = c.lib.slender_model_info(made)
        self.points, self.dofs, self.size = int(info.points), int(info.dofs), int(info.params)
        self._rest = lent(info.rest, (self.dofs,), self._handle, writable=False)
        self.rest = self.places(self._rest)  # [points, 3] m: at rest, or in the pose; a scene's `start` is in state()
        self.faces = lent(info.face, (info.faces, 3), self._handle, writable=False, kind="<i4")
        self.warnings = tuple(info.warnings.decode().splitlines())
        self._terms = [c.lib.slender_model_term(made, k).decode() for k in range(info.terms)]
        self._energies = np.full(len(self._terms), math.nan)
        self.blocks: dict[str, Block] = {}
        for k in range(info.blocks):
            b = c.lib.slender_model_block(made, k)
            name = b.name.decode()
            self.blocks[name] = Block(name, (b.unit or b"").decode(), b.offset, b.count, b.width, bool(b.per_case))
        self._p = [lent(c.lib.slender_model_params(made, k), (self.size,), self._handle) for k in range(info.cases)]
        names = [c.lib.slender_model_case(made, k).decode() for k in range(info.cases)]
        self.cases = {name: Case(name, k, self._case_params(k)) for k, name in enumerate(names)}
        self.params = self._shared_params(names)
        for sentence in self.warnings:
            warnings.warn(sentence, SlenderWarning, stacklevel=3)

    # ---- Parameters ----

    def _shared_params(self, cases: list[str]) -> Params:
        several = len(cases) > 1
        blocks = [b for b in self.blocks.values() if not (several and b.per_case)]
        elsewhere = {b.name: f"each load case has its own {b.name}: model.cases[{cases[0]!r}].params[{b.name!r}] .. "
                             f"(cases: {', '.join(cases)})" for b in self.blocks.values() if b.per_case}
        return Params(self.blocks_of(self._p[0], blocks), elsewhere)

    def _case_params(self, case: int) -> Params:
        elsewhere = {b.name: f"all load cases share {b.name}: model.params[{b.name!r}]"
                     for b in self.blocks.values() if not b.per_case}
        return Params(self.blocks_of(self._p[case], [b for b in self.blocks.values() if b.per_case]), elsewhere)

    def blocks_of(self, p: Array, blocks: Optional[list[Block]] = None) -> dict[str, Array]:
        """Views of the blocks in a vector over the parameters."""
        wanted = self.blocks.values() if blocks is None else blocks
        return {b.name: p[b.where].reshape(b.shape) for b in wanted}

    def vector_of(self, values: Mapping[str, ArrayLike]) -> Array:
        """A vector over the parameters with these blocks, 0 elsewhere."""
        p = np.zeros(self.size)
        for name, value in values.items():
            if name not in self.blocks:
                raise KeyError(f"there is no block {name!r}; there are {', '.join(self.blocks)}")
            block = self.blocks[name]
            p[block.where].reshape(block.shape)[...] = value
        return p

    # ---- Places and dofs ----

    def places(self, dofs: Array) -> Array:
        """[.., points, 3] of [.., dofs], a view."""
        return dofs[..., : 3 * self.points].reshape(*dofs.shape[:-1], self.points, 3)

    def dofs_of(self, places: ArrayLike, what: str = "dF/dx") -> Array:
        """[dofs] of [points, 3], 0 at all other dofs; or of [dofs]."""
        given = np.asarray(places, dtype=np.float64)
        if given.shape == (self.dofs,):
            return np.ascontiguousarray(given)
        if given.shape != (self.points, 3):
            raise ValueError(f"{what} has the shape {given.shape}; it must be [points, 3], ({self.points}, 3), or "
                             f"[dofs], ({self.dofs},)")
        whole = np.zeros(self.dofs)
        whole[: given.size] = given.reshape(-1)
        return whole

    # ---- States ----

    def _case(self, case: Optional[str], state: Optional[State] = None) -> int:
        if case is None and state is not None:
            return state.case.number
        if case is None and len(self.cases) == 1:
            return 0
        if case not in self.cases:
            said = "say which case" if case is None else f"there is no case {case!r}"
            raise KeyError(f"{said}: there are {', '.join(self.cases)}")
        return self.cases[case].number

    def _state(self, pointer: int, case: int) -> State:
        return State(Handle(pointer, c.lib.slender_state_destroy, self._handle), self, list(self.cases.values())[case])

    def state(self, case: Optional[str] = None) -> State:
        """Where the case starts."""
        number = self._case(case)
        return self._state(self._handle.make(c.lib.slender_state_create, number), number)

    def _start(self, case: int, start: Optional[State]) -> Handle:
        """A copy; of another model's state its numbers alone, since what it knows of its solve is the other's."""
        if start is not None and start.model is self:
            return start._copy()
        state = self._state(self._handle.make(c.lib.slender_state_create, case), case)
        if start is not None:
            if start.dofs.shape != state.dofs.shape or start.memory.shape != state.memory.shape:
                raise Error(f"the state has {len(start.dofs)} dofs and the model {self.dofs}: it is of another model")
            state.dofs[:], state.memory[:], state.time = start.dofs, start.memory, start.time
        return state._handle

    def equilibrium(self, case: Optional[str] = None, start: Optional[State] = None, *,
                    progress: Optional[Progress] = None, check: bool = False) -> State:
        """The equilibrium of the case with the parameters as they are: by load steps from where the case starts, or
        from `start`. Where that is this model's equilibrium of the case with other parameters, it goes on from there
        along the tangent, which is faster. `start` stays as it is.

        Where none is found, .status of what comes back says why ("saddle", "max_iterations", ..); with check=True
        NotConverged is raised then."""
        number = self._case(case, start)
        state = self._start(number, start)
        with Host(self._handle, progress) as host:
            self._handle.do(c.lib.slender_equilibrium, number, state.pointer, byref(host.struct),
                            accept=(DONE,) if check else (DONE, NOT_CONVERGED))
        return State(state, self, list(self.cases.values())[number])

    def energy(self, state: State, case: Optional[str] = None) -> Energies:
        """Of each term, in J; .total is their sum."""
        with self._handle.lock:
            self._energies.fill(math.nan)
            total = self._energy(state, case, self._energies, None)
            energies = Energies(zip(self._terms, self._energies.tolist()))
        energies.total = total
        return energies

    def gradient(self, state: State, case: Optional[str] = None, *, dofs: bool = False) -> Array:
        """dE/dx in N, [points, 3], or of all dofs. At dofs that are held it is the support's force on the body."""
        gradient = np.full(self.dofs, math.nan)
        with self._handle.lock:
            self._energy(state, case, None, gradient)
        return gradient if dofs else self.places(gradient)

    def _energy(self, state: State, case: Optional[str], energies: Optional[Array], gradient: Optional[Array]) -> float:
        error = c.CError()
        total: float = c.lib.slender_energy(self._handle.use(), self._case(case, state), state._handle.pointer,
                                            address(energies), address(gradient), byref(error))
        if error.status != DONE:
            raise error_of(error.status, error.text)
        return total

    # ---- Derivatives of equilibria ----

    def vjp(self, state: State, dF: ArrayLike, case: Optional[str] = None) -> dict[str, Array]:
        """dF/dp by blocks, from dF/dx [points, 3] or [dofs] at an equilibrium x(p). Exact. Raises Error where the state
        is no equilibrium of the case with the parameters as they are."""
        dx, dp = self.dofs_of(dF), np.empty(self.size)
        number = self._case(case, state)
        with Shield():
            self._handle.do(c.lib.slender_vjp, number, state._handle.pointer, address(dx), address(dp))
        return self.blocks_of(dp)

    def jvp(self, state: State, dp: Mapping[str, ArrayLike], case: Optional[str] = None, *, dofs: bool = False) -> Array:
        """dx [points, 3] (or of all dofs) of an equilibrium for changes of blocks, 0 of those that are not named."""
        p, dx = self.vector_of(dp), np.empty(self.dofs)
        number = self._case(case, state)
        with Shield():
            self._handle.do(c.lib.slender_jvp, number, state._handle.pointer, address(p), address(dx))
        return dx if dofs else self.places(dx)

    # ---- Motions ----

    def simulate(self, state: Optional[State] = None, *, steps: int, dt: float, field: Field = None,
                 on_frame: Optional[OnFrame] = None, case: Optional[str] = None, progress: Optional[Progress] = None,
                 memory: float = 0, check: bool = False) -> Motion:
        """A motion by implicit Euler, from a state with its velocities (None: where the case starts).

        field: the uniform flux density in T that acts in each step: [steps, 3], [3], or a function of the time at the end of
        a step; None: the scene's. on_frame(time, x[points, 3]) is called after each step. memory: bytes that factors
        may take, which derivatives else make again; 0: 1 GiB.

        Where a step fails the motion comes back as long as it came, and its status says so; with check=True NotConverged is
        raised then."""
        start = state if state is not None else self.state(case)
        number, steps = self._case(case, start), c.whole(steps, "steps")
        flux = _flux(field, start.time, steps, dt)
        status, error = c_int(), c.CError()
        with Host(self._handle, progress, on_frame) as host, self._handle.lock:
            job = c.CMotionDef(steps, dt, address(flux), memory, host.struct)
            pointer = c.lib.slender_simulate(self._handle.use(), number, start._handle.pointer, byref(job), byref(status),
                                             byref(error))
            self._handle.lost = status.value == NO_MEMORY
            handle = Handle(pointer, c.lib.slender_motion_destroy, self._handle) if pointer else None
            if handle is None or status.value == INTERRUPTED or (check and status.value != DONE):
                raise error_of(status.value, error.text)
        return Motion(handle, self, number, steps, status.value, spoken(error.text), flux is not None)


def _flux(field: Field, start: float, steps: int, dt: float) -> Optional[Array]:
    """[steps, 3]; None: the scene's."""
    if field is None:
        return None
    value: Any = [field(start + (n + 1) * dt) for n in range(steps)] if callable(field) else field
    flux = np.asarray(value, dtype=np.float64)
    if flux.shape not in ((steps, 3), (3,)) and steps:
        raise ValueError(f"field has the shape {flux.shape}; it must be [steps, 3], ({steps}, 3), or [3]")
    return np.array(np.broadcast_to(flux, (steps, 3)), order="C") if steps else np.zeros((0, 3))
