"""Plane and axisymmetric models over analytic straight lines and circles: against meshed floors, one layer over a plane or a
cylinder in space, Hertz, Lame."""

import numpy as np

import formulas
from plane import POISSON, SAME_BOUND, YOUNG, other_iterations
from scene import write

# A floor of lines and a straight line are one surface: the linear solver's rounding is left.
FLOOR_BOUND = 1e-10
# A ring of 24 linear cells along the radius on a rigid shaft.
RING_BOUND = 1e-3
# Hertz' largest pressure, 12 facets over the contact's radius of a tenth of the ball's, and its force at that depth.
BALL_BOUND = 0.015
# Of the contact radius: where the border, which lies inside a facet, disturbs the pressure little.
WITHIN = 0.75


def plane_analytic(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    floors(verdicts, driver)
    circles(verdicts, driver)
    ring_on_shaft(verdicts, driver)
    ball_on_line(verdicts, driver)


def floors(verdicts, driver):
    """The block of plane_block.yaml on its meshed floor and on a straight line; two ranks, too."""
    common = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["block", "floor"],
        "supports": ["rigid"],
        "rigid": {"body": "floor", "components": ["x", "y"]},
        "loads": ["press", "push"],
        "press": {"surface": "block.ymax", "traction": [0, -200], "curve": [0, 0, 1, 1]},
        "push": {"surface": "block.xmin", "traction": [60, 0], "curve": [1, 0, 2, 1]},
        "interfaces": ["base"],
        "base": {"nonmortar": "block.ymin", "mortar": "floor.surface", "friction": 0.2, "weights": "reference"},
        "steps": {"end": 2, "count": 4},
        "output": {"vtu": "last", "csv": "last"},
    }
    box = {"type": "box", "young": YOUNG, "poisson": POISSON}
    meshed = {**common, "floor": {**box, "lower": [-0.5, -1], "upper": [4.5, 0], "cells": [13, 1]}}
    meshed["base"] = {**common["base"], "mortar": "floor.ymax"}
    line = {**common, "floor": {"type": "analytic", "shape": "line", "point": [1, 0], "direction": [0, 2]}}
    for cell in ("quad", "quad8"):
        runs = []
        for name, scene in (("meshed", meshed), ("line", line)):
            block = {**box, "lower": [0, 0], "upper": [4, 2], "cells": [10, 5], "small_strain": True, "cell": cell}
            path = write({**scene, "block": block}, driver.output / f"floor_{name}_{cell}.yaml")
            runs.append(driver.run(path))
            if name == "line":
                runs.append(driver.run(path, ranks=2, label=f"floor_line_{cell}_ranks"))
        tables = [run.interface("base") for run in runs]
        scale = np.abs(tables[0]["fy"]).max()
        for other, what in ((1, "meshed floor"), (2, "meshed floor, two ranks")):
            error = max(np.abs(tables[0][f] - tables[other][f]).max() for f in ("fx", "fy")) / scale
            verdicts.below(f"block on a line, {cell}: nodal forces", error, FLOOR_BOUND, what)
            different = other_iterations(runs[0], runs[other])
            verdicts.below(f"block on a line, {cell}: steps with other iterations", different, 0, what)


