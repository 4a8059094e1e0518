"""A shaft that is too thick for its hub, by curved quadrilaterals with nine nodes of scikit-fem. Arguments: shaft_in_hub.py."""

import numpy as np
import scipy.sparse
import shaft_in_hub
from shaft_in_hub import POISSON, YOUNG
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad, MeshQuad2
from skfem.models.elasticity import lame_parameters, linear_elasticity


def ring(inner, outer, size):
    """What shaft_in_hub.py asks for."""
    around = np.linspace(0, np.pi / 2, int(np.ceil(np.pi / 2 / size)) + 1)
    square = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.linspace(inner, outer, int(np.ceil((outer - inner) / size)) + 1), around))
    r, angle = square.doflocs
    mesh = MeshQuad2(np.array([r * np.cos(angle), r * np.sin(angle)]), square.t)
    nodes, basis = Basis(mesh, ElementQuad2(), intorder=5), Basis(mesh, ElementVector(ElementQuad2()), intorder=5)
    dofs = np.hstack([basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs]).T  # of each node its displacements
    X = nodes.doflocs.T
    K = linear_elasticity(*lame_parameters(YOUNG, POISSON)).assemble(basis)
    S = scipy.sparse.identity(basis.N, format="csr")[dofs.ravel()]
    return X, nodes.element_dofs.T, K, dofs[np.isclose(X, 0, atol=1e-9)], S


shaft_in_hub.main("scikit-fem", ring)
