"""Two elastic blocks in contact with friction, small strain: bodies by scikit-fem. Arguments: two_blocks.py."""

import numpy as np
import two_blocks
from skfem import Basis, ElementHex1, ElementVector, MeshHex
from skfem.models.elasticity import lame_parameters, linear_elasticity


def block(lower, upper, cells, young, poisson):
    """A box of hexahedra: nodes, cells, forces and stiffness numbered node by node."""
    mesh = MeshHex.init_tensor(*(np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)))
    basis = Basis(mesh, ElementVector(ElementHex1()), intorder=3)  # 2 x 2 x 2 points
    order = basis.nodal_dofs.T.ravel()  # node by node, whatever scikit-fem's own order
    stiffness = linear_elasticity(*lame_parameters(young, poisson)).assemble(basis).tocsr()[order][:, order]
    return mesh.p.T.copy(), mesh.t.T, lambda u: ((stiffness @ u.ravel()).reshape(u.shape), stiffness)


two_blocks.main("scikit-fem", block)
