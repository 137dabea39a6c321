"""Curved shells, and shells that move far: the classical obstacle course."""
from __future__ import annotations

import math

from case import Case, Figure
from forms import denser
from grid import Grid

SZE = "Sze, Liu, Lo 2004"


def equilibrium(thickness: float, young: float, poisson: float, fix: list, loads: list, **more) -> dict:
    return {"job": "equilibrium",
            "shell": {"mesh": "shell.obj", "thickness": thickness, "young": young, "poisson": poisson},
            "fix": fix, "loads": loads, **more}


def point_force(grid: Grid, u: float, v: float, force: list) -> dict:
    return {"force": force, "on": {"vertices": [grid.nearest(u, v)]}}


# ---- Linear: loads so small that nothing else counts ----

def scordelis_lo(cells: int = 56, pattern: str = "crossed") -> Case:
    radius, length, part = 25.0, 50.0, 1e-4
    grid = Grid((cells, cells), lambda u, v: (radius * math.sin(math.radians(80 * u - 40)), length * v,
                                              radius * math.cos(math.radians(80 * u - 40))), pattern)
    edge = grid.points[grid.nearest(0, 0.5)]
    fix = [{"vertices": grid.where(lambda u, v: v in (0, 1)), "axes": "xz"}, {"vertices": [grid.nearest(0.5, 0)], "axes": "y"}]
    return Case(
        name="Scordelis-Lo roof", source="MacNeal, Harder 1985: 0.3024 with shear; without it 0.3006 [Kiendl et al. 2009]",
        mesh=f"{cells} x {cells} cells, {pattern}", files={"shell.obj": grid.obj()},
        scenes=[equilibrium(0.25, 4.32e8, 0, fix, [{"area": [0, 0, -90 * part]}])],
        figures=[Figure("w in the middle of the free edge", lambda r: -r.moved(*edge)[2] / part, 0.3006, 0.01)])


def pinched_cylinder(cells: int = 56, pattern: str = "crossed") -> Case:
    radius, length = 300.0, 600.0

    def place(u: float, v: float) -> tuple:
        angle = 2 * math.pi * denser(u, 0.8, 2)
        return radius * math.sin(angle), length * denser(v, 0.8, 2), radius * math.cos(angle)
    grid = Grid((2 * cells, cells), place, pattern, wrap=True)
    fix = [{"vertices": grid.where(lambda u, v: v in (0, 1)), "axes": "xz"}, {"vertices": [grid.nearest(0, 0.5)], "axes": "y"}]
    loads = [point_force(grid, 0, 0.5, [0, 0, -1]), point_force(grid, 0.5, 0.5, [0, 0, 1])]
    return Case(
        name="pinched cylinder", source="Lindberg, Olson, Cowper 1969: w = 164.24 P/(E h)",
        mesh=f"{2 * cells} x {cells} cells, {pattern}, denser under the forces", files={"shell.obj": grid.obj()},
        scenes=[equilibrium(3, 3e6, 0.3, fix, loads)],
        figures=[Figure("w E h/P under the force", lambda r: -r.moved(0, 300, 300)[2] * 3e6 * 3, 164.24, 0.01)])


def hyperbolic_paraboloid(thickness: float, load: float, reference: float, cells: int) -> Case:
    part = 1e-6 if thickness < 5e-4 else 1e-5
    grid = Grid((cells, cells), lambda u, v: (u - 0.5, v - 0.5, (u - 0.5) ** 2 - (v - 0.5) ** 2), "crossed")
    fix = [{"vertices": grid.where(lambda u, v: u == 0), "clamp": True}]
    return Case(
        name=f"hyperbolic paraboloid, h/L {thickness:g}", source="Bathe, Iosilevich, Chapelle 2000",
        mesh=f"{cells} x {cells} cells, crossed", files={"shell.obj": grid.obj()},
        scenes=[equilibrium(thickness, 2e11, 0.3, fix, [{"area": [0, 0, -load * part]}])],
        figures=[Figure("w of the free side's middle, m", lambda r: -r.moved(0.5, 0, 0.25)[2] / part, reference, 0.01)])


