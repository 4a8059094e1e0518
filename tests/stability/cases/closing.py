"""Balls that fall on blocks and planes by their load alone: facets that are slanted to each other close a gap faster than
the bodies move; units of length; planes whose point lies far away; bodies so stiff that rounding hides their loads."""

import host
from cell import series

CELLS = (3, 4, 5, 6, 7, 8)  # of the ball along each edge
SIZES = ("1e-6", "1e-3", "1e3", "1e4", "1e6", "1e9")
AWAY = ("0", "10", "1e3", "1e4", "1e5", "1e6")
STIFF = ("1e12", "1e14", "1e15", "1e16", "1e18", "1e20")  # of the punch; the base has 1e3
SOFT = ("500", "200", "50", "10", "2", "0.5")
# A step ends at 2e-11 of the forces, in each of a few bodies.
BALANCE = 1e-9
LOST = "are lost in the rounding of its own forces"
# From here on nothing but a refusal will do, beside the answer.
HIDDEN = 1e16


def body(cells, size, **more):
    box = {"type": "box", "lower": [-size / 2] * 3, "upper": [size / 2] * 3, "cells": [cells] * 3, "ball": [0, 0, 0]}
    return box | {"young": 1000, "poisson": 0.3} | more


def pressed(scene, load):
    """The reaction of the ground against the load that is pressed on it."""

    def run(context):
        found = context.solve(scene)
        result = host.outcome(found)
        if result.refusal is None:
            carried = found.steps[-1]["reactions"]["ground"][2]
            result.below("reaction", abs(carried / load(found) - 1), BALANCE, "the load")
            held = found.summary.get("held_by_nothing")
            result.true("nothing is free", not held, "the contact holds it")
        return result

    return run


def ball(cells=4, size=1.0, gap=0.0, plane=None, friction=0.0, traction=1.0):
    base = {"type": "analytic", "shape": "plane", "point": plane, "direction": [0, 0, 1]}
    if plane is None:
        low = [-size, -size, -2 * size - gap]
        base = {"type": "box", "lower": low, "upper": [size, size, -size / 2 - gap], "cells": [4, 4, 2]}
        base |= {"young": 1000, "poisson": 0.3}
    scene = {
        "schema": 1,
        "bodies": ["ball", "base"],
        "ball": body(cells, size),
        "base": base,
        "supports": ["ground", "guide"],
        "ground": {"body" if plane else "surface": "base" if plane else "base.zmin", "components": ["x", "y", "z"]},
        "guide": {"surface": "ball.zmax", "components": ["x", "y"]},
        "loads": ["press"],
        "press": {"surface": "ball.zmax", "traction": [0, 0, -traction]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "ball.zmin", "mortar": "base.surface" if plane else "base.zmax", "friction": friction},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }
    return scene


def by_contact(run):
    """What the contact carries: the ball has no other support along z."""
    return run.resultant("contact")[2]


def on_base(upper, friction, pressure, steps, guide=None, **more):
    """A block from corner to corner on the base [0, 1]^3 with E = 1000, under a pressure, held by the contact alone but for
    a `guide` of its head."""
    common = {"type": "box", "poisson": 0.3} | more
    lower, upper, cells, young = upper
    area = (upper[0] - lower[0]) * (upper[1] - lower[1])
    scene = {
        "schema": 1,
        "bodies": ["block", "base"],
        "block": common | {"lower": lower, "upper": upper, "cells": cells, "young": young},
        "base": common | {"lower": [0, 0, 0], "upper": [1, 1, 1], "cells": [3, 3, 2], "young": 1000},
        "supports": ["ground"],
        "ground": {"surface": "base.zmin", "components": ["x", "y", "z"]},
        "loads": ["press"],
        "press": {"surface": "block.zmax", "pressure": pressure},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.zmin", "mortar": "base.zmax", "friction": friction},
        "steps": {"count": steps},
        "output": {"vtu": "none", "csv": "none"},
    }
    if guide:
        scene["supports"].append("guide")
        scene["guide"] = {"surface": "block.zmax", "components": ["x", "y"], "value": guide}
    return pressed(scene, lambda run: pressure * area)


def stiff(young):
    block = [0.1, 0.1, 1], [0.9, 0.9, 1.5], [2, 2, 2], float(young)
    return on_base(block, friction=0.3, pressure=10, steps=3, guide=[0.01, 0, 0])


def soft(young):
    """A soft block on a hard one widens, so that all of it slips outwards: friction holds it all the same."""
    block = [0.2, 0.2, 1], [0.8, 0.8, 1.5], [3, 3, 2], float(young)
    return on_base(block, friction=0.02, pressure=0.02 * float(young), steps=2, small_strain=True)


def cells():
    slanted = lambda n: pressed(ball(n, gap=0.5), by_contact)
    sized = lambda text: pressed(ball(3, float(text), 0.0, [0, 0, -float(text) / 2], 0.8, 0.01), by_contact)
    far = lambda text: pressed(ball(3, 1.0, 0.0, [float(text), 0, -0.5], 0.8, 0.01), by_contact)
    lost = lambda young: LOST if float(young) >= HIDDEN else None
    yield from series("ball over a gap falls on a block, cells", CELLS, slanted, quick=(5,))
    yield from series("ball on a plane, size", SIZES, sized, quick=("1e3",))
    yield from series("ball on a plane, its point far away", AWAY, far, quick=("1e3",))
    yield from series("punch under a load, its modulus", STIFF, stiff, quick=("1e14", "1e18", "1e20"), may_refuse=lost)
    yield from series("soft block held by slipping friction, modulus", SOFT, soft, quick=("10",))
