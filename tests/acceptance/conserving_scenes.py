"""Scenes of contact that conserves: what slides, swings in a bowl, meets freely, rolls, is braked, spun up and hops, each in the plane or in space."""

import math

GRAVITY = 9.81
NONE = {"vtu": "none", "csv": "none"}
ELASTIC = {"type": "box", "poisson": 0.3}
QUADRATIC = ("quad8", "quad9", "hex20", "hex27")


ENDS = {2: ("ymin", "ymax"), 3: ("zmin", "zmax")}


def space(d, x, y, z):
    """Of x, y, z, with z upwards, what a plane has."""
    return [x, y, z] if d == 3 else [x, z]


def scene(d, **more):
    return {"schema": 1, "model": "plane_strain" if d == 2 else "solid", "dynamics": {"rho_inf": 1}, "output": NONE, **more}


# --- slides -------------------------------------------------------------------------------------------------------------
def slide(facets, d=2, cell=None, steps=None, **interface):
    """A block slides over so many facets of an elastic floor, 0.2 of one a step. It rests 0.001 deep."""
    box = {**ELASTIC, "young": 1e4, "small_strain": True, "cell": cell or ("quad" if d == 2 else "hex")}
    length, (low, high) = 0.1 * facets + 0.8, ENDS[d]
    return scene(
        d,
        bodies=["block", "floor"],
        block={**box, "lower": space(d, 0, 0, 0), "upper": space(d, 0.4, 0.2, 0.2), "cells": space(d, 4, 1, 2), "density": 20, "velocity": space(d, 2, 0, 0)},
        floor={**box, "lower": space(d, -0.4, -0.15, -0.4), "upper": space(d, length - 0.4, 0.35, 0), "cells": space(d, round(length / 0.1), 3, 4), "density": 2},
        supports=["ground"],
        ground={"surface": f"floor.{low}", "components": ["x", "y", "z"][:d]},
        loads=["weight"],
        weight={"body": "block", "gravity": space(d, 0, 0, -10), "curve": [0, 1, 9, 1]},
        interfaces=["c"],
        c={"nonmortar": f"block.{low}", "mortar": f"floor.{high}", **interface},
        probes=["corner"],
        corner={"body": "block", "point": space(d, 0, 0, 0.2)},
        steps={"count": steps or 5 * facets, "end": 0.05 * facets},
    )


# --- a bowl -------------------------------------------------------------------------------------------------------------
SWING = 60


def bowl(n, d=2, cell=None, steps=900, end=9.0, **interface):
    """A block of n x n cells slides in a round bowl without friction, let go at SWING degrees from the lowest place."""
    cell = cell or ("quad" if d == 2 else "hex")
    middle = math.radians(SWING - 90)
    return scene(
        d,
        bodies=["puck", "ring"],
        puck={**ELASTIC, "polar": True, "lower": [0.8, SWING - 100, 0][:d], "upper": [1, SWING - 80, 0.1][:d], "cells": [n, n, 1][:d], "cell": cell, "young": 1e4, "density": 100,
              "material": "neo_hooke"},
        ring={"type": "analytic", "shape": "circle", "point": [0, 0], "radius": -1} if d == 2 else
             {"type": "analytic", "shape": "cylinder", "point": [0, 0, 0], "direction": [0, 0, 1], "radius": -1},
        loads=["weight"],
        weight={"body": "puck", "gravity": [0, -GRAVITY, 0][:d], "curve": [0, 1, 99, 1]},
        supports=["base"] + ([] if d == 2 else ["flat"]),
        base={"body": "ring", "components": ["x", "y", "z"][:d]},
        **({} if d == 2 else {"flat": {"surface": ["puck.zmin", "puck.zmax"], "components": ["z"]}}),
        interfaces=["c"],
        c={"nonmortar": "puck.xmax", "mortar": "ring.surface", **interface},
        probes=["middle"],
        middle={"body": "puck", "point": [0.9 * math.cos(middle), 0.9 * math.sin(middle), 0][:d]},
        steps={"count": steps, "end": end},
    )


# --- two free blocks ------------------------------------------------------------------------------------------------------
def free_blocks(d=2, cell=None, steps=60, **interface):
    """Two blocks of finite strain that spin and meet off centre, with meshes that do not match; nothing else acts."""
    cell = cell or ("quad" if d == 2 else "hex")
    box = {**ELASTIC, "young": 1000, "density": 1, "material": "neo_hooke", "cell": cell}
    n = 2 if cell in QUADRATIC else 4
    return scene(
        d,
        bodies=["upper", "lower"],
        upper={**box, "lower": [0.35, 0.25, 0.01][3 - d:], "upper": [1.15, 1.05, 0.81][3 - d:], "cells": [n - 1] * d,
               "velocity": [0.4, 0.2, -2][3 - d:], "spin": [0.4, 0.3, 1] if d == 3 else 1, "about": [0.75, 0.65, 0.41][3 - d:]},
        lower={**box, "lower": [0, 0, -0.8][3 - d:], "upper": [1, 1, 0][3 - d:], "cells": [n] * d},
        interfaces=["c"],
        c={"nonmortar": f"upper.{'xyz'[d - 1]}min", "mortar": f"lower.{'xyz'[d - 1]}max", **interface},
        steps={"count": steps, "end": 0.12},
    )


