"""What the tests share: small scenes, and where things are."""
import copy
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path
from typing import Any

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("SLENDER_PACKAGE", str(SOURCE / "python")))

import slender  # noqa: E402
import numpy as np  # noqa: E402

STRIP: dict[str, Any] = {
    "slender": 1, "job": "equilibrium",
    "shell": {"mesh": {"shape": "sheet", "size": ["30 mm", "10 mm"], "cells": [6, 2]}, "thickness": "1 mm",
              "young": "0.1 MPa", "poisson": 0.5, "magnetization": [20000, 0, 0]},
    "flux_density": [0, 0, "5 mT"], "fix": [{"group": "root", "clamp": True}]}


def strip(**keys: Any) -> dict[str, Any]:
    return {**copy.deepcopy(STRIP), **keys}


def up_and_down() -> dict[str, Any]:
    """Two load cases, and a design."""
    scene = strip(job="design", cases=[{"name": "up", "flux_density": [0, 0, 0.005]},
                                       {"name": "down", "flux_density": [0, 0, -0.004]}],
                  target={"formula": ["x", "y", "0.3*x"]},
                  design={"unknowns": {"magnetization": {"scale": 1e4}}, "objectives": [{"target": 1}],
                          "optimizer": "gauss_newton", "iterations": 4, "tolerance": 0})
    del scene["flux_density"]
    return scene


def model_of(scene: Any = None, **keys: Any) -> slender.Model:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", slender.SlenderWarning)  # of coarse meshes
        return slender.Scene(strip(**keys) if scene is None else scene).model()


def count_destroyed(handle: Any) -> list[int]:
    """Of a handle: grows when the library is told to destroy it."""
    gone: list[int] = []
    destroy = handle._destroy
    handle._destroy = lambda pointer: (gone.append(pointer), destroy(pointer))
    return gone


def python(code: str, *before: str, **environment: str) -> "subprocess.CompletedProcess[str]":
    """Another Python with this package."""
    env = {name: value for name, value in os.environ.items() if not name.startswith("OPENBLAS_")}
    env.update(environment, PYTHONPATH=os.pathsep.join(sys.path))
    return subprocess.run([*before, sys.executable, "-c", code], env=env, capture_output=True, text=True, timeout=60)


class TestCase(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        ignoring = warnings.catch_warnings()
        ignoring.__enter__()
        self.addCleanup(ignoring.__exit__, None, None, None)
        warnings.simplefilter("ignore", slender.SlenderWarning)

    def refuses(self, kind: Any, pattern: str, function: Any, *args: Any, **keys: Any) -> BaseException:
        with self.assertRaisesRegex(kind, pattern) as caught:
            function(*args, **keys)
        return caught.exception

    def same(self, a: Any, b: Any) -> None:
        self.assertEqual(np.asarray(a).tobytes(), np.asarray(b).tobytes())

    def near(self, a: Any, b: Any, relative: float) -> None:
        difference, size = np.linalg.norm(np.asarray(a) - np.asarray(b)), np.linalg.norm(np.asarray(b))
        self.assertLessEqual(difference, relative * size, f"{difference} of {size}")
