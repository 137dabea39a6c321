"""What Python costs: each figure against the same work of C's in the same process, or of the program's in the same minute.

    PYTHONPATH=python OPENBLAS_NUM_THREADS=1 python3 python/bench.py [PROGRAM]"""
import os
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path
from typing import Any, Callable

import slender
import numpy as np

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "scenes/hexagram.yaml"
SETTINGS = {"design.optimizer": "lbfgs", "design.iterations": 30, "output.every": 1, "output.precision": "double"}
c = slender._library


def least(function: Callable[[], Any], times: int, repeats: int = 7) -> float:
    """Seconds of one of so many calls, the least of some series."""
    best = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        for _ in range(times):
            function()
        best = min(best, (time.perf_counter() - begin) / times)
    return float(best)


def say(name: str, value: float, unit: str, goal: str = "") -> None:
    print(f"{name:42} {value:10.4g} {unit:4} {goal}", flush=True)


def calls(model: slender.Model) -> None:
    """Beyond the bare call of C's, whose own way through ctypes is that of a call that does nothing."""
    nothing = least(c.lib.slender_version, 10000)
    state = model.equilibrium("up")
    pointers = model._handle.pointer, 0, state._handle.pointer
    energies = model._energies.ctypes.data
    bare = least(lambda: c.lib.slender_energy(*pointers, energies, None, None), 200)
    say("energy_c_us", 1e6 * bare, "us")
    say("energy_beyond_c_us", 1e6 * (least(lambda: model.energy(state), 200) - bare + nothing), "us", "<= 50")
    dF = 2 * (state.x - model.rest)
    dx, dp, error = model.dofs_of(dF), np.empty(model.size), c.CError()
    bare = least(lambda: c.lib.slender_vjp(*pointers, dx.ctypes.data, dp.ctypes.data, error), 20)
    say("vjp_c_ms", 1e3 * bare, "ms")
    say("vjp_ms", 1e3 * least(lambda: model.vjp(state, dF), 20), "ms")
    say("vjp_beyond_c_ms", 1e3 * (least(lambda: model.vjp(state, dF), 20) - bare), "ms", "<= 2 beyond the solve")
    say("view_us", 1e6 * least(lambda: model.params["magnetization"], 10000), "us")
    say("state_us", 1e6 * least(lambda: model.state("up"), 200), "us")


def design(designs: list[np.ndarray], targets: dict[str, np.ndarray]) -> "tuple[float, list[float]]":
    """The program's evaluations again: seconds of all but the first, and the objectives."""
    model = slender.Scene(SCENE).model()
    states: dict[str, Any] = {case: None for case in model.cases}
    begin, objectives = 0.0, []
    for k, M in enumerate(designs):
        if k == 1:
            begin = time.perf_counter()
        model.params["magnetization"] = M
        F, dM = 0.0, np.zeros(M.shape)
        for case, target in targets.items():
            states[case] = model.equilibrium(case, states[case])
            off = states[case].x - target
            F += float(np.sum(off ** 2))
            dM += model.vjp(states[case], 2 * off)["magnetization"]
        objectives.append(F)
    return time.perf_counter() - begin, objectives


def loop(program: Path) -> None:
    """The same designs, one after the other, by the program's design job and by a loop in Python; in turns."""
    ratios, env = [], {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as folder:
        words = [f"--set={key}={value}" for key, value in SETTINGS.items()]
        for _ in range(5):
            subprocess.run([program, "run", SCENE, "-o", f"{folder}/h", "--force", "--quiet", "--no-picture", "--threads", "1",
                            *words], env=env, capture_output=True)
            r = slender.open(f"{folder}/h.vtkhdf")
            seconds, objective = r.history["seconds"], r.history["objective"]
            frames = r.frames[:len(objective)]  # every evaluation was an improvement
            targets = {case: r[f"cases/{case}/target"] for case in ("up", "down")}
            mine, objectives = design([frame["magnetization"] for frame in frames], targets)
            assert np.allclose(objectives, objective, rtol=1e-6), (objectives, objective)
            ratios.append((mine / (seconds[-1] - seconds[0]), mine / (len(objective) - 1)))
    best = min(ratios)
    say("design_s_per_evaluation", best[1], "s")
    say("design_over_program", best[0], "", "<= 1.1")
    say("design_over_program_median", float(np.median([ratio for ratio, _ in ratios])), "")


if __name__ == "__main__":
    warnings.simplefilter("ignore", slender.SlenderWarning)
    print(slender.versions().split("\n")[3])
    calls(slender.Scene(SCENE).model())
    loop(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(c.lib._name).resolve().parent / "slender")
