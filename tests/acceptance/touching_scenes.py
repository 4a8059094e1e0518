"""Scenes of bodies that touch in a point or line, or not yet, and that nothing but contact holds along z: a quarter of a
cylinder, an eighth of a ball, a cube on its corner, each over a block or an analytic plane, pressed by a force."""

import numpy as np

# Facets under the pole are this long; the cube's are as long everywhere.
FACET, CUBE_FACET = 0.025, 0.25
# Of cylinder and ball the radius, of the cube the edge.
SIZE = 1.0
ACROSS = [0, 0.025, 0.05, 0.075, 0.1, 0.125, 0.15, 0.2, 0.32, 0.56, 1]
DOWN = [-1, -0.975, -0.95, -0.925, -0.87, -0.76, -0.5, 0]
BLOCK_ACROSS = [0, 0.029, 0.058, 0.087, 0.116, 0.145, 0.174, 0.23, 0.36, 0.63, 1.2]
BLOCK_DOWN = np.array([-1.2, -0.6, -0.28, -0.14, -0.087, -0.058, -0.029, 0])
SHAPES = ("cylinder", "ball", "cube")
# A tenth of the radius is in contact, or a third of the cube's edge.
TRACTIONS = {"cylinder": 2.2, "ball": 0.25, "cube": 5.0}
ELASTIC = {"young": 1000, "poisson": 0.3}


def facet(shape):
    return CUBE_FACET if shape == "cube" else FACET


def upper_body(shape):
    """Body, the surface in contact, those that are loaded, supports, the loaded point that is prescribed instead."""
    if shape == "cube":
        return cube()
    body = {"type": "box", "x": ACROSS, "z": DOWN, **ELASTIC}
    if shape == "cylinder":
        body |= {"cylinder": [0, 0, 0], "axis": "y", "y": [0, 0.1]}
    else:
        body |= {"ball": [0, 0, 0], "y": ACROSS}
    supports = {
        "symmetryx": {"surface": "upper.xmin", "components": ["x"]},
        "symmetryy": {"surface": "upper.ymin", "components": ["y"]},
    }
    if shape == "cylinder":
        supports["symmetryy"]["surface"] = ["upper.ymin", "upper.ymax"]
    foot = {"of": "upper.zmin", "within": [-1, -1, -2, 0.3, 0.3, 1]}
    return body, foot, ["upper.zmax"], supports, [0, 0, 0]


def cube():
    """On its corner at (0, 0, -1), the opposite one above it. The faces around that one are loaded and held in x, y."""
    axes = np.array([[1, 1, 1], [1, -1, 0], [1, 1, -2]]) / np.sqrt([[3], [2], [6]])
    turn = axes[[1, 2, 0]]  # rows: where x, y, z come from; the diagonal becomes z
    turn[0] *= np.linalg.det(turn)
    unit = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
    corners = SIZE * unit @ turn.T + [0, 0, -1]
    cells = [round(SIZE / CUBE_FACET)] * 3
    body = {"type": "box", "corners": corners.ravel().tolist(), "cells": cells, **ELASTIC}
    foot = {"of": ["upper.xmin", "upper.ymin", "upper.zmin"], "within": [-9, -9, -9, 9, 9, 9]}
    head = ["upper.xmax", "upper.ymax", "upper.zmax"]
    return body, foot, head, {"guide": {"surface": head, "components": ["x", "y"]}}, [0, 0, -1 + np.sqrt(3) * SIZE]


