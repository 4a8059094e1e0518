"""Patch tests of contact between quadratic cells: slivers, kinds mixed, mid nodes off the middle of their edges.

With mid nodes in the middle the answer is exact. Elsewhere the parts' mapping and the facet's differ within the facet, and
the multipliers are off by what that amounts to (docs/formulation 12.2)."""

import sys
from pathlib import Path

import numpy as np

import host
from cases.patch_meshes import SHIFTS
from cell import series
from library import spaces_in_question
from scenes import patch, patch_bound, stretch
from comparisons import multiplier

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "acceptance"))
from second_order import SecondOrder  # noqa: E402  (needs the path)

KINDS = ("tet10", "hex20", "hex27")
MIXED = ("hex20 on hex", "hex20 on tet", "tet10 on hex27", "hex27 on tet10", "hex on hex20", "tet on hex27")
OFF = (0.0, 0.001, 0.01, 0.05, 0.1, 0.15, 0.2, 0.22, 0.24, 0.3)
# From here on a corner has no normal to go by; at 0.239 a run without that refusal ended with a multiplier five times too large.
NO_NORMAL = 0.225
# Relative error of a multiplier over the mid nodes' offset in edges: 1.5 as measured, with dual multipliers 0.3.
PER_OFFSET = 2.0
REFUSED = r"at its node \d|its part between the nodes|volume|Jacobian|inside out"


def with_cells(scene, upper, lower, space):
    scene["upper"]["cell"], scene["lower"]["cell"] = upper, lower
    if any(kind in KINDS for kind in (upper, lower)):
        scene["base"]["multiplier_space"] = space
    return scene


def check(result, run, bound, reason):
    """Multipliers where there are any: mid nodes have none with `corner`."""
    if run.exit_code != host.CONVERGED:
        return host.outcome(run)
    table = run.interface("base")
    exact = np.array([0, 0, -10]) / stretch(table)
    found = multiplier(table)[table["area_covered"] > 0]
    error = np.linalg.norm(found - exact, axis=1).max() / np.linalg.norm(exact)
    result.below("multiplier", error, max(bound, patch_bound(run)), reason)
    result.figures["quadratic_patch_error"] = max(error, result.figures.get("quadratic_patch_error", 0))
    return result


def solved(context, scenes, bound=0.0, reason="uniform and exact; max(1e-10, 100 eps kappa)"):
    result = None
    for name, scene in scenes:
        run = context.solve(scene, name=name, kappa=True)
        result = result or host.outcome(run)
        result = check(result, run, bound, reason)
        if result.refusal is not None:
            return result
    return result


def slivers(shift):
    """The inner planes of nodes of the lower brick lie beside those of the upper one."""
    planes = [0, 1 / 3, 2 / 3, 1]
    shifted = [0, 1 / 3 + float(shift), 2 / 3 - float(shift), 1]

    def scene(kind, space):
        made = with_cells(patch(), kind, kind, space)
        for name, x, z in (("upper", planes, [0.5, 0.75, 1]), ("lower", shifted, [0, 0.25, 0.5])):
            for key in ("lower", "upper", "cells"):
                del made[name][key]
            made[name] |= {"x": x, "y": x, "z": z}
        return made

    return lambda context: solved(context, ((f"{k}_{s}", scene(k, s)) for k in KINDS for s in spaces_in_question()))


def mixed(text):
    """One kind on another, 2 on 3 cells."""
    upper, lower = text.split(" on ")

    def run(context):
        size = {"upper_cells": (2, 2, 1), "lower_cells": (3, 3, 1)}
        return solved(context, ((s, with_cells(patch(**size), upper, lower, s)) for s in spaces_in_question()))

    return run


def drawn(s):
    """Mid nodes within the upper body's face drawn towards the one or the other end of their edges by s edges, in the
    plane of the face: at a quarter the mapping ends, and before that the normal."""
    n = 2

    def bend(p):
        lattice = p * n
        odd = np.abs(lattice - np.round(lattice)) > 0.1
        if p[2] == 0 and odd[:2].sum() == 1:
            axis = int(np.argmax(odd[:2]))
            other = p[1 - axis]
            if 0 < other < 1:  # the rim stays: it is shared with faces that are no contact
                p = p.copy()
                p[axis] += s / n * (1 if int(lattice.sum() * 2) % 4 < 2 else -1)
        return p + [0, 0, 0.5]

    def run(context):
        return solved(context, scenes(context), PER_OFFSET * s, "the facet's mapping and its parts' differ")

    def scenes(context):
        for kind in KINDS:
            mesh = SecondOrder(kind, n, bend)
            context.folder.mkdir(parents=True, exist_ok=True)
            mesh.write_41(context.folder / f"{kind}.msh")
            for space in spaces_in_question():
                made = with_cells(patch(lower=(0, 0, -0.5), size=(1, 1, 2)), kind, kind, space)
                made["upper"] = {"type": "gmsh", "file": f"{kind}.msh", "young": 1000, "poisson": 0.3}
                yield f"{kind}_{space}", made

    return run


def cells():
    yield from series("quadratic patch, slivers of this width", SHIFTS, slivers, quick=("1e-11",))
    yield from series("quadratic patch, kinds", MIXED, mixed, quick=("tet10 on hex27",))
    beyond = lambda s: REFUSED if s >= 0.25 else "no normal to go by" if s > NO_NORMAL else None
    yield from series("quadratic patch, mid nodes drawn by", OFF, drawn, quick=(0.1,), may_refuse=beyond)
