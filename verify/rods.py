"""Rods in equilibrium: elastica of all kinds, chains, and the bend in space."""
from __future__ import annotations

import math

import numpy as np

from case import Case, Figure
from forms import bisect, ellip_e, ellip_k

# Where the end of a level, clamped, heavy elastica hangs, x/L and -z/L, by weight L^3/EI (solve.py)
HEAVY = {1: (0.9912463953, 0.1234714020), 10: (0.6563537612, 0.7001997155), 100: (0.1592233826, 0.9375239354),
         1000: (0.0459864548, 0.9811412693), 10000: (0.0142608898, 0.9941099339)}
RADIUS, YOUNG, DENSITY = 1e-3, 1e6, 1000.0
BENDING = YOUNG * math.pi * RADIUS**4 / 4
LINE = DENSITY * math.pi * RADIUS**2  # kg/m
UPRIGHT = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]


def rod(elements: int, loads: list | None = None, gravity: list | None = None, **more) -> dict:
    """Straight, 1 m, along x."""
    return {"job": "equilibrium",
            "rod": {"natural_strain": [0, 0, 0], "length": 1, "elements": elements, "radius": RADIUS, "young": YOUNG,
                    "poisson": 0.5, "density": DENSITY, "gravity": gravity or [0, 0, 0], "loads": loads or [], **more}}


def heavy(load: int) -> Case:
    elements = 400 if load < 1000 else 2000
    x, z = HEAVY[load]
    return Case(
        name=f"heavy elastica, w L^3/EI = {load}", source="Bickley 1934; its equation solved to 1e-10 (solve.py)",
        mesh=f"{elements} elements", scenes=[rod(elements, gravity=[0, 0, -load * BENDING / LINE])],
        figures=[Figure("x/L of the end", lambda r: r.x[-1][0], x, 1e-3), Figure("-z/L", lambda r: -r.x[-1][2], z, 1e-3)])


def mattiasson(load: int, along: float, across: float) -> Case:
    return Case(
        name=f"cantilever, F L^2/EI = {load}", source="Mattiasson 1981", mesh="200 elements",
        scenes=[rod(200, [{"force": [0, 0, load * BENDING], "point": "end"}])],
        figures=[Figure("u/L of the end", lambda r: 1 - r.x[-1][0], along, 1e-3),
                 Figure("w/L", lambda r: r.x[-1][2], across, 1e-3)])


def rolled_up() -> Case:
    return Case(
        name="couple that closes a circle", source="Euler 1744: M = 2 pi EI/L", mesh="200 elements",
        scenes=[rod(200, [{"couple": [0, -2 * math.pi * BENDING, 0], "point": "end"}])],
        figures=[Figure("x/L of the end", lambda r: r.x[-1][0], 0, 1e-3, scale=1),
                 Figure("z/L in the middle", lambda r: r.x[100][2], 1 / math.pi, 1e-3)])


def catenary() -> Case:
    """Half as long again as its supports are apart; it bends as good as not at all."""
    span, soft = 2 / 3, 1e-5
    a = bisect(lambda a: 2 * a * math.sinh(span / (2 * a)) - 1, 0.05, 1)
    scene = rod(1000, gravity=[0, 0, -1e-5 * BENDING / (soft * LINE)], hold="pinned", natural_strain=[0, -2, 0],
                end={"position": [span, 0, 0], "hold": "pinned"})
    scene["sequence"] = [{"gravity": [0, 0, -10.0**n * BENDING / (soft * LINE)]} for n in np.arange(-4, 0.1, 0.5)]
    return Case(
        name="catenary", source="Leibniz, Huygens, Bernoulli 1691", mesh="1000 elements, w L^3/EI = 1e5", scenes=[scene],
        figures=[Figure("sag/L", lambda r: -r.x[500][2], a * (math.cosh(span / (2 * a)) - 1), 1e-3),
                 Figure("pull at its support/(w L)", lambda r: -r["final/support_force"][0][0] * soft / BENDING, a, 1e-3)])


def shortened(clamped: bool, modulus: float) -> Case:
    """Ends of an elastica pushed together until sin(theta/2) = modulus."""
    big_k, big_e = ellip_k(modulus), ellip_e(modulus)
    apart, deflection, load = 2 * big_e / big_k - 1, modulus / big_k, 4 * big_k**2
    if clamped:
        load *= 4
    ends = {"position": [apart, 0, 0], "hold": "clamped", "frame": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]} if clamped else \
        {"position": [apart, 0, 0], "hold": "pinned"}
    scene = rod(200, natural_strain=[0, 1e-3, 0], end=ends, hold="clamped" if clamped else "pinned")
    return Case(
        name=f"elastica between {'clamps' if clamped else 'hinges'}, k = {modulus}", source="Euler 1744; Love 1927, art. 263",
        mesh="200 elements", scenes=[scene],
        figures=[Figure("force L^2/EI", lambda r: abs(r["final/support_force"][1][0]) / BENDING, load, 1e-3),
                 Figure("deflection/L", lambda r: np.abs(r.x[:, 1:]).max(), deflection, 1e-3)])


def bend(force: float, tip: tuple) -> Case:
    """An eighth of a circle of 100 m in the plane z = 0, pushed out of it; a unit section that shears and stretches."""
    section = {"area": 1, "I1": 1 / 12, "I2": 1 / 12, "J": 1 / 6, "kappa": [1, 1], "contact_radius": 0.5}
    scene = {"job": "equilibrium",
             "rod": {"model": "cosserat", "natural_strain": [0, 0, 0.01], "length": 25 * math.pi, "elements": 100,
                     "section": section, "young": 1e7, "poisson": 0, "density": 1, "gravity": [0, 0, 0],
                     "loads": [{"force": [0, 0, force], "point": "end"}]}}
    figures = [Figure(f"{axis} of the end", lambda r, k=k: r.x[-1][k], tip[k], 2e-3, scale=100)
               for k, axis in enumerate("xyz")]
    return Case(name=f"45 degree bend, {force:g} lb", source="Bathe, Bolourchi 1979; Simo, Vu-Quoc 1986",
                mesh="100 elements", scenes=[scene], figures=figures)


def timoshenko() -> Case:
    """A stubby beam: shear makes a fifth of its deflection."""
    side, force = 0.4, 1.0
    area, inertia = side**2, side**4 / 12
    scene = rod(100, [{"force": [0, 0, force], "point": "end"}], model="cosserat", young=1e9, poisson=0.25,
                section={"area": area, "I1": inertia, "I2": inertia, "J": 0.1406 * side**4, "kappa": [5 / 6, 5 / 6]})
    del scene["rod"]["radius"]
    w = force / (3 * 1e9 * inertia) + force / (5 / 6 * 1e9 / 2.5 * area)
    return Case(name="Timoshenko's cantilever", source="Timoshenko 1921: F L^3/(3 EI) + F L/(kappa G A)", mesh="100 elements",
                scenes=[scene], figures=[Figure("w of the end, m", lambda r: r.x[-1][2], w, 1e-3)])


CASES = [*(heavy(load) for load in HEAVY), mattiasson(1, 0.05643, 0.30172), mattiasson(10, 0.55500, 0.81061), rolled_up(),
         catenary(), shortened(False, 0.5), shortened(True, 0.5), bend(300, (58.84, 22.33, 40.08)),
         bend(600, (47.23, 15.79, 53.37)), timoshenko()]
