"""Contact of quadratic cells: how smooth the pressure under a ball is."""

import numpy as np

from dual import about_profile
from scene import write
from second_order import SecondOrder

# Over the largest pressure, about a smooth profile within 0.75 of the contact radius.
SCATTER_BOUND, LARGEST_BOUND = 0.005, 0.01
# The standard basis oscillates: 4 to 7 % are measured. The check can fail.
STANDARD_SCATTER = 0.02
# A multiplier's place is a corner of the lattice, up to the digits of the table.
SAME_PLACE = 1e-6

# Facets a side of the ball, and of the block it is pressed on, over those of the ball: coarser and finer.
FACETS, OTHERS = (12, 16), (5 / 6, 4 / 3)
KINDS = ("tet10", "hex20", "hex27")
YOUNG, POISSON = 1000.0, 0.3
# A square pillar, 2 x 2 x 1, with a paraboloid below. The contact radius is 0.72: that is 4.3 of 12 facets a side, 5.7 of
# 16.
RADIUS, HALF, DEPTH = 20.0, 1.0, 0.018


def paraboloid(kind, facets):
    """The lower face is raised by r^2 / 2R, which fades with height."""

    def bend(p):
        x, y = HALF * (2 * p[0] - 1), HALF * (2 * p[1] - 1)
        return np.array([x, y, p[2] + (1 - p[2]) * (x * x + y * y) / (2 * RADIUS)])

    return SecondOrder(kind, (facets, facets, 4), bend)


def ball_scene(driver, kind, facets, others):
    file = paraboloid(kind, facets).write_41(driver.output / f"ball_{kind}_{facets}.msh")
    common = {"young": YOUNG, "poisson": POISSON, "small_strain": True}
    scene = {
        "schema": 1,
        "bodies": ["ball", "block"],
        "ball": {"type": "gmsh", "file": file.name, **common},
        "block": {"type": "box", "lower": [-1.1, -1.1, -1], "upper": [1.1, 1.1, 0], "cells": [others, others, 4],
                  "cell": kind, **common},
        "supports": ["ground", "press"],
        "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
        "press": {"surface": "ball.zmax", "components": ["x", "y", "z"], "value": [0, 0, -DEPTH]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "ball.zmin", "mortar": "block.zmax", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }
    return write(scene, driver.output / f"ball_{kind}_{facets}_{others}.yaml")


def at_corners(table, facets):
    """The rows of the facets' corners, which have the multipliers."""
    lattice = [(table[axis] / HALF + 1) * facets / 2 for axis in "XY"]
    return table[np.all([np.abs(place - np.round(place)) < SAME_PLACE for place in lattice], axis=0)]


def quadratic_contact(verdicts, driver):
    """Ball on block, multipliers at the facets' corners."""
    driver.output.mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        for facets in FACETS:
            for ratio in OTHERS:
                others = round(facets * ratio)
                rms, largest, count = ball(driver, kind, facets, others, "dual")
                label = f"ball of {kind}, {facets} facets on {others}, {count} nodes"
                verdicts.below(f"{label}: scatter of the pressure", rms, SCATTER_BOUND, "a smooth profile")
                verdicts.below(f"{label}: largest deviation", largest, LARGEST_BOUND, "a smooth profile")
        others = round(FACETS[0] * OTHERS[-1])
        rms = ball(driver, kind, FACETS[0], others, "standard")[0]
        label = f"ball of {kind}, {FACETS[0]} facets on {others}"
        verdicts.at_least(f"{label}: scatter with the standard basis", rms, STANDARD_SCATTER, "it oscillates")


def ball(driver, kind, facets, others, basis):
    path = ball_scene(driver, kind, facets, others)
    run = driver.run(path, "-contact_basis", basis, label=f"{path.stem}_{basis}")
    return about_profile(at_corners(run.interface("contact"), facets))
