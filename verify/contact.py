"""What touches and rubs, and what sinks in water."""
from __future__ import annotations

import math

import numpy as np

from case import Case, Figure
from grid import graded_box

G = 9.81
STEP = 1e-3


def plate_on_slope(slope: float, steps: int) -> dict:
    """A stiff plate on a plane whose friction is 0.6; the slope is in gravity. It begins as deep in as it will be."""
    angle = math.atan(slope)
    return {"job": "simulate",
            "shell": {"mesh": {"shape": "sheet", "size": [0.02, 0.01], "cells": [4, 2]}, "thickness": 1e-3, "young": 1e6,
                      "poisson": 0.3, "density": 1000, "gravity": [G * math.sin(angle), 0, -G * math.cos(angle)]},
            "obstacles": [{"plane": {"point": [0, 0, -5e-4], "normal": [0, 0, 1]}}],
            "contact": {"friction": 0.6, "slip_speed": 1e-3}, "time": {"step": STEP, "steps": steps},
            "probes": {"middle": {"mass_center": True}}}


def speed(r, frame: int) -> float:
    x = r["probes/middle"][:, 0]
    return (x[frame] - x[frame - 1]) / STEP


def slides(slope: float) -> Case:
    angle = math.atan(slope)
    return Case(
        name=f"slope of {slope:g}, friction 0.6: slides", source="Coulomb 1785: g (sin a - mu cos a)", mesh="4 x 2 cells",
        scenes=[plate_on_slope(slope, 200)],
        figures=[Figure("acceleration, m/s^2", lambda r: (speed(r, 200) - speed(r, 100)) / (100 * STEP),
                        G * (math.sin(angle) - 0.6 * math.cos(angle)), 1e-3)])


def sticks(slope: float) -> Case:
    return Case(
        name=f"slope of {slope:g}, friction 0.6: sticks", source="Coulomb 1785; creeps as its friction is made: "
        "v_s (1 - sqrt(1 - tan a/mu))", mesh="4 x 2 cells", scenes=[plate_on_slope(slope, 300)],
        figures=[Figure("speed, m/s", lambda r: speed(r, 300), 1e-3 * (1 - math.sqrt(1 - slope / 0.6)), 0.01)])


def lifted() -> Case:
    """A heavy beam on a floor, its end held up a little by a hinge: so much of it leaves the floor."""
    radius, young, density, height = 1e-3, 1e8, 1000.0, 2e-3
    bending, weight = young * math.pi * radius**4 / 4, density * math.pi * radius**2 * G
    scene = {"job": "equilibrium",
             "rod": {"natural_strain": [0, 0, 0], "length": 1, "elements": 800, "radius": radius, "young": young, "poisson": 0.3,
                     "density": density, "gravity": [0, 0, -G], "clamp": {"position": [0, 0, radius]},
                     "loads": [{"force": [0, 0, 0.0], "point": "end"}]},
             "obstacles": [{"name": "floor", "plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}}]}
    free = (24 * bending * height / weight) ** 0.25
    force = weight * free / 2
    scene["rod"]["loads"][0]["force"][2] = force
    return Case(
        name="beam lifted off a floor", source="Bernoulli's beam: lifted by w L^4/(24 EI), F = w L/2", mesh="800 elements",
        scenes=[scene],
        figures=[Figure("height of its end, m", lambda r: r.x[-1][2] - radius, height, 0.02),
                 Figure("force of floor and clamp/(weight - F)",
                        lambda r: (r["final/contact_force"][0][2] + r["final/support_force"][0][2]) / (weight - force), 1, 1e-3)])


def cantilever_on_bar() -> Case:
    """Its end is pressed up by a bar."""
    radius, young, bar, down = 1e-3, 1e8, 0.01, 5e-4
    at = 0.19
    bending = young * math.pi * radius**4 / 4
    scene = {"job": "equilibrium",
             "rod": {"natural_strain": [0, 0, 0], "length": 0.2, "elements": 400, "radius": radius, "young": young, "poisson": 0.3,
                     "density": 1000, "gravity": [0, 0, 0]},
             "obstacles": [{"name": "bar", "cylinder": {"point": [at, 0, down - bar - radius], "axis": [0, 1, 0], "radius": bar}}]}
    return Case(
        name="cantilever on a bar", source="Bernoulli's beam: 3 EI d/L^3", mesh="400 elements", scenes=[scene],
        figures=[Figure("force of the bar L^3/(3 EI d)",
                        lambda r: r["final/contact_force"][0][2] * at**3 / (3 * bending * down), 1, 0.01)])


def sinks() -> Case:
    """Flat through water, at the speed whose drag is its weight."""
    density, thickness = 2000.0, 1e-4
    scene = {"job": "simulate",
             "shell": {"mesh": {"shape": "sheet", "size": [0.02, 0.02], "cells": [4, 4]}, "thickness": thickness, "young": 1e8,
                       "poisson": 0.3, "density": density, "gravity": [0, 0, -G]},
             "water": {"density": 1000}, "time": {"step": STEP, "steps": 300}, "probes": {"middle": {"mass_center": True}}}
    return Case(
        name="sheet that sinks flat", source="its model's balance: sqrt(rho_s h g/(2 rho_w)), thrust and drag of 1 each",
        mesh="4 x 4 cells", scenes=[scene],
        figures=[Figure("speed, m/s", lambda r: (r["probes/middle"][-2][2] - r["probes/middle"][-1][2]) / STEP,
                        math.sqrt(density * thickness * G / 2000), 1e-3)])


def hertz() -> Case:
    """A rigid ball on a quarter of a block, symmetric at x = 0 and y = 0, forty times as large as where they touch."""
    radius, depth, young, poisson, cells = 8e-3, 2e-5, 1e5, 0.3, 9
    contact = math.sqrt(radius * depth)
    side = 40 * contact
    inner = np.linspace(0, 1.2 * contact, 5)
    outer = inner[-1] + (side - inner[-1]) * (np.geomspace(1, 60, cells - 3) - 1)[1:] / 59
    near = np.concatenate([inner, outer])
    fix = [{"box": box, "axes": "xyz"[axis]}
           for axis, box in enumerate(([[-1e-9, -1, -1], [1e-9, 1, 1]], [[-1, -1e-9, -1], [1, 1e-9, 1]],
                                       [[-1, -1, -1], [1, 1, -side + 1e-9]]))]
    scene = {"job": "equilibrium", "solid": {"mesh": "block.msh", "young": young, "poisson": poisson}, "fix": fix,
             "obstacles": [{"name": "ball", "sphere": {"center": [0, 0, radius], "radius": radius},
                            "move": ["0", "0", f"-{depth}*t"]}], "time": 1}
    force = 4 / 3 * young / (1 - poisson**2) * math.sqrt(radius) * depth**1.5 / 4
    return Case(name="ball pressed onto a block", source="Hertz 1881: 4/3 E* sqrt(R) d^(3/2)",
                mesh=f"{len(near) - 1}^3 cells, quadratic, denser below the ball",
                files={"block.msh": graded_box([near, near, -near[::-1]])}, scenes=[scene],
                figures=[Figure("force on a quarter, of Hertz's", lambda r: -r["final/contact_force"][0][2] / force, 1, 0.01)])


CASES = [slides(0.7), slides(1), sticks(0.3), sticks(0.5), lifted(), cantilever_on_bar(), sinks(), hertz()]
