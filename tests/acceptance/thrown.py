"""Checks of bodies that contact alone holds and that nothing loads: Newton's method may not throw them out to a place where nothing
presses on them, which is an equilibrium, too (solve/thrown.c)."""

import numpy as np

from scene import write

# A sled of which all nodes slip: tangential forces over normal ones. Some nodes slip aside, too: 3e-4.
SLED_FRICTION, ALONG_CONE = 0.1, 1e-3
# Its force after three steps and after six, which the paths of slip tell apart.
SAME_PATH = 1e-3
# Orders of the matrix, by -mat_mumps_icntl_7: rounding decides what Newton's method makes of a singular one.
ORDERS = (0, 5)
# Degrees; 5.7 times as far as the blocks close: beyond the lever that is allowed where the scene says nothing.
WEDGE, CLOSES, LEVER = 10, 0.01, "6"
# What it has gone, over CLOSES / tan WEDGE: the corners of its facets touch first.
GONE = 1e-2


def sled(steps):
    """A block pressed onto a plate that lies on a floor, and drawn along it by more than two of its facets a step: the plate,
    which nothing but contact holds, is in equilibrium anywhere where it is not pressed."""
    box = {"type": "box", "young": 1000, "poisson": 0.3}
    return {
        "schema": 1,
        "bodies": ["block", "plate", "floor"],
        "block": box | {"lower": [0, 0, 1], "upper": [1, 1, 1.5], "cells": [3, 3, 1]},
        "plate": box | {"lower": [-0.1, -0.1, 0.5], "upper": [1.2, 1.1, 1], "cells": [5, 4, 1]},
        "floor": box | {"lower": [-0.5, -0.5, 0], "upper": [5, 1.5, 0.5], "cells": [15, 5, 1]},
        "supports": ["ground", "grip"],
        "ground": {"surface": "floor.zmin", "components": ["x", "y", "z"]},
        "grip": {"surface": "block.zmax", "components": ["x", "y", "z"], "value": [2.5, 0.02, -0.01]},
        "interfaces": ["top", "low"],
        "top": {"nonmortar": "block.zmin", "mortar": "plate.zmax", "friction": 0.6},
        "low": {"nonmortar": "plate.zmin", "mortar": "floor.zmax", "friction": SLED_FRICTION},
        "steps": {"count": steps},
        "output": {"vtu": "none", "csv": "last"},
    }


def run(driver, scene, label, *options, **more):
    return driver.run(write(scene, driver.output / "scenes" / f"{label}.yaml"), *options, label=label, **more)


def guided():
    """A block that its support draws along a floor, which nothing presses on it: it moves, and all else rests."""
    box = {"type": "box", "young": 1000, "poisson": 0.3}
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "floor"],
        "block": box | {"lower": [0, 0], "upper": [1, 0.5], "cells": [4, 2]},
        "floor": box | {"lower": [-1, -0.5], "upper": [4, 0], "cells": [11, 2]},
        "supports": ["ground", "grip"],
        "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
        "grip": {"surface": "block.xmin", "components": ["x"], "value": [0.3, 0]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "block.ymin", "mortar": "floor.ymax"},
        "steps": {"count": 3},
    }


def wedge():
    """A wedge of WEDGE degrees from its axis between two blocks that close, without friction: it goes out."""
    box = {"type": "box", "young": 1000, "poisson": 0.3}
    slope, length = np.tan(np.radians(WEDGE)), 2.5
    rise = slope * length
    return {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["wedge", "upper", "lower"],
        "wedge": box | {"corners": [0, -0.3, 1, -0.3 - slope, 1, 0.3 + slope, 0, 0.3], "cells": [4, 2]},
        "upper": box | {"corners": [-0.5, 0.3 - 0.5 * slope, 2, 0.3 - 0.5 * slope + rise, 2, 2, -0.5, 2], "cells": [5, 2]},
        "lower": box | {"corners": [-0.5, -2, 2, -2, 2, -0.3 + 0.5 * slope - rise, -0.5, -0.3 + 0.5 * slope], "cells": [5, 2]},
        "supports": ["down", "up"],
        "down": {"body": "upper", "components": ["x", "y"], "value": [0, -CLOSES]},
        "up": {"body": "lower", "components": ["x", "y"], "value": [0, CLOSES]},
        "interfaces": ["a", "b"],
        "a": {"nonmortar": "wedge.ymax", "mortar": "upper.ymin"},
        "b": {"nonmortar": "wedge.ymin", "mortar": "lower.ymax"},
        "probes": ["tip"],
        "tip": {"body": "wedge", "point": [0, 0]},
        "steps": {"count": 3},
    }


def thrown(verdicts, driver):
    """The plate goes with the block, in whatever order the matrix is factorised; it is not thrown out to where nothing touches it."""
    reference = run(driver, sled(6), "sled_6").steps[-1]["reactions"]["grip"]
    for order in ORDERS:
        result = run(driver, sled(3), f"sled_{order}", "-mat_mumps_icntl_7", str(order))
        grip = result.steps[-1]["reactions"]["grip"]
        verdicts.near(f"sled, order {order}: force", grip[2], reference[2], SAME_PATH, "in twice as many steps")
        drag = np.hypot(*grip[:2]) / abs(grip[2])
        verdicts.near(f"sled, order {order}: drag over force", drag, SLED_FRICTION, ALONG_CONE, "nearly all slip is along")
    result = run(driver, wedge(), "wedge", expect=2)
    verdicts.true("slim wedge: refused, with its remedy", "`steps: {lever}`" in result.text, "no shorter step would help it")
    result = run(driver, wedge(), "wedge_lever", "-steps_lever", LEVER)
    gone = result.steps[-1]["probes"]["tip"][0] * np.tan(np.radians(WEDGE)) / CLOSES
    verdicts.near("slim wedge, with a lever: goes out by", gone, 1, GONE, "what its slope says")
    result = run(driver, guided(), "guided")
    verdicts.true("moved by its support: not thrown", not result.summary["failed_attempts"], "its steps converge at once")
