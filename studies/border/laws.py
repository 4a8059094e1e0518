"""Contact laws: the library's, decided at nodes, and those that decide at points with weights of now.

A law has `residual(x1, x2, lam)`, the vector of f1, f2 and its multiplier rows, `tangent(x1, x2, lam)`, its derivative, both
as the library orders them, and `components`, its multipliers a node. Forces have the sign of internal ones, lambda is minus the
traction on the non-mortar body, g > 0 is open (docs/formulation 1). Decided at points:

    gh_A = nu . g_A / D_A, the dual gap as a length;  sigma = sum_A N_A (lambda_A + r_A gh_A);  t = min(0, sigma)        (1)
    forces  int N_A t, - int N_C t;                                                                                    (2)
    rows  -(1 / r_A) [int N_A (sum_B N_B lambda_B - t) + (r_A / rhat_A) sum_B K_AB lambda_B]                             (3)
    K_AB = 1/6 int h^2 grad N_A . grad N_B,      rhat_A = 0.9 E* / h_A                                                   (4)

Lumped: D_A lambda_A in place of the mass matrix and K. r_A = rhat_A unless a factor says otherwise.
"""

from dataclasses import dataclass

import numpy as np

import overlaps
from library import BASES, COMMITTED, CURRENT, OF_COMMIT, REFERENCE, Interface

# rhat over E* / h, E* of both bodies together, as in Hertz' formulas.
STIFFNESS = 0.9
# Of K. On a row of equal lines the mass matrix and K together are D then.
STABILISATION = 1 / 6
# Of complex steps: its square is far below rounding.
TINY = 1e-30
# Nodes: a node acts on those within four facets of either side, of about one size.
APART = 12
# Gauss points an overlap and a direction: the library's own rule for lines, and exact for their weights.
RULE = 2
WEIGHTS = {"current": CURRENT, "committed": COMMITTED, "reference": REFERENCE}


@dataclass
class Pair:
    """The two surfaces as they are meshed, and E*."""

    one: overlaps.Surface
    two: overlaps.Surface
    modulus: float

    @property
    def dimension(self):
        return self.one.x.shape[1]


class Nodal:
    """The library's handle. `x1`, `x2`: the first configuration, which has the frozen weights; `weights`: one of
    WEIGHTS; without `mu` no friction; `decision`: of "nodes" or "points"."""

    def __init__(self, library, pair, x1, x2, basis, mu=0.0, weights="reference", decision="nodes"):
        lines = {"model": 1} if pair.dimension == 2 else {}
        self.components = pair.dimension if mu else 1
        self.interface = Interface(library, x1, pair.one.facets, x2, pair.two.facets, components=self.components, mu=mu,
                                   basis=BASES[basis], weights=WEIGHTS[weights], normals=OF_COMMIT,
                                   modulus=pair.modulus, friction=0 if mu else 1,
                                   decision=("nodes", "points").index(decision), **lines)

    def residual(self, *at):
        return np.concatenate([v.ravel() for v in self.interface.residual(*at)])

    def tangent(self, *at):
        return self.interface.tangent(*at)

    def commit(self, *at):
        self.interface.commit(*at)


