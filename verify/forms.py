"""Closed forms that several cases share. scipy is not needed."""
from __future__ import annotations

import math

import numpy as np


def ellip_k(k: float) -> float:
    """Complete elliptic integral of the first kind, of the modulus k, by the arithmetic-geometric mean [Gauss]."""
    a, b = 1.0, math.sqrt(1 - k * k)
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, math.sqrt(a * b)
    return math.pi / (2 * a)


def ellip_e(k: float) -> float:
    """Complete elliptic integral of the second kind, of the modulus k < 1 [Abramowitz, Stegun 17.6]."""
    a, b, c, power, total = 1.0, math.sqrt(1 - k * k), k, 0.5, 1 - k * k / 2
    while abs(c) > 1e-16:
        a, b, c, power = (a + b) / 2, math.sqrt(a * b), (a - b) / 2, 2 * power
        total -= power * c * c
    return math.pi / (2 * a) * total


def bessel_zero(order: float) -> float:
    """The first positive zero of J of an order between -1/2 and 1/2, from its series."""
    def series(z: float) -> float:
        return sum((-z * z / 4) ** n / (math.factorial(n) * math.gamma(n + order + 1)) for n in range(30))
    return bisect(series, 0.5, 4.0)


def bisect(f, low: float, high: float) -> float:
    """A zero between low and high, where f has two signs."""
    sign = f(low) > 0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if (f(middle) > 0) == sign else (low, middle)
    return (low + high) / 2


def integral(f, low: float, high: float, pieces: int = 200) -> float:
    """Gauss-Legendre, ten points a piece."""
    nodes, weights = np.polynomial.legendre.leggauss(10)
    edges = np.linspace(low, high, pieces + 1)
    half = (high - low) / pieces / 2
    return half * sum(w * f(m + half * n) for m in (edges[:-1] + edges[1:]) / 2 for n, w in zip(nodes, weights))


def denser(u: float, by: float, periods: int = 1) -> float:
    """0..1 onto itself, with points by so much denser (0: not, 1: all) at 0, 1, and between: periods - 1 times."""
    return u - by * math.sin(2 * math.pi * periods * u) / (2 * math.pi * periods)
