"""Two equal cylinders roll on each other with a tangential force below what slides (Carter). Lengths are those of the contact's
half-width, which is near 1. Parts of the cylinders are meshed, on rigid cores that turn.

The upper core is turned; the lower one, which is a rigid body, turns as it likes under a moment. What it lags behind is the
creepage."""

import numpy as np

import formulas
from friction_checks import graded
from plane_mesh import PlaneMesh
from scene import write

YOUNG, POISSON, MU = 1.0, 0.3, 0.3
RADIUS, CORE = 50.0, 34.0
MODULUS = formulas.plane_modulus(YOUNG, POISSON) / 2
FORCE = np.pi * MODULUS / (4 * RADIUS / 2)  # for a half-width of 1
# How much nearer the axes are: the half-width is near 1.
PRESSED = 0.0715  # pressing comes first, then the moment, then rolling
# The way that is rolled; facets are fine as far around it, and cells grow beyond.
WAY, AROUND, BEYOND, GROWTH = 8.0, 2.0, 16.0, 1.25
# Of the other side's facets, so that none match.
RATIO = 1.18
# From here on nothing changes but by how nodes meet: two widths of the contact.
STEADY = 4.0
NAME = "contact"


def creepage(share, half_width=1.0):
    """Of a tangential force of so much of what slides."""
    return MU * half_width / (RADIUS / 2) * (1 - np.sqrt(1 - share))


def planes(facet):
    """Along the rim, and away from it."""
    fine = np.arange(-AROUND, WAY + AROUND + facet / 2, facet)
    far = graded(facet, 0, BEYOND, GROWTH)[1:]
    return np.concatenate([fine[0] - far[::-1], fine, fine[-1] + far]), graded(facet, 0, RADIUS - CORE, GROWTH)


def mesh(path, along, heights):
    """p: the way along the rim, which comes into contact from left to right as both roll, and the height above the rim, below 0 in the
    lower one."""

    def bend(p):
        angle, above = p[0] / RADIUS, 1 if max(heights) > 0 else -1
        r = RADIUS - abs(p[1])
        return [-r * np.sin(angle), above * (RADIUS - r * np.cos(angle))]

    return PlaneMesh("quad", along, heights, True, bend).write(path).name


def scene(folder, facets, share, steps, **interface):
    """`facets` over the half-width; `steps` of rolling."""
    size = 1 / facets
    body = {"young": YOUNG, "poisson": POISSON, "material": "neo_hooke"}
    (above, high), (below, deep) = planes(size), planes(RATIO * size)
    name = lambda part: folder / f"carter_{part}_{facets}.msh"
    moment = share * MU * FORCE * RADIUS
    return write(
        {
            "schema": 1,
            "model": "plane_strain",
            "bodies": ["upper", "lower", "core"],
            "upper": {"type": "gmsh", "file": mesh(name("upper"), above, high), **body},
            "lower": {"type": "gmsh", "file": mesh(name("lower"), below, -deep[::-1]), **body},
            "core": {"type": "rigid", "from": "gmsh", "file": mesh(name("core"), below, np.array([-1 - deep[-1], -deep[-1]])),
                     "reference": [0, -RADIUS]},
            "supports": ["turn", "axis"],
            "turn": {"surface": "upper.ymax", "components": ["x", "y"], "value": [0, -PRESSED], "curve": [0, 0, 1, 1],
                     "origin": [0, RADIUS - PRESSED], "rotate": WAY / RADIUS, "rotate_curve": [2, 0, 3, 1]},
            "axis": {"body": "core", "components": ["x", "y"]},
            "loads": ["brake"],
            "brake": {"body": "core", "moment": moment, "curve": [1, 0, 2, 1]},
            "interfaces": [NAME, "tie"],
            NAME: {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "friction": MU, **interface},
            "tie": {"nonmortar": "lower.ymin", "mortar": "core.ymax", "law": "tied"},
            "steps": {"stages": [1, 1, 2, 2, 3, steps]},
            "output": {"vtu": "none", "csv": "all", "quiet": True},
        },
        folder / f"carter_{facets}_{share:g}_{steps}.yaml",
    )


def rolled(run):
    """(way, normal force, tangential force over what slides, creepage over that of the formula) of the steps of rolling."""
    found, before = [], run.steps[2]
    for step in run.steps[3:]:
        across, along = step["interfaces"][NAME]["force"][1], abs(step["interfaces"][NAME]["force"][0])
        half = formulas.LineContact(across, MODULUS, RADIUS / 2).half_width
        turned = [(s["rigid"]["core"]["rotation"]) for s in (before, step)]
        turned = [t[2] if isinstance(t, list) else t for t in turned]
        way = WAY * (step["t"] - before["t"])
        lag = 1 + (turned[1] - turned[0]) * RADIUS / way
        found.append((WAY * (step["t"] - 2), across, along / (MU * across), lag / creepage(along / (MU * across), half)))
        before = step
    return np.array(found)


def stick_zone(run, step=None):
    """(trailing end, leading end) of what sticks, over the half-width; the borders lie halfway between nodes. The contact moves to the
    left over the rims."""
    table = run.interface(NAME, step)
    place = table["X"] + table["ux"]
    order = np.argsort(place)
    place, state = place[order], table["state"][order]
    force = run.steps[-1 if step is None else step - 1]["interfaces"][NAME]["force"][1]
    half = formulas.LineContact(force, MODULUS, RADIUS / 2).half_width
    closed, stick = (np.flatnonzero(s) for s in (state != "gap", state == "stick"))
    edge = lambda k, l: (place[k] + place[l]) / 2
    middle = (edge(closed[0] - 1, closed[0]) + edge(closed[-1], closed[-1] + 1)) / 2
    return (edge(stick[-1], stick[-1] + 1) - middle) / half, (edge(stick[0] - 1, stick[0]) - middle) / half


def steady(run):
    """The columns of `rolled` from STEADY on."""
    return rolled(run).T[:, rolled(run)[:, 0] > STEADY]


def end_of_stick(run):
    """How far the border between stick and slip is from the formula's, over the half-width: the mean over the steps from STEADY on."""
    first, share = len(run.steps) - len(steady(run)[0]) + 1, steady(run)[2].mean()
    ends = [stick_zone(run, k)[0] for k in range(first, len(run.steps) + 1)]
    return np.mean(ends) - (2 * np.sqrt(1 - share) - 1)
