"""How far a finite element field is from an exact one, over cells with straight sides: H1 seminorm and L2 norm."""

import itertools

import numpy as np

# Exact for polynomials of degree 9 in each direction; squares of gradients of what is left have a higher degree, but are
# known to some digits by it.
POINTS = 5
TETRAHEDRA = {4: 1, 10: 2}  # nodes: degree


def exponents(nodes):
    """The monomials of a cell's displacements, by its number of nodes: P1, Q1, P2, serendipity, Q2."""
    box = list(itertools.product(range(2 if nodes <= 8 else 3), repeat=3))
    if nodes in TETRAHEDRA:
        return np.array([e for e in box if sum(e) <= TETRAHEDRA[nodes]])
    if nodes == 20:  # degree at most 3, where squares do not count if they are not alone
        return np.array([e for e in box if sum(x for x in e if x > 1) <= 2])
    return np.array(box)


def monomials(z, powers):
    """(..., 3) points -> (..., monomials), and the derivatives of each: (..., monomials, 3)"""
    table = z[..., None, :] ** powers
    slopes = []
    for k in range(3):
        each = table.copy()
        each[..., k] = powers[:, k] * z[..., None, k] ** np.maximum(powers[:, k] - 1, 0)
        slopes.append(each.prod(axis=-1))
    return table.prod(axis=-1), np.stack(slopes, axis=-1)


def rule(X):
    """Points (cells, q, 3) and weights (cells, q) of boxes along the axes, or of tetrahedra, whose corners come first."""
    s, w = np.polynomial.legendre.leggauss(POINTS)
    s, w = (s + 1) / 2, w / 2
    place = np.array(list(itertools.product(s, repeat=3)))
    weight = np.prod(list(itertools.product(w, repeat=3)), axis=1)
    if X.shape[1] in TETRAHEDRA:  # a cube whose one side shrinks to an edge, and that to a corner
        a, b, c = place.T
        weight = weight * a**2 * b
        place = np.stack([a * (1 - b), a * b * (1 - c), a * b * c], axis=1)
        sides = X[:, 1:4] - X[:, :1]
        return X[:, :1] + place @ sides, weight * np.abs(np.linalg.det(sides))[:, None]
    low, size = X.min(axis=1), np.ptp(X, axis=1)
    return low[:, None] + place * size[:, None], weight * size.prod(axis=1)[:, None]


def errors(run, exact):
    """(H1 seminorm, L2 norm) of what is between the displacement and `exact`, over the norms of the exact one. `exact`
    takes (..., 3) points and returns displacements and their gradients (..., i, j) = du_i / dx_j."""
    points, cells, displacement = run.mesh()
    missed, whole = np.zeros(2), np.zeros(2)
    for block in cells.values():
        X, u, powers = points[block], displacement[block], exponents(block.shape[1])
        size = np.ptp(X, axis=1).max(axis=1)[:, None, None]
        centre = X.mean(axis=1, keepdims=True)
        factors = np.linalg.solve(monomials((X - centre) / size, powers)[0], u)
        x, weight = rule(X)
        values, slopes = monomials((x - centre) / size, powers)
        found = values @ factors
        gradient = np.einsum("eqmj,emi->eqij", slopes, factors) / size[..., None]
        wanted, its_gradient = exact(x)
        for k, (one, two) in enumerate(((gradient, its_gradient), (found, wanted))):
            axes = tuple(range(2, one.ndim))
            missed[k] += (weight * ((one - two) ** 2).sum(axis=axes)).sum()
            whole[k] += (weight * (two**2).sum(axis=axes)).sum()
    return np.sqrt(missed / whole)
