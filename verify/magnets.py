"""Hard magnets: what bends in a field, the fields of magnets and coils, forces and couples."""
from __future__ import annotations

import math

import numpy as np

from case import Case, Figure
from forms import bisect, ellip_e, ellip_k, integral

MU0 = 4e-7 * math.pi
LENGTH, WIDTH, THICKNESS, YOUNG, MAGNET = 0.02, 0.005, 4e-4, 1e6, 1e5


def elastica(q: float, phi: float) -> tuple[float, float]:
    """x/L and y/L of the end of a strip in a field at phi (degrees) to it: EI theta'' + M B A sin(phi - theta) = 0."""
    angle = math.radians(phi)

    def incomplete(k: float, amplitude: float) -> float:
        return integral(lambda e: 1 / math.sqrt(1 - (k * math.sin(e)) ** 2), 0, amplitude, 40)

    def modulus(end: float) -> float:
        return math.cos((angle - end) / 2)
    low, high = 1e-9, angle - 1e-9
    end = bisect(lambda t: ellip_k(modulus(t)) - incomplete(modulus(t), math.asin(min(1, math.cos(angle / 2) / modulus(t)))) -
                 math.sqrt(q), low, high)
    # theta'^2 = 2 q (cos(phi - end) - cos(phi - theta)); theta = end - (end) s^2 takes the root out at the end
    def slope(s: float) -> tuple[float, float]:
        theta = end * (1 - s * s)
        rate = math.sqrt(2 * q * (math.cos(angle - end) - math.cos(angle - theta)))
        return 2 * end * s / rate, theta
    x = integral(lambda s: slope(s)[0] * math.cos(slope(s)[1]), 0, 1)
    y = integral(lambda s: slope(s)[0] * math.sin(slope(s)[1]), 0, 1)
    return x, y


def flux(q: float, phi: float) -> list:
    size = q * YOUNG * THICKNESS**2 / (12 * MAGNET * LENGTH**2)
    return [size * math.cos(math.radians(phi)), 0, size * math.sin(math.radians(phi))]


def strip(q: float, phi: float) -> Case:
    scene = {"job": "equilibrium",
             "shell": {"mesh": {"shape": "sheet", "size": [LENGTH, WIDTH], "cells": [48, 12], "pattern": "alternate"},
                       "thickness": THICKNESS, "young": YOUNG, "poisson": 0, "magnetization": [MAGNET, 0, 0]},
             "fix": [{"group": "root", "clamp": True}], "flux_density": flux(q, phi)}
    x, y = elastica(q, phi)
    return Case(
        name=f"magnetised strip, {phi:g} degrees, q = {q:g}", source="Lum et al. 2016; Wang et al. 2020, elliptic integrals",
        mesh="48 x 12 cells", scenes=[scene],
        figures=[Figure("x/L of the end", lambda r: 1 + r.moved(LENGTH, WIDTH / 2, 0)[0] / LENGTH, x, 0.01),
                 Figure("y/L", lambda r: r.moved(LENGTH, WIDTH / 2, 0)[2] / LENGTH, y, 0.01)])


def rod_scene(q: float, field: list) -> dict:
    side = THICKNESS
    return {"job": "equilibrium",
            "rod": {"natural_strain": [0, 0, 0], "length": LENGTH, "elements": 200, "section": {"width": side, "height": side},
                    "young": YOUNG, "poisson": 0.5, "density": 1000, "gravity": [0, 0, 0], "magnetization": [MAGNET, 0, 0]},
            "flux_density": field}


def rod(q: float, phi: float) -> Case:
    x, y = elastica(q, phi)
    return Case(
        name=f"magnetised rod, {phi:g} degrees, q = {q:g}", source="Wang et al. 2020, elliptic integrals", mesh="200 elements",
        scenes=[rod_scene(q, flux(q, phi))],
        figures=[Figure("x/L of the end", lambda r: r.x[-1][0] / LENGTH, x, 1e-3, scale=1),
                 Figure("y/L", lambda r: r.x[-1][2] / LENGTH, y, 1e-3)])


def couple() -> Case:
    """A rod magnetised across itself: m x B, all of it at its clamp."""
    scene = rod_scene(0, [0, 5e-3, 0])
    scene["rod"].update(magnetization=[0, 0, MAGNET], young=1e12)  # so stiff that it does not turn
    m = MAGNET * THICKNESS**2 * LENGTH
    return Case(name="couple on a rod magnetised across", source="Maxwell 1873: m x B", mesh="200 elements", scenes=[scene],
                figures=[Figure("couple of its clamp/(m B)",
                                lambda r: np.linalg.norm(r["final/support_couple"][0]) / (m * 5e-3), 1, 1e-3)])


# ---- Fields, in the middle of a sheet of a micrometre ----