# --- rolls ----------------------------------------------------------------------------------------------------------------
SLOPE = math.radians(20)


# The weight of the wheel, which comes on smoothly.
RAMP = [value for k in range(17) for value in (0.2 * k / 16, math.sin(math.pi * k / 32) ** 2)] + [9, 1]


def wheel(n, steps=500, end=1.0, young=2e3, radius=0.5):
    """A wheel of n x n cells, 4 n facets round it, rolls down SLOPE on an elastic floor, gravity turned instead of it."""
    low, high = -0.4, 1.6
    facet = math.pi * radius / (2 * n)
    return scene(
        2,
        bodies=["wheel", "floor"],
        wheel={**ELASTIC, "ball": [0, radius], "lower": [-radius, 0], "upper": [radius, 2 * radius], "cells": [n, n], "young": young, "density": 1, "material": "neo_hooke"},
        floor={**ELASTIC, "lower": [low, -0.2], "upper": [high, 0], "cells": [round((high - low) / facet), 3], "young": young, "density": 1, "small_strain": True},
        supports=["ground"],
        ground={"surface": "floor.ymin", "components": ["x", "y"]},
        loads=["weight"],
        weight={"body": "wheel", "gravity": [GRAVITY * math.sin(SLOPE), -GRAVITY * math.cos(SLOPE)], "curve": RAMP},
        surfaces=["rim"],
        rim={"of": [f"wheel.{axis}{end_}" for axis in "xy" for end_ in ("min", "max")], "within": [-9, -9, 9, 9]},
        interfaces=["c"],
        c={"nonmortar": "rim", "mortar": "floor.ymax", "friction": 0.8},
        probes=["centre"],
        centre={"body": "wheel", "point": [0, radius]},
        steps={"count": steps, "end": end},
    )


# --- is braked, spins up --------------------------------------------------------------------------------------------------
BRAKE = {"friction": 0.3, "press": 10.0, "inertia": 0.6, "spin": 5.0}


def brake(steps=300, end=1.5, n=24):
    """A wheel of 4 n rigid facets that spins about a fixed axle, and a pad that its load presses on the rim."""
    pad = {**ELASTIC, "lower": [-0.1, 1], "upper": [0.1, 1.02], "cells": [12, 2], "young": 2e3, "density": 1, "small_strain": True}
    return scene(
        2,
        bodies=["wheel", "pad"],
        wheel={"type": "rigid", "from": "box", "ball": [0, 0], "lower": [-1, -1], "upper": [1, 1], "cells": [n, n], "reference": [0, 0], "mass": 1, "inertia": BRAKE["inertia"],
               "spin": -BRAKE["spin"], "about": [0, 0]},
        pad=pad,
        dynamics={"rho_inf": 1, "stiffness_damping": 1e-3},
        supports=["axle", "guide"],
        axle={"body": "wheel", "components": ["x", "y"]},
        guide={"surface": "pad.ymax", "components": ["x"]},
        loads=["press"],
        press={"surface": "pad.ymax", "traction": [0, -BRAKE["press"] / 0.2], "curve": [0, 0, 0.1, 1, 9, 1]},
        surfaces=["rim"],
        rim={"of": [f"wheel.{axis}{end_}" for axis in "xy" for end_ in ("min", "max")], "within": [-9, -9, 9, 9]},
        interfaces=["c"],
        c={"nonmortar": "pad.ymin", "mortar": "rim", "friction": BRAKE["friction"]},
        steps={"count": steps, "end": end},
    )