def lower_body(shape, base, gap):
    """Body, the surface in contact, supports; its top is the gap below z = -1."""
    top = -1 - gap
    if base == "plane":
        body = {"type": "analytic", "shape": "plane", "point": [0, 0, top], "direction": [0, 0, 1]}
        return body, "lower.surface", {"still": {"body": "lower", "components": ["x", "y", "z"]}}
    body = {"type": "box", "z": (top + BLOCK_DOWN).tolist(), **ELASTIC}
    if shape == "cube":
        across = np.linspace(-1.1, 1.1, 10).tolist()
        return body | {"x": across, "y": across}, "lower.zmax", {"ground": held("lower.zmin", "xyz")}
    supports = {"ground": held("lower.zmin", "z"), "symmetry2": held("lower.xmin", "x")}
    if shape == "ball":
        supports["symmetry3"] = held("lower.ymin", "y")
        return body | {"x": BLOCK_ACROSS, "y": BLOCK_ACROSS}, "lower.zmax", supports
    supports["plane2"] = held(["lower.ymin", "lower.ymax"], "y")
    return body | {"x": BLOCK_ACROSS, "y": [0, 0.1]}, "lower.zmax", supports


def held(surface, components):
    return {"surface": surface, "components": list(components)}


def touching(shape, base="block", gap=0.0, friction=0.0, times=(0.25, 0.5, 1.0), contact=None, down=1.0):
    """The scene, pressed by a force that grows evenly. `gap` in facets; `contact`: more keys of the interface; `down`:
    -1 pulls."""
    body, foot, head, supports, point = upper_body(shape)
    lower, top, more = lower_body(shape, base, gap * facet(shape))
    supports = supports | more
    scene = {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": body,
        "lower": lower,
        "surfaces": ["foot"],
        "foot": foot,
        "supports": list(supports),
        **supports,
        "loads": ["press"],
        "press": {"surface": head, "traction": [0, 0, -down * TRACTIONS[shape]]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "foot", "mortar": top, "friction": friction} | (contact or {}),
        "steps": {"times": list(times)},
        "probes": ["pole"],
        "pole": {"body": "upper", "point": [float(v) for v in point]},
        "output": {"vtu": "none", "csv": "all"},
        "snes": {"rtol": 1e-13},
    }
    return scene


def load(shape):
    """The force of `press`, from the area that its traction acts on."""
    if shape == "ball":  # a quarter of a disc, as a polygon
        area = np.sin(np.diff(np.arctan(ACROSS))).sum()
    else:
        area = 3 * SIZE**2 if shape == "cube" else SIZE * 0.1
    return TRACTIONS[shape] * area


def stack(gaps, friction=0.0, tied=False, shape="ball"):
    """A ball or cylinder over a slab that nothing holds along z, over a floor, with two gaps in facets; or over a slab
    that is tied to the floor."""
    scene = touching(shape, gap=gaps[0], friction=friction)
    z = np.array(scene["lower"]["z"])
    top = z[0] - gaps[1] * FACET
    floor = scene["lower"] | {"z": [top - 1.0, top - 0.6, top - 0.2, top], "young": 3000}
    below = {"nonmortar": "lower.zmin", "mortar": "floor.zmax"}
    sides = "floor.ymin" if shape == "ball" else ["floor.ymin", "floor.ymax"]
    supports = {"symmetry4": held("floor.xmin", "x"), "symmetry5": held(sides, "y")}
    return scene | supports | {
        "bodies": ["upper", "lower", "floor"],
        "floor": floor,
        "supports": [*scene["supports"], *supports],
        "ground": held("floor.zmin", "z"),
        "interfaces": ["contact", "below"],
        "below": below | ({"law": "tied"} if tied else {"friction": friction}),
        "probes": ["pole", "slab"],
        "slab": {"body": "lower", "point": [0, 0, float(z[-1])]},
    }


def prescribed(scene, run):
    """The same scene under the same forces, with the closing of a run of it prescribed at its probes, step by step."""
    pins = {}
    for probe in scene["probes"]:
        curve = [0.0, 0.0]
        for step in run.steps:
            curve += [step["t"], step["probes"][probe][2]]
        pin = {**scene[probe], "components": ["z"], "value": [0, 0, 1], "curve": curve}
        pins[f"pin{probe}"] = pin
    return scene | pins | {"supports": [*scene["supports"], *pins]}
