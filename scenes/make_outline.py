#!/usr/bin/python3
"""strip_outline.csv: what a photograph of a sagging strip from the side would give. A strip of 0.83 MPa, finer than that of
strip_outline.yaml, is put to rest; 120 points at random along its middle, from 3 mm on from the clamp, each with an error
of 0.2 mm (normal, in x and in z), in mm and in no order.    scenes/make_outline.py PROGRAM

Needs numpy."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

SETTINGS = ["design.iterations=0", "shell.mesh.n=64", "shell.young=0.83 MPa"]
here = pathlib.Path(__file__).parent

with tempfile.TemporaryDirectory() as folder:
    result, mesh = f"{folder}/true.vtkhdf", f"{folder}/true.obj"
    sets = [word for setting in SETTINGS for word in ("--set", setting)]
    subprocess.run([sys.argv[1], "run", here / "strip_outline.yaml", *sets, "-o", result, "--no-picture", "--quiet"], check=True)
    subprocess.run([sys.argv[1], "export", result, "-o", mesh], check=True)
    points = np.array([line.split()[1:] for line in open(mesh) if line.startswith("v ")], float)
line = points[np.abs(points[:, 1] - 5e-3) < 1e-4]
s = np.r_[0, np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))]
random = np.random.default_rng(19)
at = random.uniform(3e-3, s[-1], 120)
seen = np.stack([np.interp(at, s, line[:, i]) for i in (0, 2)], 1) + random.normal(0, 2e-4, (120, 2))
np.savetxt(here / "strip_outline.csv", 1e3 * seen, fmt="%.3f", delimiter=",", header="x [mm],z [mm]", comments="")
