"""Jobs, and their results."""
import gc
import unittest

import support
from support import np, slender


class Runs(support.TestCase):
    def test_a_design(self) -> None:
        path = self.folder / "design"
        r = slender.run(support.up_and_down(), path)
        self.assertEqual(r.status, "max_iterations")
        self.assertEqual(sorted(p.suffix for p in self.folder.iterdir()), [".run", ".run-lock", ".vtkhdf", ".xdmf"])
        self.assertEqual(r["design/magnetization"].shape, (24, 3))
        self.same(r["slender/design/magnetization"], r["design/magnetization"])
        self.assertEqual(r.unit("design/magnetization"), "A/m")
        self.assertEqual(r["design/young"].shape, (24,))
        self.assertEqual(r["faces"].dtype, np.int32)
        self.assertIn("job: design", r["scene"])
        self.assertEqual(r["case_names"].split(), ["up", "down"])
        objective = r.history["objective"]
        self.assertEqual(objective.shape, (5,))
        self.assertLess(objective[-1], objective[0])
        self.refuses(KeyError, "has no 'design/yuong'", lambda: r["design/yuong"])
        self.assertIn("state/x", list(r))
        self.assertTrue(all(r[name] is not None for name in r))

    def test_frames(self) -> None:
        r = slender.run(support.up_and_down(), self.folder / "a", journal=False)
        self.assertFalse((self.folder / "a.run").exists())
        last = r.frames[-1]
        self.assertEqual((len(r.frames), last.x.shape, last["magnetization"].shape), (2, (21, 3), (24, 3)))
        self.near(last.x, r["state/x"], 1e-6)
        self.assertEqual([frame.time for frame in r.frames[0:2]], [0, 1])
        self.refuses(KeyError, "frames have no 'mass'; they have .*magnetization", lambda: last["mass"])
        self.refuses(IndexError, "out of range", lambda: r.frames[2])

    def test_the_parameters_go_back_into_a_model(self) -> None:
        """What a design found is, in a model, the equilibrium of the result."""
        r = slender.run(support.up_and_down(), self.folder / "a")
        model = support.model_of(support.up_and_down())
        model.params["magnetization"] = r["design/magnetization"]
        self.near(model.equilibrium(case="up").x, r["cases/up/x"], 1e-6)

    def test_arrays_outlive_the_result(self) -> None:
        r = slender.run(support.up_and_down(), self.folder / "a")
        x = r["state/x"]
        want = x.copy()
        del r
        gc.collect()
        [np.full(x.shape, 7.0) for _ in range(100)]
        self.same(x, want)

    def test_names(self) -> None:
        """Of a file, the scene's; of others one must be given; the ending is no part of it."""
        scene = slender.Scene(support.STRIP)
        self.refuses(slender.Error, "run needs an output", slender.run, scene)
        self.assertEqual(slender.run(scene, self.folder / "b.vtkhdf").path, str(self.folder / "b.vtkhdf"))
        with self.assertRaises(slender.Error) as caught:
            slender.run(scene, self.folder / "nowhere" / "b")
        self.assertEqual(caught.exception.status, 4)

    def test_what_does_not_converge(self) -> None:
        scene = support.strip(solver={"max_iterations": 1})
        self.assertEqual(slender.run(scene, self.folder / "a").status, "max_iterations")
        self.refuses(slender.NotConverged, ".", slender.run, scene, self.folder / "a", check=True)
        self.assertEqual(slender.open(self.folder / "a.vtkhdf").status, "max_iterations")

    def test_refusals(self) -> None:
        self.refuses(slender.Error, "resume .* force", slender.run, support.STRIP, self.folder / "a", resume=True,
                     force=True)
        self.refuses(slender.Error, "threads is 0", slender.run, support.STRIP, self.folder / "a", threads=0)
        path = self.folder / "bad.vtkhdf"
        self.refuses(slender.Error, "bad.vtkhdf", slender.open, path)
        path.write_bytes(b"no result")
        self.refuses(slender.Error, "bad.vtkhdf", slender.open, path)


if __name__ == "__main__":
    unittest.main()
