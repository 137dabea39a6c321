"""Solids: their motions and equilibria, with derivatives."""
import unittest
from typing import Any

import support
from support import np, slender

BLOCK: dict[str, Any] = {
    "mesh": {"shape": "box", "size": ["10 mm", "8 mm", "4 mm"], "cells": [3, 2, 1]}, "young": "0.1 MPa", "poisson": 0.45,
    "gravity": [3, 0, -9.81], "skin": {"thickness": "1 mm", "magnetization": [2e4, 0, 1e4]}}


def thrown(order: int, coupling: str) -> dict[str, Any]:
    """A block that falls onto a floor and against a ball, in a field."""
    return {"slender": 1, "job": "simulate", "solid": {"order": order, **BLOCK}, "flux_density": [0, 0.01, 0.02],
            "obstacles": [{"name": "floor", "plane": {"point": [0, 0, "-0.1 mm"]}},
                          {"name": "ball", "sphere": {"center": ["12.5 mm", "4 mm", 0], "radius": "2 mm"}}],
            "contact": {"friction": 0.3, "coupling": coupling}, "time": {"step": "1 ms", "steps": 30}}


class Solids(support.TestCase):
    def test_derivatives(self) -> None:
        """Back and forth through contact and friction, of both orders."""
        for order, coupling in ((1, "lagged"), (2, "lagged"), (2, "implicit")):
            model = support.model_of(thrown(order, coupling))
            motion = model.simulate(steps=15, dt=1e-3)
            r = np.random.default_rng(4)
            dF = {8: r.normal(size=(model.points, 3)), 15: r.normal(size=(model.points, 3))}
            dp, _, (dx, dv) = motion.vjp(dF, start=True)
            names = ("friction", "contact_stiffness", "young", "gravity", "magnetization", "volume_magnetization",
                     "flux_density")
            for name in names:
                self.assertGreater(np.abs(dp[name]).max(), 0, name)
            d = {name: r.normal(size=dp[name].shape) * max(1e-3, np.abs(model.params[name]).max()) for name in names}
            x, v = 1e-6 * r.normal(size=dx.shape), 1e-3 * r.normal(size=dv.shape)
            tangent = motion.jvp(d, dx=x, dv=v)
            back = sum(np.sum(dp[name] * d[name]) for name in d) + np.sum(dx * x) + np.sum(dv * v)
            size = sum(np.abs(dp[name] * d[name]).sum() for name in d)
            error = abs(sum(np.sum(seed * tangent[n]) for n, seed in dF.items()) - back)
            self.assertLess(error, 1e-11 * size, (order, coupling))

    def test_supports(self) -> None:
        """A block that hangs from its top bears its weight there; the result has its tetrahedra and their least det F."""
        scene = {"slender": 1, "job": "equilibrium", "solid": BLOCK, "fix": [{"group": "top"}]}
        r = slender.run(scene, self.folder / "hung", journal=False)
        weight = 1000 * 10e-3 * 8e-3 * 4e-3 * 9.81
        force = r["final/gradient"].sum(axis=0)
        self.near(force, [-3 * weight / 9.81, 0, weight], 1e-9 * weight)
        self.assertEqual(r["cells"].shape, (36, 10))
        self.assertTrue(0.9 < r["final/least_jacobian"] < 1)


if __name__ == "__main__":
    unittest.main()