def disc_brake(steps=60, end=1.5):
    """A ring that is pressed on the flat face of a rigid disc that spins: their facets pass over each other."""
    return scene(
        3,
        bodies=["disc", "pad"],
        disc={"type": "rigid", "from": "box", "polar": True, "lower": [0.4, 0, -0.2], "upper": [1.2, 360, 0], "cells": [3, 20, 1], "reference": [0, 0, -0.1], "mass": 1,
              "inertia": [BRAKE["inertia"]] * 3, "spin": [0, 0, BRAKE["spin"]], "about": [0, 0, 0]},
        pad={**ELASTIC, "polar": True, "lower": [0.6, 0, 0], "upper": [1, 360, 0.1], "cells": [2, 24, 1], "young": 2e4, "poisson": 0, "density": 1, "small_strain": True},
        dynamics={"rho_inf": 1, "stiffness_damping": 1e-3},
        supports=["axle", "guide"],
        axle={"body": "disc", "components": ["x", "y", "z", "rx", "ry"]},
        guide={"surface": "pad.zmax", "components": ["x", "y"]},
        loads=["press"],
        press={"surface": "pad.zmax", "traction": [0, 0, -BRAKE["press"] / (math.pi * 0.64)], "curve": [0, 0, 0.1, 1, 9, 1]},
        interfaces=["c"],
        c={"nonmortar": "pad.zmin", "mortar": "disc.zmax", "friction": BRAKE["friction"]},
        steps={"count": steps, "end": end},
    )


CAPSTAN = {"friction": 0.3, "tension": 1.0, "moment": 3.0, "inertia": 0.7, "spin": 1.0}


def capstan(steps=300, end=1.5, cells=45, facets=180):
    """A thin belt half around a rigid drum that a moment spins up below it: drawn by CAPSTAN's tension at one end, held at the other."""
    thin = 0.005
    return scene(
        2,
        bodies=["belt", "drum"],
        belt={**ELASTIC, "polar": True, "lower": [1.0001, 0], "upper": [1.0001 + thin, 180], "cells": [1, cells], "young": 3e4, "poisson": 0, "density": 1, "material": "neo_hooke"},
        drum={"type": "rigid", "from": "box", "polar": True, "lower": [0.9, 0], "upper": [1, 360], "cells": [1, facets], "reference": [0, 0], "mass": 1, "inertia": CAPSTAN["inertia"],
              "spin": CAPSTAN["spin"], "about": [0, 0]},
        dynamics={"rho_inf": 1, "stiffness_damping": 1e-3},
        supports=["axle", "hold"],
        axle={"body": "drum", "components": ["x", "y"]},
        hold={"surface": "belt.ymin", "components": ["y"]},
        loads=["draw", "drive"],
        draw={"surface": "belt.ymax", "traction": [0, -CAPSTAN["tension"] / thin], "curve": [0, 0, 0.2, 1, 9, 1]},
        drive={"body": "drum", "moment": CAPSTAN["moment"], "curve": [0, 0, 0.2, 1, 9, 1]},
        interfaces=["c"],
        c={"nonmortar": "belt.xmin", "mortar": "drum.xmax", "friction": CAPSTAN["friction"]},
        steps={"count": steps, "end": end},
    )


# --- hops ---------------------------------------------------------------------------------------------------------------
def hops(n, spread, steps, end):
    """A quarter of a ball, n cells from its centre to its surface, is let go above a plane."""
    return scene(
        3,
        bodies=["ball", "floor"],
        ball={**ELASTIC, "ball": [0, 0, 0], "lower": [0, 0, -1], "upper": [1, 1, 1], "cells": [n, n, 2 * n], "young": 2e4, "density": 1, "small_strain": True},
        floor={"type": "analytic", "shape": "plane", "point": [0, 0, -1.01], "direction": [0, 0, 1]},
        dynamics={"rho_inf": 1, "contact_mass": "spread" if spread else "consistent"},
        supports=["sx", "sy", "still"],
        sx={"surface": "ball.xmin", "components": ["x"]},
        sy={"surface": "ball.ymin", "components": ["y"]},
        still={"body": "floor", "components": ["x", "y", "z"]},
        loads=["weight"],
        weight={"body": "ball", "gravity": [0, 0, -GRAVITY], "curve": [0, 1, 99, 1]},
        interfaces=["c"],
        c={"nonmortar": "ball.zmin", "mortar": "floor.surface"},
        steps={"count": steps, "end": end},
    )


def fall(gap, count, end, along=0):
    """A block is let go so far above an elastic floor."""
    box = {**ELASTIC, "young": 1e4, "small_strain": True, "density": 20}
    return scene(
        2,
        bodies=["block", "floor"],
        block={**box, "lower": [0, gap], "upper": [0.4, 0.2 + gap], "cells": [4, 2]},
        floor={**box, "lower": [-0.4, -0.4], "upper": [0.8, 0], "cells": [12, 4]},
        supports=["ground"],
        ground={"surface": "floor.ymin", "components": ["x", "y"]},
        loads=["weight"],
        weight={"body": "block", "gravity": [along, -10], "curve": [0, 1, 9, 1]},
        interfaces=["c"],
        c={"nonmortar": "block.ymin", "mortar": "floor.ymax"},
        steps={"count": count, "end": end},
    )
