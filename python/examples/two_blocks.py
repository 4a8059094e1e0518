"""What the examples of two blocks share: surfaces of a mesh, Newton's method, the picture.

The upper block stands on the lower one. Its top is pressed down and then pushed along x by given displacements.
"""

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import stickslip

FRICTION = 0.3
# The residual's largest entry over the largest force: quadratic convergence ends below it.
TOLERANCE = 1e-9


def surface_facets(X, facets, up):
    """Facets, (m, 4) nodes in any order, in right-hand order about the z axis, seen from above or from below."""
    centred = X[facets] - X[facets].mean(axis=1, keepdims=True)
    order = np.argsort(np.arctan2(centred[:, :, 1], centred[:, :, 0]), axis=1)
    ordered = np.take_along_axis(facets, order, axis=1)
    return ordered if up else ordered[:, ::-1]


def local(X, facets, equations, multipliers_from=None):
    """A stickslip surface of these facets, and the nodes that it has."""
    nodes, inverse = np.unique(facets, return_inverse=True)
    numbers = None
    if multipliers_from is not None:
        numbers = multipliers_from + np.arange(3 * len(nodes), dtype=np.int64).reshape(-1, 3)
    surface = stickslip.Surface(X[nodes], inverse.reshape(facets.shape), equations[nodes].astype(np.int64), numbers)
    return surface, nodes


def solve(X, upper, lower, internal, modulus, top, bottom, path):
    """Follows a path of displacements (dx, dz) of the top; bottom nodes stay.

    X: (n, 3) of both bodies; upper, lower: facets in contact; internal(u): forces and stiffness of both bodies.
    Gives the displacements, the contact states of the last step, the non-mortar nodes and the forces on the top.
    """
    size = X.size
    equations = np.arange(size, dtype=np.int64).reshape(X.shape)
    first, nodes1 = local(X, upper, equations, size)
    second, nodes2 = local(X, lower, equations)
    total = size + 3 * len(nodes1)
    unknowns, reactions = np.zeros(total), []
    free = np.setdiff1d(np.arange(total), equations[np.concatenate([top, bottom])])
    with stickslip.Interface(first, second, mu=FRICTION, modulus=modulus) as face:
        unknowns[size:] = face.initial_multipliers().ravel()
        plan = stickslip.Plan(face, X[nodes1], X[nodes2], total)
        for step, (dx, dz) in enumerate(path, 1):
            unknowns[equations[top]] = dx, 0.0, dz
            for iteration in range(30):
                u = unknowns[:size].reshape(X.shape)
                point = X[nodes1] + u[nodes1], X[nodes2] + u[nodes2], unknowns[size:].reshape(-1, 3)
                forces, stiffness = internal(u)
                force1, force2, rows = face.residual(*point)
                residual = np.concatenate([forces.ravel(), rows.ravel()])
                residual[equations[nodes1]] += force1
                residual[equations[nodes2]] += force2
                if np.abs(residual[free]).max() < TOLERANCE * np.abs(residual).max():
                    break
                host = scipy.sparse.block_diag([stiffness, scipy.sparse.csr_matrix((total - size,) * 2)], "csr")
                matrix = (host + plan.values(*point))[free][:, free]
                unknowns[free] -= scipy.sparse.linalg.spsolve(matrix.tocsc(), residual[free])
            else:
                raise SystemExit(f"step {step} does not converge")
            states = face.states(*point)
            face.commit(*point)
            reactions.append(residual[equations[top]].sum(axis=0))
            print(f"step {step:2} iterations {iteration} force on the top {reactions[-1].round(6).tolist()}")
    return u, states, nodes1, np.array(reactions)


def draw(picture, title, X, u, states, nodes1, reactions):
    """The nodal pressures where they are now, and the forces on the top."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    pressure = -(states.traction * states.normal).sum(axis=1)
    drawn = left.tripcolor(*(X + u)[nodes1, :2].T, pressure, shading="gouraud")
    figure.colorbar(drawn, ax=left, label="pressure")
    left.set(aspect="equal", xlabel="x", ylabel="y", title=title)
    right.plot(reactions[:, 0], label="along x")
    right.plot(-reactions[:, 2], label="down")
    right.plot(-FRICTION * reactions[:, 2], "k:", label="friction's limit")
    right.set(xlabel="step", ylabel="force on the top")
    right.legend()
    figure.savefig(picture, dpi=120)
