"""General contact over facets of all kinds: a block pressed and drawn over a larger one, each of a kind of cells of its own, against a named pair."""

from general import SAME, apart
from general_models import BOX, NONE
from scene import write

# Of the block and of what it lies on.
PLANE = (("quad", "quad"), ("tri", "quad"), ("quad8", "quad8"), ("quad9", "tri6"), ("tri6", "tri6"), ("quad", "tri6"))
SPACE = (("hex", "hex"), ("tet", "hex"), ("hex20", "hex20"), ("hex27", "tet10"), ("tet10", "tet10"), ("hex", "tet10"))


def drawn(axes, kinds, **more):
    """Over a third of a facet, with friction."""
    up, plane = axes - 1, [0.13] * (axes - 1)
    body = lambda lower, upper, cells, kind: {**BOX, "lower": lower, "upper": upper, "cells": cells, "cell": kind}
    held = lambda surface, **value: {"surface": surface, "components": list("xyz"[:axes]), **value}
    face = "xyz"[up]
    return {
        "schema": 1,
        **({"model": "plane_strain"} if axes == 2 else {}),
        "bodies": ["block", "base"],
        "block": body([*plane, 0], [p + 0.6 for p in plane] + [0.4], [3] * up + [2], kinds[0]),
        "base": body([0] * up + [-0.4], [1] * up + [0], [4] * up + [2], kinds[1]),
        "supports": ["ground", "press"],
        "ground": held(f"base.{face}min"),
        "press": held(f"block.{face}max", value=[0.08] + [0] * (up - 1) + [-0.01]),
        "steps": {"count": 4},
        "output": NONE,
        **more,
    }, {"interfaces": ["pair"], "pair": {"nonmortar": f"block.{face}min", "mortar": f"base.{face}max", "friction": 0.3}}


def general_cells(verdicts, driver):
    for axes, kinds in [(2, kinds) for kinds in PLANE] + [(3, kinds) for kinds in SPACE]:
        scene, named = drawn(axes, kinds)
        label = "_on_".join(kinds)
        runs = [driver.run(write({**scene, **contact}, driver.output / "scenes" / f"{label}_{axes}_{kind}.yaml"), label=f"{label}_{axes}_{kind}")
                for kind, contact in (("all", {"contact": "all", "friction": 0.3}), ("named", named))]
        verdicts.below(f"{kinds[0]} on {kinds[1]}: all reactions against a named pair", apart(*runs), SAME, "the same roles")
        verdicts.below(f"{kinds[0]} on {kinds[1]}: iterations beyond those of a named pair", runs[0].newton_iterations - runs[1].newton_iterations, 0, "the same problem")
        touching = runs[0].summary["general_contact"]["touching"]
        verdicts.true(f"{kinds[0]} on {kinds[1]}: it slips", any(one["slip"] for one in touching), "friction acts")
