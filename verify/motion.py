"""Motions by implicit Euler, and frequencies."""
from __future__ import annotations

import math

from case import Case, Figure

STRIP = {"shape": "sheet", "size": [0.1, 0.01], "cells": [60, 6], "pattern": "alternate"}
THICKNESS, YOUNG, DENSITY = 1e-3, 1e6, 1000.0


def oscillator() -> Case:
    """One triangle, one free coordinate: a spring of Y h/2 and a third of its mass."""
    side, speed, steps = 0.01, 1e-6, 50
    omega2 = (YOUNG * THICKNESS / 2) / (DENSITY * THICKNESS * side**2 / 2 / 3)
    dt = 0.2 / math.sqrt(omega2)
    scene = {"job": "simulate",
             "shell": {"mesh": "one.obj", "thickness": THICKNESS, "young": YOUNG, "poisson": 0, "density": DENSITY,
                       "velocity": [speed, 0, 0]},
             "fix": [{"vertices": [0, 2]}, {"vertices": [1], "axes": "yz"}], "time": {"step": dt, "steps": steps}}
    x, v, largest = 0.0, speed, speed / math.sqrt(omega2)
    for _ in range(steps):
        v = (v - dt * omega2 * x) / (1 + dt * dt * omega2)
        x += dt * v
    return Case(
        name="spring by implicit Euler", source="Hairer, Wanner 1996: amplitude (1 + w^2 dt^2)^(-n/2), phase n atan(w dt)",
        mesh="one triangle", scenes=[scene],
        files={"one.obj": f"v 0 0 0\nv {side} 0 0\nv 0 {side} 0\nf 1 2 3\n"},
        figures=[Figure("x after 50 steps, of its amplitude undamped", lambda r: (r.x[1][0] - side) / largest, x / largest, 1e-3)])


def flight() -> Case:
    """Thrown and spinning: what is left is weight."""
    dt, steps, speed = 1e-3, 200, [0.3, -0.2, 1.0]
    scene = {"job": "simulate",
             "shell": {"mesh": {**STRIP, "cells": [20, 2]}, "thickness": THICKNESS, "young": YOUNG, "poisson": 0.3,
                       "density": DENSITY, "gravity": [0, 0, -9.81],
                       "velocity": {"formula": [f"{speed[0]} + 5*z", f"{speed[1]} + 20*(x - 0.05)",
                                                f"{speed[2]} + 40*(x - 0.05)"]}},
             "time": {"step": dt, "steps": steps}, "probes": {"middle": {"mass_center": True}}}
    fall = -9.81 * dt * dt * steps * (steps + 1) / 2

    def travelled(axis: int):
        return lambda r: r["probes/middle"][-1][axis] - r["probes/middle"][0][axis]
    expected = [s * dt * steps + (fall if k == 2 else 0) for k, s in enumerate(speed)]
    return Case(
        name="strip thrown, spinning", source="Newton 1687: its centre of mass, by implicit Euler", mesh="20 x 2 cells",
        scenes=[scene], figures=[Figure(f"{axis} after 0.2 s, m", travelled(k), expected[k], 1e-6) for k, axis in enumerate("xyz")])


def hz(r, k: int) -> float:
    return float(r["final/modes_hz"][k])


def strip() -> Case:
    scene = {"job": "equilibrium",
             "shell": {"mesh": {**STRIP, "cells": [100, 8]}, "thickness": THICKNESS, "young": YOUNG, "poisson": 0,
                       "density": DENSITY},
             "fix": [{"group": "root", "clamp": True}], "modes": 4}
    unit = math.sqrt(YOUNG * THICKNESS**2 / (12 * DENSITY)) / (2 * math.pi * 0.1**2)
    return Case(
        name="clamped strip vibrates", source="Euler, Bernoulli 1751: 3.51602, 22.0345", mesh="100 x 8 cells", scenes=[scene],
        figures=[Figure("first, Hz", lambda r: hz(r, 0), 3.51602 * unit, 0.01),
                 Figure("second, Hz", lambda r: min((hz(r, k) for k in range(4)), key=lambda f: abs(f - 22.0345 * unit)),
                        22.0345 * unit, 0.01)])


def plate() -> Case:
    scene = {"job": "equilibrium",
             "shell": {"mesh": {"shape": "sheet", "size": [0.1, 0.1], "cells": [40, 40], "pattern": "alternate"},
                       "thickness": THICKNESS, "young": YOUNG, "poisson": 0.3, "density": DENSITY},
             "fix": [{"boundary": True}], "modes": 4}
    unit = math.pi / (2 * 0.1**2) * math.sqrt(YOUNG * THICKNESS**2 / (12 * (1 - 0.09) * DENSITY))
    return Case(
        name="supported plate vibrates", source="Leissa 1969: pi/2 (m^2 + n^2) sqrt(D/(rho h))/a^2", mesh="40 x 40 cells",
        scenes=[scene], figures=[Figure(f"mode {k + 1}, Hz", lambda r, k=k: hz(r, k), n * unit, 0.01)
                                 for k, n in enumerate((2, 5, 5, 8))])


def rod(name: str, source: str, elements: int, young: float, expected: list, tolerance: float, **more) -> Case:
    """Hangs, 1 m long and 2 mm thick."""
    scene = {"job": "equilibrium",
             "rod": {"natural_strain": [0, 0, 0], "length": 1, "elements": elements, "radius": 1e-3, "young": young,
                     "poisson": 0.3, "density": DENSITY, "clamp": {"frame": [[0, 0, -1], [0, 1, 0], [1, 0, 0]]}, **more},
             "modes": 6}
    return Case(name=name, source=source, mesh=f"{elements} elements", scenes=[scene],
                figures=[Figure(f"{what}, Hz", lambda r, f=f: min(r["final/modes_hz"], key=lambda g: abs(g - f)), f, tolerance)
                         for what, f in expected])


def beam() -> Case:
    unit = math.sqrt(1e9 * 1e-6 / 4 / DENSITY) / (2 * math.pi)
    return rod("clamped rod vibrates", "Euler, Bernoulli 1751: 3.516015, 22.03449, 61.69721", 200, 1e9,
               [(what, b * unit) for what, b in zip(("first", "second", "third"), (3.516015, 22.03449, 61.69721))], 1e-3,
               gravity=[0, 0, 0])


def pendulum() -> Case:
    """A stiff strip that hangs from a hinge."""
    scene = {"job": "equilibrium",
             "shell": {"mesh": {**STRIP, "cells": [40, 4]}, "thickness": THICKNESS, "young": 1e11, "poisson": 0,
                       "density": DENSITY, "gravity": [9.81, 0, 0]},
             "fix": [{"group": "root"}], "modes": 1}
    return Case(name="pendulum", source="Huygens 1673: sqrt(3 g/(2 L))", mesh="40 x 4 cells", scenes=[scene],
                figures=[Figure("frequency, Hz", lambda r: hz(r, 0), math.sqrt(1.5 * 9.81 / 0.1) / (2 * math.pi), 1e-3)])


def chain() -> Case:
    zeros = (2.404826, 5.520078)
    return rod("hanging chain", "Bernoulli 1732: j/2 sqrt(g/L), J_0(j) = 0", 400, 10.0,
               [(what, j / 2 * math.sqrt(9.81) / (2 * math.pi)) for what, j in zip(("first", "second"), zeros)], 1e-3,
               gravity=[0, 0, -9.81], hold="pinned")


CASES = [oscillator(), flight(), strip(), plate(), beam(), pendulum(), chain()]
