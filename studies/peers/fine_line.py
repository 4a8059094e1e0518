"""What the pressure of Hertz' line in `compare.py` converges to: the same half-cylinders without friction under the same force,
on a mesh many times finer, for each theory of contact that a program may have. No part of the library is used.

The bodies are linear and mirror each other, so one matrix says all: the displacements of the surface under forces on it, of a
quarter of a disc of quadrilaterals of nine nodes whose flat side is held. q is a force along z per length along x, linear
between the vertices of facets, and not negative; against its hats the gap must not be negative either. Which points
touch and along which normal is the theory:

  current       points that are one above the other in the deformed bodies, normals of the deformed bodies. Bodies are alike, so
                they meet in a plane.
  start         the same points, normals of the undeformed non-mortar side: those of a step's beginning, where that is one step.
  non-mortar    undeformed bodies, along the normal of the non-mortar side.
  mortar        undeformed bodies, along the normal of the mortar side.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

THEORIES = ("current", "start", "non-mortar", "mortar")
RADIUS, YOUNG, POISSON = 8.0, 200.0, 0.3
# Facets over the half-width of the scene's load, and how cells grow away from the fine part.
HALF_WIDTH, FACETS, GROWTH = 0.68, 80, 1.15
# The fine part: contact never comes near its end.
FINE = 0.8
GAUSS = {n: np.polynomial.legendre.leggauss(n) for n in (3, 5)}
# Columns that are solved for at a time
BLOCK = 64
# Points that touch, theory "start": of the size of the bodies.
SETTLED, MOST = 1e-9, 50


def shapes(s):
    """Three functions at points s of [-1, 1], and their derivatives: (points, 3) each."""
    s = np.asarray(s)
    return np.stack([s * (s - 1) / 2, 1 - s * s, s * (s + 1) / 2], -1), np.stack([s - 0.5, -2 * s, s + 0.5], -1)


def graded(h, fine, growth):
    """Positions from 0 to the radius, the middles of cells among them, and the number of cells of size h."""
    inner = h * np.arange(round(fine / h) + 1)
    steps = [h * growth]
    while sum(steps) < RADIUS - inner[-1]:
        steps.append(steps[-1] * growth)
    outer = inner[-1] + np.cumsum(steps) * (RADIUS - inner[-1]) / sum(steps)
    ends = np.append(inner, outer)
    return np.sort(np.append(ends, (ends[1:] + ends[:-1]) / 2)), len(inner) - 1


def bent(x, z):
    """Half a square about (0, R) becomes half a disc, as the driver's boxes do (`cylinder`)."""
    z = z - RADIUS
    scale = np.maximum(np.abs(x), np.abs(z)) / np.maximum(np.hypot(x, z), 1e-300)
    return np.stack([x * scale, RADIUS + z * scale], -1)


def stiffness(points, cells):
    """Plane strain, cells of nine nodes, 3 x 3 points"""
    shear = YOUNG / (2 * (1 + POISSON))
    lame = 2 * shear * POISSON / (1 - 2 * POISSON)
    law = np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])
    matrix, x = np.zeros((len(cells), 18, 18)), points[cells]
    at, weight = GAUSS[3]
    value, slope = shapes(at)
    for i in range(3):
        for j in range(3):
            along = np.stack([np.outer(value[j], slope[i]).ravel(), np.outer(slope[j], value[i]).ravel()], -1)
            jacobian = np.einsum("ka,ckb->cba", along, x)
            gradient = np.einsum("ka,cab->ckb", along, np.linalg.inv(jacobian))
            strain = np.zeros((len(cells), 3, 18))
            strain[:, 0, 0::2] = strain[:, 2, 1::2] = gradient[:, :, 0]
            strain[:, 1, 1::2] = strain[:, 2, 0::2] = gradient[:, :, 1]
            share = weight[i] * weight[j] * np.linalg.det(jacobian)
            matrix += np.einsum("c,cki,ckj->cij", share, strain, law @ strain, optimize=True)
    freedoms = (2 * cells[:, :, None] + np.arange(2)).reshape(len(cells), 18)
    rows, columns = np.repeat(freedoms, 18, 1).ravel(), np.tile(freedoms, 18).ravel()
    return coo_matrix((matrix.ravel(), (rows, columns)), shape=(2 * len(points),) * 2).tocsc()


