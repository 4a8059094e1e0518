"""Two plane bodies that meet: one stiffer and stiffer, or heavier and heavier, steps from a hundredth of h / c to a hundred of it. Whatever
becomes of it, no step gives energy, and what contact takes is all that is gone; momentum is kept."""

import numpy as np

import host
from cell import series

# Newton's method ends at 1e-11 of the forces, once a step; the energy of a body that a step stops is all of it.
ENERGY = 1e-8
CELL = 0.25


def meeting(stiff=1.0, heavy=1.0, step=1.0, **interface):
    """Two blocks of soft cells with c = 1, a hundredth of a cell apart, that do not match; 30 steps of `step` times h / c."""
    box = {"type": "box", "poisson": 0.3, "small_strain": True}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["upper", "lower"],
        "upper": {**box, "lower": [0.1, 0.0025], "upper": [1.1, 1.0025], "cells": [4, 4], "young": 1.0, "density": 1.0, "velocity": [0.02, -0.1]},
        "lower": {**box, "lower": [0, -1], "upper": [1.3, 0], "cells": [7, 4], "young": stiff, "density": heavy},
        "dynamics": {"rho_inf": 1},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "weights": "reference", **interface},
        "steps": {"count": 30, "end": 30 * step * CELL},
        "output": {"vtu": "none", "csv": "last"},
    }


def kept(context, scene):
    whole = context.solve(scene)
    result = host.outcome(whole)
    if result.refusal is None:
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        energy = table["kinetic"] + table["strain"]
        result.below("growth of energy", max(0.0, np.diff(energy).max() / energy[0]), ENERGY, "no step gives any")
        result.below("balance", np.abs(table["numerical"]).max() / energy[0], ENERGY, "contact took the rest")
        result.below("momentum", np.abs(table["momentum_y"] / table["momentum_y"][0] - 1).max(), ENERGY, "nothing acts from outside")
        result.true("they met", table["contact_work"].min() < 0, "contact did work")
    return result


def cells():
    yield from series("dynamics: stiffness over that of the other", (1e0, 1e2, 1e4, 1e6), lambda s: lambda c: kept(c, meeting(stiff=s)), quick=(1e4,))
    yield from series("dynamics: mass over that of the other", (1e0, 1e2, 1e4, 1e6), lambda s: lambda c: kept(c, meeting(heavy=s)))
    yield from series("dynamics: steps over h / c", (1e-1, 1e0, 1e1, 1e2), lambda s: lambda c: kept(c, meeting(step=s)), quick=(1e0,))
    yield from series("dynamics: with friction", (0.1, 0.3, 1.0), lambda s: lambda c: kept(c, meeting(friction=s)), quick=(0.3,))
