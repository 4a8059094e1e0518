"""Two elastic blocks of numpy_blocks.py on each other, and what their contact is made of."""

import numpy as np
import scipy.sparse
import stickslip
from numpy_blocks import block

MU, YOUNG, HEIGHT = 0.3, 1000.0, 0.5


class Blocks:
    """The upper one, of the first nodes, lies on the lower one. Nodes of their meshes do not match."""

    def __init__(self, poisson=0.3, margin=0.1, **options):
        parts = [block((margin, margin, HEIGHT), (1 - margin, 1 - margin, 2 * HEIGHT), (3, 3, 2), YOUNG, poisson),
                 block((0.0, 0.0, 0.0), (1.0, 1.0, HEIGHT), (4, 4, 2), 2 * YOUNG, poisson)]
        self.X = np.vstack([X for X, _, _ in parts])
        self.K = scipy.sparse.block_diag([internal(np.zeros(X.shape))[1] for X, _, internal in parts], "csr")
        n1 = len(parts[0][0])
        self.cells = [parts[0][1], parts[1][1] + n1]
        self.facets = [stickslip.skin(cells, self.X, lambda x: np.isclose(x[2], HEIGHT)) for cells in self.cells]
        self.dofs = np.arange(self.X.size).reshape(self.X.shape)
        self.top, self.bottom = self.dofs[np.isclose(self.X[:, 2], 2 * HEIGHT)], self.dofs[self.X[:, 2] == 0]
        self.fixed = np.concatenate([self.top, self.bottom])
        self.options = {"mu": MU, "modulus": YOUNG, **options}

    def contact(self, **how):
        return stickslip.Contact(self.X, **how).add(*self.facets, **self.options)

    def values(self, grip):
        """Of the fixed unknowns, where the top has moved by the grip."""
        return np.concatenate([np.tile(grip, (len(self.top), 1)), np.zeros(self.bottom.shape)])

    def residual(self, u, time=1.0):
        return self.K @ u

    def tangent(self, u, time=1.0):
        return self.K

    def solve(self, contact, grip, **how):
        """All unknowns of one step, and the iterations."""
        x = contact.start()
        return x, stickslip.newton(contact, self.residual, self.tangent, x, fixed=self.fixed, values=self.values(grip), **how)
