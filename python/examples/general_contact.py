"""General contact at finite strain: a hairpin between a block and a round punch touches both, and itself. No pairs and no sides are
named. numpy and scipy alone. Usage: general_contact.py [PICTURE]"""

import sys

import numpy as np
import scipy.sparse
import stickslip

SHEAR, LAME, STEPS, DEPTH, DRAW = 0.4, 0.6, 12, 0.34, 0.1
CORNERS = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])


def body(nx, ny, shape):
    """Quadrilaterals of the unit square, whose nodes ``shape`` takes elsewhere."""
    s, t = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1)))
    first = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    return np.column_stack(shape(s, t)), first[:, None] + [0, 1, nx + 2, nx + 1]


def hairpin(s, t, length=1.0, radius=0.2):
    """A strip 0.1 thick: along the block, around a bend, and back."""
    way, r = s * (2 * length + np.pi * radius), radius + 0.05 - 0.1 * t
    angle = np.clip((way - length) / radius, 0, np.pi)
    straight = np.minimum(way, length) - np.maximum(way - length - np.pi * radius, 0)
    return straight + r * np.sin(angle), 0.25 - r * np.cos(angle)


punch = lambda s, t: (0.4 + (0.4 - 0.25 * t) * np.sin(2.4 * s - 1.2), 0.9 - (0.4 - 0.25 * t) * np.cos(2.4 * s - 1.2))
bodies = [body(27, 4, lambda s, t: (1.6 * s - 0.2, 0.25 * (t - 1))), body(48, 2, hairpin), body(12, 4, punch)]
X, starts = np.vstack([nodes for nodes, _ in bodies]), np.cumsum([0] + [len(nodes) for nodes, _ in bodies])
cells = np.vstack([quads + start for (_, quads), start in zip(bodies, starts)])
dofs = np.arange(X.size).reshape(X.shape)[cells].reshape(-1, 8)


def neo_hooke(u):
    """Internal forces, of P = mu (F - F^-T) + lambda ln J F^-T, and their derivative."""
    u, f, K = u.reshape(X.shape)[cells], 0.0, 0.0
    for xi, eta in CORNERS / np.sqrt(3):
        local = 0.25 * CORNERS * np.column_stack([1 + eta * CORNERS[:, 1], 1 + xi * CORNERS[:, 0]])
        J = np.einsum("eai,aj->eij", X[cells], local)
        g, v = np.einsum("aj,eji->eai", local, np.linalg.inv(J)), np.linalg.det(J)[:, None, None]
        F = np.eye(2) + np.einsum("eai,eaj->eij", u, g)
        if not (np.linalg.det(F) > 0).all():
            raise stickslip.StepRefused("a cell is turned inside out")
        now, log = g @ np.linalg.inv(F), np.log(np.linalg.det(F))[:, None, None]
        f = f + v * (SHEAR * g @ F.transpose(0, 2, 1) + (LAME * log - SHEAR) * now)
        parts = SHEAR * np.einsum("eaj,ebj,ik->eaibk", g, g, np.eye(2)) + LAME * np.einsum("eai,ebk->eaibk", now, now)
        K = K + v[..., None, None] * (parts + (SHEAR - LAME * log)[..., None, None] * np.einsum("eak,ebi->eaibk", now, now))
    return np.bincount(dofs.ravel(), f.ravel()), scipy.sparse.coo_matrix((K.ravel(), (dofs.repeat(8), np.tile(dofs, 8).ravel()))).tocsr()


# Held are the block's lower edge and one end of the hairpin; the punch is gripped inside.
held = np.flatnonzero((X[:, 1] < -0.249) | (np.abs(X[:, 0]) < 1e-9) & (X[:, 1] > 1e-9) & (X[:, 1] < 0.11))
grip = starts[2] + np.flatnonzero(np.hypot(*(bodies[2][0] - [0.4, 0.9]).T) < 0.151)
fixed = np.concatenate([2 * held, 2 * held + 1, 2 * grip, 2 * grip + 1])
whole = stickslip.skin(cells, X)
contact = stickslip.Contact(X).add(whole, mu=0.3, modulus=1.0)

way = lambda t: np.repeat([0, 0, DRAW * max(t - 1, 0), -DEPTH * min(t, 1)], [len(held), len(held), len(grip), len(grip)])
times = np.arange(1, 2 * STEPS + 1) / STEPS
for step in stickslip.steps(contact, lambda u, t: neo_hooke(u)[0], lambda u, t: neo_hooke(u)[1], times, fixed=fixed, prescribed=way):
    print(step)
print(contact.report())
if len(sys.argv) > 1:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import collections
    from matplotlib import pyplot as plt

    skin, states, x = contact.interfaces[0], step.states[0], X + step.x[: X.size].reshape(X.shape)
    copies, closed = x[np.unique(whole)][skin.originals], states.state != stickslip.State.GAP
    colours = np.array(["0.4", "tab:red", "tab:blue"])[skin.facets().side]
    figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
    axes.add_collection(collections.PolyCollection(x[cells], facecolor="0.93", edgecolor="0.8"))
    axes.add_collection(collections.LineCollection(x[whole], colors=colours, linewidths=2))
    figure.colorbar(axes.scatter(*copies[closed].T, c=states.pressure[closed], zorder=3), label="pressure")
    axes.set(aspect="equal", title="Red facets have the multipliers, and press on blue ones")
    figure.savefig(sys.argv[1], dpi=120)
