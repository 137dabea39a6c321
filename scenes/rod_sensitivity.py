#!/usr/bin/python3
"""How well an inversion gives back a straight rod that hangs down (the paper's figure 5): for Young's moduli from 0.1 MPa to 1 GPa
the cantilever of rod_cantilever.yaml is simulated, the curve through its nodes inverted, and the largest |z| of the natural shape
printed over the length, beside the bending length L_gb over the length, L_gb^3 = E r^2/(4 rho g).

    PYTHONPATH=python scenes/rod_sensitivity.py [ELEMENTS] [PICTURE]    default: 200, no picture; needs a built clone
                                                                      (docs/python.md), the picture matplotlib, too"""
import os
import sys
import tempfile

import numpy
import slender

HERE = os.path.dirname(os.path.abspath(__file__))
RADIUS, LENGTH, DENSITY, GRAVITY = 2.225e-3, 0.2, 1200, 9.8


def hang(young, elements, folder):
    """Places of the simulated rod, and those of the natural shape that the curve through its nodes has."""
    settings = {"rod.young": young, "rod.elements": elements}
    scene = slender.Scene(os.path.join(HERE, "rod_cantilever.yaml"), set=settings)
    rest = slender.run(scene, output=os.path.join(folder, "rest"), force=True)
    x = rest["rod/x"]
    nodes = os.path.join(folder, "nodes.csv")
    numpy.savetxt(nodes, x, fmt="%.17g", delimiter=", ")
    rod = {"curve": {"file": nodes, "noise": 0}, "elements": elements, "radius": RADIUS, "young": young, "poisson": 0.5,
           "density": DENSITY, "gravity": [0, 0, -GRAVITY]}
    inverse = slender.run({"slender": 1, "job": "invert", "rod": rod}, output=os.path.join(folder, "natural"), force=True)
    return x, inverse["rod/natural"]


def draw(rows, picture):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, (natural, rest, error) = pyplot.subplots(1, 3, figsize=(12, 3.6), layout="constrained")
    colours = pyplot.get_cmap("viridis")(numpy.linspace(0, 0.9, len(rows)))
    for (ratio, most, x, shape), colour in zip(rows, colours):
        rest.plot(1e3 * x[:, 0], 1e3 * x[:, 2], color=colour)
        natural.plot(1e3 * shape[:, 0], 1e6 * shape[:, 2], color=colour)
    error.loglog([row[0] for row in rows], [row[1] for row in rows], "o-")
    error.axhline(1e-2, color="grey", linestyle=":")
    for axes, title, label in ((natural, "natural shapes", "z (\u00b5m)"), (rest, "simulated", "z (mm)")):
        axes.set(title=title, xlabel="x (mm)", ylabel=label)
    error.set(title="largest |z|/L of the natural shape", xlabel="L_gb/L")
    figure.savefig(picture, dpi=130)


def main():
    elements = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for young in numpy.logspace(5, 9, 13):
            x, shape = hang(float(young), elements, folder)
            ratio = (young * RADIUS ** 2 / (4 * DENSITY * GRAVITY)) ** (1 / 3) / LENGTH
            most = float(numpy.abs(shape[:, 2]).max() / LENGTH)
            rows.append((ratio, most, x, shape))
            print("%8.3g Pa  L_gb/L %.4f  tip at z = %7.2f mm  largest |z|/L %.2g"
                  % (young, ratio, 1e3 * x[-1, 2], most))
    if len(sys.argv) > 2:
        draw(rows, sys.argv[2])


main()
