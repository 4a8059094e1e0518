"""Scenes of the matrix, as dictionaries, and the errors that are compared on each kind."""

import copy

import numpy as np

import host  # noqa: F401  (puts studies on the path)
from comparisons import multiplier, stretch

EPS = np.finfo(float).eps
# Patch tests of the acceptance checks end at 1e-12; what an ill-conditioned matrix adds is its condition times the
# rounding of each of some hundred operations an unknown.
PATCH_FLOOR, PATCH_KAPPA = 1e-10, 100.0
# Where a body is free to drift the matrix is singular to rounding, and its condition says nothing about the tractions,
# which the drift does not change. They are held to this, and the cell is a warning.
SINGULAR, PATCH_CEILING = 1e13, 1e-3


def patch(
    *,
    lower=(0, 0, 0),
    size=(1, 1, 1),
    upper_cells=(3, 3, 2),
    lower_cells=(4, 4, 2),
    young=(1000, 1000),
    poisson=0.3,
    friction=0.3,
    traction=(0, 0, -10),
    body=None,
    steps=1,
):
    """Two bricks, one on the other, half of the height each, under pressure: the multiplier is uniform and exact.

    `body`: more keys of both bodies. Held at points that lie above each other, so that both are free to widen.
    """
    x, y, z = lower
    a, b, c = size
    middle = z + c / 2
    scene = {
        "schema": 1,
        "bodies": ["upper", "lower"],
        "upper": {"type": "box", "lower": [x, y, middle], "upper": [x + a, y + b, z + c], "cells": list(upper_cells)},
        "lower": {"type": "box", "lower": [x, y, z], "upper": [x + a, y + b, middle], "cells": list(lower_cells)},
        "supports": ["bottom", "corner1", "side1", "corner2", "side2"],
        "bottom": {"surface": "lower.zmin", "components": ["z"]},
        "corner1": {"body": "lower", "point": [x, y, z], "components": ["x", "y"]},
        "side1": {"body": "lower", "point": [x + a, y, z], "components": ["y"]},
        "corner2": {"body": "upper", "point": [x, y, z + c], "components": ["x", "y"]},
        "side2": {"body": "upper", "point": [x + a, y, z + c], "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.zmax", "traction": list(traction)},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": friction},
        "steps": {"count": steps},
        "output": {"vtu": "none", "csv": "last"},
    }
    for name, modulus in zip(("upper", "lower"), young):
        scene[name] |= {"young": modulus, "poisson": poisson} | (body or {})
    return scene


def changed(scene, **maps):
    """A copy with keys of some maps replaced."""
    scene = copy.deepcopy(scene)
    for name, keys in maps.items():
        scene[name] = scene.get(name, {}) | keys if isinstance(keys, dict) else keys
    return scene


def patch_error(run, traction, interface="base"):
    """Largest relative error of the nodal multipliers; exact is minus the force over the deformed area."""
    table = run.interface(interface)
    exact = np.asarray(traction, float) / stretch(table)
    return np.linalg.norm(multiplier(table) - exact, axis=1).max() / np.linalg.norm(exact)


def patch_bound(run, floor=PATCH_FLOOR):
    return max(floor, min(PATCH_KAPPA * EPS * (run.kappa or 0), PATCH_CEILING))


def check_patch(run, traction=(0, 0, -10), floor=PATCH_FLOOR, reason="uniform and exact; max(1e-10, 100 eps kappa)"):
    """The Outcome of a patch test."""
    result = host.outcome(run)
    if result.refusal is None:
        error = patch_error(run, traction)
        result.below("multiplier", error, patch_bound(run, floor), reason)
        result.figures |= {"patch_error": error, "patch_bound": patch_bound(run, floor)}
        if (run.kappa or 0) > SINGULAR:
            result.warnings.append(f"condition {run.kappa:.0e}: a body is free to drift")
    return result


def patch_cell(scene, traction=(0, 0, -10), floor=PATCH_FLOOR, options=()):
    """The run of a patch cell."""
    return lambda context: check_patch(context.solve(scene, *options, kappa=True), traction, floor)
