"""General contact of random bodies, convex and hollow, thrown and dropped on each other and on a floor, spinning, with friction and without: nobody
passes through anybody, contact gives no energy, and its forces balance."""

import host
import numpy as np
from cell import series
from plane_mesh import PlaneMesh

SEEDS = tuple(range(24))
STEPS, END = 50, 0.5
# A corner of one body may be in a facet of another one, for gaps are means over facets: so far, over the longer of the facets there.
DEEPEST = 0.5
# What contact may give over all steps, over the largest energy: what Newton's method leaves. More must be told by the run: where the end of a body
# slides off a facet at the border of a piece, its sliver gives some (docs/general_contact.md).
GIVEN = 1e-9
# Of the forces of contact on all bodies, over the largest.
BALANCE = 1e-9


def convex(random):
    """Between an ellipse and a rectangle: from the square of side 2 to the body."""
    size, power = 0.48 * random.uniform(0.6, 1.0, 2), 1 + random.uniform(1, 4)

    def shape(p):
        out, way = np.abs(p).max(), np.arctan2(p[1], p[0])
        radius = (np.abs(np.cos(way)) ** power + np.abs(np.sin(way)) ** power) ** (-1 / power)
        round_, straight = size * out * radius * np.array([np.cos(way), np.sin(way)]), 0.7 * size * p
        return out * round_ + (1 - out) * straight

    return shape, (int(random.integers(4, 8)),) * 2


def hollow(random):
    """A bar that is bent to an arc."""
    half, radius, thick = random.uniform(0.8, 1.6), random.uniform(0.3, 0.38), random.uniform(0.16, 0.24)

    def shape(p):
        r, way = radius + thick / 2 * p[1], half * p[0]
        return np.array([r * np.sin(way), r * np.cos(way) - 0.7 * radius])

    return shape, (int(random.integers(10, 16)), 2)


class Body:
    """A mesh in a file, and its outline: nodes once around, by their places in the undeformed body."""

    def __init__(self, random, centre, path):
        shape, cells = (hollow if random.random() < 0.4 else convex)(random)
        angle = random.uniform(0, 2 * np.pi)
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        place = lambda p: turn @ shape(np.asarray(p, dtype=float)) + centre
        x, y = (np.linspace(-1, 1, n + 1) for n in cells)
        path.parent.mkdir(parents=True, exist_ok=True)
        self.file = PlaneMesh("quad", x, y, False, place).write(path)
        around = [*((s, -1) for s in x[:-1]), *((1, t) for t in y[:-1]), *((s, 1) for s in x[:0:-1]), *((-1, t) for t in y[:0:-1])]
        self.outline = np.array([place(p) for p in around])


def crowd(context, seed):
    """The scene, and its bodies' outlines."""
    random = np.random.default_rng(seed)
    places = random.permutation([(i, j) for i in range(2) for j in range(2)])[: random.integers(2, 5)]
    places -= [0, places[:, 1].min()]  # somebody is near the floor
    mu, scene = float(random.choice([0.0, 0.2, 0.5])), {}
    bodies = [Body(random, np.array([1.0, 0.55]) + 1.02 * place, context.folder / f"body{k}.msh") for k, place in enumerate(places)]
    middle = 1.02 * places.mean(axis=0)
    for k, (body, place) in enumerate(zip(bodies, places)):
        velocity = random.uniform(1, 3) * (middle - 1.02 * place) + random.uniform(-0.3, 0.3, 2) - [0, 2]
        scene[f"body{k}"] = {"type": "gmsh", "file": str(body.file), "young": 1000 * random.uniform(0.5, 3), "poisson": 0.3, "material": "neo_hooke",
                             "density": 1, "velocity": velocity.round(6).tolist(), "spin": round(random.uniform(-3, 3), 6)}
    scene |= {
        "schema": 1,
        "model": "plane_strain",
        "bodies": [*scene, "floor"],
        "floor": {"type": "box", "lower": [0, -0.3], "upper": [3, 0], "cells": [30, 3], "young": 2000, "poisson": 0.3, "material": "neo_hooke", "density": 1},
        "supports": ["ground"],
        "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
        "loads": ["weight"],
        "weight": {"body": [f"body{k}" for k in range(len(bodies))], "gravity": [0, -10]},
        "dynamics": {"rho_inf": 1},
        "contact": "all",
        "friction": mu,
        "steps": {"count": STEPS, "end": END},
        "output": {"vtu": "all", "csv": "none"},
    }
    return scene, [body.outline for body in bodies]


def find(points, X):
    """Numbers of the nodes that are at X in the undeformed bodies."""
    return np.array([np.linalg.norm(points[:, :2] - x, axis=1).argmin() for x in X])


def inside(points, ring):
    """Which points are inside a closed line: it goes around them."""
    a, b = ring[None] - points[:, None], np.roll(ring, -1, axis=0)[None] - points[:, None]
    turned = np.arctan2(a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0], (a * b).sum(axis=2))
    return np.abs(turned.sum(axis=1)) > np.pi


def depth(rings):
    """How far any node of an outline is inside another one, over the longer of the facets there, its own and those of the other."""
    found, lengths = 0.0, [np.linalg.norm(np.roll(ring, -1, axis=0) - ring, axis=1) for ring in rings]
    for k, ring in enumerate(rings):
        others = np.vstack([other for j, other in enumerate(rings) if j != k])
        own = np.hstack([np.maximum(length, np.roll(length, 1)) for j, length in enumerate(lengths) if j != k])
        a, b = ring, np.roll(ring, -1, axis=0)
        for node in np.flatnonzero(inside(others, ring)):
            part = np.clip(((others[node] - a) * (b - a)).sum(axis=1) / lengths[k] ** 2, 0, 1)[:, None]
            away = np.linalg.norm(a + part * (b - a) - others[node], axis=1)
            found = max(found, away.min() / max(own[node], lengths[k][away.argmin()]))
    return found


def thrown(seed):
    def run(context):
        scene, outlines = crowd(context, seed)
        whole = context.solve(scene)
        result = host.outcome(whole)
        if result.refusal is not None:
            return result
        width = np.linspace(0, 3, 31)
        outlines = [*outlines, np.array([[0, -0.3], [3, -0.3], *([s, 0] for s in width[::-1])])]
        points = whole.mesh(1)[0]
        nodes = [find(points, outline) for outline in outlines]
        deepest = 0.0
        for step in range(1, len(whole.steps) + 1):
            moved = points[:, :2] + whole.mesh(step)[2][:, :2]
            deepest = max(deepest, depth([moved[ring] for ring in nodes]))
        table = np.genfromtxt(whole.directory / "energy.csv", delimiter=",", names=True)
        result.below("depth", deepest, DEEPEST, "nobody passes through anybody")
        given = table["contact_gain"][-1] / (table["kinetic"] + table["strain"]).max()
        result.true("contact gives nothing, or it is told", given < GIVEN or "energy_told" in whole.summary, f"{given:.2g} of the energy")
        if given >= GIVEN:
            result.warnings.append(f"contact gives {given:.2g} of the energy, and it is told")
        forces = np.array(list(whole.summary["general_contact"]["forces"].values()))
        result.below("sum of the forces", np.abs(forces.sum(axis=0)).max() / max(np.abs(forces).max(), 1.0), BALANCE, "balance")
        result.true("somebody has met somebody", np.abs(table["contact_work"]).max() > 0, "they are thrown at each other")
        result.figures |= {"depth": deepest, "given": given, "made": whole.summary["general_contact"]["made"]}
        return result

    return run


def cells():
    yield from series("general: bodies thrown at each other, seed", SEEDS, thrown, quick=(0,))
