"""Solids: uniform stretches by their energies, bending, torsion, and Cook's membrane."""
from __future__ import annotations

import math
from typing import Callable

from case import Case, Figure
from forms import bisect
from grid import Grid

SIDE, YOUNG = 0.01, 1e5
LAME = {"neo_hookean": lambda mu, la, J: (la + mu) * (J - 1) - mu,      # V'(J) of mu/2 (I - 3) + V(J)
        "neo_hookean_log": lambda mu, la, J: (la * math.log(J) - mu) / J}
ROLLERS = [{"group": "left", "axes": "x"}, {"group": "front", "axes": "y"}, {"group": "bottom", "axes": "z"}]


def stress(material: str, poisson: float) -> Callable[[float, float, float], float]:
    """First Piola's along the first of three stretches, Pa."""
    mu, la = YOUNG / (2 * (1 + poisson)), YOUNG * poisson / ((1 + poisson) * (1 - 2 * poisson))

    def hooke(a: float, b: float, c: float) -> float:
        strains = [(s * s - 1) / 2 for s in (a, b, c)]
        return a * (la * sum(strains) + 2 * mu * strains[0])
    if material == "st_venant_kirchhoff":
        return hooke
    return lambda a, b, c: mu * a + LAME[material](mu, la, a * b * c) * b * c


def box(size: list, cells: list, poisson: float, fix: list, loads: list, **more) -> dict:
    return {"job": "equilibrium",
            "solid": {"mesh": {"shape": "box", "size": size, "cells": cells}, "young": YOUNG, "poisson": poisson, **more},
            "fix": fix, "loads": loads}


def pulled(material: str, poisson: float, stretch: float, both: bool) -> Case:
    """A cube on rollers, pulled along x (and y) to a stretch; what is free follows."""
    first = stress(material, poisson)
    if both:
        thin = bisect(lambda c: first(c, stretch, stretch), 0.3, 1.5)
        load, pulls = first(stretch, stretch, thin), ("right", "back")
    else:
        thin = bisect(lambda c: first(c, c, stretch), 0.3, 1.5)
        load, pulls = first(stretch, thin, thin), ("right",)
    loads = [{"area": [load if side == "right" else 0, load if side == "back" else 0, 0], "on": {"group": side}} for side in pulls]
    return Case(
        name=f"{'equibiaxial' if both else 'uniaxial'} stretch, {material}, nu {poisson}",
        source="Ogden 1984, section 4.3; Bonet, Wood 2008" if material != "st_venant_kirchhoff" else "Ogden 1984",
        mesh="3 x 3 x 3 cells, quadratic", scenes=[box([SIDE] * 3, [3, 3, 3], poisson, ROLLERS, loads, material=material)],
        figures=[Figure("stretch", lambda r: 1 + r.moved(SIDE, SIDE, SIDE)[0] / SIDE, stretch, 1e-6),
                 Figure("thickness", lambda r: 1 + r.moved(SIDE, SIDE, SIDE)[2] / SIDE, thin, 1e-6)])


def bar(poisson: float, order: int = 2) -> Case:
    """Its left side stays plane and upright, and may become narrower."""
    length, side, force, e = 0.2, 0.01, 1e-5, 1e-6
    middle = [side / 2 - e, side / 2 + e]
    fix = [{"group": "left", "axes": "x"}, {"box": [[-e, middle[0], -1], [e, middle[1], 1]], "axes": "y"},
           {"box": [[-e, middle[0], middle[0]], [e, middle[1], middle[1]]], "axes": "z"}]
    inertia = side**4 / 12
    w = force * length**3 / (3 * YOUNG * inertia) + 1.2 * force * length * 2 * (1 + poisson) / (YOUNG * side**2)
    return Case(
        name=f"bent bar, nu {poisson}" + (", linear" if order == 1 else ""), source="Timoshenko, Goodier 1970, art. 21",
        mesh=f"60 x 4 x 4 cells, {'linear' if order == 1 else 'quadratic'}",
        scenes=[box([length, side, side], [60, 4, 4], poisson, fix,
                    [{"area": [0, 0, -force / side**2], "on": {"group": "right"}}], order=order)],
        figures=[Figure("w of its end, m", lambda r: -r.moved(length, side / 2, side / 2)[2], w, 0.01,
                        miss="linear tetrahedra do not bend: they shear, and lock" if order == 1 else "")])


