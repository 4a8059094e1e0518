"""A shaft that is too thick for its hub: a quarter in plane strain, by curved quadrilaterals with nine nodes of scikit-fem.

It prints the pressure over that of Lame's formula, at the least and at the most. Usage: scikit_fem_shaft.py [CELLS] [PICTURE]
"""

import sys

import numpy as np
import scipy.sparse
from skfem import Basis, ElementQuad2, ElementVector, MeshQuad, MeshQuad2
from skfem.models.elasticity import lame_parameters, linear_elasticity

import stickslip

BORE, RADIUS, OUTER, EXCESS, YOUNG, POISSON = 0.4, 1.0, 2.0, 0.003, 1000.0, 0.3  # EXCESS: by how much the shaft is too thick


def ring(inner, outer, n_radial, n_around):
    """Nodes (n, 2), cells (m, 9), the displacement dofs of the nodes, and the stiffness."""
    square = MeshQuad2.from_mesh(MeshQuad.init_tensor(np.linspace(inner, outer, n_radial + 1), np.linspace(0, np.pi / 2, n_around + 1)))
    r, angle = square.doflocs
    mesh = MeshQuad2(np.array([r * np.cos(angle), r * np.sin(angle)]), square.t)
    nodes, basis = Basis(mesh, ElementQuad2(), intorder=5), Basis(mesh, ElementVector(ElementQuad2()), intorder=5)
    dofs = np.hstack([basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs]).T
    return nodes.doflocs.T, nodes.element_dofs.T, dofs, linear_elasticity(*lame_parameters(YOUNG, POISSON)).assemble(basis)


def solve(n):
    """Angles and pressures of the nodes that have a multiplier, with n cells around the quarter of the shaft."""
    X1, cells1, dofs1, K1 = ring(BORE, RADIUS + EXCESS, n, n)
    X2, cells2, dofs2, K2 = ring(RADIUS, OUTER, n, n + 1)
    X, dofs = np.vstack([X1, X2]), np.vstack([dofs1, dofs2 + dofs1.size])
    K = scipy.sparse.block_diag([K1, K2], "csr")
    face1 = stickslip.skin(cells1, X, lambda x: np.isclose(np.hypot(*x), RADIUS + EXCESS))
    face2 = stickslip.skin(cells2 + len(X1), X, lambda x: np.isclose(np.hypot(*x), RADIUS))
    symmetry = dofs[np.isclose(X, 0, atol=1e-9)]  # x = 0 does not move along x, y = 0 not along y
    contact = stickslip.Contact(X, dofs).add(face1, face2, held=symmetry, modulus=YOUNG, mu=0.0)
    (step,) = stickslip.steps(contact, lambda u, time: K @ u, lambda u, time: K, [1.0], fixed=symmetry, progress=True)
    corners = step.states[0].coverage > 0  # mid nodes have no multiplier
    return np.arctan2(*X[np.unique(face1)[corners]].T[::-1]), step.states[0].pressure[corners]


def lame():
    """The pressure of two thick rings in plane strain."""
    flat, across = YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)
    shaft = (RADIUS**2 + BORE**2) / (RADIUS**2 - BORE**2) - across
    hub = (OUTER**2 + RADIUS**2) / (OUTER**2 - RADIUS**2) + across
    return EXCESS * flat / RADIUS / (shaft + hub)


if __name__ == "__main__":
    angles, pressures = solve(int(sys.argv[1]) if len(sys.argv) > 1 else 12)
    ratio = pressures / lame()
    print("pressure over Lame's:", ratio.min(), ratio.max())
    if len(sys.argv) > 2:
        import matplotlib.pyplot as plt

        plt.plot(np.degrees(angles), ratio, "o")
        plt.gca().set(xlabel="angle [degrees]", ylabel="pressure over Lame's", ylim=(0.95, 1.05))
        plt.savefig(sys.argv[2])
