#!/usr/bin/python3
"""Every triangle of an OBJ in four, its groups as they are, and a table with a row per face to it: what tests/crossings.sh runs
scenes on that have a mesh from a file.

    tests/finer_mesh.py IN.obj OUT.obj [IN.csv OUT.csv]"""
import sys


def split(lines):
    """The lines of the finer OBJ: all old vertices, then the edges' middles, then the faces."""
    points, body, middles = [], [], {}

    def middle(a, b):
        edge = min(a, b), max(a, b)
        if edge not in middles:
            points.append([(p + q) / 2 for p, q in zip(points[a - 1], points[b - 1])])
            middles[edge] = len(points)
        return middles[edge]

    for line in lines:
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            a, b, c = (int(word.split("/")[0]) for word in words[1:4])
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            body += ["f %d %d %d" % face for face in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        else:
            body.append(line.rstrip("\n"))
    return ["v %.17g %.17g %.17g" % tuple(point) for point in points] + body


def main():
    with open(sys.argv[1]) as file, open(sys.argv[2], "w") as out:
        out.write("\n".join(split(file)) + "\n")
    if len(sys.argv) > 3:
        with open(sys.argv[3]) as file, open(sys.argv[4], "w") as out:
            out.writelines(line * (1 if line.startswith("#") else 4) for line in file)


if __name__ == "__main__":
    main()
