"""Solids: their motions and equilibria, with derivatives."""
import itertools
import pathlib
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


def write_bar(path: pathlib.Path, nodes: Any, cells: Any, second: Any) -> str:
    """A .msh of tetrahedra in two groups: `second` tells of each whether it is in that one."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '3 1 "first"', '3 2 "second"',
             "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{k + 1} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(np.asarray(nodes).tolist())]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{k + 1} 4 2 {1 + b} {1 + b} " + " ".join(str(n + 1) for n in cell)
              for k, (cell, b) in enumerate(zip(cells, map(int, second)))]
    path.write_text("\n".join(lines + ["$EndElements", ""]))
    return str(path)


def bar(cells: tuple[int, int, int], size: float) -> Any:
    """Nodes and tetrahedra of a bar of cubes, six each [Freudenthal 1942]."""
    counts = np.array(cells) + 1
    nodes = size * np.indices(counts).reshape(3, -1).T
    tets = []
    for corner in np.ndindex(*cells):
        for order in itertools.permutations(range(3)):
            way = [np.array(corner)]
            for axis in order:
                way.append(way[-1] + np.eye(3, dtype=int)[axis])
            tet = [int(np.ravel_multi_index(tuple(place), counts)) for place in way]
            if np.linalg.det([way[k + 1] - way[0] for k in range(3)]) < 0:
                tet[2], tet[3] = tet[3], tet[2]
            tets.append(tet)
    return nodes, tets


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

    def test_two_materials(self) -> None:
        """The moduli of a bar's two halves, and that of its film, are found again from how it hangs."""
        nodes, tets = bar((6, 1, 1), 5e-3)
        second = [nodes[tet, 0].mean() > 15e-3 for tet in tets]
        scene: dict[str, Any] = {
            "slender": 1, "job": "equilibrium", "fix": [{"box": [[-1, -1, -1], [1e-6, 1, 1]]}],
            "solid": {"mesh": write_bar(self.folder / "bar.msh", nodes, tets, second), "order": 1, "averaging": 1,
                      "young": {"groups": {"first": "80 kPa", "second": "200 kPa"}}, "poisson": 0.4, "gravity": [1, 0, -9.81],
                      "skin": {"thickness": "0.5 mm", "young": "0.3 MPa", "poisson": 0.3}}}
        hung = slender.run(scene, self.folder / "hung", journal=False)
        self.assertEqual(hung.status, "converged")
        self.assertGreater(np.abs(hung["state/x"] - nodes).max(), 1e-4)
        target = write_bar(self.folder / "target.msh", hung["state/x"], tets, second)
        scene.update(job="design", target={"file": target}, solver={"step_tolerance": 1e-12}, design={
            "objectives": [{"target": 1}], "optimizer": "gauss_newton", "iterations": 40, "tolerance": 1e-12,
            "unknowns": {"young": {"per": "group", "start": "120 kPa"}}})
        found = slender.run(scene, self.folder / "found", journal=False)
        want = np.where(second, 2e5, 8e4)
        self.near(found["design/young"] / want, 1, 1e-6)
        scene["design"]["unknowns"] = {"skin_young": {"start": "0.2 MPa"}}
        scene["design"]["iterations"] = 20
        film = slender.run(scene, self.folder / "film", journal=False)
        self.assertLess(film.history["objective"].min(), 1e-4 * film.history["objective"][0])

    def test_tangled(self) -> None:
        """A cube that its load turns inside out: no job calls that an equilibrium."""
        cube: dict[str, Any] = {
            "slender": 1, "job": "equilibrium", "fix": [{"group": "left"}],
            "solid": {"mesh": {"shape": "box", "size": [0.01] * 3, "cells": [2, 2, 2]}, "young": "10 kPa", "poisson": 0.4},
            "loads": [{"on": {"group": "right"}, "force": [-30, 0, 0]}]}
        r = slender.run(cube, self.folder / "a")
        self.assertEqual(r.status, "tangled")
        self.assertLess(r["final/least_jacobian"], 0)
        design = {**cube, "job": "design", "target": {"formula": ["x", "y", "z"]},
                  "design": {"unknowns": {"young": {}}, "objectives": [{"target": 1}], "iterations": 2}}
        self.assertEqual(slender.run(design, self.folder / "b").status, "unsolved")
        time = {"step": "1 ms", "steps": 3}
        self.assertEqual(slender.run({**cube, "job": "simulate", "time": time}, self.folder / "c").status, "tangled")
        trajectory = {**cube, "job": "trajectory", "time": time, "design": {
            "unknowns": {"young": {}}, "objectives": [{"waypoint": {"mass_center": True, "at": [0, 0, 0]}}], "iterations": 2}}
        self.assertEqual(slender.run(trajectory, self.folder / "d").status, "unsolved")

    def test_water(self) -> None:
        """A falling cube is borne by its lower side alone: 2 rho A v^2 = rho A h g."""
        for order in (1, 2):
            scene = {"slender": 1, "job": "simulate", "water": {},
                     "solid": {"mesh": {"shape": "box", "size": [0.01] * 3, "cells": [2, 2, 2]}, "order": order,
                               "young": "1 MPa", "poisson": 0.3, "density": 3000, "gravity": [0, 0, -9.81]},
                     "time": {"step": "5 ms", "steps": 40}}
            model = support.model_of(scene)
            motion = model.simulate(steps=40, dt=5e-3)
            self.near(motion.states[40].v[:, 2].mean(), -np.sqrt(3 * 9.81 * 0.01 / 2), 2e-4)

    def test_modes(self) -> None:
        """A free solid has six motions that cost nothing, and no more."""
        scene = {"slender": 1, "job": "equilibrium", "modes": 7, "solid": {**BLOCK, "gravity": [0, 0, 0]}}
        values = slender.run(scene, self.folder / "free", journal=False)["final/eigenvalues"]
        self.assertLess(np.abs(values[:6]).max(), 1e-6 * values[6])

    def test_bending_frequency(self) -> None:
        """A cantilever that is let go swings as Euler and Bernoulli say; implicit Euler lags, w dt -> atan(w dt)."""
        length, height, young, dt = 0.06, 0.003, 1e6, 5e-4
        scene = {"slender": 1, "job": "simulate", "fix": [{"group": "left"}],
                 "solid": {"mesh": {"shape": "box", "size": [length, height, height], "cells": [20, 1, 1]}, "young": young,
                           "poisson": 0.3, "gravity": [0, 0, -0.1]}, "time": {"step": dt, "steps": 1}}
        model = support.model_of(scene)
        start = model.equilibrium()
        model.params["gravity"] = [0, 0, 0]
        motion = model.simulate(start, steps=1600, dt=dt)
        rest = model.state().x
        tip = np.argmax(rest[:, 0])
        z = np.array([motion.states[n].x[tip, 2] - rest[tip, 2] for n in range(1601)])
        at = np.flatnonzero(z[:-1] * z[1:] < 0)
        zero = at + z[at] / (z[at] - z[at + 1])
        self.assertGreater(len(zero), 5)
        turn = np.pi / np.diff(zero).mean()  # per step
        want = 1.8751041**2 / length**2 * np.sqrt(young * height**2 / 12 / 1000)
        self.near(np.tan(turn) / dt / want, 1, 0.02)

    def test_loads(self) -> None:
        """Forces and tractions on a side's group: what bears them; an even traction stretches evenly."""
        for order, load in ((1, {"area": [2, 0, 0]}), (2, {"area": [2, 0, 0]}), (2, {"force": [2e-4, 0, 0]})):
            scene = {"slender": 1, "job": "equilibrium", "fix": [{"group": "left"}],
                     "solid": {"mesh": {"shape": "box", "size": ["20 mm", "10 mm", "10 mm"], "cells": [4, 2, 2]}, "order": order,
                               "averaging": 0.5, "young": "0.1 MPa", "poisson": 0},
                     "loads": [{"on": {"group": "right"}, **load}]}
            r = slender.run(scene, self.folder / "a", force=True)
            self.near(r["final/gradient"].sum(axis=0) + [2e-4, 0, 0] + [1, 1, 1], [1, 1, 1], 1e-12)
            moved = (r["state/x"] - r["rest"])[r["rest"][:, 0] > 0.0199, 0] / (2 / 1e5 * 0.02)
            self.near(moved if "area" in load else moved.mean(), 1, 1e-5 if "area" in load else 0.2)
        scene["loads"] = [{"line": [1, 0, 0]}]
        self.refuses(slender.Error, "no boundary edge", slender.run, scene, self.folder / "b")

    def test_pose(self) -> None:
        """A job that starts from a pose of all nodes is where the pose is; one of other nodes is refused."""
        nodes, tets = bar((2, 1, 1), 5e-3)
        half = [True] * 6 + [False] * 6
        mesh, moved = (write_bar(self.folder / name, x, tets, half)
                       for name, x in (("bar.msh", nodes), ("moved.msh", nodes * [1.1, 1, 1])))
        scene: dict[str, Any] = {"slender": 1, "job": "evaluate", "solid": {
            "mesh": mesh, "order": 1, "averaging": 1, "young": "0.1 MPa", "poisson": 0, "pose": moved}}
        r = slender.run(scene, self.folder / "a")
        self.near(r["state/x"], nodes * [1.1, 1, 1], 1e-15)
        mu, J = 5e4, 1.1  # of poisson 0
        psi = mu / 2 * (J**2 - 1) - mu * (J - 1) + mu / 2 * (J - 1)**2
        self.near(r["final/energy/elastic"] + r["final/energy/mean_dilation"], psi * 10e-3 * 25e-6, 1e-12)
        scene["solid"].update(order=2, averaging=0)
        self.refuses(slender.Error, "moved.msh has 12 vertices, and the mesh 45", slender.run, scene, self.folder / "b")


if __name__ == "__main__":
    unittest.main()
