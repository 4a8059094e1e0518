"""A fluid between a thin layer and a die that slants: the layer carries each place by itself, so that the fluid comes to where its pressure is the
contact's, p = PEAK x, and leaks at PEAK, whatever the meshes, steps and materials are."""

import host
from cell import series

PEAK = 2.0
# 40 facets of the layer are as long as half of it is high in the mildest; a layer as high as 8 facets spreads what it carries over these.
HEIGHTS = (0.02, 0.05, 0.08, 0.12, 0.16, 0.2)
# Facets of the die, over the layer's 40.
DIES = (40, 30, 50, 23, 11, 160)
FRICTIONS = (0.05, 0.1, 0.2, 0.4, 0.7, 1.0)
STEPS = (44, 22, 11, 5, 2, 1)
STIFFNESSES = (1e1, 1e2, 1e4, 1e6, 1e8, 1e-2)  # modulus of the layer: fluid and die go with it
# Of one facet of each side the front is known to one, and to what the layer spreads, which is less than it is high.
FACETS = 1.5
SPREADS = 1.0
# A step ends at 1e-11 of the forces.
LEAKS = 1e-9


def wedge(height=0.05, die=30, friction=0.0, steps=11, young=100.0):
    """Pressed in the first unit of time; then the fluid rises to PEAK, in so many steps, and by a tenth beyond in two more."""
    peak = PEAK * young / 100
    box = {"type": "box", "young": young, "poisson": 0}
    slope = peak * height / young
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["layer", "die"],
        "layer": box | {"lower": [0, 0], "upper": [1, height], "cells": [40, 2], "small_strain": True},
        "die": box | {"lower": [0, height], "upper": [1, 3 * height], "cells": [die, 2], "small_strain": True},
        "supports": ["base", "press"],
        "base": {"surface": "layer.ymin", "components": ["x", "y"]},
        "press": {"body": "die", "components": ["x", "y"], "gradient": [0, 0, -slope, 0], "curve": [0, 0, 1, 1]},
        "loads": ["oil"],
        "oil": {"surface": ["layer.xmin", "die.xmin"], "pressure": 1.1 * peak, "into": "seal", "outlet": ["layer.xmax", "die.xmax"],
                "curve": [1, 0, 2, 1 / 1.1, 3, 1]},
        "interfaces": ["seal"],
        "seal": {"nonmortar": "layer.ymax", "mortar": "die.ymin"} | ({"friction": friction} if friction else {}),
        "steps": {"stages": [1, 1, 2, steps, 3, 2]},
        "output": {"vtu": "none", "csv": "none"},
    }


def sealed(**more):
    def run(context):
        scene = wedge(**more)
        found = context.solve(scene)
        result = host.outcome(found)
        if result.refusal is not None:
            return result
        height, die, young = more.get("height", 0.05), more.get("die", 30), more.get("young", 100.0)
        peak, known = PEAK * young / 100, FACETS * (1 / 40 + 1 / die) / 2 + SPREADS * height
        off, wrong = 0.0, 0
        for step in found.steps:
            oil = step["fluids"]["oil"]
            off = max(off, abs(oil["area"] / 2 - min(1, oil["pressure"] / peak)))
            wrong += oil["at_outlet"] and oil["pressure"] < peak * (1 - known)
            wrong += not oil["at_outlet"] and oil["pressure"] > peak * (1 + LEAKS)
        result.below("front", off, known, "where the pressures are equal, in the worst of the steps")
        result.true("leak", not wrong, "where the fluid's pressure is the contact's largest")
        return result

    return run


def cells():
    yield from series("seal, height of the layer", HEIGHTS, lambda h: sealed(height=h))
    yield from series("seal, facets of the die", DIES, lambda n: sealed(die=n), quick=(30,))
    yield from series("seal, friction", FRICTIONS, lambda mu: sealed(friction=mu))
    yield from series("seal, steps to the leak", STEPS, lambda n: sealed(steps=n))
    yield from series("seal, modulus", STIFFNESSES, lambda young: sealed(young=young))
