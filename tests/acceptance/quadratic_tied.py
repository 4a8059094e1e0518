"""Quadratic cells tied over facets that do not match, 2 to 3: orders of the error against an exact solution."""

import itertools

import numpy as np

from cell_fields import errors
from scene import write

# Displacements of quadratic cells err by h^2 in the energy's norm, by h^3 in the mean.
ORDERS, ORDER_BOUND = {"H1": 2.0, "L2": 3.0}, 0.2
KINDS, SPACES = ("hex20", "hex27", "tet10"), ("corner", "sub")
# Facets a side of the upper block's lower face; the lower block has one and a half as many.
FACETS = (4, 8, 12)
# Dual multipliers at corners hold constants, not linear functions: order 1.5, which is 1.66 here. The check can fail.
DUAL_ORDER = 1.75
# Of each block, so that the interface is not far from where the solution is largest.
HEIGHT = 0.25
YOUNG, POISSON = 1000.0, 0.3
# Of the displacements. Bodies and weights are linear: any size would do.
SIZE = 1e-3
# sin(pi) becomes the zero that the planes of symmetry prescribe.
DIGITS = 15
# Largest difference of displacements on one rank and on two, over the largest: the solver's rounding.
RANKS_BOUND = 1e-10


def exact(x):
    """The gradient of a harmonic function, which is in equilibrium for every Poisson's ratio. All sides x, y = 0, 1 are
    planes of symmetry."""
    k = np.pi * np.array([1j, 1j, np.sqrt(2)])
    # cos(pi x) cos(pi y) exp(sqrt(2) pi z) as a sum of exponentials of (+-k_x, +-k_y, k_z)
    waves = np.array([k * (a, b, 1) for a in (1, -1) for b in (1, -1)])
    value = SIZE * np.exp(x @ waves.T) / len(waves)
    u = np.einsum("...w,wi->...i", value, waves).real
    return u, np.einsum("...w,wi,wj->...ij", value, waves, waves).real


def follow(file, faces):
    """Writes what the ends' nodes are to do: `faces` are (facets a side, z)."""
    rows = []
    for facets, z in faces:
        s = np.linspace(0, 1, 2 * facets + 1)
        x, y = np.meshgrid(s, s)
        rows.append(np.stack([x, y, np.full_like(x, z)], axis=-1).reshape(-1, 3))
    X = np.concatenate(rows)
    np.savetxt(file, np.hstack([X, np.round(exact(X)[0], DIGITS)]), fmt="%.17g", header="X Y Z ux uy uz")


def scene(driver, kind, facets):
    """Two blocks; their ends follow the exact solution, their sides glide."""
    fine = facets * 3 // 2
    common = {"type": "box", "cell": kind, "young": YOUNG, "poisson": POISSON, "small_strain": True}
    bodies = {
        "upper": {"lower": [0, 0, 0], "upper": [1, 1, HEIGHT], "cells": [facets, facets, facets // 4], **common},
        "lower": {"lower": [0, 0, -HEIGHT], "upper": [1, 1, 0], "cells": [fine, fine, facets // 4], **common},
    }
    file = driver.output / f"ends_{facets}.txt"
    follow(file, ((facets, HEIGHT), (fine, -HEIGHT)))
    walls = {}
    for axis, end in itertools.product("xy", ("min", "max")):
        walls[axis + end] = {"surface": [f"{body}.{axis}{end}" for body in bodies], "components": [axis]}
    rest = {
        "supports": [*walls, "ends"],
        **walls,
        "ends": {"surface": ["upper.zmax", "lower.zmin"], "components": ["x", "y", "z"], "file": file.name},
        "interfaces": ["base"],
        "base": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": "tied", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "last", "csv": "none"},
    }
    return write({"schema": 1, "bodies": list(bodies), **bodies, **rest}, driver.output / f"tied_{kind}_{facets}.yaml")


def tied(driver, kind, facets, space, basis="standard", ranks=1):
    path = scene(driver, kind, facets)
    options = ("-base_multiplier_space", space, "-base_basis", basis)
    return driver.run(path, *options, label=f"{path.stem}_{space}_{basis}_{ranks}", ranks=ranks)


def orders(driver, kind, space, basis="standard"):
    """(facets, facets of the finer mesh, norm, its order, error of the finer mesh)"""
    found = [errors(tied(driver, kind, facets, space, basis), exact) for facets in FACETS]
    for one, two in itertools.pairwise(range(len(FACETS))):
        for k, norm in enumerate(("H1", "L2")):
            slope = np.log(found[one][k] / found[two][k]) / np.log(FACETS[two] / FACETS[one])
            yield FACETS[one], FACETS[two], norm, slope, found[two][k]


def quadratic_tied(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    for kind in KINDS:
        for space in SPACES:
            for one, two, norm, slope, error in orders(driver, kind, space):
                what = f"tied {kind}, {space}, {one} to {two} facets: order of {norm}, error {error:.2e}"
                verdicts.within(what, slope, ORDERS[norm] - ORDER_BOUND, ORDERS[norm] + ORDER_BOUND, "optimal")
    *_, slope, error = [row for row in orders(driver, "hex20", "corner", "dual") if row[2] == "H1"][-1]
    verdicts.below(f"tied hex20, corner, dual: order of H1, error {error:.2e}", slope, DUAL_ORDER, "not optimal")
    ranks(verdicts, driver)


def ranks(verdicts, driver):
    """A support that follows a file does so on every rank."""
    one, two = (tied(driver, "hex20", FACETS[0], "corner", ranks=n).mesh()[2] for n in (1, 2))
    worst = np.abs(two - one).max() / np.abs(one).max()
    verdicts.below("tied hex20 on two ranks: displacements", worst, RANKS_BOUND, "one rank")