def compliance(facets, growth):
    """(positions (n, 2), displacements (n, 2, n, 2) under unit forces) of the nodes of the fine part of the surface"""
    h = HALF_WIDTH / facets
    x, fine = graded(h, FINE, growth)
    z, _ = graded(h, 3 * h, growth)
    points = bent(*np.meshgrid(x, z)).reshape(-1, 2)
    wide = len(x)
    first = (2 * np.arange(len(z) // 2)[:, None] * wide + 2 * np.arange(wide // 2)).ravel()
    cells = first[:, None] + (np.arange(3)[:, None] * wide + np.arange(3)).ravel()
    held = np.zeros((len(points), 2), bool)
    held[-wide:] = True
    held[::wide, 0] = True
    free = np.flatnonzero(~held.ravel())
    solver = splu(stiffness(points, cells)[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True},
                  diag_pivot_thresh=0.0)
    count = 2 * (2 * fine + 1)
    place = np.full(held.size, -1)
    place[free] = np.arange(len(free))
    wanted = np.flatnonzero(place[:count] >= 0)
    found = np.zeros((count, count))
    for some in np.split(wanted, range(BLOCK, len(wanted), BLOCK)):
        right = np.zeros((len(free), len(some)))
        right[place[some], np.arange(len(some))] = 1
        found[np.ix_(wanted, some)] = solver.solve(right)[place[wanted]]
    return points[: count // 2], found.reshape(count // 2, 2, count // 2, 2)


class FineLine:
    """`profile` gives the pressure of a theory under a force. The matrix is kept in `folder`."""

    def __init__(self, folder, facets=FACETS, growth=GROWTH):
        file = folder / f"fine_line_{facets}_{growth:g}.npz"
        if not file.is_file():
            folder.mkdir(parents=True, exist_ok=True)
            points, matrix = compliance(facets, growth)
            np.savez(file, points=points, matrix=matrix)
        with np.load(file) as old:
            self.points, self.matrix = old["points"], old["matrix"]
        self.x = self.points[:, 0]
        self.vertices = self.x[::2]
        at, weight = GAUSS[5]
        value, slope = shapes(at)
        nodes = 2 * np.arange(len(self.x) // 2)[:, None] + np.arange(3)
        self.at = (self.x[nodes] @ value.T).ravel()
        self.share = ((self.x[nodes] @ slope.T) * weight).ravel()
        # Hats in the facets' own coordinate, but that of the last vertex: nothing touches there.
        self.hats = np.zeros((len(self.at), len(self.vertices)))
        facet = np.repeat(np.arange(len(nodes)), len(at))
        local = np.tile((1 + at) / 2, len(nodes))
        self.hats[np.arange(len(facet)), facet], self.hats[np.arange(len(facet)), facet + 1] = 1 - local, local
        self.hats = self.hats[:, :-1]

    def interpolation(self, x):
        """(points, nodes): functions of the surface's nodes at places x; beyond the fine part those of its end"""
        x = np.clip(x, 0, self.x[-1])
        facet = np.clip(np.searchsorted(self.vertices, x) - 1, 0, len(self.vertices) - 2)
        # Middle nodes are not quite in the middle along x: two steps of Newton's method
        nodes = 2 * facet[:, None] + np.arange(3)
        local = 2 * (x - self.vertices[facet]) / np.diff(self.vertices)[facet] - 1
        for _ in range(2):
            value, slope = shapes(local)
            local -= ((value * self.x[nodes]).sum(1) - x) / (slope * self.x[nodes]).sum(1)
        found = np.zeros((len(x), len(self.x)))
        np.put_along_axis(found, nodes, shapes(local)[0], 1)
        return found

    def pairs(self, theory, shift):
        """(x of the other point, normal out of the non-mortar body) of each point; `shift` is how far the surfaces have slid"""
        x, z = self.at, height(self.at)
        radial = np.stack([x, z - RADIUS], -1) / RADIUS
        if theory == "current":
            return x, np.broadcast_to([0.0, -1.0], radial.shape)
        if theory == "start":
            return x + shift, radial
        if theory == "mortar":
            way = np.stack([x, z + RADIUS], -1)
            far = np.hypot(*way.T)
            return RADIUS * x / far, -way / far[:, None]
        cosine = -radial[:, 1]
        return (2 * RADIUS * cosine - RADIUS * np.sqrt(4 * cosine**2 - 3)) * radial[:, 0], radial

    def profile(self, theory, force):
        """The pressure along z per length along x as a function of x, under `force` per thickness on both halves"""
        shift = np.zeros(len(self.at))
        for _ in range(MOST):
            other, normal = self.pairs(theory, shift)
            normal = normal / -normal[:, 1:]
            q, slid = self.solved(other, normal, force)
            if theory != "start" or np.abs(slid - shift).max() < SETTLED * RADIUS:
                return lambda x: np.interp(np.abs(x), self.vertices, np.append(q, 0))
            shift = slid
        raise RuntimeError(f"the points that touch did not settle in {MOST} steps")

    def solved(self, other, normal, force):
        """(q, how far the other points are to slide from the undeformed place of each) for given pairs and normals"""
        here, there = self.interpolation(self.at), self.interpolation(other)
        weights = self.hats * self.share[:, None]
        flip = normal * [1, -1]
        own = np.einsum("pa,pn,pi->ani", weights, here, normal, optimize=True)
        across = np.einsum("pa,pn,pi->ani", weights, there, flip, optimize=True)
        size, flat = weights.shape[1], self.matrix.reshape(2 * len(self.x), -1)
        own, across = own.reshape(size, -1), across.reshape(size, -1)
        matrix = own @ flat @ own.T + across @ flat @ across.T
        between = np.stack([other - self.at, -height(other) - height(self.at)], -1)
        gap, area = weights.T @ (normal * between).sum(1), weights.sum(0)
        closed = np.ones(size, bool)
        for _ in range(MOST):
            q, travel = complementary(matrix[closed][:, closed], area[closed], gap[closed], force / 2)
            whole = np.zeros(size)
            whole[closed] = q
            open_gap = gap + matrix @ whole - travel * area
            now = np.where(closed, whole > 0, open_gap < 0)
            if np.array_equal(now, closed):
                break
            closed = now
        else:
            raise RuntimeError(f"no contact found in {MOST} steps")
        slid = (here @ -(flat @ own.T @ whole).reshape(-1, 2) - there @ (flat @ across.T @ whole).reshape(-1, 2))[:, 0]
        return whole, slid


def complementary(matrix, area, gap, force):
    """(q, travel) where all of these are closed: gap + matrix q - travel area = 0, area . q = force"""
    found = np.linalg.solve(np.block([[matrix, -area[:, None]], [area, 0]]), np.append(-gap, force))
    return found[:-1], found[-1]


def height(x):
    """Of the cylinder over its lowest line"""
    return RADIUS - np.sqrt(RADIUS**2 - np.minimum(np.abs(x), RADIUS) ** 2)
