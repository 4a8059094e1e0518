"""Laws in the place of Coulomb's: cohesion up to many times the pressure, friction that weakens within less and less slip, until the
block snaps, and orthotropic friction up to a ratio of 1000. A flat block is pulled over a longer one until all of it slips; then
the force is that of area and load, whatever came before."""

import numpy as np

import host
from cell import series

# Sums of nodal forces where all nodes slip, over a base that is bent by the pressure: 1e-4 of its modulus. Measured 1e-5.
SUMS = 1e-4
# Of a block that is moved along a line while its nodes slip by what it is strained less: moduli are 1e4 of the pressure.
STRAINED = 1e-3

YOUNG, PRESSURE, MU = 1e4, 1.0, 0.4
# The trailing edge opens where the cohesion is many times the pressure: no equilibrium need exist there, for the shear of a node that
# opens drops by the cohesion.
OPENS = r"states of nodes repeat|not converged"
# A block that is softer than the law's fall has none close to the last one.
SNAPS = r"not converged"


def pulled(ways, dimension=2, towards=(1, 0, 0), **interface):
    """A block, 1 long and 0.05 high, on a longer one; its top is pressed, and moved along a direction by these ways, one a step."""
    box = {"type": "box", "young": YOUNG, "poisson": 0.0, "small_strain": True}
    plane = dimension == 2
    axes = "xy" if plane else "xyz"
    up, low, high = axes[-1], [0] * (dimension - 1), [1] * (dimension - 1)
    around = [-1] * (dimension - 1), [2] * (dimension - 1)
    moved = list(axes[:-1])
    return {
        "schema": 1,
        **({"model": "plane_strain"} if plane else {}),
        "bodies": ["upper", "lower"],
        "upper": {**box, "lower": [*low, 0], "upper": [*high, 0.05], "cells": [5, 1] if plane else [3, 2, 1]},
        "lower": {**box, "lower": [*around[0], -0.05], "upper": [*around[1], 0], "cells": [17, 1] if plane else [7, 8, 1]},
        "supports": ["floor", "pull"],
        "floor": {"surface": f"lower.{up}min", "components": list(axes)},
        "pull": {"surface": f"upper.{up}max", "components": moved, "value": [float(v) for v in towards[:dimension]],
                 "curve": [v for k, way in enumerate([0, *ways]) for v in (k, way)]},
        "loads": ["press"],
        "press": {"surface": f"upper.{up}max", "pressure": PRESSURE, "curve": [0, 1, 1, 1]},
        "interfaces": ["base"],
        "base": {"nonmortar": f"upper.{up}min", "mortar": f"lower.{up}max", "friction": MU, **interface},
        "steps": {"times": list(range(1, len(ways) + 1))},
        "output": {"vtu": "none", "csv": "last"},
    }


def forced(context, scene, exact, bound, reason):
    """The force along the surface at the end."""
    whole = context.solve(scene)
    result = host.outcome(whole)
    if result.refusal is None:
        slips = whole.interface("base")["state"] == "slip"
        result.true("all nodes slip", bool(np.all(slips)), "moved far enough")
        force = np.array(whole.resultant("base"))[: len(exact)]
        force = force * np.sign(force @ exact)
        result.below("force", np.abs(force - exact).max() / np.abs(exact).max(), bound, reason)
    return result


def cohesion(over_pressure):
    def run(context):
        scene = pulled([0, 1e-3, 0.1], law="cohesion", cohesion=over_pressure * PRESSURE)
        return forced(context, scene, [MU * PRESSURE + over_pressure * PRESSURE], SUMS, "area times cohesion, and mu times the load")

    return run


def weakening(critical):
    """There and back, ten times the critical slip at least."""

    def run(context):
        scene = pulled([0, 1e-3, 0.05, 0.1, -0.1], law="weakening", friction_after=0.1, critical_slip=critical)
        return forced(context, scene, [0.1 * PRESSURE], SUMS, "the coefficient after the slip times the load")

    return run


def orthotropic(ratio):
    def run(context):
        across, angle = MU / ratio, 0.5
        scene = pulled([0, 1e-3, 0.1], 3, (np.cos(1.3), np.sin(1.3), 0), law="orthotropic", friction_across=across,
                       direction=[float(np.cos(angle)), float(np.sin(angle)), 0.3])
        axes = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        square = axes.T @ np.diag([MU**2, across**2]) @ axes
        way = np.array([np.cos(1.3), np.sin(1.3)])
        exact = PRESSURE * square @ way / np.sqrt(way @ square @ way)
        return forced(context, scene, exact, STRAINED, "the point of the ellipse with that normal")

    return run


def cells():
    over = (1e-8, 1e-4, 1e-2, 0.1, 0.3, 1, 3, 10, 100)
    yield from series("cohesion over the pressure", over, cohesion, quick=(0.3,), may_refuse=OPENS)
    slips = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6)
    yield from series("friction weakens within a slip", slips, weakening, quick=(1e-3,), may_refuse=SNAPS)
    yield from series("orthotropic friction, ratio", (1, 1.5, 3, 10, 30, 100, 300, 1000), orthotropic, quick=(3,))
