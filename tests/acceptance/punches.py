"""Rigid punches on a half-plane: a flat one that slides, one with rounded edges. A piece of the half-plane is meshed, whose other
sides follow the exact field, so that nothing is finite. Half of the contact's width is 1."""

import functools
from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad
from scipy.special import roots_jacobi

import fields
import formulas
from friction_checks import graded
from plane_mesh import PlaneMesh
from quadratic_line import divided
from scene import write

YOUNG, POISSON = 1.0, 0.3
MODULUS = formulas.plane_modulus(YOUNG, POISSON)
# Ends of the piece, and how cells grow towards them.
FAR, GROWTH = 5.0, 1.1
NAME = "contact"
# Gauss points of a traction as seen from the piece's other sides, 4 half-widths away and more.
SEEN = 24
BODY = {"young": YOUNG, "poisson": POISSON, "small_strain": True}


def write_far(path, x, field):
    np.savetxt(path, np.hstack([x, np.zeros((len(x), 1)), field, np.zeros((len(x), 1))]), fmt="%.17g")
    return path.name


def outer(along, deep):
    """Nodes of the sides and of the bottom, those in the middle of edges, too."""
    along, deep = divided(along, 2), divided(deep, 2)
    grid = np.stack([g.ravel() for g in np.meshgrid(along, -deep, indexing="ij")], axis=1)
    return grid[(np.abs(grid[:, 0]) > FAR - 1e-9) | (grid[:, 1] < 1e-9 - FAR)]


def towards_edge(cells, halvings):
    """From 0 to 1: equal facets, the last of which is halved so many times."""
    last = 1 - 0.5 ** np.arange(halvings + 1) / cells
    return np.concatenate([np.arange(cells - 1) / cells, last[:1], last[1:], [1]]) if halvings else np.linspace(0, 1, cells + 1)


# --- a flat punch that slides -----------------------------------------------------------------------------------------
@dataclass
class Sliding:
    """Pushed along -x and pressed by `load`; it slips everywhere. So flat that nothing turns, slid by a hundredth of a facet."""

    mu: float
    load: float = 1e-5
    way: float = 1e-3

    @property
    def exact(self):
        return formulas.SlidingPunch(self.load, self.mu, POISSON)

    def scene(self, folder, facets, halvings=0, cell="quad", **interface):
        """`facets` over the half-width, the outermost of which are halved."""
        inside, smallest = towards_edge(facets, halvings), 0.5**halvings / facets
        beyond = 1 + graded(smallest, 0, FAR - 1, GROWTH if not halvings else 1.3)[1:]
        right = np.append(inside, beyond)
        along = np.append(-right[:0:-1], right)
        deep = graded(smallest, 0, FAR, GROWTH if not halvings else 1.3)
        stem = f"sliding_{self.mu:g}_{facets}_{halvings}_{cell}"
        g = self.exact.power
        with np.errstate(divide="ignore", invalid="ignore"):  # a recurrence of scipy's, which it puts right, as both powers add up to -1
            places, weights = roots_jacobi(SEEN, -0.5 - g, -0.5 + g)
        forces = np.outer(weights * self.load * np.cos(np.pi * g) / np.pi, [-self.mu, -1])
        X = outer(along, deep)
        far = write_far(folder / f"{stem}.txt", X, fields.under_forces(X, places, forces, YOUNG, POISSON))
        return write(
            {
                "schema": 1,
                "model": "plane_strain",
                "bodies": ["block", "punch"],
                "block": {"type": "box", "x": along.tolist(), "y": (-deep[::-1]).tolist(), "cell": cell, **BODY},
                "punch": {"type": "rigid", "from": "box", "reference": [0, 0], "lower": [-1.2, 0], "upper": [1.2, 1], "cells": [5, 1]},
                "surfaces": ["foot"],
                "foot": {"of": "block.ymax", "within": [-1, -0.1, 1, 0.1]},
                "supports": ["far", "slide"],
                "far": {"surface": ["block.xmin", "block.xmax", "block.ymin"], "components": ["x", "y"], "file": far},
                "slide": {"body": "punch", "components": ["x", "rz"], "value": [-self.way, 0]},
                "loads": ["press"],
                "press": {"body": "punch", "force": [0, -self.load], "curve": [0, 1, 1, 1]},
                "interfaces": [NAME],
                NAME: {"nonmortar": "foot", "mortar": "punch.ymin", "friction": self.mu, **interface},
                "steps": {"count": 1},
                "output": {"vtu": "none", "csv": "last", "quiet": True},
            },
            folder / f"{stem}.yaml",
        )

    def pressures(self, run, quadratic=False):
        """(x, nodal forces over nodal lengths, means of the exact pressure over the nodes' functions, lengths)."""
        table = run.interface(NAME)
        table = table[np.argsort(table["X"])]
        x = table["X"]
        _, share = formulas.nodal_shares(x, quadratic, 4)
        length = share.sum(axis=1)
        return x, -table["fy"] / length, self.exact.nodal_force(x, quadratic) / length, length


