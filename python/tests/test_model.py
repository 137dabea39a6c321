"""Models: their parameters are views; equilibria and their derivatives."""
import copy
import gc
import pickle
import unittest

import support
from support import np, slender


class Parameters(support.TestCase):
    def test_views_write_into_the_model(self) -> None:
        model = support.model_of()
        before = model.equilibrium().x.copy()
        model.params["magnetization"][:] = 0
        model.params["flux_density"] = [0, 0, 0]
        after = model.equilibrium()
        self.near(after.x, model.rest, 1e-12)
        self.assertGreater(np.abs(after.x - before).max(), 1e-4)
        self.assertEqual(model.params["magnetization"].shape, (24, 3))
        self.assertEqual(model.params["young"].shape, (24,))
        self.assertEqual(model.blocks["young"].unit, "Pa")

    def test_cases(self) -> None:
        model = support.model_of(support.up_and_down())
        self.assertEqual(list(model.cases), ["up", "down"])
        self.same(model.cases["down"].params["flux_density"], [[0, 0, -0.004]])
        self.refuses(KeyError, r"model\.cases\['up'\]\.params\['flux_density'\]", lambda: model.params["flux_density"])
        self.refuses(KeyError, r"model\.params\['young'\]", lambda: model.cases["up"].params["young"])
        self.refuses(KeyError, "there is no 'yuong'; there are young", lambda: model.params["yuong"])
        self.refuses(KeyError, "say which case: there are up, down", model.equilibrium)
        self.refuses(KeyError, "no case 'left'", model.equilibrium, case="left")
        up, down = (model.equilibrium(case=case) for case in model.cases)
        self.assertEqual((up.case.name, down.case.name), ("up", "down"))
        self.assertGreater(up.x[:, 2].sum(), 0)
        self.assertLess(down.x[:, 2].sum(), 0)
        model.params["magnetization"][:] *= -1  # of all cases
        self.assertLess(model.equilibrium(case="up").x[:, 2].sum(), 0)
        self.assertGreater(model.equilibrium(case="down").x[:, 2].sum(), 0)

    def test_rest_is_the_models(self) -> None:
        model = support.model_of()
        self.assertFalse(model.rest.flags.writeable)
        self.assertEqual((model.rest.shape, model.faces.shape), ((model.points, 3), (24, 3)))
        self.assertLess(model.faces.max(), model.points)


class Ownership(support.TestCase):
    def test_views_outlive_their_objects(self) -> None:
        model = support.model_of()
        state = model.equilibrium()
        gone_state, gone_model = support.count_destroyed(state._handle), support.count_destroyed(model._handle)
        M, x, v, rest = model.params["magnetization"], state.x, state.v, model.rest
        want = x.copy()
        del model, state
        gc.collect()
        self.assertFalse(gone_state or gone_model)
        self.same(x, want)
        M[:], v[:] = 7, 1
        part = x[0]
        del x, v
        gc.collect()
        self.assertFalse(gone_state, "a view of a view keeps it, too")
        del part
        gc.collect()
        self.assertTrue(gone_state)
        self.assertFalse(gone_model)
        self.assertEqual(M.sum() + 0 * rest.sum(), 7 * M.size)
        del M, rest
        gc.collect()
        self.assertTrue(gone_model)

    def test_states_are_values(self) -> None:
        model = support.model_of()
        state = model.equilibrium()
        x = state.x.copy()
        other = copy.deepcopy(state)
        model.params["magnetization"][:] *= 0.5
        model.equilibrium(start=state)
        self.same(state.x, x)
        other.dofs[:] = 0
        other.time = 3
        self.same(state.x, x)
        self.assertEqual((state.time, other.time), (0, 3))
        self.refuses(TypeError, "cannot be pickled", pickle.dumps, state._handle)

    def test_a_state_of_another_model(self) -> None:
        a, b = support.model_of(), support.model_of()
        state = a.equilibrium()
        moved = b.equilibrium(start=state)
        self.near(moved.x, state.x, 1e-8)
        small = support.model_of(modes=0, fix=[])
        del small
        scene = support.strip()
        scene["shell"]["mesh"]["cells"] = [3, 1]
        self.refuses(slender.Error, "another model", support.model_of(scene).equilibrium, start=state)
        for function in (support.model_of(scene).energy, support.model_of(scene).gradient):
            self.refuses(slender.Error, "another model", function, state)

    def test_statics_have_the_scene_s_time(self) -> None:
        """Of fields that vary in space, too."""
        scene = support.strip(flux_density=["0", "0", "0.01*t + 0*x"], time="0.5 s")
        model = support.model_of(scene)
        start = model.state()
        start.time = 3
        later, state = model.equilibrium(start=start), model.equilibrium()
        self.assertEqual((later.time, state.time), (0.5, 0.5))
        self.same(later.x, state.x)


