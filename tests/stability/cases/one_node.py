"""Klarbring's problem: one node with friction that may stick, slip or lift off under the same load.

Its stiffness (normal, tangential) is [[1, 1/2], [1/2, 1]], its load (-1, -2.5). Lifted off it is at (1/3, -8/3).
Stuck at 0 it carries a pressure of 1 and a shear of 2.5, which takes mu >= 2.5. Slipping to u it carries p = 1 + u /
2 > 0, and u + 2.5 = mu p, so u = (mu - 2.5) / (1 - mu / 2), which must be negative. Where mu < k_tt / |k_nt| = 2
there is no more than one solution.
"""

import numpy as np

import host
from cell import series

UNIQUE = 2.0
# Of one of the edge's two nodes while the other is held: the corner's stiffness is (lambda + 4 G) / 9 along an axis and
# (lambda + G) / 12 across, with lambda = 1.5 and G = 0.5. That is what the driver can tell, and must.
UNIQUE_ALONE = 7 / 3
FRICTIONS = (0.5, 1, 1.9, 2.1, 2.5, 3, 10, 1000)
SCALES = tuple(f"1e{k}" for k in range(-6, 7, 2))
EXACT = 1e-9  # two unknowns, solved to 1e-11 of the forces


def solutions(mu):
    found = {"open": (-8 / 3, 1 / 3)}
    if mu >= 2.5:
        found["stick"] = (0.0, 0.0)
    if mu != UNIQUE:
        u = (mu - 2.5) / (1 - mu / 2)
        if u < 0 and 1 + u / 2 > 0:
            found["slip"] = (u, 0.0)
    return found


def solve(context, mu, *options):
    run = context.solve("klarbring", "-contact_friction", repr(float(mu)), *options)
    result = host.outcome(run)
    if result.refusal is None:
        edge = np.array(run.steps[-1]["probes"]["edge"])[[0, 2]]
        distances = {name: np.abs(edge - at).max() for name, at in solutions(mu).items()}
        name = min(distances, key=distances.get)
        result.below(f"place of the node ({name})", distances[name], EXACT, "one of the exact solutions")
        told = run.summary["several_states"].get("contact", {}).get("critical_friction")
        result.below("several states told wrongly", float((told is not None) != (mu >= UNIQUE_ALONE)), 0.5, "it is known")
        if told is not None:
            result.below("friction from which they are", abs(told - UNIQUE_ALONE), EXACT, "from the cell's stiffness")
        if len(distances) > 1:
            result.warnings.append(
                f"mu > {UNIQUE:g}, {len(distances)} solutions ({', '.join(distances)}); ended in {name}"
            )
    return result


def cells():
    several = lambda mu: r"not converged.*(state|repeat)" if mu > UNIQUE else None
    yield from series(
        "one node, friction",
        FRICTIONS,
        lambda mu: lambda context: solve(context, mu),
        quick=(1, 3, 1000),
        may_refuse=several,
    )
    scaled = lambda text: lambda context: solve(context, 1, "-contact_augmentation_scale", text)
    yield from series("one node that chatters, augmentation", SCALES, scaled, quick=("1e-6", "1e2"))
