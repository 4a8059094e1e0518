"""Plane and axisymmetric models: patches of every kind of cell, the same scenes in space, Gmsh meshes, rings, a ball."""

import numpy as np

from formulas import shrink_fit_free
from jacobian import whole_matrix
from plane_mesh import PlaneMesh
from scene import write

# The discrete solution is the exact one: rounding of some hundred unknowns, and Newton's tolerance of 1e-11.
EXACT_BOUND = 1e-10
# A model in space of one layer has the same equations: the linear solver's rounding is left, up to 2e-12.
SAME_BOUND = 1e-9
# Nodes of both models are computed alike.
SAME_PLACE = 1e-12
# Two ranks add the same numbers in another order.
RANKS_BOUND = 1e-9
# Lame, 36 + 24 linear cells along the radius.
RING_BOUND = 1e-3
# Discs of plane stress: circles are polygons of 60 facets.
DISC_BOUND = 5e-3
# A quarter of the ball in space has other cells: both miss by parts of a per cent.
BALL_BOUND = 0.01
# Of the contact radius: where the border, which lies inside a facet, disturbs the pressure little.
WITHIN = 0.75

# Iterations are counted down to so much of the largest first residual of a step. A layer of two rows of nodes has another augmentation, and
# norms that are other sums: a norm that is within NEARLY of the limit may lie on this side or on that.
COUNTED, NEARLY = 1e-9, 10

KINDS = ("quad", "tri", "tri6", "quad8", "quad9")
MODELS = {"plane_strain": 0.7, "plane_stress": 0.7, "axisymmetric": None}
YOUNG, POISSON, PRESSURE = 1000.0, 0.3, 10.0


def plane(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    patches(verdicts, driver)
    gmsh(verdicts, driver)
    same_as_space(verdicts, driver)
    sliding(verdicts, driver)
    rings(verdicts, driver)
    discs(verdicts, driver)
    ranks_and_tangents(verdicts, driver)


def patch_scene(driver, model, lower, upper, meshed=None):
    """Two rectangles, or rings, that do not match, pressed on each other; the sides are free. `meshed`: from Gmsh files, whose
    cells turn clockwise or not."""
    common = {"type": "box", "young": YOUNG, "poisson": POISSON, "small_strain": True}
    inside = 1.0 if model == "axisymmetric" else 0.0
    scene = {
        "schema": 1,
        "model": model,
        "bodies": ["lower", "upper"],
        "lower": {**common, "cell": lower, "x": [inside + x for x in (0, 0.3, 0.7, 1.3, 2)], "y": [0, 0.4, 1]},
        "upper": {**common, "cell": upper, "x": [inside + x for x in (0, 0.5, 1.1, 2)], "y": [1, 1.7, 2]},
        "supports": ["ground"],
        "ground": {"surface": "lower.ymin", "components": ["y"]},
        "loads": ["press"],
        "press": {"surface": "upper.ymax", "pressure": PRESSURE},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "upper.ymin", "mortar": "lower.ymax", "weights": "reference"},
        "steps": {"count": 1},
        "output": {"vtu": "last", "csv": "last"},
    }
    if MODELS[model]:
        scene["thickness"] = MODELS[model]
    if model != "axisymmetric":  # a ring is held
        scene["supports"] += ["left"]
        scene["left"] = {"surface": ["lower.xmin", "upper.xmin"], "components": ["x"]}
    for body, kind in (("lower", lower), ("upper", upper)) if meshed is not None else ():
        box = scene[body]
        mesh = PlaneMesh(kind, box.pop("x"), box.pop("y"), meshed).write(driver.output / f"{body}_{kind}_{meshed}.msh")
        del box["cell"]
        box.update(type="gmsh", file=mesh.name)
    end = "" if meshed is None else f"_gmsh_{meshed}"
    return write(scene, driver.output / f"patch_{model}_{lower}_{upper}{end}.yaml"), inside


def patches(verdicts, driver):
    for model in MODELS:
        for lower, upper in zip(KINDS, KINDS[1:] + KINDS[:1]):
            path, _ = patch_scene(driver, model, lower, upper)
            error = patch_error(driver.run(path), model)
            verdicts.below(f"{model}: patch, {upper} on {lower}", error, EXACT_BOUND, "exact solution")


