"""slender: simulates and designs slender things. numpy in, numpy out.

    scene = slender.Scene("sheet.yaml")          # or a dict
    model = scene.model()
    state = model.equilibrium()
    dp = model.vjp(state, 2 * (state.x - model.rest))

docs/python.md has recipes. Units are SI."""
from __future__ import annotations

from types import ModuleType

from . import _library  # first: OpenBLAS takes its kernels when it is loaded
from ._errors import Error, NotConverged, SceneError, SlenderWarning
from ._model import Block, Case, Energies, Model, Params
from ._motion import Motion
from ._result import Frame, Result, open
from ._scene import Scene, run
from ._state import State

__version__ = _library.VERSION
__all__ = ["Block", "Case", "Energies", "Error", "Frame", "Model", "Motion", "NotConverged", "Params", "Result",
           "Scene", "SceneError", "SlenderWarning", "State", "open", "run", "schema", "versions"]


def versions() -> str:
    """slender and the libraries that it works with, a line each."""
    return _library.text(_library.lib.slender_versions())


def schema() -> str:
    """The JSON Schema of scenes."""
    return _library.text(_library.lib.slender_schema())


def __getattr__(name: str) -> ModuleType:
    """slender.torch loads torch when it is asked for."""
    if name == "torch":
        import importlib

        return importlib.import_module(".torch", __name__)
    raise AttributeError(f"module 'slender' has no attribute {name!r}")
