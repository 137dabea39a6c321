"""Long calls: Ctrl-C, callbacks, threads; and OpenBLAS beneath them."""
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings
from pathlib import Path
from typing import Any

import support
from support import np, slender

LONG = {"load_steps": 10000}  # an equilibrium of many seconds


def interrupt_soon() -> None:
    threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()


def interrupt_at_third(line: str) -> None:
    if line.startswith("3 of"):
        os.kill(os.getpid(), signal.SIGINT)


class CtrlC(support.TestCase):
    """Real signals to this process, whose main thread is in the call."""

    def interrupted(self, function: Any, *args: Any, **keys: Any) -> None:
        handler, begin = signal.getsignal(signal.SIGINT), time.monotonic()
        interrupt_soon()
        with self.assertRaises(KeyboardInterrupt):
            function(*args, **keys)
        self.assertLess(time.monotonic() - begin, 2)
        self.assertIs(signal.getsignal(signal.SIGINT), handler)

    def test_equilibrium(self) -> None:
        model = support.model_of(**LONG)
        self.interrupted(model.equilibrium)
        self.assertEqual(model.state().status, "start")  # the model can be used

    def test_simulate(self) -> None:
        self.interrupted(support.model_of().simulate, steps=10**6, dt=1e-6)

    def test_run_and_resume(self) -> None:
        """What was interrupted goes on to the bits of what was not."""
        scene = support.up_and_down()
        scene["design"]["iterations"] = 10**6
        for threads in (1, 2):
            path = self.folder / f"design{threads}"
            with self.assertRaises(KeyboardInterrupt):
                slender.run(scene, path, threads=threads, progress=interrupt_at_third)
            self.assertTrue(path.with_suffix(".run").exists())
            self.refuses(slender.Error, "resume=True, or .* force=True", slender.run, scene, path)
        done = len(slender.open(path.with_suffix(".vtkhdf")).history["objective"])
        scene["design"]["iterations"] = done + 2
        resumed, whole = (slender.run(scene, name, **how) for name, how in
                          ((path, {"resume": True}), (self.folder / "whole", {})))
        self.assertGreater(len(whole.history["objective"]), done)
        self.same(resumed["design/magnetization"], whole["design/magnetization"])
        self.same(resumed.history["objective"], whole.history["objective"])

    def test_process_ends(self) -> None:
        """As a script: Python says KeyboardInterrupt, and nothing else."""
        code = (f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r})\n"
                "import support, slender\n"
                "scene = support.up_and_down(); scene['design']['iterations'] = 10**6\n"
                f"slender.run(scene, {str(self.folder / 'script')!r}, progress=lambda line: print(line, flush=True))")
        child = subprocess.Popen([sys.executable, "-W", "ignore", "-c", code], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        assert child.stdout is not None
        while not child.stdout.readline().startswith("3 of"):
            self.assertIsNone(child.poll())
        child.send_signal(signal.SIGINT)
        _, said = child.communicate(timeout=30)
        self.assertEqual(child.returncode, -signal.SIGINT)
        self.assertTrue(said.strip().endswith("KeyboardInterrupt"), said)
        self.assertNotIn("Exception ignored", said)
        self.assertTrue((self.folder / "script.run").exists())

    def test_in_a_callback(self) -> None:
        """Where a callback is at work the exception is raised in it: it need not come back first."""
        model = support.model_of()
        self.interrupted(model.simulate, steps=3, dt=1e-3, on_frame=lambda *_: time.sleep(5))
        inner = support.model_of()
        self.interrupted(model.simulate, steps=3, dt=1e-3,
                         on_frame=lambda *_: inner.simulate(steps=10**6, dt=1e-6))

    def test_other_signals(self) -> None:
        """A time limit of the user's, say."""
        def handler(*_: object) -> None:
            raise TimeoutError("too long")
        before = signal.signal(signal.SIGALRM, handler)
        model = support.model_of()
        try:
            for keys in ({}, {"on_frame": lambda *_: None}):
                signal.setitimer(signal.ITIMER_REAL, 0.2)
                self.refuses(TimeoutError, "too long", model.simulate, steps=10**6, dt=1e-6, **keys)
        finally:
            signal.signal(signal.SIGALRM, before)

    def test_a_handler_of_the_users(self) -> None:
        def handler(*_: object) -> None:
            raise RuntimeError("my own")
        before = signal.signal(signal.SIGINT, handler)
        try:
            interrupt_soon()
            self.refuses(RuntimeError, "my own", support.model_of(**LONG).equilibrium)
        finally:
            signal.signal(signal.SIGINT, before)


class Callbacks(support.TestCase):
    def test_what_they_raise(self) -> None:
        """Ends the call, at once, and is raised as it is."""
        calls = []

        def fails(*args: Any) -> None:
            calls.append(args)
            raise ZeroDivisionError("mine")
        model = support.model_of()
        for function, keys in ((model.simulate, {"steps": 10**6, "dt": 1e-6, "on_frame": fails}),
                               (model.simulate, {"steps": 10**6, "dt": 1e-6, "progress": fails}),
                               (model.simulate, {"steps": 4, "dt": 1e-3, "field": fails}),
                               (slender.run, {"scene": support.up_and_down(), "output": self.folder / "a",
                                              "progress": fails})):
            calls.clear()
            error = self.refuses(ZeroDivisionError, "mine", function, **keys)
            self.assertTrue(error.__suppress_context__ or not error.__context__)
            self.assertEqual(len(calls), 1)
        self.assertEqual(model.equilibrium().status, "converged")

    def test_progress_of_an_equilibrium(self) -> None:
        lines: list[str] = []
        support.model_of().equilibrium(progress=lines.append)
        self.assertGreater(len(lines), 1)
        self.assertIn("energy", lines[0])

    def test_calls_from_callbacks(self) -> None:
        """On the model at work: refused, not a deadlock; on another one they are fine; what is let go waits."""
        model, other, seen = support.model_of(), support.model_of(), []
        states = [model.state()]
        gone = support.count_destroyed(states[0]._handle)

        def on_frame(time: float, x: Any) -> None:
            states.clear()
            seen.append((other.energy(other.state()).total, len(gone)))
            model.energy(model.state())
        self.refuses(slender.Error, "callback", model.simulate, steps=4, dt=1e-3, on_frame=on_frame)
        self.assertEqual(seen, [(other.energy(other.state()).total, 0)])
        self.assertEqual(model.equilibrium().status, "converged")
        self.assertEqual(len(gone), 1)

    def test_progress(self) -> None:
        lines: list[str] = []
        slender.run(support.up_and_down(), self.folder / "a", progress=lines.append)
        self.assertTrue(lines[0].startswith("1 of 5: F "), lines)
        self.assertTrue(any("result" in line for line in lines), lines)

    def test_warnings_as_errors(self) -> None:
        warnings.simplefilter("error", slender.SlenderWarning)
        scene = support.strip(flux_density=[0, 0, 0.9])
        self.refuses(slender.SlenderWarning, "too coarse", slender.run, scene, self.folder / "a")


class Threads(support.TestCase):
    def test_two_models_at_once(self) -> None:
        """The bits of one after the other; and while one works the other threads go on."""
        def design() -> Any:
            model = support.model_of(support.up_and_down())
            found, states = [], {case: model.equilibrium(case=case) for case in model.cases}
            for _ in range(10):
                for case in model.cases:
                    states[case] = model.equilibrium(start=states[case])
                    dp = model.vjp(states[case], 2 * (states[case].x - model.rest))
                    model.params["magnetization"][:] -= 1e9 * dp["magnetization"]
                found.append(model.params["magnetization"].tobytes())
            motion = model.simulate(case="up", steps=5, dt=1e-3, field=[0, 0, 1e-3])
            return found, motion.states[-1].x.tobytes()
        alone, results = design(), [None, None]

        def work(k: int) -> None:
            results[k] = design()
        threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(results, [alone, alone])

    def test_one_model_of_two_threads(self) -> None:
        """Calls wait for each other; and a call lets the others run."""
        model, ticks = support.model_of(load_steps=100), []
        want = model.equilibrium().x.copy()
        got: list[Any] = []
        threads = [threading.Thread(target=lambda: got.append(model.equilibrium().x.copy())) for _ in range(2)]
        for thread in threads:
            thread.start()
        while any(thread.is_alive() for thread in threads):
            ticks.append(time.monotonic())
            time.sleep(0.001)
        self.same(got[0], want)
        self.same(got[1], want)
        self.assertLess(max(np.diff(ticks), default=0), 0.1)

    def test_blas_has_its_threads_back(self) -> None:
        get, put = slender._library.lib.openblas_get_num_threads, slender._library.lib.openblas_set_num_threads
        before, seen = get(), []
        put(2)
        try:
            support.model_of().simulate(steps=1, dt=1e-3, on_frame=lambda *_: seen.append(get()))
            self.assertEqual((seen, get()), ([1], 2))
        finally:
            put(before)


class Kernels(unittest.TestCase):
    """On a machine that its OpenBLAS does not know (tests/machine_shim.c)."""

    def setUp(self) -> None:
        self.shim = os.environ.get("SLENDER_SHIM", str(support.SOURCE / "build/tests/libmachine_shim.so"))
        flags = Path("/proc/cpuinfo").read_text().split()
        if not os.path.exists(self.shim) or "avx2" not in flags:
            self.skipTest("no shim, or an old processor")
        self.best = "SkylakeX" if {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"} <= set(flags) else "Haswell"

    def say(self, before: str, **environment: str) -> "tuple[str, str]":
        code = (f"{before}\nimport os, slender\nkernels = slender.versions().split('kernels ')[1].split()[0].strip(',')\n"
                "print(os.environ.get('OPENBLAS_CORETYPE'), kernels)")
        done = support.python(code, LD_PRELOAD=self.shim, **environment)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip(), done.stderr

    def test_ours_is_the_first(self) -> None:
        said, warned = self.say("")
        self.assertEqual((said, warned), (f"{self.best} {self.best}", ""))

    def test_the_users_word(self) -> None:
        said, warned = self.say("", OPENBLAS_CORETYPE="Nehalem")
        self.assertEqual((said, warned), ("Nehalem Nehalem", ""))

    def test_loaded_before(self) -> None:
        """Said once, and the environment stays."""
        if "openblas" not in support.python("import numpy; print(open('/proc/self/maps').read())").stdout:
            self.skipTest("numpy has no OpenBLAS")
        said, warned = self.say("import numpy")
        self.assertEqual(said, "None Prescott")
        self.assertEqual(warned.count("OPENBLAS_CORETYPE=" + self.best), 1, warned)
        self.assertIn("import slender before numpy", warned)


if __name__ == "__main__":
    unittest.main()
