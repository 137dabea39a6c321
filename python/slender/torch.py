"""Equilibria and motions as functions of torch's autograd, on the same exact products as Model.vjp and Motion.vjp.

Tensors are taken to numpy and the results are of float64, on the CPU. Blocks that are not given are the model's, as they are
when the function is called; those that are given stay in the model afterwards. Where there is no equilibrium, or a step
fails, NotConverged is raised. Derivatives of derivatives are not there."""
from __future__ import annotations

from contextlib import contextmanager
from typing import Any, Iterator, Mapping, Optional

import numpy as np
import torch
from torch.autograd.function import once_differentiable

from ._handle import Array
from ._model import Model
from ._state import State

_once: Any = once_differentiable  # which has no types


def equilibrium(model: Model, params: Mapping[str, torch.Tensor], case: Optional[str] = None,
                start: Optional[State] = None) -> torch.Tensor:
    """x [points, 3] of the equilibrium of the case with these blocks: {"magnetization": tensor of the block's shape}."""
    x: torch.Tensor = _Equilibrium.apply(model, case, start, tuple(params), *params.values())
    return x


def simulate(model: Model, start: Optional[State], steps: int, dt: float, field: Optional[torch.Tensor] = None,
             params: Optional[Mapping[str, torch.Tensor]] = None, case: Optional[str] = None) -> torch.Tensor:
    """x [steps + 1, points, 3] of the states of a motion: of `start` (None: where the case starts), then after each step of
    dt in the uniform flux density field [steps, 3] (None: the scene's)."""
    blocks = params or {}
    x: torch.Tensor = _Motion.apply(model, (start, steps, dt, case), field, tuple(blocks), *blocks.values())
    return x


def _write(model: Model, case: Optional[str], names: tuple[str, ...], tensors: list[torch.Tensor]) -> None:
    for name, tensor in zip(names, tensors):
        own = case is not None and name in model.blocks and model.blocks[name].per_case
        block = model.cases[case].params[name] if own and case is not None else model.params[name]
        if tuple(tensor.shape) != block.shape:
            raise ValueError(f"{name} has the shape {tuple(tensor.shape)}; the model's has {block.shape}")
        block[...] = tensor.detach().cpu().numpy()


@contextmanager
def _parameters(model: Model, saved: list[Array]) -> Iterator[None]:
    """The model with other parameters for a while: an equilibrium is one with those that it was found for."""
    with model._handle.lock:
        now = [p.copy() for p in model._p]
        try:
            for p, before in zip(model._p, saved):
                p[:] = before
            yield
        finally:
            for p, before in zip(model._p, now):
                p[:] = before


def _gradients(ctx: Any, dp: Mapping[str, Array]) -> list[Optional[torch.Tensor]]:
    """Of the last inputs, which are the blocks."""
    first = len(ctx.needs_input_grad) - len(ctx.names)
    return [torch.from_numpy(dp[name].copy()).to(kind) if ctx.needs_input_grad[first + k] else None
            for k, (name, kind) in enumerate(zip(ctx.names, ctx.kinds))]


class _Equilibrium(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, *args: Any, **_: Any) -> torch.Tensor:
        model, case, start, names, *tensors = args
        with model._handle.lock:
            _write(model, case, names, tensors)
            state = model.equilibrium(case, start, check=True)
            ctx.saved = (state, [p.copy() for p in model._p])
        ctx.names, ctx.kinds = names, [tensor.dtype for tensor in tensors]
        return torch.from_numpy(state.x.copy())

    def _pull(ctx: Any, dx: torch.Tensor) -> Any:
        state, saved = ctx.saved
        with _parameters(state.model, saved):
            dp = state.model.vjp(state, dx.cpu().numpy())
        return (None, None, None, None, *_gradients(ctx, dp))

    backward = staticmethod(_once(_pull))


class _Motion(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, *args: Any, **_: Any) -> torch.Tensor:
        model, (start, steps, dt, case), field, names, *tensors = args
        if field is not None and tuple(field.shape) != (steps, 3):
            raise ValueError(f"field has the shape {tuple(field.shape)}; it must be [steps, 3], ({steps}, 3)")
        with model._handle.lock:
            _write(model, case, names, tensors)
            motion = model.simulate(start, steps=steps, dt=dt, case=case, check=True,
                                    field=None if field is None else field.detach().cpu().numpy())
        ctx.motion, ctx.field_kind = motion, None if field is None else field.dtype
        ctx.names, ctx.kinds = names, [tensor.dtype for tensor in tensors]
        return torch.from_numpy(np.array([state.x for state in motion.states]))

    def _pull(ctx: Any, dx: torch.Tensor) -> Any:
        dp, dfield = ctx.motion.vjp(dict(enumerate(dx.cpu().numpy())))
        of_field = None if dfield is None else torch.from_numpy(dfield).to(ctx.field_kind)
        return (None, None, of_field, None, *_gradients(ctx, dp))

    backward = staticmethod(_once(_pull))
