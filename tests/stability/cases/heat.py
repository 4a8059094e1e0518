"""Heat through two bars whose meshes do not match: conductances from nothing to nearly perfect, bodies of very different
conductivity, few facets over many, zeros of temperature far away, a bar that covers the other one in part."""

import host
from cell import series

# Linear fields: what rounding leaves of a temperature, over the difference of the two that are prescribed.
EXACT = 1e-9
# What passes is a conductance times a difference of temperatures of the size of their zero.
ROUNDING = 1e-14
HOT, COLD = 100.0, 20.0


def bars(h, contrast=1.0, cells=3, zero=0.0, width=1.0, basis="dual"):
    box = {"type": "box", "young": 1000.0, "poisson": 0.0, "small_strain": True}
    sides = ["upper", "lower"]
    return {
        "schema": 1,
        "bodies": sides,
        "upper": {**box, "lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [cells, 2, 2], "conductivity": contrast},
        "lower": {**box, "lower": [0, 0, -1], "upper": [width, 1, 0], "cells": [4, 3, 2], "conductivity": 1.0},
        "supports": ["floor", "left", "front"],
        "floor": {"surface": "lower.zmin", "components": ["z"]},
        "left": {"surface": [f"{side}.xmin" for side in sides], "components": ["x"]},
        "front": {"surface": [f"{side}.ymin" for side in sides], "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "pressure": 1.0},
        "heat": {"initial": COLD + zero},
        "temperatures": ["hot", "cold"],
        "hot": {"surface": "upper.zmax", "value": HOT + zero},
        "cold": {"surface": "lower.zmin", "value": COLD + zero},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "weights": "reference", "basis": basis,
                 "conductance_constant": h, "conductance_reach": 0.5},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "none"},
    }


def passes(**of):
    """What the supports give and take is one number, and that of the closed form where the bars cover each other."""

    def run(context):
        whole = context.solve(bars(**of))
        result = host.outcome(whole)
        if result.refusal is None:
            h, contrast = of["h"], of.get("contrast", 1.0)
            found = whole.steps[-1]["heat"]
            flux = (HOT - COLD) / (1 / contrast + 1 / h + 1)
            # The stiffest entry times the last digit of a temperature.
            rounding = ROUNDING * max(h, contrast, 1.0) * (HOT + abs(of.get("zero", 0.0)))
            bound = EXACT * flux + rounding
            given, taken = found["supplied"]["hot"], -found["supplied"]["cold"]
            result.below("heat in and out", abs(given - taken), bound, "nothing is lost")
            if of.get("width", 1.0) >= 1:
                result.below("heat", abs(given - flux), bound, "closed form")
            else:
                result.true("heat through a part", 0 < given < flux + bound, "less than through the whole")
        return result

    return run


def cells():
    for basis in ("standard", "dual"):
        conductances = [10.0**k for k in range(-12, 13, 2)]
        yield from series(f"conductance over a bar's, {basis}", conductances, lambda h, b=basis: passes(h=h, basis=b), quick=(1.0,))
    yield from series("conductivities, one over the other", (1e-6, 1e-3, 1e3, 1e6), lambda k: passes(h=1.0, contrast=k), quick=(1e3,))
    yield from series("facets along the bar over 4", (1, 2, 8, 16, 40), lambda n: passes(h=2.0, cells=n), quick=(1,))
    yield from series("zero of temperature", (-1e6, -273.15, 1e3, 1e6), lambda t: passes(h=2.0, zero=t), quick=(1e3,))
    yield from series("width of the other bar", (0.9, 0.5, 0.1, 0.01), lambda w: passes(h=2.0, width=w), quick=(0.5,))
