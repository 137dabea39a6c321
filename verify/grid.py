"""Triangle meshes over a rectangle of parameters, for cases whose surfaces the program does not generate."""
from __future__ import annotations

from typing import Callable

import numpy as np

Place = Callable[[float, float], tuple]


class Grid:
    """cells across and along the parameters 0..1, each split by a diagonal, as `pattern` says of sheets (right, alternate,
    crossed; unstructured: alternate, with the inner vertices moved at random); wrap closes it along the first one."""

    def __init__(self, cells: tuple[int, int], place: Place, pattern: str = "right", wrap: bool = False):
        self.cells, self.wrap = cells, wrap
        nu, nv = cells
        columns = nu if wrap else nu + 1
        parameters = [[i / nu, j / nv] for j in range(nv + 1) for i in range(columns)]
        corner = [[j * columns + i % columns for i in range(nu + 1)] for j in range(nv + 1)]
        self.faces: list[tuple[int, int, int]] = []
        for j in range(nv):
            for i in range(nu):
                a, b, c, d = corner[j][i], corner[j][i + 1], corner[j + 1][i + 1], corner[j + 1][i]
                if pattern == "crossed":
                    m = len(parameters)
                    parameters.append([(i + 0.5) / nu, (j + 0.5) / nv])
                    self.faces += [(a, b, m), (b, c, m), (c, d, m), (d, a, m)]
                elif pattern == "right" or (i + j) % 2 == 0:
                    self.faces += [(a, b, c), (a, c, d)]
                else:
                    self.faces += [(a, b, d), (b, c, d)]
        self.parameters = np.array(parameters, float)
        if pattern == "unstructured":
            self._scatter()
        self.points = np.array([place(u, v) for u, v in self.parameters], float)

    def _scatter(self) -> None:
        inner = ((self.parameters > 0) & (self.parameters < 1)).all(1)
        moved = np.random.default_rng(21).uniform(-0.3, 0.3, self.parameters.shape) / np.array(self.cells)
        self.parameters[inner] += moved[inner]

    def where(self, choose: Callable[[float, float], bool]) -> list[int]:
        """The vertices whose parameters are so."""
        return [n for n, (u, v) in enumerate(self.parameters) if choose(u, v)]

    def nearest(self, u: float, v: float) -> int:
        return int(np.argmin(((self.parameters - (u, v)) ** 2).sum(1)))

    def obj(self) -> str:
        lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in self.points]
        return "\n".join(lines + ["f " + " ".join(str(v + 1) for v in face) for face in self.faces]) + "\n"


def graded_box(sides: list[np.ndarray]) -> str:
    """A box of tetrahedra, six in each cell between the given x, y and z: a Gmsh file, 2.2."""
    nx, ny, nz = (len(side) for side in sides)
    node = np.arange(nx * ny * nz).reshape(nx, ny, nz) + 1
    places = np.stack(np.meshgrid(*sides, indexing="ij"), -1).reshape(-1, 3)
    paths = [(4, 6), (5, 4), (6, 2), (2, 3), (1, 5), (3, 1)]  # from corner 0 to 7 along the axes, corners in binary
    lines = []
    for i, j, k in np.ndindex(nx - 1, ny - 1, nz - 1):
        corner = [node[i + (c >> 2), j + (c >> 1 & 1), k + (c & 1)] for c in range(8)]
        lines += [f"{{}} 4 2 1 1 {corner[0]} {corner[a]} {corner[b]} {corner[7]}" for a, b in paths]
    text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + f"{len(places)}\n"
    text += "".join(f"{n + 1} {x:.17g} {y:.17g} {z:.17g}\n" for n, (x, y, z) in enumerate(places))
    text += f"$EndNodes\n$Elements\n{len(lines)}\n" + "".join(line.format(n + 1) + "\n" for n, line in enumerate(lines))
    return text + "$EndElements\n"