class Equilibria(support.TestCase):
    def test_energies(self) -> None:
        model = support.model_of()
        state = model.equilibrium()
        energies = model.energy(state)
        self.assertIn("magnetic", energies)
        self.near(sum(energies.values()), energies.total, 1e-12)
        self.near(energies.total, state.energy, 1e-12)
        self.assertEqual((state.status, model.state().status), ("converged", "start"))

    def test_gradient(self) -> None:
        """By differences; and free points are at rest."""
        model = support.model_of()
        state, h = model.equilibrium(), 1e-7
        free = np.abs(model.rest[:, 0]) > 1e-9
        self.assertLess(np.abs(model.gradient(state)[free]).max(), 1e-9)
        state.x[5] += 1e-4
        g = model.gradient(state)
        whole = model.gradient(state, dofs=True)
        self.assertEqual((g.shape, whole.shape), ((model.points, 3), (model.dofs,)))
        E = []
        for side in (1, -2):
            state.x[7, 2] += side * h
            E.append(model.energy(state).total)
        self.near((E[0] - E[1]) / (2 * h), g[7, 2], 1e-5)

    def test_derivatives(self) -> None:
        """Adjoint, tangent and differences agree; [points, 3] is [dofs] with 0 beyond."""
        model = support.model_of(support.up_and_down())
        M, size = model.params["magnetization"], 10
        direction = np.random.default_rng(1).normal(size=M.shape)
        for case in model.cases:
            state = model.equilibrium(case=case)
            dF = 2 * (state.x - model.rest)
            dp = model.vjp(state, dF)
            self.assertEqual({name: block.shape for name, block in model.blocks.items()},
                             {name: values.shape for name, values in dp.items()})
            whole = np.concatenate([dF.reshape(-1), np.zeros(model.dofs - dF.size)])
            self.same(model.vjp(state, whole)["magnetization"], dp["magnetization"])
            slope = np.sum(dp["magnetization"] * direction)
            dx = model.jvp(state, {"magnetization": direction})
            self.near(np.sum(dF * dx), slope, 1e-10)
            self.assertEqual(model.jvp(state, {"magnetization": 1}, dofs=True).shape, (model.dofs,))
            F = []
            for side in (1, -2):
                M += side * size * direction
                moved = model.equilibrium(start=state)
                self.assertEqual(moved.case.name, case)
                F.append(np.sum((moved.x - model.rest) ** 2))
            M += size * direction
            self.near((F[0] - F[1]) / (2 * size), slope, 1e-6)

    def test_refusals_of_derivatives(self) -> None:
        model = support.model_of()
        state = model.equilibrium()
        self.refuses(ValueError, r"\[points, 3\], \(21, 3\), or \[dofs\]", model.vjp, state, np.zeros(7))
        self.refuses(KeyError, "no block 'yuong'", model.jvp, state, {"yuong": 1})
        model.params["young"][:] *= 2
        self.refuses(slender.Error, "no equilibrium", model.vjp, state, np.zeros((21, 3)))

    def test_warm_starts_are_shorter(self) -> None:
        model = support.model_of()
        state = model.equilibrium()
        model.params["magnetization"][:] *= 1.01
        self.assertLess(model.equilibrium(start=state).newton_iterations, model.equilibrium().newton_iterations)

    def test_what_does_not_converge(self) -> None:
        model = support.model_of(solver={"max_iterations": 1})
        self.assertEqual(model.equilibrium().status, "max_iterations")
        error = self.refuses(slender.NotConverged, "iteration", model.equilibrium, check=True)
        self.assertEqual(getattr(error, "status"), 1)


if __name__ == "__main__":
    unittest.main()
