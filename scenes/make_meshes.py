#!/usr/bin/python3
"""Makes the meshes of the scenes that walk, swim and grip, and Cook's membrane: meshes/*.obj, in metres, and the octopus's
magnetisation, octopus_*_magnetization.csv. All of them are sheets (or a ball) of triangles with groups of faces and edges;
every one is made of formulas, so that this file says what they are.

    scenes/make_meshes.py [FOLDER]        default: this file's own"""
import math
import os
import sys

MM = 1e-3


class Mesh:
    """Vertices by name: whoever asks for the same one gets the same number."""

    def __init__(self):
        self.places, self.numbers, self.groups, self.edges = [], {}, {}, {}

    def vertex(self, name, place):
        if name not in self.numbers:
            self.numbers[name] = len(self.places)
            self.places.append(tuple(place))
        return self.numbers[name]

    def flat(self, x, y):
        """One in the plane z = 0, named by where it is."""
        return self.vertex((round(2 * x), round(2 * y)), (x * MM, y * MM, 0))

    def face(self, group, *corners):
        self.groups.setdefault(group, []).append(corners)

    def edge(self, group, a, b):
        self.edges.setdefault(group, []).append((a, b))

    def crossed(self, group, x, y):
        """A cell of 1 mm from (x, y) mm on: four triangles around its middle."""
        a, b, c, d = (self.flat(x + i, y + j) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
        middle = self.flat(x + 0.5, y + 0.5)
        for p, q in ((a, b), (b, c), (c, d), (d, a)):
            self.face(group, p, q, middle)

    def cell(self, group, a, b, c, d, falling):
        """Two triangles; falling: the diagonal is b d, else a c."""
        if falling:
            self.face(group, a, b, d), self.face(group, b, c, d)
        else:
            self.face(group, a, b, c), self.face(group, a, c, d)

    def faces(self):
        return [(group, face) for group, faces in self.groups.items() for face in faces]

    def middle(self, face):
        return tuple(sum(self.places[v][i] for v in face) / 3 for i in range(3))

    def write(self, path, comment):
        with open(path, "w") as file:
            file.write("# %s\n" % comment)
            file.writelines("v %.9g %.9g %.9g\n" % tuple(x + 0.0 for x in p) for p in self.places)
            for letter, groups in (("f", self.groups), ("l", self.edges)):
                for group, items in groups.items():
                    file.write("g %s\n" % group)
                    file.writelines("%s %s\n" % (letter, " ".join(str(v + 1) for v in item)) for item in items)


def reptile():
    """A body of 17 by 4 crossed cells of 1 mm along x, its middle line y = 0; legs of 1 by 4 cells, l on the side of y > 0, at
    its cells 2, 4, .., 14, which count from 0."""
    mesh = Mesh()
    for i in range(17):
        for j in range(4):
            mesh.crossed("body", i, j - 2)
    for leg in range(1, 8):
        for j in range(4):
            mesh.crossed("leg%dl" % leg, 2 * leg, 2 + j)
            mesh.crossed("leg%dr" % leg, 2 * leg, -3 - j)
    return mesh


AROUND, RINGS, CELLS, TENTACLES = 24, 4, 9, 6  # of the octopus; a tentacle is three of the rim's edges wide
RADIUS, TENTACLE = 6 * MM, 18 * MM


def tentacle_direction(k, flare):
    """Outwards, of tentacle k: backwards, turned by the flare (degrees) from the axis, in the plane of its middle."""
    a, around = math.radians(flare), 2 * math.pi * (4 * k + 1.5) / AROUND
    return (-math.cos(a), math.sin(a) * math.cos(around), math.sin(a) * math.sin(around))


def octopus(flare):
    """A hemisphere about +x whose rim is in x = 0, and tentacles backwards from it. Normals are outwards."""
    mesh = Mesh()

    def ring(k, i):
        polar, around = math.pi / 2 * k / RINGS, 2 * math.pi * (i % AROUND) / AROUND
        return mesh.vertex(("head", k, i % AROUND if k else 0),
                           (RADIUS * math.cos(polar) if k < RINGS else 0.0,
                            RADIUS * math.sin(polar) * math.cos(around),
                            RADIUS * math.sin(polar) * math.sin(around)))

    def arm(k, i, j):
        if j == 0:
            return ring(RINGS, 4 * k + i)
        rim, along = mesh.places[ring(RINGS, 4 * k + i)], tentacle_direction(k, flare)
        return mesh.vertex((k, i, j), (p + TENTACLE * j / CELLS * d for p, d in zip(rim, along)))

    for i in range(AROUND):
        mesh.face("head", ring(0, 0), ring(1, i), ring(1, i + 1))
    for k in range(1, RINGS):
        for i in range(AROUND):
            mesh.cell("head", ring(k, i), ring(k + 1, i), ring(k + 1, i + 1), ring(k, i + 1), (k + i) % 2)
    for k in range(TENTACLES):
        for j in range(CELLS):
            for i in range(3):
                mesh.cell("tentacle%d" % (k + 1), arm(k, i, j), arm(k, i, j + 1), arm(k, i + 1, j + 1),
                          arm(k, i + 1, j), (i + j) % 2)
    return mesh


def write_magnetization(path, mesh, flare, size):
    """Along each tentacle to its tip; none in the head."""
    with open(path, "w") as file:
        file.write("# Remanent magnetisation of meshes/octopus_%d.obj, A/m, a row per face\n" % flare)
        for group, _ in mesh.faces():
            along = (0, 0, 0) if group == "head" else tentacle_direction(int(group[-1]) - 1, flare)
            file.write("%.6g,%.6g,%.6g\n" % tuple(size * d + 0.0 for d in along))


def gripper():
    """A palm of 5 by 5 crossed cells of 1 mm, and four arms of 20 by 5 cells, which are the same turned by 90 degrees. At the
    palm's middle is the origin, normals are along z."""
    mesh = Mesh()
    for i in range(5):
        for j in range(5):
            mesh.crossed("palm", i - 2.5, j - 2.5)
    for k, (c, s) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        for i in range(20):
            for j in range(5):
                corners = ((i + a + 2.5, j + b - 2.5) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)))
                mesh.cell("arm%d" % (k + 1), *(mesh.flat(c * x - s * y, s * x + c * y) for x, y in corners), (i + j) % 2)
    return mesh