def gmsh(verdicts, driver):
    """Meshes from files, of first and of second order, with cells that turn either way."""
    for kind in KINDS:
        for clockwise in (False, True):
            path, _ = patch_scene(driver, "plane_strain", kind, kind, clockwise)
            error = patch_error(driver.run(path), "plane_strain")
            verdicts.below(f"{kind} from Gmsh{', clockwise' * clockwise}: patch", error, EXACT_BOUND, "exact solution")


def patch_error(run, model):
    """Of multipliers and displacements; uniaxial stress, but in plane strain nothing moves across."""
    table = run.interface("contact")
    held = table[table["state"] != "none"]
    points, _, u = run.mesh()
    free = model != "plane_strain"
    along = PRESSURE / YOUNG * (1 if free else 1 - POISSON**2)
    across = PRESSURE / YOUNG * (POISSON if free else POISSON * (1 + POISSON))
    exact = np.stack([across * points[:, 0], -along * points[:, 1], 0 * points[:, 0]], axis=1)
    return max(np.abs(held["lambda_n"] / PRESSURE + 1).max(), np.abs(u - exact).max() / np.abs(exact).max())


def compare(verdicts, label, flat, solid, axes):
    """Nodes, displacements and iterations of a plane run and of one in space whose axes (x, y) of the plane are `axes`."""
    points, _, u = flat.mesh()
    points_3, _, u_3 = solid.mesh()
    order = np.lexsort(np.round(points[:, :2].T, 9))
    places, displacements = points[order, :2], u[order, :2]
    worst = 0.0
    across = ({0, 1, 2} - set(axes)).pop()
    for layer in (points_3[:, across].min(), points_3[:, across].max()):
        of_layer = np.flatnonzero(np.abs(points_3[:, across] - layer) <= SAME_PLACE)
        found = points_3[np.ix_(of_layer, axes)]
        here = of_layer[np.lexsort(np.round(found.T, 9))]
        if len(here) != len(order) or np.abs(points_3[np.ix_(here, axes)] - places).max() > SAME_PLACE:
            continue  # of another body, wider than the layer
        worst = max(worst, np.abs(u_3[np.ix_(here, axes)] - displacements).max() / np.abs(u).max())
        break
    else:
        verdicts.failed(f"{label}: nodes", "no layer of the model in space has them")
    verdicts.below(f"{label}: displacements", worst, SAME_BOUND, "one layer in space")
    name = next(iter(flat.steps[-1]["interfaces"]))
    forces = [run.resultant(name) for run in (flat, solid)]
    scale = np.ptp(points_3[:, across]) if name == "contact" else 1.0
    error = np.abs(forces[0][:2] * scale - forces[1][list(axes)]).max() / np.abs(forces[1]).max()
    verdicts.below(f"{label}: force", error, SAME_BOUND, "one layer in space")
    different = other_iterations(flat, solid)
    verdicts.below(f"{label}: steps with other iterations", different + abs(len(flat.steps) - len(solid.steps)), 0, "one layer")


def same_as_space(verdicts, driver):
    flat, solid = driver.run("plane_hertz"), driver.run("hertz_line_coarse")
    compare(verdicts, "Hertz line", flat, solid, (0, 2))
    flat, solid = driver.run("plane_block"), driver.run("block_bottom_mu02")
    for corner in ("topleft", "topright"):
        here, there = (np.array(run.steps[-1]["probes"][corner]) for run in (flat, solid))
        error = np.abs(here[:2] - there[[0, 2]]).max() / np.abs(there).max()
        verdicts.below(f"block: {corner}", error, SAME_BOUND, "one layer in space")
    tables = [run.interface("base") for run in (flat, solid)]
    for force, of in (("fx", "fx"), ("fy", "fz")):
        here = tables[0][force]
        there = np.array([tables[1][of][np.abs(tables[1]["X"] - x) <= SAME_PLACE].sum() for x in tables[0]["X"]])
        verdicts.below(f"block: nodal {force}", np.abs(here - there).max() / 40, SAME_BOUND, "one layer, of 200 times 0.2")
    different = other_iterations(flat, solid)
    verdicts.below("block: steps with other iterations", different, 0, "one layer in space")


def other_iterations(one, other):
    """Steps that took another number of iterations."""
    most, least = zip(*([counted(run.steps, part) for part in (COUNTED / NEARLY, COUNTED * NEARLY)] for run in (one, other)))
    return sum(l0 > m1 or l1 > m0 for m0, m1, l0, l1 in zip(*most, *least))