def relative(found, exact, weight):
    return np.sqrt((weight * (found - exact) ** 2).sum() / (weight * exact**2).sum())


# --- a punch with rounded edges ---------------------------------------------------------------------------------------
# Facets of one size reach beyond the contact; the punch's are half as large, so that its shape is hardly in an error.
FINE, FINER = 1.35, 2
RADIUS = 1000.0


def positions(facets, count=10):
    """Facets over the half-width, numbers that move the border through a facet."""
    return facets + (np.arange(count) + 0.5) / count


@functools.cache
def rounded(flat):
    return formulas.RoundedPunch(flat, 1.0, RADIUS, MODULUS)


@functools.cache
def sunk(flat):
    """Height of the middle of the surface in the field of fields.under_forces."""
    exact = rounded(flat)
    logarithm = 2 * quad(lambda s: exact.pressure(s) * np.log(s), 0, 1, points=[flat], limit=400)[0]
    return (1 + POISSON) / (2 * np.pi * YOUNG) * (4 * (1 - POISSON) * logarithm + exact.force)


def rounded_field(x, flat):
    """Displacements; the middle of the surface stays."""
    nodes, weights = np.polynomial.legendre.leggauss(SEEN)
    exact, places, forces = rounded(flat), [], []
    for low, high in ((-1, -flat), (-flat, 0), (0, flat), (flat, 1)):
        at = low + (high - low) * (nodes + 1) / 2
        places.append(at)
        forces.append(exact.pressure(at) * weights * (high - low) / 2)
    places, forces = np.concatenate(places), np.concatenate(forces)
    forces *= exact.force / forces.sum()  # the pressure is not smooth at either end of a part
    down = np.outer(forces, [0, -1])
    u = fields.under_forces(x, places, down, YOUNG, POISSON) - [0, sunk(flat)]
    u[x[:, 0] == 0, 0] = 0  # but for rounding
    return u


def rounded_scene(folder, flat, facets, cell="quad", **interface):
    """`facets` over the half-width, a real number: it moves the border through a facet. Half of the piece is there."""
    size = 1 / facets
    along, deep = graded(size, FINE, FAR, GROWTH), graded(size, 0, FAR, GROWTH)
    stem = f"rounded_{flat:g}_{facets:g}_{cell}"
    X = outer(along, deep)
    X = X[(X[:, 0] > FAR - 1e-9) | (X[:, 1] < 1e-9 - FAR)]
    far = write_far(folder / f"{stem}.txt", X, rounded_field(X, flat))
    wide = FINE + size
    x = np.linspace(0, wide, FINER * int(np.ceil(wide / size)) + 1)
    bend = lambda p: [p[0], p[1] + rounded(flat).rise(p[0])]
    mesh = PlaneMesh("quad", x, np.array([0, 0.5]), False, bend).write(folder / f"{stem}.msh")
    return write(
        {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["block", "punch"],
            "block": {"type": "box", "x": along.tolist(), "y": (-deep[::-1]).tolist(), "cell": cell, **BODY},
            "punch": {"type": "gmsh", "file": mesh.name, **BODY},
            "surfaces": ["foot"],
            "foot": {"of": "block.ymax", "within": [0, -0.1, FINE, 0.1]},
            "supports": ["far", "symmetry", "rigid"],
            "far": {"surface": ["block.xmax", "block.ymin"], "components": ["x", "y"], "file": far},
            "symmetry": {"surface": "block.xmin", "components": ["x"]},
            "rigid": {"body": "punch", "components": ["x", "y"]},
            "interfaces": [NAME],
            NAME: {"nonmortar": "foot", "mortar": "punch.ymin", **interface},
            "steps": {"count": 1},
            "output": {"vtu": "none", "csv": "last", "quiet": True},
        },
        folder / f"{stem}.yaml",
    )


def rounded_pressures(run, flat, quadratic=False):
    """(x, nodal forces over nodal lengths, means of the exact pressure over the nodes' functions, lengths)."""
    table = run.interface(NAME)
    table = table[np.argsort(table["X"])]
    at, share = formulas.nodal_shares(table["X"], quadratic)
    length = share.sum(axis=1)
    return table["X"], -table["fy"] / length, share @ rounded(flat).pressure(at) / length, length


def rounded_load(run, flat):
    """Over the exact one."""
    return -2 * run.interface(NAME)["fy"].sum() / rounded(flat).force