class Weights:
    """The points at these positions, D, the dual functions there, gaps. Positions may be complex."""

    def __init__(self, points, facets, others, x1, x2):
        self.points, self.facets, self.x1, self.x2 = points, facets, x1, x2
        self.at_own, self.at_other = facets[points.facet], others[points.mortar]
        kind, (m, k) = points.weight.dtype, facets.shape
        mass = np.zeros((m, k, k), kind)
        np.add.at(mass, points.facet, points.weight[:, None, None] * points.own[:, :, None] * points.own[:, None, :])
        nodal, covered = mass.sum(axis=2), np.unique(points.facet)
        # A_e = diag(m_A) M_e^-1, and with it psi_A at each point.
        dual = np.zeros_like(mass)
        dual[covered] = nodal[covered][:, :, None] * np.linalg.inv(mass[covered])
        self.psi = np.einsum("pab,pb->pa", dual[points.facet], points.own)
        self.area = np.zeros(len(x1), kind)
        np.add.at(self.area, facets, nodal)

    def sums(self, values, nodes, count):
        """Of `values` (points, k, ...) times the points' weights, at their nodes."""
        total = np.zeros((count, *values.shape[2:]), values.dtype)
        shape = (len(values),) + (1,) * (values.ndim - 1)
        np.add.at(total, nodes, values * self.points.weight.reshape(shape))
        return total

    def own(self, values):
        """Sums of N_A times `values`, one a point."""
        return self.sums(self.points.own * values[:, None], self.at_own, len(self.x1))

    def at(self, nodal):
        """A nodal field at the points."""
        return (self.points.own * nodal[self.at_own]).sum(axis=1)

    def gaps(self, normals):
        """gh_A: of each facet the part along its own e."""
        p = self.points
        place, under = (np.einsum("pa,pad->pd", f, x[n]) for f, x, n in
                        ((p.own, self.x1, self.at_own), (p.other, self.x2, self.at_other)))
        along = ((place - under) * p.axis).sum(axis=1)
        turned = np.einsum("pad,pd->pa", normals[self.at_own], p.axis)
        return self.sums(self.psi * along[:, None] * turned, self.at_own, len(self.x1)) / self.area


class Points:
    """Weights of now, of lines; nodal normals of the first configuration. Tangents by complex steps, which are exact.

    `factor`: r over rhat; `apart`: with K over rhat, as in (3), and not over r."""

    components = 1

    def __init__(self, pair, x1, x2, factor=1.0, apart=True, lumped=False):
        self.pair, self.lumped, self.h = pair, lumped, pair.one.nodal_sizes
        self.r = factor * STIFFNESS * pair.modulus / self.h
        self.stabilisation = STABILISATION * (factor if apart else 1)
        self.normals = overlaps.normals_of_lines(x1, pair.one.facets)

    def residual(self, x1, x2, lam):
        facets, others = self.pair.one.facets, self.pair.two.facets
        w, lam = Weights(overlaps.of_lines(x1, facets, x2, others, RULE), facets, others, x1, x2), lam.ravel()
        p = w.points
        sigma = w.at(lam + self.r * w.gaps(self.normals))
        t = np.where(sigma.real < 0, sigma, 0)
        push = (t[:, None] * p.axis)[:, None]
        f1 = w.sums(p.own[:, :, None] * push, w.at_own, len(x1))
        f2 = -w.sums(p.other[:, :, None] * push, w.at_other, len(x2))
        if self.lumped:
            left = w.area * lam
        else:
            slope = np.einsum("pag,pa->pg", p.gradients, lam[w.at_own]) * (self.stabilisation * w.at(self.h) ** 2)[:, None]
            left = w.own(w.at(lam)) + w.sums(np.einsum("pag,pg->pa", p.gradients, slope), w.at_own, len(x1))
        return np.concatenate([f1.ravel(), f2.ravel(), -(left - w.own(t)) / self.r])

    def tangent(self, x1, x2, lam):
        """Columns of nodes that are APART from each other are made together: no row feels two of them."""
        shapes, sizes = (x1.shape, x2.shape, (-1,)), np.cumsum([x1.size, x2.size])
        z = np.concatenate([x1.ravel(), x2.ravel(), lam.ravel()]).astype(complex)
        n1, n2 = len(x1), len(x2)
        place = np.concatenate([np.repeat(x1[:, 0], 2), np.repeat(x2[:, 0], 2), x1[:, 0]])
        # Nodes are counted along the line.
        of_positions = lambda n: 2 * (np.repeat(np.arange(n), 2) % APART) + np.tile([0, 1], n)
        kind = np.concatenate([of_positions(n1), of_positions(n2), np.arange(n1) % APART])
        kind += np.repeat([0, 2 * APART, 4 * APART], [2 * n1, 2 * n2, n1])
        matrix = np.zeros((len(z), len(z)))
        for columns in (np.flatnonzero(kind == k) for k in range(kind.max() + 1)):
            if not len(columns):
                continue
            z[columns] += 1j * TINY
            found = self.residual(*(v.reshape(s) for v, s in zip(np.split(z, sizes), shapes))).imag / TINY
            z[columns] = z[columns].real
            own = columns[np.abs(place[:, None] - place[columns]).argmin(axis=1)]
            matrix[np.arange(len(z)), own] = found
        return matrix
