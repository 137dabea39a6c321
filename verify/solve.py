#!/usr/bin/env python3
"""Solves the boundary value problems whose numbers the cases keep (scipy, tolerance 1e-10) and prints them.

    heavy elastica: theta'' = -w (1 - s) cos theta, theta(0) = 0, theta'(1) = 0: clamped level, w = weight L^3/EI"""
from __future__ import annotations

import numpy as np
from scipy.integrate import solve_bvp


def heavy_elastica(load: float) -> tuple[float, float]:
    """Where the end hangs, x and y over L."""
    s = np.linspace(0, 1, 401)
    guess = np.zeros((4, s.size))
    for w in np.geomspace(min(load, 0.5), load, 40):
        def slope(s, y, w=w):
            return np.vstack([y[1], -w * (1 - s) * np.cos(y[0]), np.cos(y[0]), np.sin(y[0])])
        found = solve_bvp(slope, lambda a, b: np.array([a[0], b[1], a[2], a[3]]), s, guess, tol=1e-10, max_nodes=200000)
        assert found.success, found.message
        s, guess = found.x, found.y
    return guess[2][-1], guess[3][-1]


for load in (1, 10, 100, 1000, 10000):
    print(f"w L^3/EI = {load}: x/L = {heavy_elastica(load)[0]:.10f}, y/L = {heavy_elastica(load)[1]:.10f}")