def twisted_beam(axis: int, reference: float) -> Case:
    force, width = 1e-9, 1.1

    def place(u: float, v: float) -> tuple:
        angle, across = math.pi / 2 * u, width * (v - 0.5)
        return 12 * u, across * math.cos(angle), across * math.sin(angle)
    grid = Grid((96, 10), place)
    fix = [{"vertices": grid.where(lambda u, v: u == 0), "clamp": True}]
    direction = [0, 0, 0]
    direction[axis] = force
    loads = [point_force(grid, 1, 0.5, direction)]
    return Case(
        name=f"twisted beam, force {'within' if axis == 2 else 'across'} its end",
        source="MacNeal, Harder 1985, with h = 0.0032 [Belytschko, Wong, Stolarski 1989]", mesh="96 x 10 cells",
        files={"shell.obj": grid.obj()}, scenes=[equilibrium(0.0032, 29e6, 0.22, fix, loads)],
        figures=[Figure("of the end along the force, for 1e-6", lambda r: r.moved(12, 0, 0)[axis] * 1e-6 / force, reference, 0.01)])


# ---- Large displacements ----

def sze_cantilever() -> Case:
    grid = Grid((40, 4), lambda u, v: (10 * u, v, 0))
    fix = [{"vertices": grid.where(lambda u, v: u == 0), "clamp": True}]
    loads = [{"line": [0, 0, 4], "on": {"vertices": grid.where(lambda u, v: u == 1)}}]
    return Case(
        name="Sze 3.1, cantilever, end shear", source=f"{SZE}, 3.1; elastica, P L^2/EI = 4", mesh="40 x 4 cells",
        files={"shell.obj": grid.obj()}, scenes=[equilibrium(0.1, 1.2e6, 0, fix, loads)],
        figures=[Figure("-U of the end", lambda r: -r.moved(10, 0.5, 0)[0], 3.2894124, 0.01),
                 Figure("W", lambda r: r.moved(10, 0.5, 0)[2], 6.6996418, 0.01)])


def sze_roll() -> Case:
    """Shells bear no end moment here: the end is held where that moment takes it, and the rest has to follow."""
    length, cells, angle = 12.0, 48, 2 * math.pi
    grid = Grid((cells, 4), lambda u, v: (length * u, v, 0))
    root = {"vertices": grid.where(lambda u, v: u < 1.5 / cells)}
    arc = f"{length}/({angle!r}*max(t, 1e-9))"
    move = [f"{arc}*sin({angle!r}*t*x/{length})", "y", f"{arc}*(1 - cos({angle!r}*t*x/{length}))"]
    fix = [{**part, "move": move} for part in (root, {"vertices": grid.where(lambda u, v: u > 1 - 1.5 / cells)})]
    scene = equilibrium(0.1, 1.2e6, 0, fix, [])
    del scene["loads"]
    scene["sequence"] = {"time": {"from": 0.05, "to": 1, "count": 20}}
    bending = 1.2e6 * 0.1**3 / 12
    return Case(
        name="Sze 3.2, cantilever rolled up", source=f"{SZE}, 3.2, by its end's place instead of its moment",
        mesh=f"{cells} x 4 cells", files={"shell.obj": grid.obj()}, scenes=[scene],
        figures=[Figure("W in the middle", lambda r: r.moved(6, 0.5, 0)[2], length / math.pi, 0.01),
                 Figure("energy of what is between the held cells", lambda r: r.energy(),
                        bending * angle**2 / (2 * length) * (1 - 1 / cells), 0.01)])


def sze_annulus(cells: int = 12, pattern: str = "crossed") -> Case:
    def place(u: float, v: float) -> tuple:
        radius, angle = 6 + 4 * v, 2 * math.pi * u
        return radius * math.cos(angle), radius * math.sin(angle), 0
    grid = Grid((10 * cells, cells), place, pattern)
    fix = [{"vertices": grid.where(lambda u, v: u == 0), "clamp": True}]
    loads = [{"line": [0, 0, 0.8], "on": {"vertices": grid.where(lambda u, v: u == 1)}}]

    def lifted(v: float):
        vertex = grid.nearest(1, v)
        return lambda r: r.x[vertex][2]
    return Case(
        name="Sze 3.3, slit annulus", source=f"{SZE}, 3.3", mesh=f"{10 * cells} x {cells} cells, {pattern}",
        files={"shell.obj": grid.obj()}, scenes=[equilibrium(0.03, 21e6, 0, fix, loads)],
        figures=[Figure("W_A", lifted(0), 13.891, 0.01), Figure("W_B", lifted(1), 17.528, 0.01)])