def torsion() -> Case:
    """Ends turned against each other, free to warp."""
    length, side, poisson, angle = 0.1, 0.01, 0.3, 0.01
    middle = side / 2
    turn = ["0", f"{middle} + (y - {middle})*cos({angle}*t) - (z - {middle})*sin({angle}*t)",
            f"{middle} + (y - {middle})*sin({angle}*t) + (z - {middle})*cos({angle}*t)"]
    scene = box([length, side, side], [20, 6, 6], poisson,
                [{"group": "left", "axes": "yz"}, {"group": "right", "axes": "yz", "move": turn},
                 {"box": [[-1e-6, middle - 1e-6, middle - 1e-6], [1e-6, middle + 1e-6, middle + 1e-6]], "axes": "x"}], [])
    del scene["loads"]
    scene["time"] = 1
    rigidity = YOUNG / (2 * (1 + poisson)) * 0.140577 * side**4
    return Case(
        name="twisted square bar", source="Saint-Venant 1855: 0.140577 G a^4", mesh="20 x 6 x 6 cells, quadratic", scenes=[scene],
        figures=[Figure("energy, of G J angle^2/(2 L)", lambda r: r.energy() / (rigidity * angle**2 / (2 * length)), 1, 0.01)])


# ---- Cook's membrane, 48 x (44, 16), here in m ----

def cook_place(u: float, v: float) -> tuple:
    return 48 * u, 44 * u + v * (44 - 28 * u), 0


def cook_sheet() -> Case:
    """Plane stress, as a shell that stays in its plane; linear."""
    cells, part = 64, 1e-6
    grid = Grid((cells, cells), cook_place, "crossed")
    scene = {"job": "equilibrium", "shell": {"mesh": "cook.obj", "thickness": 1, "young": 1, "poisson": 1 / 3},
             "fix": [{"vertices": grid.where(lambda u, v: u == 0)}, {"box": [[-1, -1, -1], [99, 99, 1]], "axes": "z"}],
             "loads": [{"line": [0, part / 16, 0], "on": {"vertices": grid.where(lambda u, v: u == 1)}}]}
    return Case(
        name="Cook's membrane, plane stress, as a shell", source="Cook 1974; Simo, Rifai 1990: 23.96",
        mesh=f"{cells} x {cells} cells, crossed", files={"cook.obj": grid.obj()}, scenes=[scene],
        figures=[Figure("v in the middle of its free side", lambda r: r.moved(48, 52, 0)[1] / part, 23.96, 0.01)])


def cook_solid(cells: int, averaging: float) -> Case:
    """Plane strain, nearly incompressible, far from linear: mu = 80.1938, lambda = 40.0942e4."""
    mu, la = 80.1938, 40.0942e4
    young, poisson = mu * (3 * la + 2 * mu) / (la + mu), la / (2 * (la + mu))
    grid = Grid((cells, cells), cook_place)
    scene = {"job": "equilibrium",
             "solid": {"mesh": {"extrude": {"file": "cook.obj"}, "thickness": 48 / cells}, "young": young, "poisson": poisson,
                       "averaging": averaging},
             "fix": [{"box": [[-1e-3, -1, -9], [1e-3, 99, 9]]}, {"box": [[-1, -1, -9], [99, 99, 9]], "axes": "z"}],
             "loads": [{"area": [0, 100 / 16, 0], "on": {"box": [[47.999, 0, -9], [49, 99, 9]]}}]}
    return Case(
        name=f"Cook's membrane, nu {poisson:.4f}, averaging {averaging:g}", source="Simo, Armero 1992: 6.9; Reese 2002: 6.93",
        mesh=f"{cells} x {cells} x 1 cells, quadratic", files={"cook.obj": grid.obj()}, scenes=[scene],
        figures=[Figure("v of its upper corner", lambda r: max(r.moved(48, 60, z)[1] for z in (-1, 1)), 6.93, 0.01)])


CASES = [pulled(material, poisson, stretch, both) for both in (False, True)
         for material, poisson, stretch in (("neo_hookean", 0.45, 1.5), ("neo_hookean_log", 0.3, 1.5),
                                            ("st_venant_kirchhoff", 0.3, 1.2))]
CASES += [bar(0), bar(0.3), bar(0.49), bar(0.3, order=1), torsion(), cook_sheet(), cook_solid(40, 0.6)]
