#!/usr/bin/python3
"""Targets of the hearts, meshes/heart_band.ply and heart_lower.ply: where the nodes of heart_known.yaml are in its field, with a
magnetised ribbon and a magnetised lower half. Binary PLY, single precision, m; the faces of the surface.

    PYTHONPATH=python scenes/make_hearts.py [FOLDER]        default: this file's own; needs a built clone (docs/python.md)"""
import os
import sys

import numpy
import slender

HEADER = """ply
format binary_little_endian 1.0
comment nodes of heart_known.yaml in its field, skin on %s; made by scenes/make_hearts.py; m
element vertex %d
property float x
property float y
property float z
element face %d
property list uchar int vertex_indices
end_header
"""


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    folder = sys.argv[1] if len(sys.argv) > 1 else here
    for name, group in (("band", "ribbon"), ("lower", "lower")):
        scene = slender.Scene(os.path.join(here, "heart_known.yaml"), set={"solid.skin.on": group})
        model = scene.model()
        x, faces = model.equilibrium().x, model.faces
        corners = numpy.empty(len(faces), dtype=[("count", "u1"), ("vertices", "<i4", 3)])
        corners["count"], corners["vertices"] = 3, faces
        with open(os.path.join(folder, "meshes", "heart_%s.ply" % name), "wb") as file:
            file.write((HEADER % (group, len(x), len(faces))).encode())
            file.write(x.astype("<f4").tobytes() + corners.tobytes())


if __name__ == "__main__":
    main()
