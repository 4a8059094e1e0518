"""Linear elastic quadrilaterals of plane and axisymmetric models, with 4 or 8 nodes, in meshes of boxes. Forces of an axisymmetric
model are those of the whole ring."""

from dataclasses import dataclass, field

import numpy as np

# Corners of a cell counterclockwise, then the nodes in the middle of its sides.
AT = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], float)
# Gauss with three points a direction.
POINTS = [(x, v) for x, v in zip((-(0.6**0.5), 0, 0.6**0.5), (5 / 9, 8 / 9, 5 / 9))]


def functions(n, x, y):
    """Values and derivatives of the functions of a cell."""
    if n == 4:
        a, b = 1 + AT[:4, 0] * x, 1 + AT[:4, 1] * y
        return a * b / 4, np.array([AT[:4, 0] * b / 4, AT[:4, 1] * a / 4])
    s, t = AT.T
    a, b, c = 1 + s * x, 1 + t * y, s * x + t * y - 1
    value, dx, dy = a * b * c / 4, s * b * (c + a) / 4, t * a * (c + b) / 4
    for k in (4, 6):
        value[k], dx[k], dy[k] = (1 - x * x) * b[k] / 2, -x * b[k], (1 - x * x) * t[k] / 2
    for k in (5, 7):
        value[k], dx[k], dy[k] = (1 - y * y) * a[k] / 2, (1 - y * y) * s[k] / 2, -y * a[k]
    return value, np.array([dx, dy])


@dataclass
class Body:
    """n x m cells with 4 or 8 nodes over a box, placed by `map`. model: "strain", "stress" or "ring"."""

    cells_along: tuple
    box: tuple  # (x0, y0, x1, y1)
    nodes: int
    model: str
    young: float
    poisson: float
    thickness: float = 1.0
    map: object = None
    x: np.ndarray = field(init=False)

    def __post_init__(self):
        n, m = self.cells_along
        x0, y0, x1, y1 = self.box
        grid = {}
        for j in range(2 * m + 1):
            for i in range(2 * n + 1):
                if (i % 2 or j % 2) and (self.nodes == 4 or (i % 2 and j % 2)):
                    continue
                grid[i, j] = len(grid)
        x = np.array([(x0 + (x1 - x0) * i / (2 * n), y0 + (y1 - y0) * j / (2 * m)) for i, j in grid])
        self.x = x if self.map is None else np.array([self.map(p) for p in x])
        places = [(int(a) + 1, int(b) + 1) for a, b in AT[: self.nodes]]
        self.cells = [[grid[2 * i + a, 2 * j + b] for a, b in places] for j in range(m) for i in range(n)]
        self.grid = grid

    def side(self, name):
        """Its lines, with the body to their left."""
        n, m = self.cells_along
        ends = {
            "bottom": [((2 * i, 0), (2 * i + 2, 0)) for i in range(n)],
            "right": [((2 * n, 2 * j), (2 * n, 2 * j + 2)) for j in range(m)],
            "top": [((2 * i + 2, 2 * m), (2 * i, 2 * m)) for i in range(n)],
            "left": [((0, 2 * j + 2), (0, 2 * j)) for j in range(m)],
        }[name]
        middle = [] if self.nodes == 4 else [1]
        return [[self.grid[a], self.grid[b]] + [self.grid[(a[0] + b[0]) // 2, (a[1] + b[1]) // 2] for _ in middle] for a, b in ends]

    def rho(self, x):
        return 2 * np.pi * x[0] if self.model == "ring" else self.thickness

    def law(self):
        """Stresses xx, yy, zz, xy from strains xx, yy, zz, 2 xy."""
        e, nu = self.young, self.poisson
        if self.model == "stress":
            c = e / (1 - nu * nu)
            return np.array([[c, c * nu, 0, 0], [c * nu, c, 0, 0], [0, 0, 0, 0], [0, 0, 0, e / (2 * (1 + nu))]])
        lame, mu = e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))
        d = np.diag([2 * mu, 2 * mu, 2 * mu, mu])
        d[:3, :3] += lame
        return d

    def strains(self, at, x, y):
        """Determinant, place and the strains of a unit displacement of each component of the nodes at `at`."""
        value, slopes = functions(len(at), x, y)
        jacobian = slopes @ at
        gradient = np.linalg.solve(jacobian, slopes)
        place, b = value @ at, np.zeros((4, 2 * len(at)))
        b[0, ::2], b[1, 1::2], b[3, ::2], b[3, 1::2] = gradient[0], gradient[1], gradient[1], gradient[0]
        if self.model == "ring":
            b[2, ::2] = value / place[0]
        return np.linalg.det(jacobian), place, b

    def stiffness(self):
        k, law = np.zeros((2 * len(self.x),) * 2), self.law()
        for cell in self.cells:
            own = np.zeros((2 * len(cell),) * 2)
            for (x, v), (y, w) in ((p, q) for p in POINTS for q in POINTS):
                det, place, b = self.strains(self.x[cell], x, y)
                own += b.T @ law @ b * (det * v * w * self.rho(place))
            dofs = (2 * np.repeat(cell, 2).reshape(-1, 2) + [0, 1]).ravel()
            k[np.ix_(dofs, dofs)] += own
        return k

    def pressed(self, name, pressure):
        """Forces of a pressure on a side, undeformed."""
        return self.loaded(name, lambda tangent: pressure * np.array([-tangent[1], tangent[0]]))

    def drawn(self, name, traction):
        """Forces of a traction on a side, undeformed."""
        return self.loaded(name, lambda tangent: np.linalg.norm(tangent) * np.array(traction))

    def loaded(self, name, traction):
        """Forces on a side; `traction` of the vector along a line, for the length of that."""
        force = np.zeros_like(self.x)
        for line in self.side(name):
            for xi, w in POINTS:
                if len(line) == 2:
                    n, d = np.array([1 - xi, 1 + xi]) / 2, np.array([-0.5, 0.5])
                else:
                    n, d = np.array([xi * (xi - 1) / 2, xi * (xi + 1) / 2, 1 - xi * xi]), np.array([xi - 0.5, xi + 0.5, -2 * xi])
                tangent, place = d @ self.x[line], n @ self.x[line]
                force[line] += np.outer(n, traction(tangent)) * (w * self.rho(place))
        return force
