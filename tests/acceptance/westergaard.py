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
HALVED_GROWTH = 1.12
POSITIONS = 10
# Facets over the half wave, in place of those over the half-width: under a light load the contact has a third of it, like Hertz', under
# a heavier one half.
LIGHT, HALF = 3.2, 2.0
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
CORNER_POINTS = element("quadratic, corner, points", "quad8", multiplier_space="corner", decision="points")
SUB_POINTS = element("quadratic, sub, points", "quad8", multiplier_space="sub", decision="points")


def half_widths(facets, part, count=POSITIONS):
    """That move the border through a facet; `part`: LIGHT or HALF."""
    return (facets + (np.arange(count) + 0.5) / count) / round(part * facets) * WAVE.length / 2


def cells(element, facets, part):
    """Over the half wave: as many nodes for quadratic ones."""
    return round(part * facets) // (2 if element.quadratic else 1)


@dataclass(frozen=True)
class Halved:
    """The facet that the border cuts and its two neighbours, halved so many times; the facet's number from the middle."""

    times: int = 0
    facet: int = 0

    @property
    def name(self):
        return f"_{self.facet}_halved_{self.times}" if self.times else ""

    def places(self, facets):
        parts = lambda i: 2**self.times if abs(i - self.facet) <= 1 else 1
        return np.append(np.concatenate([i + np.arange(parts(i)) / parts(i) for i in range(facets)]), facets) / facets


def mesh(folder, cell, facets, halved):
    """`facets`: over the half wave."""
    size = WAVE.length / 2 / facets / 2**halved.times
    x, deep = WAVE.length / 2 * halved.places(facets), graded(size, 0, DEPTH, GROWTH if not halved.times else HALVED_GROWTH)
    bend = lambda p: [p[0], p[1] - WAVE.gap(p[0]) * (1 + p[1] / DEPTH)]
    return PlaneMesh(cell, x, -deep[::-1], False, bend).write(folder / f"wavy_{cell}_{facets}{halved.name}.msh")


def scene(folder, cell, facets, pressure, times=(1,), halved=Halved()):
    """`facets`: over the half wave; `pressure`: the mean one at time 1."""
    body = {"young": YOUNG, "poisson": POISSON, "small_strain": True}
    return write(
        {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["wavy", "flat"],
            "wavy": {"type": "gmsh", "file": mesh(folder, cell, facets, halved).name, **body},
            "flat": {"type": "box", "lower": [0, 0], "upper": [WAVE.length / 2, 0.2], "cells": [FLAT, 1], **body},
            "supports": ["symmetry", "rigid"],
            "symmetry": {"surface": ["wavy.xmin", "wavy.xmax"], "components": ["x"]},
            "rigid": {"body": "flat", "components": ["x", "y"]},
            "loads": ["press"],
            "press": {"surface": "wavy.ymin", "pressure": pressure, "curve": [0, 0, 1, 1]},
            "interfaces": [NAME],
            NAME: {"nonmortar": "wavy.ymax", "mortar": "flat.ymin"},
            "steps": {"times": list(times)},
            "output": QUIET,
        },
        folder / f"wave_{cell}_{facets}{halved.name}_{pressure:.6e}_{len(times)}.yaml",
    )


def options(element):
    return [word for key, value in element.options for word in (f"-{NAME}_{key}", value)]


def solve(driver, element, facets, half_width, halved=Halved()):
    """`facets`: over the half wave."""
    driver.output.mkdir(parents=True, exist_ok=True)
    path = scene(driver.output, element.cell, facets, WAVE.mean_pressure(half_width), halved=halved)
    return driver.run(path, *options(element), label=f"{path.stem}_{element.name.replace(', ', '_')}")


def pressures(run, half_width, element):
    """(x, nodal forces over nodal areas, means of the exact pressure over the nodes' functions, areas)."""
    table = run.interface(NAME)
    table = table[np.argsort(table["X"])]
    at, share = formulas.nodal_shares(table["X"], element.quadratic)
    area = share.sum(axis=1)
    return table["X"], -table["fy"] / area, share @ WAVE.pressure(at, half_width) / area, area


def error(run, half_width, element):
    """Root mean square over the nodes, over that of the pressure."""
    _, found, exact, area = pressures(run, half_width, element)
    return np.sqrt((area * (found - exact) ** 2).sum() / (area * exact**2).sum())


def border_by_area(run):
    """What is closed, as a length."""
    table = run.interface(NAME)
    if "closed" in table.dtype.names:
        return (table["closed"] * table["area_covered"]).sum()
    decide = np.sort(table[table["state"] != "none"], order="X")  # nodes without a multiplier have no state
    half = np.diff(decide["X"]) / 2
    return (np.append(half, 0) + np.append(0, half))[decide["state"] != "gap"].sum()


# Of the half-width: nodes that the border of the contact is fitted to.
FITTED = (0.3, 0.8)


def border_by_fit(run, half_width, element):
    """Where the profile of the exact pressure ends that fits nodal ones best: its square over cos^2 is linear in sin^2."""
    x, found, _, _ = pressures(run, half_width, element)
    inside = (x > FITTED[0] * half_width) & (x < FITTED[1] * half_width)
    angle = np.pi * x[inside] / WAVE.length
    slope, top = np.polyfit(np.sin(angle) ** 2, (found[inside] / np.cos(angle)) ** 2, 1)
    return WAVE.length / np.pi * np.arcsin(np.sqrt(min(1.0, -top / slope)))


# Mean pressures over the one that closes the last gap, at which it is looked for; the last one has a gap no more.
STEP = 0.001
CLOSING = np.round(np.arange(0.98, 1.02 + STEP / 2, STEP), 3)


def closing(driver, element, facets):
    """The mean pressure in whose step the last gap closes, over the exact one; None: beyond the last; `facets` over the half wave."""
    driver.output.mkdir(parents=True, exist_ok=True)
    path = scene(driver.output, element.cell, facets, CLOSING[-1] * WAVE.closing, (CLOSING / CLOSING[-1]).tolist())
    run = driver.run(path, *options(element), "-output_csv", "all", label=f"closing_{facets}_{element.name.replace(', ', '_')}")
    for pressure, step in zip(CLOSING, range(1, len(run.steps) + 1)):
        table = run.interface(NAME, step)
        open_part = 1 - table["closed"].min() if "closed" in table.dtype.names else (table["state"] == "gap").sum()
        if open_part < OPEN:
            return pressure
    return None


# Of a node's area: less is rounding.
OPEN = 1e-9
