"""torch's own check of derivatives, on a small strip. Tensors are in units in which all of them are near 1 (1e4 A/m, 1e5 Pa,
mT, mm), so that one step of differences, 1e-3, fits all."""
import unittest
from typing import Any

import support
from support import np, slender

try:
    import torch
except ImportError as error:
    raise unittest.SkipTest("no torch here") from error

CHECK = {"eps": 1e-3, "atol": 1e-6, "rtol": 1e-5}


def tensor(values: Any, gradient: bool = True) -> torch.Tensor:
    return torch.tensor(values, dtype=torch.float64, requires_grad=gradient)


class Torch(support.TestCase):
    def test_equilibrium(self) -> None:
        model = support.model_of()
        M, B, Y = (tensor(model.params[name] / unit) for name, unit in
                   (("magnetization", 1e4), ("flux_density", 1e-3), ("young", 1e5)))

        def x(M: torch.Tensor, B: torch.Tensor, Y: torch.Tensor) -> torch.Tensor:
            return 1e3 * slender.torch.equilibrium(model, {"magnetization": 1e4 * M, "flux_density": 1e-3 * B,
                                                           "young": 1e5 * Y})
        self.assertTrue(torch.autograd.gradcheck(x, (M, B, Y), **CHECK))

    def test_simulate(self) -> None:
        model = support.model_of()
        M = tensor(model.params["magnetization"] / 1e4)
        field = tensor(np.random.default_rng(1).normal(0, 5, (5, 3)))

        def states(field: torch.Tensor, M: torch.Tensor) -> torch.Tensor:
            return 1e3 * slender.torch.simulate(model, None, 5, 1e-3, 1e-3 * field, {"magnetization": 1e4 * M})
        self.assertEqual(states(field, M).shape, (6, model.points, 3))
        self.assertTrue(torch.autograd.gradcheck(states, (field, M), **CHECK))

    def test_cases_and_what_came_between(self) -> None:
        """The backward pass is of the parameters of its own forward pass, and leaves the model as it is."""
        model = support.model_of(support.up_and_down())
        M = tensor(model.params["magnetization"].copy())
        F = torch.tensor(0.0, dtype=torch.float64)
        want = np.zeros(M.shape)
        for case, factor in (("up", 1.0), ("down", 2.0)):
            x = slender.torch.equilibrium(model, {"magnetization": factor * M}, case)
            F = F + (x[:, 2] ** 2).sum()
            state = model.equilibrium(case)
            dF = np.zeros((model.points, 3))
            dF[:, 2] = 2 * state.x[:, 2]
            want += factor * model.vjp(state, dF)["magnetization"]
        model.params["magnetization"][:] = 3
        F.backward()
        assert M.grad is not None
        self.near(M.grad.numpy(), want, 1e-9)
        self.same(model.params["magnetization"], np.full((24, 3), 3.0))

    def test_single_precision(self) -> None:
        model = support.model_of()
        M = torch.tensor(model.params["magnetization"].copy(), dtype=torch.float32, requires_grad=True)
        x = slender.torch.equilibrium(model, {"magnetization": M})
        x.sum().backward()
        assert M.grad is not None
        self.assertEqual((x.dtype, M.grad.dtype), (torch.float64, torch.float32))

    def test_refusals(self) -> None:
        model = support.model_of(solver={"max_iterations": 1})
        M = tensor(model.params["magnetization"].copy())
        self.refuses(slender.NotConverged, ".", slender.torch.equilibrium, model, {"magnetization": M})
        self.refuses(ValueError, r"has the shape \(3,\)", slender.torch.equilibrium, model, {"magnetization": M[0]})
        self.refuses(ValueError, r"\[steps, 3\]", slender.torch.simulate, model, None, 2, 1e-3, tensor(np.zeros((1, 3))))
        x = slender.torch.equilibrium(support.model_of(), {"magnetization": M})
        g, = torch.autograd.grad((x ** 2).sum(), M, create_graph=True)
        self.refuses(RuntimeError, "once_differentiable", g.sum().backward)


if __name__ == "__main__":
    unittest.main()
