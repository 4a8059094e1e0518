"""Gravity, centrifugal forces, pressures that follow their surface, moments of reactions, stresses at nodes."""

import numpy as np

from jacobian import whole_matrix
from scene import write

# Rounding of some hundred unknowns, and Newton's tolerance of 1e-11.
EXACT_BOUND = 1e-10
# Sums of forces: what Newton's tolerance leaves.
STATICS_BOUND = 1e-9
# A disc of 40 quad8 around; 1.4e-5 is measured.
DISC_BOUND = 1e-3
# The .vtu has six digits of a stress; half of the last.
STRESS_DIGITS = 1e-5
YOUNG, POISSON, DENSITY, GRAVITY = 1000.0, 0.3, 2.0, 9.81


def loads(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    column(verdicts, driver)
    disc(verdicts, driver)
    compressed(verdicts, driver)
    cantilever(verdicts, driver)
    groove(verdicts, driver)


def column(verdicts, driver):
    """Under its own weight, without Poisson's effect: linear cells have the exact displacements at their nodes."""
    height = 3.0
    for cell in ("hex", "tet10", "hex20"):
        scene = {
            "schema": 1,
            "bodies": ["column"],
            "column": {"type": "box", "cell": cell, "lower": [0, 0, 0], "upper": [1, 1, height], "cells": [2, 2, 5],
                       "young": YOUNG, "poisson": 0, "density": DENSITY, "small_strain": True},
            "supports": ["ground"],
            "ground": {"surface": "column.zmin", "components": ["x", "y", "z"]},
            "loads": ["weight"],
            "weight": {"body": "column", "gravity": [0, 0, -GRAVITY]},
            "steps": {"count": 1},
        }
        run = driver.run(write(scene, driver.output / f"column_{cell}.yaml"))
        points, _, u = run.mesh()
        z = points[:, 2]
        exact = DENSITY * GRAVITY / YOUNG * (z**2 / 2 - height * z)
        error = np.abs(u[:, 2] - exact).max() / np.abs(exact).max()
        verdicts.below(f"column of {cell}: displacements", error, EXACT_BOUND, "closed form")
        weight = run.steps[-1]["reactions"]["ground"][2]
        verdicts.near(f"column of {cell}: reaction", weight, DENSITY * GRAVITY * height, STATICS_BOUND, "its weight")


def disc(verdicts, driver):
    """A disc with a bore in plane stress that turns about its middle."""
    bore, outer, speed = 1.0, 3.0, 2.0
    scene = {
        "schema": 1,
        "model": "plane_stress",
        "bodies": ["disc"],
        "disc": {"type": "box", "cell": "quad8", "polar": True, "lower": [bore, 0], "upper": [outer, 90], "cells": [8, 10],
                 "young": YOUNG, "poisson": POISSON, "density": DENSITY, "small_strain": True},
        "supports": ["left", "below"],
        "left": {"surface": "disc.ymax", "components": ["x"]},
        "below": {"surface": "disc.ymin", "components": ["y"]},
        "loads": ["turn"],
        "turn": {"body": "disc", "centrifugal": speed},
        "steps": {"count": 1},
        "probes": ["rim"],
        "rim": {"body": "disc", "point": [outer, 0]},
    }
    run = driver.run(write(scene, driver.output / "turning_disc.yaml"))
    exact = DENSITY * speed**2 * outer / (4 * YOUNG) * ((1 - POISSON) * outer**2 + (3 + POISSON) * bore**2)
    verdicts.near("turning disc: its rim moves out", run.steps[-1]["probes"]["rim"][0], exact, DISC_BOUND, "closed form")


def compressed(verdicts, driver):
    """A cube under a pressure on its surface of now: the same stretch s everywhere, with Cauchy's stress -p."""
    pressure = 400.0
    shear, lame = YOUNG / (2 + 2 * POISSON), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    low, high = 0.1, 1.0
    for _ in range(100):  # bisection: the stress grows with the stretch
        s = (low + high) / 2
        low, high = (s, high) if (shear * (s**2 - 1) + 3 * lame * np.log(s)) / s**3 < -pressure else (low, s)
    for cell in ("hex", "tet10"):
        scene = {
            "schema": 1,
            "bodies": ["cube"],
            "cube": {"type": "box", "cell": cell, "x": [0, 0.3, 1], "y": [0, 0.6, 1], "z": [0, 0.45, 1], "young": YOUNG,
                     "poisson": POISSON, "material": "neo_hooke"},
            "supports": ["x", "y", "z"],
            **{axis: {"surface": f"cube.{axis}min", "components": [axis]} for axis in "xyz"},
            "loads": ["press"],
            "press": {"surface": [f"cube.{axis}max" for axis in "xyz"], "pressure": pressure, "follower": True},
            "steps": {"count": 4},
        }
        run = driver.run(write(scene, driver.output / f"compressed_{cell}.yaml"), "-snes_test_jacobian")
        points, _, u = run.mesh()
        verdicts.below(f"compressed cube of {cell}: displacements", np.abs(u - (s - 1) * points).max(), EXACT_BOUND, "closed form")
        stress = run.point_field("stress_xx_yy_zz_xy_yz_xz")
        error = np.abs(stress + pressure * np.array([1, 1, 1, 0, 0, 0])).max() / pressure
        verdicts.below(f"compressed cube of {cell}: stress at nodes", error, STRESS_DIGITS, "closed form")
        whole_matrix(verdicts, f"compressed cube of {cell}", run)


def cantilever(verdicts, driver):
    """The moment at its foot is that of the load in the deformed state."""
    scene = {
        "schema": 1,
        "bodies": ["beam"],
        "beam": {"type": "box", "lower": [0, 0, 0], "upper": [5, 1, 1], "cells": [10, 2, 2], "young": YOUNG, "poisson": POISSON,
                 "material": "neo_hooke"},
        "supports": ["foot"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"], "origin": [0, 0.5, 0.5]},
        "loads": ["tip"],
        "tip": {"surface": "beam.xmax", "traction": [0, 0, -3]},
        "steps": {"count": 2},
    }
    run = driver.run(write(scene, driver.output / "cantilever.yaml"))
    points, _, u = run.mesh()
    tip = points[:, 0] == 5
    y, z = (np.round(2 * points[tip, k]).astype(int) for k in (1, 2))
    share = np.where(y == 1, 2, 1) * np.where(z == 1, 2, 1) / 16  # of a node in the uniform traction
    arm = (points + u)[tip] - [0, 0.5, 0.5]
    moment = np.cross(arm, share[:, None] * [0, 0, -3.0]).sum(axis=0)
    found = np.array(run.steps[-1]["moments"]["foot"])
    error = np.abs(found + moment).max() / np.abs(moment).max()
    verdicts.below("cantilever: moment of the reactions and of the load", error, STATICS_BOUND, "they balance")


def groove(verdicts, driver):
    """A wedge falls through a gap into a groove of two rigid walls, at 45 and at 30 degrees, without friction: statics has
    the forces."""
    steep, flat = np.radians(45), np.radians(30)
    along = {"left": np.array([-np.cos(steep), np.sin(steep)]), "right": np.array([np.cos(flat), np.sin(flat)])}
    normal = {"left": np.array([np.sin(steep), np.cos(steep)]), "right": np.array([-np.sin(flat), np.cos(flat)])}
    numbers = lambda corners: [float(c) for point in corners for c in point]
    common = {"type": "box", "young": YOUNG, "poisson": POISSON}
    walls = {}
    for side in along:  # counterclockwise, with the wall above
        inner, outer = np.zeros(2), 2 * along[side]
        top = [inner, outer] if side == "left" else [outer, inner]
        walls[side] = {**common, "corners": numbers([p - 0.5 * normal[side] for p in top[::-1]] + top), "cells": [13, 1]}
    tip = np.array([0.0, 0.02])
    wedge = [tip, tip + 1.3 * along["right"], tip + 1.3 * along["right"] + 1.1 * along["left"], tip + 1.1 * along["left"]]
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["wedge", "left", "right"],
        "wedge": {**common, "corners": numbers(wedge), "cells": [7, 6], "density": DENSITY, "material": "neo_hooke"},
        **walls,
        "supports": ["still"],
        "still": {"body": ["left", "right"], "components": ["x", "y"]},
        "loads": ["weight"],
        "weight": {"body": "wedge", "gravity": [0, -GRAVITY]},
        "interfaces": ["one", "two"],
        "one": {"nonmortar": "wedge.xmin", "mortar": "left.ymax"},
        "two": {"nonmortar": "wedge.ymin", "mortar": "right.ymax"},
        "steps": {"count": 1},
    }
    run = driver.run(write(scene, driver.output / "groove.yaml"))
    weight = np.array([0, -DENSITY * GRAVITY * np.cross(wedge[1] - wedge[0], wedge[3] - wedge[0])])
    one, two = np.linalg.solve(np.array([normal["left"], normal["right"]]).T, -weight)
    for name, size, side in (("one", one, "left"), ("two", two, "right")):
        force = run.resultant(name)[:2]
        error = np.abs(force - size * normal[side]).max() / np.linalg.norm(weight)
        verdicts.below(f"wedge in a groove: force of the {side} wall", error, STATICS_BOUND, "statics")
