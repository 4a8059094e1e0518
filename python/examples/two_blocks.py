"""What the examples of two blocks share: all that concerns contact, Newton's method, the picture.

Two elastic blocks with meshes that do not match, pressed together and drawn along each other, with friction 0.3. The bodies are
the example's. Arguments:

    EXAMPLE.py [PICTURE]                  the scene two_blocks of the driver, in four steps
    EXAMPLE.py friction STEPS FILE        the same; FILE receives a row X Y Z ux uy uz for each node
    EXAMPLE.py patch STEPS FILE           a constant pressure through blocks of equal width, Poisson's ratio 0
"""

import sys

import numpy as np
import scipy.sparse

import stickslip

FRICTION, STEPS = 0.3, 4
HEIGHT = 0.8  # of the surfaces in contact


def solve(make_body, patch, steps, moves_along=False):
    """Nodes, displacements, the upper facets, their states in the last step, and the forces on the top of each step.

    make_body(lower, upper, cells, young, poisson): (nodes (n, 3), hexahedra (m, 8), internal), where internal(u) gives the
    body's forces (n, 3) and its stiffness, node by node. moves_along: a step starts with the upper body moved as its top is, as
    the driver does at finite strain.
    """
    margin, poisson = (0.0, 0.0) if patch else (0.1, 0.3)
    grip = np.array([0.0, 0.0, -0.005] if patch else [0.002, 0.0008, -0.005])
    young = 1000.0
    X1, cells1, internal1 = make_body((margin, margin, HEIGHT), (1 - margin, 1 - margin, 2 * HEIGHT), (4, 4, 4), young, poisson)
    X2, cells2, internal2 = make_body((0.0, 0.0, 0.0), (1.0, 1.0, HEIGHT), (5, 5, 4), 2000.0, poisson)
    X, n1 = np.vstack([X1, X2]), len(X1)

    def internal(u):
        (forces1, K1), (forces2, K2) = internal1(u.reshape(-1, 3)[:n1]), internal2(u.reshape(-1, 3)[n1:])
        return np.vstack([forces1, forces2]).ravel(), scipy.sparse.block_diag([K1, K2], "csr")

    def at_interface(x):
        return np.isclose(x[2], HEIGHT)

    side1, side2 = (stickslip.skin(cells, X, at_interface) for cells in (cells1, cells2 + n1))
    contact = stickslip.Contact(X).add(side1, side2, mu=FRICTION, modulus=young)
    dofs = np.arange(X.size).reshape(X.shape)
    top, bottom = dofs[np.isclose(X[:, 2], 2 * HEIGHT)], dofs[np.isclose(X[:, 2], 0)]

    def move(x, begin, end):
        x[: X1.size] += np.tile((end - begin) * grip, n1)

    reactions = []
    for number, step in enumerate(stickslip.steps(
            contact, lambda u, time: internal(u)[0], lambda u, time: internal(u)[1], np.linspace(0, 1, steps + 1)[1:],
            fixed=np.concatenate([top, bottom]), predictor=False, start=move if moves_along else None,
            prescribed=lambda time: np.concatenate([np.tile(time * grip, len(top)), np.zeros(bottom.size)])), 1):
        lam = step.x[X.size + 2 :: 3]
        print(f"step {number}: {step.iterations} iterations, {step.states[0]}, multipliers along z {lam.min():.16g} {lam.max():.16g}")
        reactions.append(internal(step.x[: X.size])[0][top].sum(axis=0))
    return X, step.x[: X.size].reshape(-1, 3), side1, step.states[0], np.array(reactions)


def draw(picture, title, X, u, side1, states, reactions):
    """The nodal pressures where they are now, and the forces on the top."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    drawn = left.tripcolor(*X[np.unique(side1), :2].T, states.pressure, shading="gouraud")
    figure.colorbar(drawn, ax=left, label="pressure")
    left.set(aspect="equal", xlabel="x", ylabel="y", title=title)
    steps = np.arange(1, len(reactions) + 1)
    right.plot(steps, np.hypot(*reactions[:, :2].T), "o-", label="along the surface")
    right.plot(steps, -FRICTION * reactions[:, 2], "k:", label="friction's limit")
    right.set(xlabel="step", ylabel="force on the top", xticks=steps)
    right.legend()
    figure.savefig(picture, dpi=120)


def main(title, make_body, **options):
    """Carries out what the arguments say."""
    words = sys.argv[1:]
    if len(words) == 3 and words[0] in ("friction", "patch"):
        X, u, *_ = solve(make_body, words[0] == "patch", int(words[1]), **options)
        np.savetxt(words[2], np.hstack([X, u]), fmt="%.17g")
    elif len(words) <= 1:
        found = solve(make_body, False, STEPS, **options)
        if words:
            draw(words[0], title, *found)
    else:
        raise SystemExit(__doc__)
