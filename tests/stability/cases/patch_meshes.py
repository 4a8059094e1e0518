"""Patch tests on meshes that are hard to cut: slivers, ratios of facet sizes, nearly equal rotated meshes."""

import numpy as np

from cell import series
from meshes import box_tets
from scenes import patch, patch_cell

SHIFTS = ("1e-3", "1e-5", "1e-7", "1e-9", "1e-11", "1e-13", "1e-14")
RATIOS = (1, 3, 10, 30, 100, 300, 1000)
ANGLES = ("1e-2", "1e-4", "1e-6", "1e-8", "1e-10", "1e-12", "1e-14", "1e-15")


def slivers(shift):
    """The inner planes of nodes of the lower brick lie beside those of the upper one: every facet is cut into strips of
    this width, and squares of it at the corners."""
    planes = [0, 1 / 3, 2 / 3, 1]
    shifted = [0, 1 / 3 + float(shift), 2 / 3 - float(shift), 1]
    scene = patch()
    for name, x, z in (("upper", planes, [0.5, 0.75, 1]), ("lower", shifted, [0, 0.25, 0.5])):
        for key in ("lower", "upper", "cells"):
            del scene[name][key]
        scene[name] |= {"x": x, "y": x, "z": z}
    return patch_cell(scene)


def ratio(fine_side):
    """One facet on a strip of many, and the other way round; in the middle of the strip, whose ends stay coarse."""

    def make(n):
        cells = {"upper_cells": (1, 1, 1), "lower_cells": (1, 1, 1)}
        cells[f"{fine_side}_cells"] = (n, 1, 1)
        return patch_cell(patch(**cells))

    return make


def rotated(angle):
    """Tetrahedra on tetrahedra, the same mesh twice, but the inner nodes of the interface are turned about its
    middle."""
    n = 4

    def move(X):
        inside = (np.abs(X[:, :2] - 0.5) < 0.5 - 1e-9).all(axis=1) & (X[:, 2] == 0.5)
        c, s = np.cos(float(angle)), np.sin(float(angle))
        X[inside, :2] = (X[inside, :2] - 0.5) @ np.array([[c, s], [-s, c]]) + 0.5
        return X

    def run(context):
        scene = patch()
        for name, z, motion in (("upper", (0.5, 1), move), ("lower", (0, 0.5), None)):
            path = box_tets(context.folder / f"{name}.msh", (0, 0, z[0]), (1, 1, z[1]), (n, n, 2), motion)
            scene[name] = {"type": "gmsh", "file": str(path.name), "young": 1000, "poisson": 0.3}
        return patch_cell(scene)(context)

    return run


def cells():
    yield from series("patch, slivers of this width", SHIFTS, slivers, quick=("1e-5", "1e-11", "1e-14"))
    yield from series("patch, 1 facet on N", RATIOS, ratio("lower"), quick=(100,))
    yield from series("patch, N facets on 1", RATIOS, ratio("upper"), quick=(100,))
    yield from series("patch, meshes turned by this angle", ANGLES, rotated, quick=("1e-4", "1e-10", "1e-15"))
