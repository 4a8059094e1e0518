"""Two plane bodies that meet: one stiffer and stiffer, or heavier and heavier, steps from a tenth of h / c to a hundred of it. Whatever
becomes of it, no step gives energy, and what contact takes is all that is gone; momentum is kept. A disc that spins, too. A rigid brick that tumbles, by more and more in a step."""

import numpy as np

import host
from cell import series

# Newton's method ends at 1e-11 of the forces, once a step; the energy of a body that a step stops is all of it.
ENERGY = 1e-8
CELL = 0.25
# A rule that keeps both exactly, whose equations Newton's method solves to 1e-11.
RIGID = 1e-9
STEPS = 60


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
        "base": {"nonmortar": "upper.ymin", "mortar": "lower.ymax", **interface},
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


def disc(spin, steps):
    """A disc of finite strain that spins and falls askew on a block: it slides on a rim of facets, which turn in every step."""
    body = {"type": "box", "poisson": 0.3, "density": 1.0, "material": "neo_hooke"}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["disc", "block"],
        "disc": {**body, "ball": [0, 0], "lower": [-0.5, -0.5], "upper": [0.5, 0.5], "cells": [6, 6], "young": 200.0,
                 "velocity": [0.5, -1], "spin": spin},
        "block": {**body, "lower": [-1.5, -1.25], "upper": [1.5, -0.505], "cells": [18, 4], "young": 400.0},
        "supports": ["ground"],
        "ground": {"surface": "block.ymin", "components": ["x", "y"]},
        "dynamics": {"rho_inf": 1},
        "surfaces": ["rim"],
        "rim": {"of": [f"disc.{axis}{end}" for axis in "xy" for end in ("min", "max")], "within": [-9, -9, 9, 9]},
        "interfaces": ["base"],
        "base": {"nonmortar": "block.ymax", "mortar": "rim", "friction": 0.1},
        "steps": {"count": steps, "end": 0.3},
        "output": {"vtu": "none", "csv": "none"},
    }


def spins(context, spin, steps=STEPS):
    whole = context.solve(disc(spin, steps))
    result = host.outcome(whole)
    if result.refusal is None:
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        energy = table["kinetic"][0]
        result.below("work of contact in a step", max(0.0, np.diff(table["contact_work"]).max() / energy), ENERGY, "never positive")
        result.below("given by contact", table["contact_gain"][-1] / energy, ENERGY, "nothing")
        result.true("it flies off", table["momentum_y"][-1] > 0, "contact did work")
    return result


def tumbles(context, turn):
    """A brick about its middle axis, `turn` radians in each of 20 steps."""
    spin = np.array([0.3, 4, 0.1])
    brick = {"type": "rigid", "from": "box", "lower": [-1, -0.5, -0.25], "upper": [1, 0.5, 0.25], "cells": [1, 1, 1], "reference": [0, 0, 0],
             "density": 3, "velocity": [1, 0, 0.5], "spin": spin.tolist()}
    whole = context.solve({"schema": 1, "bodies": ["brick"], "brick": brick, "dynamics": {"rho_inf": 1},
                           "steps": {"count": 20, "end": 20 * turn / 4}, "output": {"vtu": "none"}})
    result = host.outcome(whole)
    if result.refusal is None:
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        energy, angular = table["kinetic"], np.stack([table[f"angular_{axis}"] for axis in "xyz"], axis=1)
        inertia = np.array([1 + 0.25, 4 + 0.25, 4 + 1]) / 4
        result.below("energy at the start", abs(energy[0] / ((3 * 1.25 + inertia @ spin**2) / 2) - 1), RIGID, "of a brick")
        result.below("energy", np.abs(energy / energy[0] - 1).max(), RIGID, "kept at any step")
        result.below("moment of momentum", np.abs(angular - inertia * spin).max() / np.linalg.norm(inertia * spin), RIGID, "kept at any step")
    return result


def cells():
    yield from series("dynamics: stiffness over that of the other", (1e0, 1e2, 1e4, 1e6), lambda s: lambda c: kept(c, meeting(stiff=s)), quick=(1e4,))
    yield from series("dynamics: mass over that of the other", (1e0, 1e2, 1e4, 1e6), lambda s: lambda c: kept(c, meeting(heavy=s)))
    yield from series("dynamics: steps over h / c", (1e-1, 1e0, 1e1, 1e2), lambda s: lambda c: kept(c, meeting(step=s)), quick=(1e0,))
    yield from series("dynamics: with friction", (0.1, 0.3, 1.0), lambda s: lambda c: kept(c, meeting(friction=s)), quick=(0.3,))
    frozen = lambda **about: lambda c: kept(c, meeting(**about, weights="reference"))
    yield from series("dynamics, weights of the reference: stiffness", (1e0, 1e2, 1e4, 1e6), lambda s: frozen(stiff=s), quick=(1e4,))
    yield from series("dynamics, weights of the reference: steps over h / c", (1e-1, 1e0, 1e1, 1e2), lambda s: frozen(step=s))
    yield from series("dynamics, weights of the reference: friction", (0.1, 0.3, 1.0), lambda s: frozen(friction=s), quick=(0.3,))
    yield from series("dynamics: a disc that spins", (0.1, 1, 5, 12, 30), lambda s: lambda c: spins(c, s), quick=(12,))
    yield from series("dynamics: a disc that spins, steps a quarter as long", (5, 30), lambda s: lambda c: spins(c, s, 4 * STEPS))
    yield from series("dynamics: a brick tumbles, radians a step", (1e-3, 1e-2, 0.1, 0.5, 1.0, 2.0), lambda s: lambda c: tumbles(c, s), quick=(0.5,))
