"""Westergaard's wavy surface, pressed onto a rigid flat one in plane strain. Half a wave lies between two planes of symmetry. The
answer is exact: nothing is finite but the depth. So this is the test of the border of a contact.

The wavy body has the multipliers. Its mean pressure is given; it moves the border through a facet."""

from dataclasses import dataclass

import numpy as np

import formulas
from friction_checks import graded
from plane_mesh import PlaneMesh
from scene import write

YOUNG, POISSON = 1.0, 0.3
MODULUS = formulas.plane_modulus(YOUNG, POISSON)
# So flat that the theory of small displacements is exact to 1e-4.
WAVE = formulas.Wave(length=2.0, height=2e-4, modulus=MODULUS)
# Twice as deep changes no digit of an error; cells that grow faster leave an error of their own (1.25: 0.15 %).
DEPTH, GROWTH = 1.5 * WAVE.length, 1.06
POSITIONS = 10
# Facets over the half-width and over the half wave: the contact has about half of it.
HALF_WAVE = 2
# Of the rigid flat side: its facets meet no node of the other.
FLAT = 7
NAME = "contact"
QUIET = {"vtu": "none", "csv": "last", "quiet": True}


@dataclass(frozen=True)
class Element:
    name: str
    cell: str
    options: tuple  # of the interface

    @property
    def quadratic(self):
        return self.cell != "quad"

    @property
    def space(self):
        return dict(self.options).get("multiplier_space", "corner")


def element(name, cell="quad", **options):
    return Element(name, cell, tuple(options.items()))


STANDARD = element("standard", basis="standard")
DUAL = element("dual")
POINTS = element("points", decision="points")
CORNER = element("quadratic, corner", "quad8", multiplier_space="corner")
CORNER_STANDARD = element("quadratic, corner, standard", "quad8", multiplier_space="corner", basis="standard")
SUB = element("quadratic, sub", "quad8", multiplier_space="sub")


def half_widths(facets, count=POSITIONS):
    """That move the border through a facet."""
    return (facets + (np.arange(count) + 0.5) / count) / (HALF_WAVE * facets) * WAVE.length / 2


def mesh(folder, cell, facets):
    """`facets`: over the half wave."""
    size = WAVE.length / 2 / facets
    x, deep = np.linspace(0, WAVE.length / 2, facets + 1), graded(size, 0, DEPTH, GROWTH)
    bend = lambda p: [p[0], p[1] - WAVE.gap(p[0]) * (1 + p[1] / DEPTH)]
    return PlaneMesh(cell, x, -deep[::-1], False, bend).write(folder / f"wavy_{cell}_{facets}.msh")


def scene(folder, cell, facets, pressure):
    """`facets`: over the half wave; `pressure`: the mean one."""
    body = {"young": YOUNG, "poisson": POISSON, "small_strain": True}
    return write(
        {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["wavy", "flat"],
            "wavy": {"type": "gmsh", "file": mesh(folder, cell, facets).name, **body},
            "flat": {"type": "box", "lower": [0, 0], "upper": [WAVE.length / 2, 0.2], "cells": [FLAT, 1], **body},
            "supports": ["symmetry", "rigid"],
            "symmetry": {"surface": ["wavy.xmin", "wavy.xmax"], "components": ["x"]},
            "rigid": {"body": "flat", "components": ["x", "y"]},
            "loads": ["press"],
            "press": {"surface": "wavy.ymin", "pressure": pressure},
            "interfaces": [NAME],
            NAME: {"nonmortar": "wavy.ymax", "mortar": "flat.ymin"},
            "steps": {"count": 1},
            "output": QUIET,
        },
        folder / f"wave_{cell}_{facets}_{pressure:.6e}.yaml",
    )


def solve(driver, element, facets, half_width):
    """`facets`: over the half wave."""
    driver.output.mkdir(parents=True, exist_ok=True)
    path = scene(driver.output, element.cell, facets, WAVE.mean_pressure(half_width))
    options = [word for key, value in element.options for word in (f"-{NAME}_{key}", value)]
    label = f"{path.stem}_{element.name.replace(', ', '_')}"
    return driver.run(path, *options, label=label)


def pressures(run, half_width, element):
    """(x, nodal forces over nodal areas, means of the exact pressure over the nodes' functions, areas)."""
    table = run.interface(NAME)
    table = table[np.argsort(table["X"])]
    shapes = formulas.nodal_shares(table["X"], element.quadratic)
    at, share = shapes
    area = share.sum(axis=1)
    return table["X"], -table["fy"] / area, share @ WAVE.pressure(at, half_width) / area, area


def error(run, half_width, element):
    """Root mean square over the nodes, over that of the pressure."""
    _, found, exact, area = pressures(run, half_width, element)
    return np.sqrt((area * (found - exact) ** 2).sum() / (area * exact**2).sum())
