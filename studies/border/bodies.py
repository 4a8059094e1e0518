"""Boxes of linear elastic bodies on graded grids, in the plane or in space, condensed to the displacements of their contact
nodes. Everything else of a box is either free or has a prescribed displacement. The contact is on the side z = 0."""

from itertools import permutations, product

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

# Two points a direction: exact for the stiffness of a box.
GAUSS = (1 - 1 / np.sqrt(3)) / 2, (1 + 1 / np.sqrt(3)) / 2
# Of places on a side, over their size.
ON = 1e-9


def graded(size, fine, far, growth, shift=0.0):
    """Places of nodes from -far to far: parts of `size` over -fine to fine or a little more, moved by `shift`, then ever
    larger ones."""
    half = int(np.ceil(fine / size - ON))
    middle = size * np.arange(-half, half + 1) + shift
    left, right = outwards(-middle[0], size, far, growth), outwards(middle[-1], size, far, growth)
    return np.concatenate([-left[:0:-1], middle, right[1:]])


def outwards(start, size, far, growth):
    """Places from `start` to `far`, whose distances grow from `size` on."""
    count = max(1, int(np.ceil(np.log(1 + (far - start) * (growth - 1) / (size * growth)) / np.log(growth))))
    steps = growth ** np.arange(1, count + 1)
    return start + (far - start) * np.append(0, np.cumsum(steps) / steps.sum())


def heights(size, fine, far, growth, upper):
    """Places of nodes of a body above or below z = 0, first at distances of `size`."""
    count = int(np.ceil(fine / size - ON))
    depths = np.concatenate([size * np.arange(count), outwards(size * count, size, far, growth)])
    return depths if upper else -depths[::-1]


