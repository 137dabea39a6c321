"""Bodies that meet something: motions on a slope, and what results say of it."""
import unittest
from typing import Any

import support
from support import np, slender

G, SLOPE, MU = 9.81, 0.5, 0.2  # the slope's tangent


def plate(**keys: Any) -> dict[str, Any]:
    """10 x 10 x 1 mm on a plane, in weight that pulls it along x, too."""
    down = G / np.hypot(1, SLOPE)
    return {"slender": 1, "job": "simulate",
            "shell": {"mesh": {"shape": "sheet", "size": ["10 mm", "10 mm"], "cells": [4, 4]}, "thickness": "1 mm",
                      "young": "1 MPa", "poisson": 0.3, "density": 1000, "gravity": [SLOPE * down, 0, -down]},
            "obstacles": [{"name": "slope", "plane": {"point": [0, 0, "-0.5 mm"]}}],
            "contact": {"friction": MU}, "time": {"step": "1 ms", "steps": 50}, "output": {"every": 10}, **keys}


class Worlds(support.TestCase):
    def test_a_slide(self) -> None:
        """v(t2) - v(t1) = g (sin a - mu cos a)(t2 - t1)."""
        motion = support.model_of(plate()).simulate(steps=50, dt=1e-3)
        v = [motion.states[n].v[:, 0].mean() for n in (20, 50)]
        self.near((v[1] - v[0]) / 0.03, G * (SLOPE - MU) / np.hypot(1, SLOPE), 1e-3)

    def test_derivatives(self) -> None:
        """Back and forth through contact and friction, with both couplings."""
        for coupling in ("lagged", "implicit"):
            model = support.model_of(plate(contact={"friction": MU, "coupling": coupling}))
            motion = model.simulate(steps=20, dt=1e-3)
            r = np.random.default_rng(4)
            dF = {10: r.normal(size=(model.points, 3)), 20: r.normal(size=(model.points, 3))}
            dp, _, (dx, dv) = motion.vjp(dF, start=True)
            for name in ("friction", "contact_stiffness", "young", "gravity"):
                self.assertGreater(np.abs(dp[name]).max(), 0, name)
            d = {name: r.normal(size=dp[name].shape) * np.abs(model.params[name]).max()
                 for name in ("friction", "contact_stiffness", "young", "gravity")}
            x, v = 1e-6 * r.normal(size=dx.shape), 1e-3 * r.normal(size=dv.shape)
            tangent = motion.jvp(d, dx=x, dv=v)
            back = sum(np.sum(dp[name] * d[name]) for name in d) + np.sum(dx * x) + np.sum(dv * v)
            size = sum(np.abs(dp[name] * d[name]).sum() for name in d)
            error = abs(sum(np.sum(seed * tangent[n]) for n, seed in dF.items()) - back)
            self.assertLess(error, 1e-11 * size, coupling)

    def test_a_history(self) -> None:
        """A motion tells what a simulation's history does; one that meets nothing, nothing."""
        scene = plate(contact={"friction": MU, "self": True})
        motion = support.model_of(scene).simulate(steps=50, dt=1e-3)
        told, r = motion.history, slender.run(scene, self.folder / "history", journal=False).history
        own = {"newton_iterations", "factorizations", "cg_iterations", "time", "pierced"}  # of its steps
        self.assertEqual(set(told), set(r) - own)
        self.assertIn("self_contacts", told)
        for name, rows in told.items():
            self.assertEqual(rows.shape, r[name].shape)
            known = np.isfinite(r[name])  # nothing is near: at no distance
            self.same(np.isfinite(rows), known)
            self.near(np.where(known, rows, 0), np.where(known, r[name], 0), 1e-5)
        self.assertGreater(told["friction_work"][2:].min(), 0)  # lagged by a step
        free = plate()
        del free["obstacles"], free["contact"]
        self.assertEqual(dict(support.model_of(free).simulate(steps=2, dt=1e-3).history), {})

    def test_a_result(self) -> None:
        """Contact is in histories, frames and datasets; a plane that moves has its pose in each frame."""
        scene = plate()
        scene["obstacles"][0]["move"] = ["0.1*t", "0", "0"]
        r = slender.run(scene, self.folder / "slide", journal=False)
        self.assertEqual(r["obstacle_names"].split(), ["slope"])
        self.assertEqual(r["obstacles/slope/kind"], "plane")
        self.assertEqual((r["obstacles/slope/points"].shape[1], r["obstacles/slope/faces"].dtype), (3, np.int32))
        pose = r["frames/obstacle_pose"].reshape(len(r.frames), 1, 3, 4)
        self.same(pose[-1, 0, :, :3], np.eye(3))
        self.near(pose[:, 0, :, 3], np.array([[0.001 * n, 0, 0] for n in range(6)]), 1e-12)
        self.assertEqual(r.history["contact_force"].shape, (50, 1, 3))
        self.near(r.frames[-1]["contact_force"].sum(axis=0), r["final/contact_force"][0], 1e-5)
        self.near(r["final/contact_force"][0, 2], 1e-4 * G / np.hypot(1, SLOPE), 1e-2)  # of 0.1 g


if __name__ == "__main__":
    unittest.main()
