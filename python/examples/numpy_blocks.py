"""Two elastic blocks in contact with friction, small strain: bodies by numpy and scipy alone. Arguments: two_blocks.py."""

import numpy as np
import scipy.sparse

# The corners of a cell in VTK's order.
CORNERS = np.array([(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)])


def box(lower, upper, cells):
    """Nodes (n, 3) and hexahedra (m, 8) of a box."""
    nx, ny, nz = cells
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)]
    X = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(X)).reshape(nx + 1, ny + 1, nz + 1)
    at = [number[i : i + nx, j : j + ny, k : k + nz].ravel() for i, j, k in (CORNERS + 1) // 2]
    return X, np.column_stack(at)


def element_stiffness(size, young, poisson):
    """K = int B^T C B dV of a box by 2 x 2 x 2 Gauss points."""
    shear = young / (2 * (1 + poisson))
    lame = 2 * shear * poisson / (1 - 2 * poisson)
    out = np.zeros((8, 3, 8, 3))
    for point in CORNERS / np.sqrt(3):
        factors = 1 + CORNERS * point
        g = CORNERS * factors[:, [1, 2, 0]] * factors[:, [2, 0, 1]] / (4 * size)  # dN/dX
        out += size.prod() / 8 * (lame * np.einsum("ai,bj->aibj", g, g) + shear * np.einsum("aj,bi->aibj", g, g)
                                  + shear * np.einsum("ac,bc,ij->aibj", g, g, np.eye(3)))
    return out.reshape(24, 24)


def block(lower, upper, cells, young, poisson):
    """A box of hexahedra: nodes, cells, forces and stiffness numbered node by node."""
    X, hexahedra = box(lower, upper, cells)
    Ke = element_stiffness((np.array(upper) - lower) / cells, young, poisson)  # all cells are alike
    dofs = (3 * hexahedra[:, :, None] + np.arange(3)).reshape(-1, 24)
    K = scipy.sparse.coo_matrix((np.tile(Ke.ravel(), len(dofs)), (dofs.repeat(24), np.tile(dofs, 24).ravel()))).tocsr()
    return X, hexahedra, lambda u: ((K @ u.ravel()).reshape(u.shape), K)


if __name__ == "__main__":
    import two_blocks

    two_blocks.main("numpy", block)