def punch_scene(driver, solid, radius, basis):
    """A block pressed onto a bar, or into a bore, and drawn along: in the plane, or as a layer of thickness 0.4."""
    lift = lambda v: [v[0], 0.0, v[1]] if solid else v
    up, top, bottom = ("z", "zmax", "zmin") if solid else ("y", "ymax", "ymin")
    block = {"type": "box", "young": YOUNG, "poisson": POISSON, "material": "neo_hooke"}
    block |= {"lower": lift([-0.9, 0.0]), "upper": [0.9, 0.4, 1.0] if solid else [0.9, 1.0]}
    block["cells"] = [9, 1, 4] if solid else [9, 4]
    tool = {"type": "analytic", "shape": "cylinder" if solid else "circle", "radius": radius, "point": lift([0.1, -radius])}
    if radius < 0:  # the block's corners go in first
        tool["point"] = lift([0.1, -radius - 0.1])
    if solid:
        tool["direction"] = [0, 1, 0]
    scene = {
        "schema": 1,
        "bodies": ["block", "tool"],
        "block": block,
        "tool": tool,
        "supports": ["still", "press", "slide"],
        "still": {"body": "tool", "components": ["x", "y", "z"] if solid else ["x", "y"]},
        "press": {"surface": f"block.{top}", "components": [up], "value": lift([0, -0.08]), "curve": [0, 0, 1, 1]},
        "slide": {"surface": f"block.{top}", "components": ["x"], "value": lift([0.3, 0.0]), "curve": [1, 0, 2, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": f"block.{bottom}", "mortar": "tool.surface", "friction": 0.3, "basis": basis},
        "steps": {"end": 2, "count": 8},
        "output": {"vtu": "last", "csv": "last"},
    }
    if solid:
        scene["supports"] += ["slice"]
        scene["slice"] = {"body": "block", "components": ["y"]}
    else:
        scene["model"] = "plane_strain"
    return write(scene, driver.output / f"punch_{'solid' if solid else 'plane'}_{basis}_{'bar' if radius > 0 else 'bore'}.yaml")


def circles(verdicts, driver):
    for basis, radius in (("standard", 1.5), ("dual", 1.5), ("dual", -6.0)):
        flat, solid = (driver.run(punch_scene(driver, dimension, radius, basis)) for dimension in (False, True))
        label = f"block {'on a bar' if radius > 0 else 'in a bore'}, {basis}"
        table, layer = flat.interface("contact"), solid.interface("contact")
        scale = np.abs(layer["fz"]).max()
        for here, there in (("fx", "fx"), ("fy", "fz")):
            of_layer = np.array([layer[there][np.abs(layer["X"] - x) < 1e-9].sum() for x in table["X"]])
            error = np.abs(0.4 * table[here] - of_layer).max() / scale
            verdicts.below(f"{label}: nodal {here}", error, SAME_BOUND, "one layer over a cylinder")
        different = other_iterations(flat, solid)
        verdicts.below(f"{label}: steps with other iterations", different, 0, "one layer over a cylinder")


def ring_on_shaft(verdicts, driver):
    """A ring from r = 5 to 10 on a rigid shaft of radius 5.02, a straight line along the axis: Lame, free along the axis. Poisson's
    ratio is zero, so that the ring's own length does not matter."""
    scene = {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["ring", "shaft"],
        "ring": {"type": "box", "lower": [5, 0], "upper": [10, 1], "cells": [24, 2], "young": YOUNG, "poisson": 0.0,
                 "small_strain": True},
        "shaft": {"type": "analytic", "shape": "line", "point": [5.02, 0], "direction": [1, 0]},
        "supports": ["still", "level"],
        "still": {"body": "shaft", "components": ["x", "y"]},
        "level": {"surface": "ring.ymin", "components": ["y"]},
        "interfaces": ["fit"],
        "fit": {"nonmortar": "ring.xmin", "mortar": "shaft.surface", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "none", "csv": "last"},
    }
    run = driver.run(write(scene, driver.output / "ring_on_shaft.yaml"))
    pressure = -run.interface("fit")["lambda_n"].mean()
    # u = A r + B / r with u(5) = 0.02 and no stress at r = 10; Poisson's ratio zero.
    slope = 0.02 / (5 + 100 / 5)
    verdicts.near("ring on a rigid shaft: pressure", pressure, -YOUNG * (slope - 100 * slope / 25), RING_BOUND, "Lame")


def ball_on_line(verdicts, driver):
    """A ball of rings on a straight line across the axis: Hertz."""
    radius = [*np.linspace(0, 0.125, 16), 0.15, 0.19, 0.26, 0.38, 0.58, 0.8, 1]
    up = [-1, -0.992, -0.984, -0.975, -0.963, -0.945, -0.92, -0.88, -0.82, -0.72, -0.55, -0.3, 0]
    scene = {
        "schema": 1,
        "model": "axisymmetric",
        "bodies": ["ball", "ground"],
        "ball": {"type": "box", "ball": [0, 0], "x": radius, "y": up, "young": YOUNG, "poisson": POISSON, "small_strain": True},
        "ground": {"type": "analytic", "shape": "line", "point": [0, -1], "direction": [0, 1]},
        "supports": ["still", "press"],
        "still": {"body": "ground", "components": ["x", "y"]},
        "press": {"surface": "ball.ymax", "components": ["y"], "value": [0, -0.0105]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "ball.ymin", "mortar": "ground.surface", "basis": "dual", "weights": "reference"},
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "last"},
    }
    run = driver.run(write(scene, driver.output / "ball_on_line.yaml"))
    table = run.interface("contact")
    hertz = formulas.PointContact(abs(run.resultant("contact")[1]), formulas.plane_modulus(YOUNG, POISSON), 1.0)
    r, p = table["X"], -table["lambda_n"]
    inside = r < WITHIN * r[p > 0].max()
    _, square = np.polyfit(r[inside] ** 2, p[inside] ** 2, 1)
    verdicts.near("ball of rings on a line: largest pressure", np.sqrt(square), hertz.peak, BALL_BOUND, "Hertz")