def place(x: float, z: float) -> dict[str, str]:
    e = 1e-6
    points = [(x - e, -e, z), (x + e, -e, z), (x + e, e, z), (x - e, e, z)]
    return {"probe.obj": "".join(f"v {a:.17g} {b:.17g} {c:.17g}\n" for a, b, c in points) + "f 1 2 3\nf 1 3 4\n"}


def field(name: str, source: str, flux_source: dict, x: float, z: float, expected: dict[int, float]) -> Case:
    scene = {"job": "evaluate", "shell": {"mesh": "probe.obj", "thickness": 1e-7, "young": 1e6, "poisson": 0},
             "flux_density": [flux_source]}

    def read(axis: int):
        return lambda r: r["frames/flux_density"].reshape(-1, 3)[-1][axis]
    scale = max(abs(b) for b in expected.values())
    return Case(name=name, source=source, mesh="a point", scenes=[scene], files=place(x, z), status="",
                figures=[Figure(f"B_{'xyz'[axis]}, T", read(axis), b, 1e-6, scale=scale) for axis, b in expected.items()])


def loop(radius: float, current: float, rho: float, z: float) -> tuple[float, float]:
    """B across and along its axis, of a round wire [Smythe 1950, section 7.10]."""
    alpha, beta = (radius - rho) ** 2 + z * z, (radius + rho) ** 2 + z * z
    k = math.sqrt(1 - alpha / beta)
    c = MU0 * current / (2 * math.pi * math.sqrt(beta))
    along = c * (ellip_k(k) + (radius**2 - rho**2 - z * z) / alpha * ellip_e(k))
    across = c * z / rho * (-ellip_k(k) + (radius**2 + rho**2 + z * z) / alpha * ellip_e(k)) if rho else 0.0
    return across, along


def block() -> Case:
    a, b, h, z, remanence = 0.02, 0.03, 0.01, 0.012, 1.2

    def half(d: float) -> float:
        return math.atan(a * b / (2 * d * math.sqrt(4 * d * d + a * a + b * b)))
    size = remanence / math.pi * (half(z - h / 2) - half(z + h / 2))
    return field("block magnet, on its axis", "Furlani 2001", {"magnet": {"at": [0, 0, 0], "size": [a, b, h],
                 "remanence": [0, 0, remanence]}}, 0, z, {2: size})


def cylinder(rho: float) -> Case:
    """Its side is a sheet of current, Br/mu_0 per metre."""
    radius, length, z, remanence = 0.01, 0.02, 0.015, 1.2
    layers = [integral(lambda s, k=k: loop(radius, remanence / MU0, rho, z - s)[k], -length / 2, length / 2, 20) for k in (0, 1)]
    source = "Derby, Olbert 2010, by elliptic integrals of its layers" if rho else "Camacho, Sosa 2013"
    if not rho:
        far, near = z + length / 2, z - length / 2
        layers[1] = remanence / 2 * (far / math.hypot(far, radius) - near / math.hypot(near, radius))
    return field(f"cylinder magnet, {'off' if rho else 'on'} its axis", source, {"magnet": {"at": [0, 0, 0], "radius": radius,
                 "length": length, "remanence": [0, 0, remanence]}}, rho, z,
                 {0: layers[0], 2: layers[1]} if rho else {2: layers[1]})


def coil() -> Case:
    across, along = loop(0.015, 3 * 300, 0.008, 0.01)
    return field("coil, off its axis", "Smythe 1950, section 7.10", {"coil": {"at": [0, 0, 0], "radius": 0.015, "current": 3,
                 "turns": 300}}, 0.008, 0.01, {0: across, 2: along})


def dipoles() -> Case:
    """A small, stiff magnetised strip above a dipole: 3 mu_0 m1 m2/(2 pi d^4), on one line."""
    size, distance, moment = 1e-3, 0.1, 2.0
    scene = {"job": "equilibrium",
             "shell": {"mesh": {"shape": "sheet", "size": [size, size], "cells": [4, 4]}, "thickness": 1e-4, "young": 1e9,
                       "poisson": 0.3, "magnetization": [0, 0, MAGNET]},
             "fix": [{"group": "root", "clamp": True}],
             "flux_density": [{"dipole": {"at": [size / 2, size / 2, -distance], "moment": [0, 0, moment]}}]}
    force = 3 * MU0 * MAGNET * size**2 * 1e-4 * moment / (2 * math.pi * distance**4)
    return Case(name="two dipoles on a line", source="Jackson 1998, eq. 5.69", mesh="4 x 4 cells", scenes=[scene],
                figures=[Figure("force/(3 mu_0 m1 m2/(2 pi d^4))", lambda r: r["final/support_force"][0][2] / force, 1, 1e-3)])


CASES = [strip(1, 90), strip(4, 90), strip(16, 90), strip(4, 60), strip(4, 150), rod(4, 90), rod(16, 120), couple(), block(),
         cylinder(0), cylinder(0.006), coil(), dipoles()]
