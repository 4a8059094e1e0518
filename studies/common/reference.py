"""Reference values: tables from reference/*.json, Hertz's formulas, and a plane block held by its contact zone.

Everything is per unit thickness. Axes as in the scenes: x along the contact, z up.
"""

import json
from pathlib import Path

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve

_HERE = Path(__file__).resolve().parent / "reference"
BLOCK = json.loads((_HERE / "block.json").read_text())
IRONING = json.loads((_HERE / "shallow_ironing.json").read_text())
HERTZ = json.loads((_HERE / "hertz.json").read_text())


class Hertz:
    """Line contact of two equal cylinders: half-width a, peak pressure p0, profile p(x)."""

    modulus = HERTZ["young"] / (2 * (1 - HERTZ["poisson"] ** 2))
    radius = HERTZ["radius"] / 2
    half_width = np.sqrt(4 * HERTZ["force"] * radius / (np.pi * modulus))
    peak = 2 * HERTZ["force"] / (np.pi * half_width)

    @classmethod
    def pressure(cls, x):
        return cls.peak * np.sqrt(np.maximum(0.0, 1 - (np.asarray(x) / cls.half_width) ** 2))


def fit_hertz(x, p, keep=0.3):
    """(p0, a) of the ellipse through a computed profile: p^2 is linear in x^2. Nodes below keep * max(p) are left out:
    next to the edge one facet decides."""
    use = p > keep * p.max()
    slope, intercept = np.polyfit(x[use] ** 2, p[use] ** 2, 1)
    return np.sqrt(intercept), np.sqrt(-intercept / slope)


def plane_strain(young, poisson):
    """3x3 elasticity matrix for (e_xx, e_zz, gamma_xz)."""
    shear = young / (2 * (1 + poisson))
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return np.array([[lame + 2 * shear, lame, 0], [lame, lame + 2 * shear, 0], [0, 0, shear]])


_GAUSS = 1 / np.sqrt(3)
GAUSS_POINTS = [(-_GAUSS, -_GAUSS), (_GAUSS, -_GAUSS), (_GAUSS, _GAUSS), (-_GAUSS, _GAUSS)]


def strain_matrix(corners, point):
    """(B, det J) of a four-node quadrilateral, corners (4, 2) counter-clockwise, at a point of the unit square."""
    xi, eta = point
    local = 0.25 * np.array([[-(1 - eta), 1 - eta, 1 + eta, -(1 + eta)], [-(1 - xi), -(1 + xi), 1 + xi, 1 - xi]])
    jacobian = local @ corners
    gradient = np.linalg.solve(jacobian, local)
    matrix = np.zeros((3, 8))
    matrix[0, 0::2] = matrix[2, 1::2] = gradient[0]
    matrix[1, 1::2] = matrix[2, 0::2] = gradient[1]
    return matrix, np.linalg.det(jacobian)


def clamped_block(columns=20, rows=10, zone=(0.2, 3.8)):
    """(x, force) of the foundation on the block of BLOCK when every node of the contact zone sticks.

    Sticking at zero gap on a rigid foundation from the first load on is the same as being clamped: a linear plane
    problem, solved here from scratch, so that nodal forces can be compared to more digits than the table has.
    """
    length, height, top, side = 4.0, 2.0, 200.0, 60.0
    size = length / columns
    node = lambda i, j: j * (columns + 1) + i
    count = (columns + 1) * (rows + 1)
    load, entries = np.zeros((count, 2)), []

    square = size * np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    elastic = plane_strain(1000.0, 0.3)
    element = sum(b.T @ elastic @ b * d for b, d in (strain_matrix(square, g) for g in GAUSS_POINTS))
    for j in range(rows):
        for i in range(columns):
            corners = np.array([node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])
            equations = np.stack([2 * corners, 2 * corners + 1], axis=1).ravel()
            entries.append((np.repeat(equations, 8), np.tile(equations, 8), element.ravel()))
    at, across, values = (np.concatenate(part) for part in zip(*entries))
    stiffness = sparse.csr_array((values, (at, across)), shape=(2 * count, 2 * count))
    for i in range(columns):
        load[[node(i, rows), node(i + 1, rows)], 1] -= top * size / 2
    for j in range(rows):
        load[[node(0, j), node(0, j + 1)], 0] += side * size / 2

    x = size * np.arange(columns + 1)
    clamped = np.flatnonzero((x > zone[0] - 1e-9) & (x < zone[1] + 1e-9))
    free = np.setdiff1d(np.arange(2 * count), np.concatenate([2 * clamped, 2 * clamped + 1]))
    displacement = np.zeros(2 * count)
    displacement[free] = spsolve(stiffness[free][:, free].tocsc(), load.ravel()[free])
    reaction = (stiffness @ displacement - load.ravel()).reshape(count, 2)
    assert abs(height - rows * size) < 1e-12, "the elements are squares"
    return x[clamped], reaction[clamped]
