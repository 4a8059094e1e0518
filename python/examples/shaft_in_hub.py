"""What the examples of a shaft share that is too thick for its hub: contact, Lame's formula, the picture.

A quarter in plane strain, by elements of order 2 on curved meshes. The bodies are the example's. It prints the pressures over
that of Lame's formula, the least and the largest. Arguments: EXAMPLE.py [SIZE_OF_CELLS] [PICTURE]
"""

import sys

import numpy as np
import scipy.sparse

import stickslip

BORE, RADIUS, OUTER, EXCESS = 0.4, 1.0, 2.0, 0.003  # EXCESS: by how much the shaft is too thick
YOUNG, POISSON = 1000.0, 0.3


def lame():
    """The pressure between two thick rings in plane strain."""
    flat, across = YOUNG / (1 - POISSON**2), POISSON / (1 - POISSON)
    shaft = (RADIUS**2 + BORE**2) / (RADIUS**2 - BORE**2) - across
    hub = (OUTER**2 + RADIUS**2) / (OUTER**2 - RADIUS**2) + across
    return EXCESS * flat / RADIUS / (shaft + hub)


def solve(make_ring, size):
    """Angles and pressures of the nodes that have a multiplier.

    make_ring(inner, outer, size): nodes (n, 2), cells, the stiffness, which unknowns are prescribed, and S: the displacements of the
    nodes, one after the other, are S times the unknowns.
    """
    (X1, cells1, K1, fixed1, S1), (X2, cells2, K2, fixed2, S2) = (
        make_ring(BORE, RADIUS + EXCESS, size), make_ring(RADIUS, OUTER, 0.9 * size))
    X, K, S = np.vstack([X1, X2]), scipy.sparse.block_diag([K1, K2], "csr"), scipy.sparse.block_diag([S1, S2], "csr")
    face1 = stickslip.skin(cells1, X, lambda x: np.isclose(np.hypot(*x), RADIUS + EXCESS, rtol=1e-6))
    face2 = stickslip.skin(cells2 + len(X1), X, lambda x: np.isclose(np.hypot(*x), RADIUS, rtol=1e-6))
    symmetry = np.flatnonzero(np.isclose(X, 0, atol=1e-9))  # x = 0 does not move along x, y = 0 not along y, on both sides
    contact = stickslip.Contact(X, S).add(face1, face2, held=symmetry, modulus=YOUNG, mu=0.0)
    (step,) = stickslip.steps(contact, lambda u, time: K @ u, lambda u, time: K, [1.0], progress=True,
                              fixed=np.concatenate([fixed1, fixed2 + K1.shape[0]]))
    corners = step.states[0].bearing  # mid nodes have no multiplier
    return np.arctan2(*X[np.unique(face1)[corners]].T[::-1]), step.states[0].pressure[corners]


def main(title, make_ring):
    """Carries out what the arguments say."""
    angles, pressures = solve(make_ring, float(sys.argv[1]) if len(sys.argv) > 1 else 0.15)
    ratio = pressures / lame()
    print("pressure over Lame's:", ratio.min(), ratio.max())
    if len(sys.argv) > 2:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        plt.plot(np.degrees(angles), ratio, "o")
        plt.gca().set(xlabel="angle [degrees]", ylabel="pressure over Lame's", ylim=(0.95, 1.05), title=title)
        plt.savefig(sys.argv[2], dpi=120)
