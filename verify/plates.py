"""Thin plates, so little loaded that they stay linear: against Kirchhoff's theory."""
from __future__ import annotations

import math

from case import Case, Figure
from forms import denser
from grid import Grid

THICKNESS, YOUNG = 0.01, 1e9
LOAD = 0.02  # N/m^2: deflections of 1e-4 of the thickness


def stiffness(poisson: float) -> float:
    """D, N m."""
    return YOUNG * THICKNESS**3 / (12 * (1 - poisson**2))


def plate(mesh: str | dict, poisson: float, fix: dict, load: dict, bending: str = "midedge") -> dict:
    return {"job": "equilibrium",
            "shell": {"mesh": mesh, "thickness": THICKNESS, "young": YOUNG, "poisson": poisson, "bending": bending},
            "fix": [fix], "loads": [load]}


def square(pattern: str, clamped: bool, cells: int, bending: str = "midedge") -> Case:
    grid = Grid((cells, cells), lambda u, v: (u, v, 0), pattern)
    edge = {"boundary": True, "clamp": True} if clamped else {"boundary": True}
    return Case(
        name=f"{'clamped' if clamped else 'supported'} square, {pattern}{', hinges' if bending == 'hinge' else ''}",
        source="Timoshenko, Woinowsky-Krieger 1959, tables 8 and 35, series with more digits",
        mesh=f"{cells} x {cells} cells",
        scenes=[plate("plate.obj", 0.3, edge, {"area": [0, 0, -LOAD]}, bending)], files={"plate.obj": grid.obj()},
        figures=[Figure("w D/(q a^4) in the middle",
                        lambda r: -r.moved(0.5, 0.5, 0)[2] * stiffness(0.3) / LOAD,
                        0.00126532 if clamped else 0.00406235, 0.01,
                        miss="hinges alone do not converge on such meshes (docs/theory.md)" if bending == "hinge" else "")])


def central_force() -> Case:
    grid = Grid((48, 48), lambda u, v: (u, v, 0), "alternate")
    force = {"force": [0, 0, -LOAD], "on": {"vertices": [grid.nearest(0.5, 0.5)]}}
    return Case(
        name="supported square, force in the middle", source="Timoshenko, Woinowsky-Krieger 1959, table 23",
        mesh="48 x 48 cells", files={"plate.obj": grid.obj()},
        scenes=[plate("plate.obj", 0.3, {"boundary": True}, force)],
        figures=[Figure("w D/(P a^2) there", lambda r: -r.moved(0.5, 0.5, 0)[2] * stiffness(0.3) / LOAD, 0.0116008, 0.01)])


def circle(clamped: bool) -> Case:
    edge = {"group": "rim", "clamp": True} if clamped else {"group": "rim"}
    scene = plate({"shape": "disc", "size": 2, "n": 24}, 0.3, edge, {"area": [0, 0, -LOAD]})

    return Case(
        name=f"{'clamped' if clamped else 'supported'} circle",
        source="Timoshenko, Woinowsky-Krieger 1959, eqs. 62 and 68", mesh="disc, n = 24", scenes=[scene],
        figures=[Figure("w D/(q a^4) in the middle", lambda r: -r.moved(0, 0, 0)[2] * stiffness(0.3) / LOAD,
                        1 / 64 if clamped else 5.3 / 1.3 / 64, 0.01)])


def skew() -> Case:
    cells, angle = 128, math.radians(30)

    def place(u: float, v: float) -> tuple:
        a, b = denser(u, 0.93), denser(v, 0.93)  # towards the corners, which are singular
        return a + b * math.cos(angle), b * math.sin(angle), 0
    grid = Grid((cells, cells), place, "crossed")
    middle = grid.points[grid.nearest(0.5, 0.5)]
    return Case(
        name="supported rhombus, 30 degrees", source="Morley 1963", mesh=f"{cells} x {cells} cells, crossed, denser at the corners",
        scenes=[plate("plate.obj", 0.3, {"boundary": True}, {"area": [0, 0, -LOAD]})], files={"plate.obj": grid.obj()},
        figures=[Figure("w D/(q a^4) in the middle", lambda r: -r.moved(*middle)[2] * stiffness(0.3) / LOAD, 0.000408, 0.01)])


def cantilever(poisson: float) -> Case:
    length, width = 1.0, 0.02
    grid = Grid((200, 4), lambda u, v: (length * u, width * v, 0), "crossed")
    root = {"vertices": grid.where(lambda u, v: u == 0), "clamp": True}
    load = {"line": [0, 0, -1e-4], "on": {"vertices": grid.where(lambda u, v: u == 1)}}
    bending = YOUNG * THICKNESS**3 / 12  # of a narrow strip, per width
    return Case(
        name=f"cantilever, nu {poisson}", source="Bernoulli's beam: F L^3/(3 EI)", mesh="200 x 4 cells, crossed",
        scenes=[plate("plate.obj", poisson, root, load)], files={"plate.obj": grid.obj()},
        figures=[Figure("w 3 EI/(F L^3) of the end", lambda r: -r.moved(length, width / 2, 0)[2] * 3 * bending / 1e-4, 1, 0.01)])


CASES = [square(pattern, clamped, 48 if pattern == "crossed" else 64)
         for clamped in (False, True) for pattern in ("right", "crossed", "unstructured")]
CASES += [square("unstructured", False, 64, "hinge"), square("crossed", True, 48, "hinge"), central_force(), circle(True), circle(False), skew()]
CASES += [cantilever(nu) for nu in (0, 0.3, 0.49)]
