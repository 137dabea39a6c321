# Makes tests/flux_reference.h: the flux density of a cylinder magnet, with derivatives, beside its side, on its ends and near its
# rims, by its definition in 60 digits: lines of charge and of current around the circle, by Gauss-Legendre on panels that grow
# from the angle of the point, which is at (x, 0, z). Needs mpmath.
#     python3 tests/flux_reference.py > tests/flux_reference.h
from itertools import product

from mpmath import mp, mpf, sqrt, cos, sin, pi, hypot, log, nstr

mp.dps = 60
RADIUS, HALF = mpf(0.01), mpf(0.006)
REMANENCE = (mpf(0.3), mpf(-0.5), mpf(1.1))

HEIGHTS = (0.0, 0.0012, -0.0058)
SIDE = (1e-3, 1e-5, 1e-8, 1e-12, 1e-15, -1e-15, -1e-10, -1e-6, -1e-3)
# (distance from the side, height), m
PLACES = [(d, z) for z in HEIGHTS for d in SIDE]
PLACES += [(-0.004, 0.006), (-0.0004, 0.006), (-1e-6, 0.006001), (1e-6, 0.006), (1e-7, 0.0060002), (-1e-9, 0.005999999),
           (0.0, 0.0060001), (-1e-12, 0.006), (-0.01, 0.0012), (-0.01, 0.006), (-0.00999999, 0.0060001), (1e-12, 0.0061),
           (0.0, 0.02), (-1e-5, 0.008), (0.03, 0.001), (0.3, 0.2)]


def axes(*names):
    return "".join(sorted(names))


def line(u, v, z):
    """F of a line of unit charge from -HALF to HALF and its derivatives, by their axes: "x", "xx", "xxz", .."""
    square = u * u + v * v
    F = {}
    f = [mpf(0)] * 3
    for end, sign in ((HALF - z, 1), (-HALF - z, -1)):
        R = sqrt(square + end * end)
        s = end / R
        f[0] += sign * s / square
        f[1] -= sign * 3 * (s - s**3 / 3) / square**2
        f[2] += sign * 15 * (s - 2 * s**3 / 3 + s**5 / 5) / square**3
        along = {"z": 1 / R, "xz": -u / R**3, "yz": -v / R**3, "zz": end / R**3,
                 "xxz": 3 * u * u / R**5 - 1 / R**3, "xyz": 3 * u * v / R**5, "yyz": 3 * v * v / R**5 - 1 / R**3,
                 "xzz": -3 * u * end / R**5, "yzz": -3 * v * end / R**5, "zzz": 3 * end * end / R**5 - 1 / R**3}
        for key, value in along.items():
            F[key] = F.get(key, 0) + sign * value
    F["x"], F["y"] = u * f[0], v * f[0]
    F["xx"], F["xy"], F["yy"] = f[0] + u * u * f[1], u * v * f[1], f[0] + v * v * f[1]
    F["xxx"], F["yyy"] = u * (3 * f[1] + u * u * f[2]), v * (3 * f[1] + v * v * f[2])
    F["xxy"], F["xyy"] = v * (f[1] + u * u * f[2]), u * (f[1] + v * v * f[2])
    return F


def legendre(n):
    out = []
    for k in range(n):
        x = cos(pi * (k + mpf(3) / 4) / (n + mpf(1) / 2))
        for _ in range(8):
            p, q = x, mpf(1)
            for m in range(2, n + 1):
                p, q = ((2 * m - 1) * x * p - (m - 1) * q) / m, p
            d = n * (x * p - q) / (x * x - 1)
            x -= p / d
        out.append((x, 2 / ((1 - x * x) * d * d)))
    return out


def sums(x, z):
    """Means of F around the circle: of what is even in y with cos psi, of what is odd with sin psi."""
    near = max(abs(x - RADIUS) / RADIUS, mpf(10) ** -6) / 4 if abs(z) >= HALF else abs(x - RADIUS) / RADIUS / 4
    near = min(near, hypot(x - RADIUS, abs(z) - HALF) / RADIUS / 4)
    ends = [near * 4**j for j in range(40)]
    ends = [mpf(0)] + [p for p in ends if p < 3] + [pi]
    total = {}
    for low, high in zip(ends, ends[1:]):
        for node, weight in sums.nodes:
            psi = (low + high) / 2 + (high - low) / 2 * node
            F = line(x - RADIUS + 2 * RADIUS * sin(psi / 2) ** 2, -RADIUS * sin(psi), z)
            c, s = cos(psi), sin(psi)
            for key, value in F.items():
                share = weight * (high - low) / 2 / pi * (s if key.count("y") % 2 else c)
                total[key] = total.get(key, 0) + share * value
    return total


def row(place):
    x, z = mpf(float(RADIUS) + place[0]), mpf(place[1])  # as a program in doubles has it
    mean = sums(x, z)
    even = lambda key: mean[key] if key.count("y") % 2 == 0 else mpf(0)
    odd = lambda key: mean[key] if key.count("y") % 2 else mpf(0)

    def flux(i, *more):
        key = axes(i, *more)
        B = REMANENCE[0] * even(key) + REMANENCE[1] * odd(key)
        if i == "x":
            B += REMANENCE[2] * even(axes("z", *more))
        if i == "y":
            B += REMANENCE[2] * odd(axes("z", *more))
        if i == "z":
            B -= REMANENCE[2] * (odd(axes("y", *more)) + even(axes("x", *more)))
        return B * RADIUS / 2

    out = [flux(i) for i in "xyz"]
    if x < RADIUS and abs(z) < HALF:
        out[0] += REMANENCE[0]
        out[1] += REMANENCE[1]
    out += [flux(*k) for k in product("xyz", repeat=2)]
    return out + [flux(*k) for k in product("xyz", repeat=3)]


if __name__ == "__main__":
    sums.nodes = legendre(56)
    print("/* flux_reference.h - made by flux_reference.py: distance from the side and height (m); B, its gradient, its curvature */\n/* clang-format off */")
    print("static const double flux_reference[][2 + 39] = {")
    for place in PLACES:
        numbers = ["%.17g" % v for v in place] + [nstr(v, 17) for v in row(place)]
        print("    {" + ",\n     ".join(", ".join(numbers[k : k + 6]) for k in range(0, 41, 6)) + "},", flush=True)
    print("};")
