"""Scenes and their jobs."""
from __future__ import annotations

import json
import os
from ctypes import byref, c_char_p
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

import numpy as np

from . import _library as c
from ._errors import DONE, NOT_CONVERGED, Error
from ._handle import Handle, Host, OnFrame, Progress
from ._model import Model
from ._result import Result, open

if TYPE_CHECKING:
    from .scene_types import Scene as SceneDict

Source = Union[str, "os.PathLike[str]", Mapping[str, Any], "SceneDict"]


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and paths, as JSON has them."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a scene cannot hold {value!r} ({type(value).__name__})")


def _json(value: Any) -> str:
    return json.dumps(value, default=_plain, ensure_ascii=False)


def _settings(settings: Optional[Mapping[str, Any]]) -> Any:
    """As `--set` has them: "shell.thickness=1 mm"."""
    given = [c.words(f"{key}={value if isinstance(value, str) else _json(value)}")
             for key, value in (settings or {}).items()]
    return (c_char_p * len(given))(*given), len(given)


class Scene:
    """A scene file, or a dict that says the same. `set` assigns to keys: {"shell.thickness": "1 mm"}. Paths in a file are
    relative to it, those of a dict to the working directory.

    A scene is a value: it does not follow the file or the dict. Raises SceneError: one sentence, with file:line:column or,
    of a dict, the key."""

    def __init__(self, source: Source, set: Optional[Mapping[str, Any]] = None) -> None:
        words, count = _settings(set)
        if isinstance(source, Mapping):
            self.path: Optional[Path] = None
            pointer = c.made(c.lib.slender_scene_parse, c.words(_json(source)), words, count, scene=True)
        else:
            self.path = Path(os.fspath(source))
            pointer = c.made(c.lib.slender_scene_read, c.words(str(self.path)), words, count, scene=True)
        self._handle = Handle(pointer, c.lib.slender_scene_destroy)

    @classmethod
    def parse(cls, text: str, set: Optional[Mapping[str, Any]] = None) -> Scene:
        """A scene of a text, YAML or JSON."""
        self = cls.__new__(cls)
        words, count = _settings(set)
        self.path = None
        self._handle = Handle(c.made(c.lib.slender_scene_parse, c.words(text), words, count, scene=True),
                              c.lib.slender_scene_destroy)
        return self

    @property
    def text(self) -> str:
        """The effective scene as YAML: every key with its value, in SI units."""
        with self._handle.lock:
            return c.text(c.lib.slender_scene_text(self._handle.use()))

    def model(self, threads: int = 1) -> Model:
        """Its body made ready, with its load cases, for whatever its job is. Every call makes a new one."""
        return Model(self._handle, threads)

    def __repr__(self) -> str:
        return f"Scene({str(self.path)!r})" if self.path else "Scene(<a dict or text>)"


def run(scene: Union[Scene, Source], output: Union[str, "os.PathLike[str]", None] = None, *, threads: int = 1,
        resume: bool = False, force: bool = False, journal: bool = True, progress: Optional[Progress] = None,
        on_frame: Optional[OnFrame] = None, check: bool = False) -> Result:
    """The scene's job, as `slender run` does it: leaves OUTPUT.vtkhdf, OUTPUT.xdmf and the journal OUTPUT.run (journal=False:
    none), and returns the result opened; its status says how it ended. OUTPUT is the scene's name where it is not given.

    progress(sentence) is told of every step, on_frame(time, x[points, 3]) of frames. Ctrl-C, or what a callback raises, ends
    it: what was done is in the journal, and resume=True goes on with it; force=True discards a journal, or
    the result of another scene under that name, which else is refused. With check=True
    a job that did not converge raises NotConverged, when its result is written."""
    if not isinstance(scene, Scene):
        scene = Scene(scene)
    if output is None:
        if not scene.path:
            raise Error("run needs an output: a scene that is no file has no name")
        output = scene.path.stem
    name = os.fsdecode(output)
    with Host(scene._handle, progress, on_frame) as host:
        job = c.CRun(c.words(name), c.whole(threads, "threads"), resume, force, not journal, host.struct)
        scene._handle.do(c.lib.slender_run, byref(job), scene=True, keeps=True,
                         accept=(DONE,) if check else (DONE, NOT_CONVERGED))
    return open(name if name.endswith(".vtkhdf") else name + ".vtkhdf")