def sze_hemisphere(cells: int = 40, pattern: str = "alternate") -> Case:
    def place(u: float, v: float) -> tuple:
        angle, height = 2 * math.pi * u, math.radians(72 * v)
        return 10 * math.cos(height) * math.cos(angle), 10 * math.cos(height) * math.sin(angle), 10 * math.sin(height)
    grid = Grid((5 * cells, cells), place, pattern, wrap=True)
    loads = [point_force(grid, k / 4, 0, f) for k, f in enumerate(([400, 0, 0], [0, -400, 0], [-400, 0, 0], [0, 400, 0]))]
    fix = [{"vertices": [grid.nearest(0, 0), grid.nearest(0.5, 0)], "axes": "yz"},  # rigid motions only
           {"vertices": [grid.nearest(0, 1)], "axes": "y"}, {"vertices": [grid.nearest(0.25, 0)], "axes": "x"}]
    return Case(
        name="Sze 3.4, pinched hemisphere", source=f"{SZE}, 3.4", mesh=f"{5 * cells} x {cells} cells, {pattern}",
        files={"shell.obj": grid.obj()},
        scenes=[equilibrium(0.04, 6.825e7, 0.3, fix, loads)],
        figures=[Figure("V_A, outwards", lambda r: r.moved(10, 0, 0)[0], 4.067, 0.01),
                 Figure("-U_B, inwards", lambda r: -r.moved(0, 10, 0)[1], 8.178, 0.01)])


def sze_pull_out(cells: int = 48, pattern: str = "alternate") -> Case:
    radius, length = 4.953, 10.35
    grid = Grid((2 * cells, cells), lambda u, v: (radius * math.sin(2 * math.pi * u), length * (v - 0.5),
                                                  radius * math.cos(2 * math.pi * u)), pattern, wrap=True)
    loads = [point_force(grid, 0, 0.5, [0, 0, 40000]), point_force(grid, 0.5, 0.5, [0, 0, -40000])]
    fix = [{"vertices": [grid.nearest(0, 0.5), grid.nearest(0.5, 0.5)], "axes": "xy"},  # rigid motions only
           {"vertices": [grid.nearest(0.25, 0.5)], "axes": "yz"}]
    return Case(
        name="Sze 3.5, pulled out cylinder", source=f"{SZE}, 3.5", mesh=f"{2 * cells} x {cells} cells, {pattern}",
        files={"shell.obj": grid.obj()}, scenes=[equilibrium(0.094, 10.5e6, 0.3125, fix, loads, load_steps=10)],
        figures=[Figure("W_A", lambda r: (r.moved(0, 0, radius)[2] - r.moved(0, 0, -radius)[2]) / 2, 2.768, 0.01),
                 Figure("-U_B", lambda r: (r.moved(-radius, 0, 0)[0] - r.moved(radius, 0, 0)[0]) / 2, 4.551, 0.01)])


def sze_roof(down: float, force: float, cells: int = 40, pattern: str = "alternate") -> Case:
    """By the middle's deflection, since its force has a limit point."""
    radius, half = 2540.0, 254.0
    grid = Grid((cells, cells), lambda u, v: (radius * math.sin(0.2 * u - 0.1), 2 * half * (v - 0.5),
                                              radius * (math.cos(0.2 * u - 0.1) - 1)), pattern)
    middle = grid.nearest(0.5, 0.5)
    fix = [{"vertices": grid.where(lambda u, v: u in (0, 1))},
           {"vertices": [middle], "axes": "z", "move": ["0", "0", f"z - {down}*t"]}]
    scene = equilibrium(12.7, 3102.75, 0.3, fix, [])
    del scene["loads"]
    scene["sequence"] = {"time": {"from": 0.1, "to": 1, "count": 10}}
    return Case(
        name=f"Sze 3.7, hinged roof, W = {down}", source=f"{SZE}, 3.7, h = 12.7", mesh=f"{cells} x {cells} cells, {pattern}",
        files={"shell.obj": grid.obj()}, scenes=[scene],
        figures=[Figure("P/3000 in the middle", lambda r: -r["final/support_force"][1][2] / 3000, force, 0.01)])


CASES = [scordelis_lo(), pinched_cylinder(), hyperbolic_paraboloid(1e-3, 8, 6.3941e-3, 64),
         hyperbolic_paraboloid(1e-4, 0.8, 5.2988e-1, 80), twisted_beam(2, 5.256e-3), twisted_beam(1, 1.294e-3),
         sze_cantilever(), sze_roll(), sze_annulus(), sze_hemisphere(), sze_pull_out(), sze_roof(5.802, 0.5647),
         sze_roof(10.358, 0.7412)]
