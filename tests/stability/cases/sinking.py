"""What moves and must neither sink nor gain: a block that slides on a flat elastic floor under its weight, over more and more facets, with the weights
that dynamics take by themselves, which conserve and may neither sink nor gain in any step, and with those of statics, which may gain where they say so; and a free block of finite strain that spins by more and more in a step, whose energy and moment of momentum neither rise nor fall."""

import numpy as np

import host
from cell import series

# The block rests 1.0e-3 deep at its weight, and swings to twice that about it; coarse facets on coarse facets add half of that at most.
DEEPEST = 0.003
# What the driver tells from on.
TOLD = 0.01
# What no step may give with conserving weights, over all energy: what Newton's method leaves.
NEVER_UP = 1e-10
# Of a block that spins, over a thousand turns: Newton's method is asked for rounding, since what it leaves of each step adds up.
ENERGY_BOUND, MOMENT_BOUND = 1e-11, 1e-12
TIGHT = ("-snes_rtol", "1e-14")
FACETS = (1, 2, 5, 10, 20, 40)
TURNS = (1e-3, 1e-2, 0.05, 0.1, 0.3, 0.7)
# Whole turns at 0.72 radians a step.
WHOLE = (10, 100, 1000)


def sliding(facets, **interface):
    """Over so many facets of the floor in 100 steps."""
    box = {"type": "box", "young": 1e4, "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "floor"],
        "block": {**box, "lower": [0, 0], "upper": [0.4, 0.2], "cells": [4, 2], "density": 20, "velocity": [0.1 * facets, 0]},
        "floor": {**box, "lower": [-0.4, -0.4], "upper": [4.6, 0], "cells": [50, 4], "density": 2},
        "supports": ["ground"],
        "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
        "loads": ["weight"],
        "weight": {"body": "block", "gravity": [0, -10], "curve": [0, 1, 9, 1]},
        "dynamics": {"rho_inf": 1},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.ymin", "mortar": "floor.ymax", **interface},
        "probes": ["corner"],
        "corner": {"body": "block", "point": [0, 0.2]},
        "steps": {"count": 100, "end": 1},
        "output": {"vtu": "none", "csv": "none"},
    }


def slides(context, facets, **interface):
    whole = context.solve(sliding(facets, **interface))
    result = host.outcome(whole)
    if result.refusal is None:
        deepest = -min(step["probes"]["corner"][1] for step in whole.steps)
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        given = table["contact_gain"][-1] / (table["kinetic"] + table["strain"]).max()
        result.below("depth", deepest, DEEPEST, "nothing sinks")
        result.true("gained and not told", given < TOLD or "energy_told" in whole.summary, f"{given:.2g} of its energy")
    return result


def conserves(context, facets):
    whole = context.solve(sliding(facets))
    result = host.outcome(whole)
    if result.refusal is None:
        deepest = -min(step["probes"]["corner"][1] for step in whole.steps)
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        largest = (table["kinetic"] + table["strain"]).max()
        given = np.diff(table["kinetic"] + table["strain"] - table["external_work"]).max() / largest
        result.below("depth", deepest, DEEPEST, "nothing sinks")
        result.below("energy that a step gives", max(0.0, given), NEVER_UP, "no step gives any")
    return result


def spins(context, turn, steps=25, material="neo_hooke"):
    """A free block, `turn` radians in each step."""
    whole = context.solve({
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block"],
        "block": {"type": "box", "lower": [-0.1, -0.1], "upper": [0.1, 0.1], "cells": [4, 4], "young": 1000, "poisson": 0.3, "density": 1,
                  "material": material, "spin": 3, "about": [0, 0]},
        "dynamics": {"rho_inf": 1},
        "steps": {"count": steps, "end": steps * turn / 3},
        "output": {"vtu": "none", "csv": "none"},
    }, *TIGHT)
    result = host.outcome(whole)
    if result.refusal is None:
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        energy, moment = table["kinetic"] + table["strain"], table["angular_z"]
        result.below("energy gained or lost", np.abs(energy / energy[0] - 1).max(), ENERGY_BOUND, "kept")
        result.below("moment of momentum gained or lost", np.abs(moment / moment[0] - 1).max(), MOMENT_BOUND, "kept")
    return result


def cells():
    yield from series("dynamics: slides over facets", FACETS, lambda n: lambda c: conserves(c, n), quick=(10,))
    yield from series("dynamics, weights of now: slides over facets", FACETS, lambda n: lambda c: slides(c, n, weights="current"), quick=(10,))
    yield from series("dynamics: finite strain spins, radians a step", TURNS, lambda t: lambda c: spins(c, t), quick=(0.3,))
    for material in ("st_venant_kirchhoff", "neo_hooke"):
        yield from series(f"dynamics: {material} spins, whole turns", WHOLE, lambda n, m=material: lambda c: spins(c, 0.72, int(np.ceil(n * 2 * np.pi / 0.72)), m))
