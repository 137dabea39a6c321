"""Loads at which a straight rod or strip gives way. Of two loads below it, the lowest eigenvalue goes to zero at the third."""
from __future__ import annotations

import math

from case import Case, Figure
from forms import bessel_zero

YOUNG, POISSON, AREA, STIFF, SOFT, TORSION = 1e6, 0.5, 1e-6, 1e-10, 1e-14, 3e-14  # a blade: SOFT about n1, STIFF about n2
EI = YOUNG * SOFT
GJ = YOUNG / (2 * (1 + POISSON)) * TORSION
NEAR = (0.97, 0.99)


def blade(loads: list, gravity: list, density: float = 1000) -> dict:
    """Along x, 1 m, deep along z: it bends easily to y."""
    return {"job": "equilibrium",
            "rod": {"natural_strain": [0, 0, 0], "length": 1, "elements": 400, "young": YOUNG, "poisson": POISSON,
                    "density": density, "gravity": gravity,
                    "section": {"area": AREA, "I1": STIFF, "I2": SOFT, "J": TORSION, "contact_radius": 1e-4},
                    "clamp": {"frame": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}, "loads": loads}}


def lowest(r) -> float:
    return float(r["final/lowest_eigenvalue"])


def crossing(power: int, stiffness=lowest):
    """Where a stiffness is zero that is linear in that power of the load, in parts of the expected load."""
    def read(one, two) -> float:
        a, b = stiffness(one), stiffness(two)
        s, t = (near**power for near in NEAR)
        return (s + a * (t - s) / (a - b)) ** (1 / power)
    return read


def lateral_tip() -> Case:
    load = 2 * bessel_zero(-0.25) * math.sqrt(EI * GJ)
    return Case(
        name="lateral buckling, force at the tip", source="Prandtl 1899: 4.0126 sqrt(EI GJ)/L^2", mesh="400 elements",
        scenes=[blade([{"force": [0, 0, -near * load], "point": "end"}], [0, 0, 0]) for near in NEAR],
        figures=[Figure("F L^2/sqrt(EI GJ)", lambda *r: crossing(2)(*r) * load / math.sqrt(EI * GJ),
                        load / math.sqrt(EI * GJ), 1e-3)])


def lateral_weight() -> Case:
    load = 6 * bessel_zero(-1 / 6) * math.sqrt(EI * GJ)
    return Case(
        name="lateral buckling, own weight", source="Prandtl 1899, Timoshenko, Gere 1961: 12.85 sqrt(EI GJ)/L^3",
        mesh="400 elements", scenes=[blade([], [0, 0, -near * load / (1000 * AREA)]) for near in NEAR],
        figures=[Figure("w L^3/sqrt(EI GJ)", lambda *r: crossing(2)(*r) * load / math.sqrt(EI * GJ),
                        load / math.sqrt(EI * GJ), 1e-3)])


def upright(name: str, source: str, load: float, figure: str, scenes) -> Case:
    return Case(name=name, source=source, mesh="400 elements", scenes=[scenes(near * load) for near in NEAR],
                figures=[Figure(figure, lambda *r: crossing(1)(*r) * load, load, 1e-3)])


def column(gravity: list, loads: list) -> dict:
    scene = blade(loads, gravity)
    scene["rod"]["clamp"]["frame"] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]
    return scene


def greenhill() -> Case:
    return upright("column under its own weight", "Greenhill 1881: (3/2 j)^2, J_-1/3(j) = 0", (1.5 * bessel_zero(-1 / 3)) ** 2,
                   "w L^3/EI", lambda load: column([0, 0, -load * EI / (1000 * AREA)], []))


def euler() -> Case:
    return upright("column, force at its end", "Euler 1744: pi^2/4", math.pi**2 / 4, "P L^2/EI",
                   lambda load: column([0, 0, 0], [{"force": [0, 0, -load * EI], "point": "end"}]))


