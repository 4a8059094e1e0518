"""A block of 4 x 2 on a rigid floor, plane strain: pressed in ten steps, then pushed in ten. Friction 0.2.

The scene is c_examples/scenes/plane_block.yaml. numpy and scipy alone. Usage: block.py [PICTURE]
"""

import sys

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

import stickslip

E, POISSON, CELLS, SIZE = 1000.0, 0.3, (20, 10), (4.0, 2.0)
PRESS, PUSH, STEPS = np.array([0.0, -200.0]), np.array([60.0, 0.0]), 10
# The residual's largest entry, over the load of one node: far above rounding, far below what a probe can see.
TOLERANCE = 1e-12

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


equations = np.arange(X.size, dtype=np.int64).reshape(X.shape)
cells = np.hstack([2 * quads[:, :, None], 2 * quads[:, :, None] + 1]).reshape(-1, 2, 4).transpose(0, 2, 1).reshape(-1, 8)
ke = element_stiffness(X[quads[0]])  # all cells are alike
bottom, top, left = np.arange(nx + 1), ny * (nx + 1) + np.arange(nx + 1), np.arange(ny + 1) * (nx + 1)
size = X.size + 2 * len(bottom)
K = scipy.sparse.coo_matrix((np.tile(ke.ravel(), len(cells)), (cells.repeat(8), np.tile(cells, 8).ravel())),
                            shape=(size, size)).tocsr()
press, push = edge_load(top, PRESS), edge_load(left, PUSH)

# The block's lower edge has the multipliers; the floor is as the driver's, and has no equations.
floor = np.column_stack([np.linspace(-0.5, 4.5, 14), np.zeros(14)])
face = stickslip.Interface(
    stickslip.Surface(X[bottom], np.column_stack([bottom[:-1], bottom[1:]]), equations[bottom],
                      X.size + np.arange(2 * len(bottom), dtype=np.int64).reshape(-1, 2)),
    stickslip.Surface(floor, np.array([(k + 1, k) for k in range(13)])),
    mu=0.2, modulus=E, model="plane", weights="reference")
unknowns = np.zeros(size)
unknowns[X.size:] = face.initial_multipliers().ravel()
plan = stickslip.Plan(face, X[bottom], floor, size)
iterations = []
for step in range(1, 2 * STEPS + 1):
    load = min(step / STEPS, 1) * press + max(step / STEPS - 1, 0) * push
    for iteration in range(30):
        x1 = X[bottom] + unknowns[equations[bottom]]
        lam = unknowns[X.size:].reshape(-1, 2)
        force1, _, rows = face.residual(x1, floor, lam)
        residual = K @ unknowns
        residual[: X.size] -= load
        residual[equations[bottom]] += force1
        residual[X.size:] = rows.ravel()
        if np.abs(residual).max() < TOLERANCE * np.abs(press).max() * size:
            break
        unknowns -= scipy.sparse.linalg.spsolve((K + plan.values(x1, floor, lam)).tocsc(), residual)
    else:
        raise SystemExit(f"step {step} does not converge")
    iterations.append(iteration)
    states = face.states(x1, floor, lam)
    face.commit(x1, floor, lam)

u = unknowns[: X.size].reshape(X.shape)
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
        below.plot(X[bottom, 0], -states.traction[:, 1], label="pressure")
        below.plot(X[bottom, 0], np.abs(states.traction[:, 0]), label="shear")
        below.set(xlabel="x", ylabel="traction on the floor")
        below.legend()
        figure.savefig(sys.argv[1], dpi=120)
