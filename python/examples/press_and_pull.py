"""A block is pressed on another one, then pulled until it slides: bodies by scikit-fem, contact in two statements."""

import numpy as np
import scipy.sparse as sp
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

import stickslip


def block(lower, upper, cells):
    """Nodes, cells and stiffness of a box in the plane, E = 1000, nu = 0.3."""
    mesh = skfem.MeshQuad.init_tensor(*(np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)))
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad1()))
    order = basis.nodal_dofs.T.ravel()  # node by node
    return mesh.p.T, mesh.t.T, linear_elasticity(*lame_parameters(1000, 0.3)).assemble(basis).tocsr()[order][:, order]


(X1, upper, K1), (X2, lower, K2) = block((0.5, 0), (2.5, 1), (16, 8)), block((0, -1), (4, 0), (25, 6))
X, K, cells = np.vstack([X1, X2]), sp.block_diag([K1, K2], format="csr"), np.vstack([upper, lower + len(X1)])
contact = stickslip.Contact(X).add(stickslip.skin(cells, X), mu=0.3, modulus=1000)  # the skin of both: no pairs, no sides
top, bottom = np.flatnonzero(X[:, 1] == 1), np.flatnonzero(X[:, 1] == -1)
fixed, along, down = np.concatenate([2 * top, 2 * top + 1, 2 * bottom, 2 * bottom + 1]), np.zeros(X.size), np.zeros(X.size)
along[2 * top], down[2 * top + 1] = 1, -1


def prescribed(time):
    """Press, then pull."""
    return (0.02 * min(1, time / 0.3) * down + 0.06 * max(0, time - 0.3) * along)[fixed]


def run(solve=None):
    """The steps, each with what presses and what pulls."""
    for step in stickslip.steps(contact, lambda u, t: K @ u, lambda u, t: K, np.linspace(0.1, 1, 10), fixed=fixed, prescribed=prescribed, solve=solve):
        forces = K @ step.x[: X.size]
        yield step, down @ forces, along @ forces


if __name__ == "__main__":
    for step, press, pull in run():
        print(f"t {step.time:.1f}   press {press:.3f}   pull {pull:.3f}   pull / press {pull / press:.3f}   iterations {step.iterations}")