def counted(steps, part):
    enough = part * max(step["residual_norms"][0] for step in steps)
    return [sum(norm > enough for norm in step["residual_norms"]) for step in steps]


def plates(driver, solid, basis):
    """Two plates of finite strain, pressed together and slid, with an overhang, in the plane or as a layer of thickness 0.4."""
    lift = lambda v: [v[0], 0.0, v[1]] if solid else v
    plate = lambda lower, upper, cells: {
        "type": "box", "lower": lift(lower), "upper": [upper[0], 0.4, upper[1]] if solid else upper,
        "cells": [cells[0], 1, cells[1]] if solid else cells, "young": YOUNG, "poisson": POISSON, "material": "neo_hooke",
    }
    top, bottom, up = ("zmax", "zmin", "z") if solid else ("ymax", "ymin", "y")
    scene = {
        "schema": 1,
        "bodies": ["lower", "upper"],
        "lower": plate([0.0, 0.0], [3.0, 0.6], [11, 3]),
        "upper": plate([0.2, 0.6], [1.7, 1.2], [7, 3]),
        "supports": ["ground", "press", "slide"],
        "ground": {"surface": f"lower.{bottom}", "components": ["x", up]},
        "press": {"surface": f"upper.{top}", "components": [up], "value": lift([0, -0.05]), "curve": [0, 0, 1, 1]},
        "slide": {"surface": f"upper.{top}", "components": ["x"], "value": lift([1.5, 0.0]), "curve": [1, 0, 4, 1]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": f"upper.{bottom}", "mortar": f"lower.{top}", "friction": 0.3, "basis": basis},
        "steps": {"end": 4, "count": 16},
        "output": {"vtu": "last", "csv": "last"},
    }
    if solid:
        scene["supports"] += ["slice"]
        scene["slice"] = {"body": ["lower", "upper"], "components": ["y"]}
    else:
        scene["model"] = "plane_strain"
    return write(scene, driver.output / f"plates_{'solid' if solid else 'plane'}_{basis}.yaml")


def sliding(verdicts, driver):
    for basis in ("standard", "dual"):
        flat, solid = (driver.run(plates(driver, dimension, basis)) for dimension in (False, True))
        compare(verdicts, f"sliding plates, {basis}", flat, solid, (0, 2))


def rings(verdicts, driver):
    run = driver.run("ring_shrink_fit")
    pressure = run.resultant("contact")[0] / (2 * np.pi * 10 * 2)
    exact = shrink_fit_free(0.01, 10, 1, 20, 2e5)
    verdicts.near("shrink fit of rings: mean pressure", abs(pressure), exact, RING_BOUND, "Lame, plane stress")


def discs(verdicts, driver):
    """The shrink fit once more, as plane discs, on which nothing pulls across."""
    common = {"type": "box", "polar": True, "young": 2e5, "poisson": 0.3}
    scene = {
        "schema": 1,
        "model": "plane_stress",
        "thickness": 2,
        "bodies": ["shaft", "hub"],
        "shaft": {**common, "lower": [1, 3], "upper": [10.005, 363], "cells": [12, 60]},
        "hub": {**common, "lower": [9.995, 0], "upper": [20, 360], "cells": [8, 60]},
        "supports": ["across", "along", "angle"],
        "across": {"body": "hub", "point": [20, 0], "components": ["y"]},
        "along": {"body": "hub", "within": [-0.1, -20.1, 0.1, 20.1], "components": ["x"]},
        "angle": {"body": "shaft", "point": [0.99862953, 0.05233596], "components": ["y"]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "shaft.xmax", "mortar": "hub.xmin", "weights": "reference"},
        "steps": {"count": 1},
    }
    run = driver.run(write(scene, driver.output / "discs.yaml"))
    table = run.interface("contact")
    exact = shrink_fit_free(0.01, 10, 1, 20, 2e5)
    verdicts.near("shrink fit of discs: mean pressure", table["p_lumped"].mean(), exact, DISC_BOUND, "Lame, plane stress")


def ball_scene(driver, solid):
    """ball_on_block.yaml and ring_ball.yaml on finer meshes: 12 facets, and 11, along the contact's radius of 0.114."""
    ball = [*np.linspace(0, 0.152, 17), 0.175, 0.2, 0.26, 0.32, 0.44, 0.56, 0.78, 1]
    up = [-1, -0.9905, -0.981, -0.9685, -0.956, -0.936, -0.91, -0.88, -0.84, -0.78, -0.68, -0.5, -0.25, 0]
    block = [*np.linspace(0, 0.155, 16), 0.18, 0.21, 0.26, 0.34, 0.46, 0.62, 0.85, 1.2]
    below = [-2.2, -1.8, -1.5, -1.32, -1.22, -1.16, -1.12, -1.09, -1.064, -1.044, -1.0315, -1.02, -1.01, -1]
    common = {"type": "box", "young": YOUNG, "poisson": POISSON}
    up_key, bottom, top = ("z", "zmin", "zmax") if solid else ("y", "ymin", "ymax")
    sides = {"x": ball, "y": ball} if solid else {"x": ball}
    sides_below = {"x": block, "y": block} if solid else {"x": block}
    scene = {
        "schema": 1,
        "bodies": ["ball", "block"],
        "ball": {**common, "ball": [0, 0, 0] if solid else [0, 0], **sides, up_key: up},
        "block": {**common, **sides_below, up_key: below},
        "surfaces": ["foot"],
        "foot": {"of": f"ball.{bottom}", "within": [0, 0, -1, 0.22, 0.22, 0] if solid else [0, -1, 0.22, 0]},
        "supports": ["ground", "press"],
        "ground": {"surface": f"block.{bottom}", "components": [up_key]},
        "press": {"surface": f"ball.{top}", "components": [up_key], "value": [0, 0, -0.0125] if solid else [0, -0.0125]},
        "interfaces": ["contact"],
        "contact": {"nonmortar": "foot", "mortar": f"block.{top}", "basis": "dual"},
        "steps": {"count": 2},
        "output": {"vtu": "none", "csv": "last"},
    }
    if solid:
        scene["supports"] += ["symmetryx", "symmetryy"]
        scene["symmetryx"] = {"surface": ["ball.xmin", "block.xmin"], "components": ["x"]}
        scene["symmetryy"] = {"surface": ["ball.ymin", "block.ymin"], "components": ["y"]}
    else:
        scene["model"] = "axisymmetric"
    return write(scene, driver.output / f"ball_{'solid' if solid else 'ring'}.yaml")


def plane_ball(verdicts, driver):
    """A ball on a block, as rings and as a quarter in space."""
    driver.output.mkdir(parents=True, exist_ok=True)
    ring, solid = (driver.run(ball_scene(driver, dimension)) for dimension in (False, True))
    force, whole = ring.resultant("contact")[1], 4 * solid.resultant("contact")[2]
    verdicts.near("ball on a block: force", force, whole, BALL_BOUND, "a quarter of it in space")
    largest = [hertz_pressure(run.interface("contact")) for run in (ring, solid)]
    verdicts.near("ball on a block: largest pressure", largest[0], largest[1], BALL_BOUND, "a quarter of it in space")
    return ring, solid


def hertz_pressure(table):
    """The largest pressure of the ellipse p^2 = p0^2 (1 - r^2 / a^2) that fits best within most of the contact."""
    solid = table["Z"].any()  # the height there, as y in the plane
    r, p = np.hypot(table["X"], table["Y"] if solid else 0), -table["lambda_n"]
    inside = r < WITHIN * r[p > 0].max()
    slope, square = np.polyfit(r[inside] ** 2, p[inside] ** 2, 1)
    return np.sqrt(square)


def ranks_and_tangents(verdicts, driver):
    one, two = driver.run("plane_block", label="one_rank"), driver.run("plane_block", ranks=2, label="two_ranks")
    for corner in ("topleft", "topright"):
        here, there = (np.array(run.steps[-1]["probes"][corner]) for run in (one, two))
        verdicts.below(f"two ranks: {corner}", np.abs(here - there).max() / np.abs(here).max(), RANKS_BOUND, "the same")
    for model in MODELS:
        path, inside = patch_scene(driver, model, "quad8", "tri6")
        places = ",".join(str(inside + x) for x in (0.13, 0.5, 1.1, 1.9))  # no ends that coincide: they are kinks
        options = [word for body in ("lower", "upper") for word in
                   (f"-{body}_young", "1", f"-{body}_small_strain", "false", f"-{body}_material", "neo_hooke")]
        options += ["-upper_x", places, "-contact_friction", "0.2", "-contact_weights", "current", "-press_pressure", "0.1"]
        run = driver.run(path, *options, "-snes_test_jacobian", label=f"tangent_{model}")
        whole_matrix(verdicts, f"tangent, {model}", run)
