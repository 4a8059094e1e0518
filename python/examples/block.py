"""A block of 4 x 2 on a rigid floor, plane strain: pressed in ten steps, then pushed in ten. Friction 0.2.

The scene is c_examples/scenes/plane_block.yaml. numpy and scipy alone. Usage: block.py [PICTURE]
"""

import sys

import numpy as np
import scipy.sparse

import stickslip

E, POISSON, CELLS, SIZE = 1000.0, 0.3, (20, 10), (4.0, 2.0)
PRESS, PUSH, STEPS = np.array([0.0, -200.0]), np.array([60.0, 0.0]), 10

# Nodes row by row from the lower left, quadrilaterals counterclockwise.
nx, ny = CELLS
X = np.array([(x, y) for y in np.linspace(0, SIZE[1], ny + 1) for x in np.linspace(0, SIZE[0], nx + 1)])
quads = np.array([[k, k + 1, k + nx + 2, k + nx + 1] for j in range(ny) for k in range(j * (nx + 1), j * (nx + 1) + nx)])


def element_stiffness(corners):
    """One bilinear quadrilateral in plane strain by 2 x 2 points."""
    law = E / (1 + POISSON) / (1 - 2 * POISSON) * np.array(
        [[1 - POISSON, POISSON, 0], [POISSON, 1 - POISSON, 0], [0, 0, 0.5 - POISSON]])
    signs, out = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]), np.zeros((8, 8))
    for xi, eta in signs / np.sqrt(3):
        local = 0.25 * signs * np.column_stack([1 + eta * signs[:, 1], 1 + xi * signs[:, 0]])
        jacobian = local.T @ corners
        dx, dy = np.linalg.solve(jacobian, local.T)
        b = np.zeros((3, 8))
        b[0, 0::2], b[1, 1::2], b[2, 0::2], b[2, 1::2] = dx, dy, dy, dx
        out += np.linalg.det(jacobian) * b.T @ law @ b
    return out


def edge_load(nodes, traction):
    """Nodal forces of a traction on a straight row of nodes."""
    out = np.zeros(X.shape)
    for a, b in zip(nodes, nodes[1:]):
        out[[a, b]] += 0.5 * np.linalg.norm(X[b] - X[a]) * traction
    return out.ravel()


dofs = np.arange(X.size).reshape(X.shape)
places = dofs[quads].reshape(-1, 8)
ke = element_stiffness(X[quads[0]])  # all cells are alike
K = scipy.sparse.coo_matrix((np.tile(ke.ravel(), len(quads)), (places.repeat(8), np.tile(places, 8).ravel()))).tocsr()
top, left = np.flatnonzero(X[:, 1] == SIZE[1]), np.flatnonzero(X[:, 0] == 0)
press, push = edge_load(top, PRESS), edge_load(left, PUSH)

# The block's lower edge has the multipliers; the floor is as the driver's, and has no unknowns.
floor = stickslip.Surface(np.column_stack([np.linspace(-0.5, 4.5, 14), np.zeros(14)]), [(k + 1, k) for k in range(13)])
bottom = stickslip.skin(quads, X, lambda x: x[1] == 0)
contact = stickslip.Contact(X).add(bottom, floor, mu=0.2, modulus=E, weights="reference")
iterations = []
for step in stickslip.steps(contact, lambda u, time: K @ u - min(time, 1) * press - max(time - 1, 0) * push, lambda u, time: K,
                            np.arange(1, 2 * STEPS + 1) / STEPS, predictor=False):
    iterations.append(step.iterations)

u, states, edge = step.x[: X.size].reshape(X.shape), step.states[0], X[np.unique(bottom), 0]
topleft, topright = u[top[0]], u[top[-1]]
if __name__ == "__main__":
    print("iterations", iterations, "in all", sum(iterations))
    print("topleft", *map(repr, topleft.tolist()), "topright", *map(repr, topright.tolist()))
    if len(sys.argv) > 1:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(6, 5))
        above.tripcolor(*(X + u).T, np.vstack([quads[:, :3], quads[:, [0, 2, 3]]]), u[:, 0], shading="gouraud")
        above.set(aspect="equal", ylabel="y", title="Displacement along the floor")
        below.plot(edge, states.pressure, label="pressure")
        below.plot(edge, np.abs(states.traction[:, 0]), label="shear")
        below.set(xlabel="x", ylabel="traction on the floor")
        below.legend()
        figure.savefig(sys.argv[1], dpi=120)