class Box:
    """A grid of cells with corner nodes: `planes`, places of nodes along each axis, the last of them the height. Plane ones
    are in plane strain."""

    def __init__(self, planes, young, poisson):
        self.young, self.poisson, self.dimension = young, poisson, len(planes)
        self.x = np.stack([g.ravel() for g in np.meshgrid(*planes, indexing="ij")], axis=1)
        counts = tuple(map(len, planes))
        number = np.arange(len(self.x)).reshape(counts)
        corners = [number[tuple(slice(c, n - 1 + c) for c, n in zip(corner, counts))].ravel()
                   for corner in product((0, 1), repeat=self.dimension)]
        self.cells = np.stack(corners, axis=1)
        self.upper = planes[-1][0] >= 0

    def facets(self):
        """On z = 0: lines with the body to their left, quadrilaterals right-handed seen from outside."""
        ends = np.arange(self.cells.shape[1]) % 2 == (0 if self.upper else 1)
        facets = self.cells[:, ends]
        facets = facets[(self.x[facets][:, :, -1] == 0).all(axis=1)]
        order = {2: ((0, 1), (1, 0)), 3: ((0, 1, 3, 2), (0, 2, 3, 1))}[self.dimension][0 if self.upper else 1]
        return facets[:, order]

    def law(self):
        """Stresses from strains: the normal ones, then shears, which are 2 e_ij."""
        d, lame = self.dimension, self.young * self.poisson / ((1 + self.poisson) * (1 - 2 * self.poisson))
        shear = self.young / (2 * (1 + self.poisson))
        matrix = np.diag([2 * shear] * d + [shear] * (d * (d - 1) // 2))
        matrix[:d, :d] += lame
        return matrix

    def gradients(self):
        """Of the functions (cells, nodes, d) with the volume of each point of a rule."""
        d, corners = self.dimension, np.array(list(product((0, 1), repeat=self.dimension)))
        sizes = self.x[self.cells[:, -1]] - self.x[self.cells[:, 0]]
        for point in product(GAUSS, repeat=d):
            ends = np.where(corners, point, 1 - np.array(point))
            slopes = [(2 * corners[:, i] - 1) * np.delete(ends, i, axis=1).prod(axis=1) for i in range(d)]
            yield np.stack(slopes, axis=1)[None] / sizes[:, None, :], sizes.prod(axis=1) / 2**d

    def stiffness(self):
        d, (count, corners), law = self.dimension, self.cells.shape, self.law()
        total = np.zeros((count, corners * d, corners * d))
        for slopes, volume in self.gradients():
            strain = np.zeros((count, len(law), corners, d))
            for i in range(d):
                strain[:, i, :, i] = slopes[:, :, i]
            for k, (i, j) in enumerate((i, j) for i in range(d) for j in range(i + 1, d)):
                strain[:, d + k, :, i], strain[:, d + k, :, j] = slopes[:, :, j], slopes[:, :, i]
            b = strain.reshape(count, len(law), -1)
            total += np.swapaxes(b, 1, 2) @ law @ b * volume[:, None, None]
        dofs = (d * self.cells[:, :, None] + np.arange(d)).reshape(count, -1)
        m, n = dofs.shape[1], d * len(self.x)
        at = np.repeat(dofs, m, axis=1).ravel(), np.tile(dofs, (1, m)).ravel()
        return sparse.csc_array((total.ravel(), at), shape=(n, n))


class Tetrahedra(Box):
    """The same box in space, each cell in six tetrahedra. Nodes nearer than `within` to the axis and to z = 0 are moved at
    random by up to `jitter`, in the planes x = 0, y = 0 and z = 0 along them."""

    def __init__(self, planes, young, poisson, jitter, within, seed):
        super().__init__(planes, young, poisson)
        place = {corner: k for k, corner in enumerate(product((0, 1), repeat=3))}
        paths = []
        for order in permutations(range(3)):
            corners = [np.zeros(3, int)]
            for axis in order:
                corners.append(corners[-1] + np.eye(3, dtype=int)[axis])
            paths.append([place[tuple(c)] for c in corners])
        self.cells = np.concatenate([self.cells[:, path] for path in paths])
        moved = jitter * np.random.default_rng(seed).uniform(-1, 1, self.x.shape)
        self.x = self.x + np.where((np.abs(self.x) < within).all(axis=1)[:, None] & (np.abs(self.x) > ON), moved, 0)

    def facets(self):
        """Triangles, right-handed seen from outside."""
        on = self.x[self.cells][:, :, 2] == 0
        cells, on = self.cells[on.sum(axis=1) == 3], on[on.sum(axis=1) == 3]
        facets = cells[on].reshape(-1, 3)
        a, b = (self.x[facets[:, k]] - self.x[facets[:, 0]] for k in (1, 2))
        outside = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] < 0) == self.upper
        return np.where(outside[:, None], facets, facets[:, ::-1])

    def gradients(self):
        at = self.x[self.cells]
        inverse = np.linalg.inv(np.swapaxes(at[:, 1:] - at[:, :1], 1, 2))
        slopes = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
        yield slopes, 1 / np.abs(np.linalg.det(inverse)) / 6


class Condensed:
    """A box seen from its contact nodes: force = stiffness u - load(prescribed displacements).

    `contact`: numbers of the nodes; `components`: which of their displacements are unknown, the others are free inside;
    `fixed`: a mask (nodes, d) of what is prescribed."""

    def __init__(self, box, contact, components, fixed):
        d, n = box.dimension, len(box.x)
        self.box, self.contact = box, contact
        self.own = (d * contact[:, None] + np.array(components)).ravel()
        self.fixed = np.flatnonzero(fixed.ravel())
        if np.isin(self.own, self.fixed).any():
            raise ValueError("a contact node's unknown is prescribed")
        inner = np.setdiff1d(np.arange(d * n), np.append(self.own, self.fixed))
        k = box.stiffness()
        factor = splu(k[inner][:, inner])
        self.inner = factor.solve(k[inner][:, self.own].toarray())
        self.stiffness = k[self.own][:, self.own].toarray() - k[self.own][:, inner] @ self.inner
        self.coupling = k[self.own][:, self.fixed], k[inner][:, self.fixed]

    def load(self, displacement):
        """Forces on the contact nodes of what is prescribed: (nodes, d), of which the prescribed ones are read."""
        u = displacement.ravel()[self.fixed]
        own, inner = self.coupling
        return self.inner.T @ (inner @ u) - own @ u
