"""Two elastic blocks in contact with friction: bodies by scikit-fem. Usage: scikit_fem_blocks.py [PICTURE]"""

import sys

import numpy as np
import scipy.sparse
import two_blocks
from skfem import Basis, ElementHex1, ElementVector, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity

E, POISSON = 1000.0, 0.3


def block(lower, upper, cells):
    """A box of hexahedra and its stiffness, numbered node by node."""
    mesh = MeshHex.init_tensor(*(np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)))
    basis = Basis(mesh, ElementVector(ElementHex1()))
    order = basis.nodal_dofs.T.ravel()  # node by node, whatever scikit-fem's own order
    stiffness = linear_elasticity(*lame_parameters(E, POISSON)).assemble(basis).tocsr()
    return mesh, stiffness[order][:, order]


def facets_at(mesh, height):
    return mesh.facets[:, mesh.facets_satisfying(lambda x: np.isclose(x[2], height))].T


above, k_above = block((0.15, 0.1, 0.5), (0.95, 0.9, 1.0), (5, 5, 3))
below, k_below = block((0, 0, 0), (1.2, 1, 0.5), (7, 6, 3))
X = np.vstack([above.p.T, below.p.T])
count = above.p.shape[1]
K = scipy.sparse.block_diag([k_above, k_below], "csr")
upper = two_blocks.surface_facets(X, facets_at(above, 0.5), up=False)
lower = two_blocks.surface_facets(X, count + facets_at(below, 0.5), up=True)
top = np.flatnonzero(np.isclose(X[:, 2], 1.0))
bottom = np.flatnonzero(np.isclose(X[:, 2], 0.0))

path = [(0.0, -0.002 * k) for k in range(1, 4)] + [(0.002 * k, -0.006) for k in range(1, 7)]
result = two_blocks.solve(X, upper, lower, lambda u: ((K @ u.ravel()), K), E, top, bottom, path)
if len(sys.argv) > 1:
    two_blocks.draw(sys.argv[1], "scikit-fem", X, *result)
