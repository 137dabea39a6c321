#!/usr/bin/python3
"""The sampled curves of the scenes: a noisy helix, and (from results of slender) poses of one rod."""
import sys
import numpy as np

rng = np.random.default_rng(1)
u = np.linspace(0, 19.565163762857, 200)
helix = np.stack([0.015 * np.cos(u), 0.015 * np.sin(u), -0.00318 * u], 1)
np.savetxt("helix_noisy.csv", helix + 3e-4 * rng.standard_normal(helix.shape), fmt="%.6f", delimiter=",",
           header="x, y, z in m: a helix, noise of 0.3 mm")

# python3 make_curves.py POSE.vtkhdf ..: points of simulated rods, every 8th node, noise of 0.1 mm
for k, name in enumerate(sys.argv[1:]):
    import h5py
    with h5py.File(name) as f:
        x = f["slender/rod/x"][::8]
    np.savetxt("pose%d.csv" % k, x + 1e-4 * rng.standard_normal(x.shape), fmt="%.6f", delimiter=",",
               header="x, y, z in m: a pose of one rod, noise of 0.1 mm")