def add_ball(mesh, radius, centre):
    """An icosahedron whose faces are halved twice: 320 faces, on the sphere. Normals are outwards."""
    golden = (1 + math.sqrt(5)) / 2
    corners = []
    for i in range(3):
        for a in (-1, 1):
            for b in (-golden, golden):
                corners.append(tuple((0, a, b)[(k - i) % 3] for k in range(3)))

    def unit(p):
        return tuple(x / math.hypot(*p) for x in p)

    def put(p):
        return mesh.vertex(("ball",) + tuple(round(1e6 * x) for x in p), (c + radius * x for c, x in zip(centre, p)))

    def halve(a, b, c, times):
        if times == 0:
            return mesh.face("ball", put(a), put(b), put(c))
        ab, bc, ca = (unit(tuple((x + y) / 2 for x, y in zip(p, q))) for p, q in ((a, b), (b, c), (c, a)))
        for face in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)):
            halve(*face, times - 1)

    def outwards(a, b, c):
        (p, q, r), (u, v, w) = (tuple(y - x for x, y in zip(a, e)) for e in (b, c))
        return a[0] * (q * w - r * v) + a[1] * (r * u - p * w) + a[2] * (p * v - q * u) > 0

    near = lambda a, b: math.dist(a, b) < 2.1
    for i, a in enumerate(corners):
        for j, b in enumerate(corners[:i]):
            for c in corners[:j]:
                if near(a, b) and near(b, c) and near(c, a):
                    halve(*(unit(p) for p in ((a, b, c) if outwards(a, b, c) else (a, c, b))), 2)


def cook(n):
    """Cook's membrane: 48 mm long, from y = 0 to 44 mm at its left and from 44 to 60 mm at its right; n by n cells."""
    mesh = Mesh()

    def at(i, j):
        x, low, high = i / n, 44 * i / n, 44 + 16 * i / n
        return mesh.vertex((i, j), (48 * x * MM, (low + (high - low) * j / n) * MM, 0))

    for j in range(n + 1):  # numbered row by row
        for i in range(n + 1):
            at(i, j)
    for j in range(n):
        for i in range(n):
            mesh.cell("membrane", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1), False)
        mesh.edge("left", at(0, j), at(0, j + 1))
        mesh.edge("right", at(n, j), at(n, j + 1))
    return mesh


BALL = 4 * MM


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    meshes = os.path.join(folder, "meshes")
    os.makedirs(meshes, exist_ok=True)

    def write(name, mesh, comment):
        mesh.write(os.path.join(meshes, name + ".obj"), comment + "; made by scenes/make_meshes.py; m")

    write("reptile", reptile(), "A body of 17 x 4 mm with seven pairs of legs")
    for flare in (0, 10, 30):
        mesh = octopus(flare)
        write("octopus_%d" % flare, mesh, "A bullet-headed octopus, tentacles flared by %d degrees" % flare)
        if flare:
            write_magnetization(os.path.join(folder, "octopus_%d_magnetization.csv" % flare), mesh, flare, 2e3)
    write("gripper", gripper(), "Four arms of 20 x 5 mm around a palm")
    both, ball = gripper(), Mesh()
    add_ball(both, BALL, (0, 0, -BALL - 1 * MM))
    add_ball(ball, BALL, (0, 0, 0))
    write("ball", ball, "A ball of 4 mm")
    write("gripper_ball", both, "Four arms around a palm, and a ball of 4 mm whose top is 1 mm under it")
    write("cook", cook(8), "Cook's membrane, 8 x 8 cells; extruded by cook.yaml")


if __name__ == "__main__":
    main()
