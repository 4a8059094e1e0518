"""A round pad is pressed on a block and rubs to and fro, a thousand cycles, by jumps: a half cycle that is computed stands for many.

What is worn off, with jumps and with jumps half as long. Argument: [PICTURE].
"""

import sys

import numpy as np
import scipy.sparse
from peeled_beam import CORNERS, YOUNG, element_stiffness

import stickslip

RADIUS, FRICTION, WEAR = 20.0, 0.6, 1e-6
PRESS, RUB = 0.004, 0.004  # of the pad's back
CYCLES, JUMP, FIRST = 1000, 20, 4  # all, those that one stands for, steps that press


def body(lower, upper, cells):
    """Nodes, cells and stiffness of a rectangle."""
    (nx, ny), size = cells, (np.array(upper) - lower) / cells
    axes = [np.linspace(a, b, n + 1) for a, b, n in zip(lower, upper, cells)]
    X = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(X)).reshape(nx + 1, ny + 1)
    corners = np.column_stack([number[i : i + nx, j : j + ny].ravel() for i, j in (CORNERS + 1) // 2])
    dofs = (2 * corners[:, :, None] + np.arange(2)).reshape(-1, 8)
    K = scipy.sparse.coo_matrix((np.tile(element_stiffness(size).ravel(), len(dofs)), (dofs.repeat(8), np.tile(dofs, 8).ravel())))
    return X, corners, K.tocsr()


def rub(jump):
    """After each step the deepest place, the volume, what friction has done in it; the places and depths in the end."""
    (X1, cells1, K1), (X2, cells2, K2) = body((-1, 0), (1, 1), (20, 8)), body((-2, -2), (2, 0), (48, 20))
    back, bottom = np.isclose(X1[:, 1], 1), np.isclose(X2[:, 1], -2)
    low = np.isclose(X1[:, 1], 0)
    X1[low, 1] = X1[low, 0] ** 2 / (2 * RADIUS)
    X, K = np.vstack([X1, X2]), scipy.sparse.block_diag([K1, K2], "csr")
    face = stickslip.skin(cells1, X, lambda x: np.isclose(x[1], x[0] ** 2 / (2 * RADIUS)))
    contact = stickslip.Contact(X).add(face, stickslip.skin(cells2 + len(X1), X, lambda x: np.isclose(x[1], 0)), mu=FRICTION, modulus=YOUNG)
    contact.interfaces[0].set_layer(wear=WEAR * jump)
    dofs = np.arange(X.size).reshape(X.shape)
    held = dofs[: len(X1)][back], dofs[len(X1) :][bottom]

    def prescribed(time):
        side = 0.0 if time <= FIRST else 1 - 2 * abs((time - FIRST) % 2 - 1)
        return np.concatenate([np.tile([RUB * side, -PRESS * min(time / FIRST, 1)], len(held[0])), np.zeros(held[1].size)])

    rows = []
    for step in stickslip.steps(contact, lambda u, time: K @ u, lambda u, time: K, np.arange(1.0, FIRST + 1 + 2 * CYCLES // jump),
                                fixed=np.concatenate([part.ravel() for part in held]), prescribed=prescribed):
        states = step.states[0]
        rows.append((states.worn.max(), states.worn_volume.sum(), states.dissipation.sum()))
    nodes = np.unique(face)
    return np.array(rows), X[nodes, 0], states.worn


def main(picture=None):
    (rows, x, worn), (finer, _, _) = rub(JUMP), rub(JUMP // 2)
    deepest, volume, work = rows.T
    print(f"monotone: {bool((np.diff(volume) >= 0).all())}")
    print(f"volume over k work / mu - 1: {abs(volume[-1] / (WEAR * JUMP * work.sum() / FRICTION) - 1):.1e}")
    print(f"jumps of {JUMP} against {JUMP // 2}: depth {deepest[-1]:.4e} {finer[-1, 0]:.4e}, volume {volume[-1]:.4e} {finer[-1, 1]:.4e}")
    if picture:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
        axes.plot(x, -1e3 * worn, ".-")
        axes.set(xlabel="along the pad", ylabel="worn off / 1000", title=f"after {CYCLES} cycles")
        figure.savefig(picture, dpi=120)


if __name__ == "__main__":
    main(*sys.argv[1:])
