"""Pins in rings with clearance, pulled by force: gaps close in a chain, from the lug by the pin to the fork, and the pin is loose
in directions that the normals of contact never hold: along its axis and about it, which friction holds once it is pressed.

An oblique pull turns the lug about the pin, until it points along the pull as far as friction lets it. A bush round the
pin makes the chain of gaps longer by one."""

import math

import host
from cell import series
from pin_joint import END, pin_chain, pin_joint

CLEARANCES = ("1e-4", "1e-3", "3e-3", "1e-2", "2e-2", "4e-2")
CELLS = (12, 14, 16, 20, 24, 28)  # round the pin
# Directions in which a support holds the one end of the pin; the rest is loose.
HELD = {"x, y, z": "xyz", "y, z": "yz", "x, y": "xy", "z": "z", "y": "y", "nothing": ""}
LOAD = 20.0
# Tractions at a lug's end, 6 from the pin's axis. Those beyond a slope of 0.03 or so turn it. The hole presses on the pin by facets.
OBLIQUE = {"along x": (20, 0, 0), "1 against y": (20, -1, 0.5), "2 along y": (20, 2, 1), "3 along z": (20, 0, 3)}
# A chain of two joints; its pulled end has this area. A link that is pulled sideways hangs on an edge.
CHAIN = {"along x": (20, 0, 0), "1 along y": (20, 1, 0), "2 along y": (20, 2, 1), "2 against y": (20, -2, 1), "1 along z": (20, 0, 1), "4 along y": (20, 4, 0)}
CHAIN_END = 8.8
# A step ends at 1e-11 of the forces, in each of a few bodies.
BALANCE = 1e-9
QUIET = {"output": {"vtu": "none", "csv": "last"}}
# Of all steps; gaps that close one by one, by hand, take as many.
ITERATIONS, CUTBACKS = 80, 2


def ring(inner, outer, low, high, around, young, layers=2):
    box = {"type": "box", "polar": True, "lower": [inner, 0, low], "upper": [outer, 360, high], "cells": [2, around, layers]}
    return box | {"young": young, "poisson": 0.3}


def joint(clearance=0.01, around=16, held=""):
    hole = 1 + clearance
    scene = {
        "schema": 1,
        "bodies": ["lug", "one", "two", "pin"],
        "lug": ring(hole, 2, -0.5, 0.5, around, 70000),
        "one": ring(hole, 2, 0.55, 1.1, around, 70000),
        "two": ring(hole, 2, -1.1, -0.55, around, 70000),
        "pin": ring(0.4, 1, -1.2, 1.2, around, 210000, layers=6),
        "supports": ["guide", "root"],
        "guide": {"surface": "lug.xmax", "components": ["y", "z"]},
        "root": {"surface": "one.xmax", "components": ["x", "y", "z"]},
        "loads": ["pull"],
        "pull": {"surface": "lug.xmax", "traction": [LOAD, 0, 0]},
        "interfaces": ["inner", "upper", "lower"],
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "last"},
    }
    scene["supports"].append("rest")
    scene["rest"] = scene["root"] | {"surface": "two.xmax"}
    for name, body in (("inner", "lug"), ("upper", "one"), ("lower", "two")):
        scene[name] = {"nonmortar": f"{body}.xmin", "mortar": "pin.xmax", "friction": 0.2}
    if held:
        scene["supports"].append("pinned")
        scene["pinned"] = {"surface": "pin.zmax", "components": list(held)}
    return scene


def bushed(clearance):
    """A bush between the lug and the pin."""
    scene = joint(clearance)
    scene["bodies"].append("bush")
    scene["bush"] = ring(1 + clearance, 2, -0.5, 0.5, 16, 110000)
    scene["lug"] = ring(2 + clearance, 3, -0.5, 0.5, 16, 70000)
    scene["pull"] = scene["pull"] | {"traction": [LOAD * 2 / 3, 0, 0]}  # over an outside that is as much larger
    scene["inner"] = {"nonmortar": "bush.xmin", "mortar": "pin.xmax", "friction": 0.2}
    scene["interfaces"].append("outer")
    scene["outer"] = {"nonmortar": "lug.xmin", "mortar": "bush.xmax", "friction": 0.2}
    return scene


def load(around):
    """On the facets of the lug's outside, which is 1 high."""
    return LOAD * around * 4 * math.sin(math.pi / around)


def judged(context, scene, force):
    """All of the load reaches the fork or the support of the pin, in directions that no guide holds; what is loose is told."""
    found = context.solve(scene)
    result = host.outcome(found)
    if result.refusal is not None:
        return result
    size = math.hypot(*force)
    for i, axis in enumerate("xyz" if "guide" not in scene else "x"):
        carried = -sum(reaction[i] for name, reaction in found.steps[-1]["reactions"].items() if name != "guide")
        result.below(f"reaction along {axis}", abs(carried - force[i]) / size, BALANCE, "the load")
    result.below("iterations", sum(step["newton_iterations"] for step in found.steps), ITERATIONS, "of all steps")
    result.below("cut-backs", found.summary["cutbacks"], CUTBACKS, "of all steps")
    result.true("what is loose is told", {"lug", "link"} & set(found.summary["held_by_contact"]), "what only a pin stops")
    result.figures["laid down by"] = found.summary.get("laid_down", {}).get("moved", 0.0)
    return result


def pulled(around=16, **more):
    return lambda context: judged(context, joint(around=around, **more), (load(around), 0, 0))


def pulled_obliquely(traction):
    return lambda context: judged(context, pin_joint(traction, 4) | QUIET, [END * t for t in traction])


def pulled_chain(traction):
    return lambda context: judged(context, pin_chain(traction, 4) | QUIET, [CHAIN_END * t for t in traction])


def pulled_by_bush(clearance):
    return lambda context: judged(context, bushed(clearance), (load(16), 0, 0))


def cells():
    yield from series("pin joint, clearance", CLEARANCES, lambda text: pulled(clearance=float(text)), quick=("1e-4",))
    yield from series("pin joint, facets round the pin", CELLS, lambda n: pulled(around=n), quick=(20,))
    loose = lambda name: pulled(held=HELD[name])
    yield from series("pin joint, what holds the pin's end", tuple(HELD), loose)
    oblique_pull = lambda text: pulled_obliquely(OBLIQUE[text])
    yield from series("pin joint without a guide, pull", tuple(OBLIQUE), oblique_pull, quick=("2 along y",))
    chain_pull = lambda text: pulled_chain(CHAIN[text])
    yield from series("chain of two pin joints, pull", tuple(CHAIN), chain_pull)
    yield from series("pin joint with a bush, clearance", CLEARANCES[1:5], lambda text: pulled_by_bush(float(text)))
