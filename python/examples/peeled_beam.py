"""A double cantilever beam is peeled: two arms that are glued together are drawn apart at their free ends, in the plane.

The force against beam theory with the length of the cohesive zone in it, and the work that the bond has lost. Argument: [PICTURE].
"""

import sys

import numpy as np
import scipy.sparse

import stickslip

LENGTH, HEIGHT, GLUED = 60.0, 1.5, 20.0  # of an arm; where the bond begins
YOUNG, POISSON = 1e5, 0.3
BOND = {"bond_stiffness": 1e4, "bond_strength": 10.0, "bond_toughness": 0.3, "bond_shear": 1.0}
CELLS, OPENING, STEPS = (120, 3), 2.4, 60
CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def element_stiffness(size):
    """Plane stress, four nodes and two modes of bending that are eliminated (Wilson, Taylor): right for beams of rectangles."""
    C = YOUNG / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
    K = np.zeros((12, 12))
    for point in CORNERS / np.sqrt(3):
        gradients = CORNERS * (1 + CORNERS[:, ::-1] * point[::-1]) / (2 * size)
        gradients = np.vstack([gradients, np.diag(-4 * point / size)])  # of 1 - xi^2 and of 1 - eta^2
        B = np.zeros((3, 12))
        B[0, 0::2], B[1, 1::2], B[2, 0::2], B[2, 1::2] = gradients[:, 0], gradients[:, 1], gradients[:, 1], gradients[:, 0]
        K += size.prod() / 4 * B.T @ C @ B
    inner = K[8:, 8:]
    return K[:8, :8] - K[:8, 8:] @ np.linalg.solve(inner, K[8:, :8])


def arm(bottom):
    """Nodes, cells and stiffness of an arm that begins at this height."""
    nx, ny = CELLS
    x, y = np.linspace(0, LENGTH, nx + 1), np.linspace(bottom, bottom + HEIGHT, ny + 1)
    X = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(X)).reshape(nx + 1, ny + 1)
    cells = np.column_stack([number[i : i + nx, j : j + ny].ravel() for i, j in (CORNERS + 1) // 2])
    dofs = (2 * cells[:, :, None] + np.arange(2)).reshape(-1, 8)
    Ke = element_stiffness(np.array([LENGTH / nx, HEIGHT / ny]))
    K = scipy.sparse.coo_matrix((np.tile(Ke.ravel(), len(dofs)), (dofs.repeat(8), np.tile(dofs, 8).ravel()))).tocsr()
    return X, cells, K


def peeled():
    """Opening, force, energy stored and work lost after each step, and the states of the last one."""
    (X1, cells1, K1), (X2, cells2, K2) = arm(0.0), arm(-HEIGHT)
    X, K = np.vstack([X1, X2]), scipy.sparse.block_diag([K1, K2], "csr")

    def glued(x):
        # Not up to the clamp: a node that is held on both sides has no use for a multiplier.
        return np.isclose(x[1], 0) & (x[0] >= GLUED - 1e-9) & (x[0] <= LENGTH - 2)

    upper, lower = stickslip.skin(cells1, X, glued), stickslip.skin(cells2 + len(X1), X, glued)
    contact = stickslip.Contact(X).add(upper, lower, mu=0.0, modulus=YOUNG, friction="coulomb", small_displacements=True)
    contact.interfaces[0].set_layer(**BOND)
    dofs = np.arange(X.size).reshape(X.shape)
    free_end, clamped = np.isclose(X[:, 0], 0), np.isclose(X[:, 0], LENGTH)
    middle = np.isclose(np.abs(X[:, 1]), HEIGHT)
    tips = [dofs[free_end & middle & (X[:, 1] * side > 0), 1] for side in (1, -1)]
    held = dofs[clamped].ravel()
    fixed = np.concatenate([*tips, held])
    rows = []
    for step in stickslip.steps(
            contact, lambda u, time: K @ u, lambda u, time: K, np.linspace(0, 1, STEPS + 1)[1:], fixed=fixed,
            prescribed=lambda time: np.concatenate([[time * OPENING / 2], [-time * OPENING / 2], np.zeros(len(held))])):
        u, states = step.x[: X.size], step.states[0]
        tension = np.maximum((states.traction * states.normal).sum(axis=1), 0)
        elastic = u @ (K @ u) / 2 + (tension * states.gap).sum() / 2  # of the arms, and what the bond gives back along its secant
        rows.append((OPENING * step.time, (K @ u)[tips[0]].sum(), elastic, (states.bond_loss * states.coverage).sum()))
    return np.array(rows), states


def theory(opening):
    """The force of arms whose crack grows: G_c = P^2 a^2 / (E I), opening = 2 P a^3 / (3 E I), with a the crack's length as the arms feel
    it: to where it would end without a zone and without the turn of its root, which is what is corrected."""
    stiffness, toughness = YOUNG * HEIGHT**3 / 12, BOND["bond_toughness"]
    return np.sqrt(2 / 3 * toughness**1.5 * stiffness**0.5 / opening)


def main(picture=None):
    rows, states = peeled()
    opening, force, elastic, lost = rows.T
    work = np.concatenate([[0], np.cumsum(np.diff(opening) * (force[1:] + force[:-1]) / 2)]) + opening[0] * force[0] / 2
    grown = (states.damage == 1).sum() > 3
    late = opening > 0.6 * OPENING
    off = np.abs(force[late] / theory(opening[late]) - 1).max()
    print(f"crack grows: {grown}; force off beam theory by {off:.2%}")
    parted = states.bond_loss[states.damage == 1]
    toughness = BOND["bond_toughness"]
    print(f"work lost an area where parted over G_c - 1: {np.abs(parted / toughness - 1).max():.1e}")
    print(f"work of the ends {work[-1]:.5f}, stored {elastic[-1]:.5f}, lost {lost[-1]:.5f}")
    if picture:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
        axes.plot(opening, force, label="computed")
        axes.plot(opening, np.minimum(theory(opening), force.max()), "k:", label="beam theory")
        axes.set(xlabel="opening of the ends", ylabel="force")
        axes.legend()
        figure.savefig(picture, dpi=120)
    return grown, off, np.abs(parted / toughness - 1).max(), work[-1], elastic[-1], lost[-1]


if __name__ == "__main__":
    main(*sys.argv[1:])