def supported_strip() -> Case:
    """The square of a frequency between hinges falls with 1 - P/P_cr."""
    length, width, thickness, part = 0.1, 0.01, 1e-3, 0.9
    bending = YOUNG * thickness**3 / 12
    critical = math.pi**2 * bending / length**2
    free = math.pi / (2 * length**2) * math.sqrt(bending / (1000 * thickness))
    scene = {"job": "equilibrium",
             "shell": {"mesh": {"shape": "sheet", "size": [length, width], "cells": [64, 4], "pattern": "alternate"},
                       "thickness": thickness, "young": YOUNG, "poisson": 0, "density": 1000},
             "fix": [{"box": [[-1e-6, -1, -1], [1e-6, 1, 1]], "axes": "xz"},
                     {"box": [[length - 1e-6, -1, -1], [1, 1, 1]], "axes": "z"},
                     {"box": [[-1e-6, -1e-6, -1], [1, 1e-6, 1]], "axes": "y"}],
             "loads": [{"line": [-part * critical, 0, 0], "on": {"box": [[length - 1e-6, -1, -1], [1, 1, 1]]}}], "modes": 1}
    return Case(
        name="strip between hinges, pressed", source="Euler 1744: pi^2 EI/L^2, by its frequency under 0.9 of it",
        mesh="64 x 4 cells", scenes=[scene],
        figures=[Figure("P/P_cr", lambda r: part / (1 - (r["final/modes_hz"][0] / free) ** 2), 1, 0.01)])


def magnetised_strip() -> Case:
    """Against a field: the hard-magnetic column."""
    load, length, thickness, magnet = math.pi**2 / 4, 0.02, 4e-4, 1e5

    def scene(q: float) -> dict:
        field = q * YOUNG * thickness**2 / (12 * magnet * length**2)
        return {"job": "equilibrium",
                "shell": {"mesh": {"shape": "sheet", "size": [length, 0.005], "cells": [64, 16]},
                          "thickness": thickness, "young": YOUNG, "poisson": 0, "magnetization": [magnet, 0, 0]},
                "fix": [{"group": "root", "clamp": True}], "flux_density": [-field, 0, 0]}
    return Case(
        name="magnetised strip against a field", source="Euler 1744, with M B A for the force: pi^2/4", mesh="64 x 16 cells",
        scenes=[scene(near * load) for near in NEAR],
        figures=[Figure("12 M B L^2/(Y h^2)", lambda *r: crossing(1)(*r) * load, load, 0.01)])


def twisted_ring() -> Case:
    """A straight rod bent to a ring, its ends turned against each other before they are joined: it spins freely within itself
    (frequency 0), and at the critical twist its first bending frequency is 0, too."""
    length, radius = 1.0, 1e-3
    ring, ratio = length / (2 * math.pi), 1.0  # EI/GJ of a round rod, nu = 0
    twist = 2 * math.pi * math.sqrt(3) * ratio

    def scene(turn: float) -> dict:
        rod = {"curve": {"formula": [f"{ring}*sin(u)", f"{ring} - {ring}*cos(u)", "0*u"], "range": [0, 2 * math.pi]},
               "natural_strain": [0, 0, 0], "frame": {"formula": f"{turn}*s/L", "from": "frenet"}, "start": "curve",
               "elements": 200, "radius": radius, "young": YOUNG, "poisson": 0, "density": 1000, "gravity": [0, 0, 0],
               "end": {"position": [0, 0, 0], "hold": "clamped",
                       "frame": [[1, 0, 0], [0, math.cos(turn), math.sin(turn)], [0, -math.sin(turn), math.cos(turn)]]}}
        return {"job": "equilibrium", "rod": rod, "modes": 2}
    stiffness = crossing(2, lambda r: r["final/modes_hz"][1] ** 2)
    return Case(
        name="ring that is twisted and closed", source="Michell 1889: 2 pi sqrt(3) EI/GJ", mesh="200 elements",
        scenes=[scene(near * twist) for near in NEAR],
        figures=[Figure("twist, rad", lambda *r: stiffness(*r) * twist, twist, 1e-3)])


CASES = [euler(), greenhill(), lateral_tip(), lateral_weight(), twisted_ring(), supported_strip(), magnetised_strip()]
