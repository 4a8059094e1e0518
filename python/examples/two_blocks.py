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
import scipy.sparse.linalg

import stickslip

FRICTION, STEPS, MAX_ITERATIONS = 0.3, 4, 25
HEIGHT = 0.8  # of the surfaces in contact
# A body's residual over its own forces; the contact over scales of its own: docs/host_convergence.md.
RTOL, CONTACT_RTOL = 2e-11, 1e-10


def facets_at(X, cells, height, up):
    """The faces of hexahedra that lie at this height, (m, 4) nodes in right-hand order seen from above (up) or from below."""
    at = np.isclose(X[cells][:, :, 2], height)
    chosen = at.sum(axis=1) == 4
    faces = cells[chosen][at[chosen]].reshape(-1, 4)
    centred = X[faces] - X[faces].mean(axis=1, keepdims=True)
    order = np.argsort(np.arctan2(centred[:, :, 1], centred[:, :, 0]), axis=1)
    faces = np.take_along_axis(faces, order, axis=1)
    return faces if up else faces[:, ::-1]


class Side:
    """A surface of a body: the nodes that it has, and what stickslip reads of it. first: the body's first unknown."""

    def __init__(self, X, facets, first, multipliers_from=None):
        self.nodes, inverse = np.unique(facets, return_inverse=True)
        self.dofs = first + 3 * self.nodes[:, None] + np.arange(3)
        numbers = None
        if multipliers_from is not None:
            numbers = multipliers_from + np.arange(self.dofs.size, dtype=np.int64).reshape(-1, 3)
        self.X = X[self.nodes]
        self.surface = stickslip.Surface(self.X, inverse.reshape(facets.shape), self.dofs.astype(np.int64), numbers)

    def positions(self, unknowns):
        return self.X + unknowns[self.dofs]


def solve(make_body, patch, steps, moves_along=False):
    """Nodes, displacements, the upper side and its states in the last step, and the forces on the top of each step.

    make_body(lower, upper, cells, young, poisson): (nodes (n, 3), hexahedra (m, 8), internal), where internal(u) gives the
    body's forces (n, 3) and its stiffness, node by node. moves_along: a step starts with the upper body moved as its top is. At
    finite strain the top alone could turn cells inside out.
    """
    margin, poisson = (0.0, 0.0) if patch else (0.1, 0.3)
    grip = np.array([0.0, 0.0, -0.005] if patch else [0.002, 0.0008, -0.005])
    young = 1000.0
    upper = make_body((margin, margin, HEIGHT), (1 - margin, 1 - margin, 2 * HEIGHT), (4, 4, 4), young, poisson)
    lower = make_body((0.0, 0.0, 0.0), (1.0, 1.0, HEIGHT), (5, 5, 4), 2000.0, poisson)
    n1, n2 = upper[0].size, lower[0].size
    side1 = Side(upper[0], facets_at(*upper[:2], HEIGHT, up=False), 0, multipliers_from=n1 + n2)
    side2 = Side(lower[0], facets_at(*lower[:2], HEIGHT, up=True), n1)
    total = n1 + n2 + side1.dofs.size
    top = np.arange(n1).reshape(-1, 3)[np.isclose(upper[0][:, 2], 2 * HEIGHT)]
    bottom = n1 + np.arange(n2).reshape(-1, 3)[np.isclose(lower[0][:, 2], 0)]
    free = np.setdiff1d(np.arange(total), np.concatenate([top.ravel(), bottom.ravel()]))
    bodies = (upper, slice(0, n1)), (lower, slice(n1, n1 + n2))
    unknowns, reactions = np.zeros(total), []

    with stickslip.Interface(side1.surface, side2.surface, mu=FRICTION, modulus=young) as face:
        unknowns[n1 + n2:] = face.initial_multipliers().ravel()
        plan = stickslip.Plan(face, side1.X, side2.X, total, pairs="skin")
        for step in range(1, steps + 1):
            if moves_along:
                unknowns[:n1] += np.tile(grip / steps, n1 // 3)
            unknowns[top] = step / steps * grip
            for iteration in range(MAX_ITERATIONS + 1):
                point = side1.positions(unknowns), side2.positions(unknowns), unknowns[n1 + n2:].reshape(-1, 3)
                residual, stiffness = np.zeros(total), []
                for (X, _, internal), own in bodies:
                    forces, matrix = internal(unknowns[own].reshape(X.shape))
                    residual[own] = forces.ravel()
                    stiffness.append(matrix)
                force1, force2, rows = face.residual(*point)
                residual[side1.dofs] += force1
                residual[side2.dofs] += force2
                residual[n1 + n2:] = rows.ravel()
                contact = np.linalg.norm(force1), np.linalg.norm(force2)
                if converged(face, point, young, residual, free, bodies, contact):
                    break
                host = scipy.sparse.block_diag([*stiffness, scipy.sparse.csr_matrix((side1.dofs.size,) * 2)], "csr")
                matrix = (host + plan.values(*point))[free][:, free]
                unknowns[free] -= scipy.sparse.linalg.spsolve(matrix.tocsc(), residual[free])
            else:
                raise SystemExit(f"step {step} does not converge")
            states = face.states(*point)  # before the commit
            face.check_step(*point, modulus=young)  # what no residual knows
            face.commit(*point)
            reactions.append(residual[top].sum(axis=0))
            gap, stick, slip = (int((states.state == stickslip.constants[f"STATE_{name}"]).sum())
                                for name in ("GAP", "STICK", "SLIP"))
            print(f"step {step} iterations {iteration} gap {gap} stick {stick} slip {slip} multipliers along z "
                  f"{point[2][:, 2].min():.16g} {point[2][:, 2].max():.16g}")
    X = np.vstack([upper[0], lower[0]])
    return X, unknowns[: n1 + n2].reshape(-1, 3), side1, states, np.array(reactions)


def converged(face, point, young, residual, free, bodies, contact):
    """The forces on each block balance, beside its own ones, and the interface is in contact equilibrium."""
    balanced = np.zeros(len(residual), bool)
    balanced[free] = True
    for (_, own), force in zip(bodies, contact):
        out_of_balance = np.linalg.norm(residual[own][balanced[own]])
        if not out_of_balance <= RTOL * (np.linalg.norm(residual[own][~balanced[own]]) + force):
            return False
    e = face.equilibrium(*point, modulus=young)
    return (e.gap <= CONTACT_RTOL * e.gap_scale and e.traction <= CONTACT_RTOL * e.traction_scale
            and e.slip <= CONTACT_RTOL * e.slip_scale)


def draw(picture, title, X, u, side1, states, reactions):
    """The nodal pressures where they are now, and the forces on the top."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
    pressure = -(states.traction * states.normal).sum(axis=1)
    drawn = left.tripcolor(*side1.X[:, :2].T, pressure, shading="gouraud")
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
