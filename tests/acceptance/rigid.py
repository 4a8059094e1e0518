"""Rigid bodies with six unknowns: equilibrium exact by statics, Hertz between two flats, the same body meshed and much stiffer, a
roller that finds its own way, surfaces from files, both sides, condensed, two ranks; the tangent against differences."""

import math

import numpy as np

from jacobian import blocks
from scene import write

# Newton's tolerance is 1e-11 of the forces.
STATICS_BOUND = 1e-9
# Ten facets over the half-width.
HERTZ_BOUND = 0.02
# A plate whose modulus is 1000 times that of the block under it.
STIFF_BOUND = 1e-4
# A round roller of facets on elastic plates: measured 0.3 % beside d/2 and d/2R.
ROLLING_BOUND = 0.01
# Linear, a uniform field: the linear solver's rounding is left.
PATCH_BOUND = 1e-10
# The same answer by another way of solving, on another number of ranks, or of another description of the same body.
SAME_BOUND = 1e-9

ELASTIC = {"type": "box", "young": 1000, "poisson": 0.3, "small_strain": True}


def rigid(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    statics(verdicts, driver)
    settles(verdicts, driver)
    surfaces(verdicts, driver)
    turns(verdicts, driver)
    stiff(verdicts, driver)
    tangent(verdicts, driver)
    face(verdicts, driver)
    hertz(verdicts, driver)
    rolls(verdicts, driver)
    turned_and_pressed(verdicts, driver)
    spins_freely(verdicts, driver)
    over_parts(verdicts, driver)


def run(driver, name, scene, *options, **more):
    return driver.run(write(scene, driver.output / f"{name}.yaml"), *options, label=more.pop("label", name), **more)


def body(result, name="ball", step=-1):
    return {key: np.array(value) for key, value in result.steps[step]["rigid"][name].items()}


# --- a face that stays rigid --------------------------------------------------------------------------------------------


def face(verdicts, driver):
    """The recipe of scenes/loads.md: a bar whose face is tied to a plate that a moment turns, by half a radian a step. The forces of the tie
    turn with the plate, in systems without multipliers, too: the matrix knew that only where it had entries of the weights' derivatives, which
    ties have not, and Newton's method took two hundred times as many iterations."""
    scene = {"schema": 1, "bodies": ["bar", "plate"],
             "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 3], "cells": [2, 2, 4], "young": 1000, "poisson": 0.3, "material": "neo_hooke"},
             "plate": {"type": "rigid", "from": "box", "lower": [0, 0, 3], "upper": [1, 1, 3.2], "cells": [2, 2, 1], "reference": [0.5, 0.5, 3]},
             "supports": ["foot"], "foot": {"surface": "bar.zmin", "components": ["x", "y", "z"]},
             "interfaces": ["tie"], "tie": {"nonmortar": "bar.zmax", "mortar": "plate.zmin", "law": "tied", "basis": "dual"},
             "loads": ["twist"], "twist": {"body": "plate", "moment": [0, 0, 40], "curve": [0, 0, 1, 1]},
             "steps": {"count": 4}, "output": {"vtu": "none", "csv": "none"}}
    found = {}
    for unknowns in ("multipliers", "displacements"):
        result = run(driver, "face", {**scene, "unknowns": unknowns}, label=f"face_{unknowns}")
        found[unknowns] = [step["newton_iterations"] for step in result.steps], body(result, "plate")
    (full, one), (condensed, other) = found["multipliers"], found["displacements"]
    verdicts.true("rigid face, condensed: iterations", condensed == full, f"{condensed}, with multipliers {full}")
    verdicts.below("rigid face, condensed: turn", abs(one["rotation"][2] - other["rotation"][2]), STATICS_BOUND, "that with multipliers")
    verdicts.at_least("rigid face: turns by", one["rotation"][2], 1.0, "radians: far")


# --- a ball in a groove -------------------------------------------------------------------------------------------------
# The flanks rise by these angles; W = mass times gravity.
LEFT, RIGHT = math.radians(50), math.radians(25)
MASS, GRAVITY = 2.0, 9.81


def flank(angle, side, young, cells):
    """A block under a plane through the origin that rises to the left (-1) or to the right (1); its top is `zmax`."""
    t = np.array([side * math.cos(angle), 0, math.sin(angle)])  # up the flank
    n = np.array([-side * math.sin(angle), 0, math.cos(angle)])  # out of the block
    up = lambda s, y, depth: (s * t + np.array([0, y, 0]) - depth * n).tolist()
    first, last = (0.2, 1.8) if side > 0 else (1.8, 0.2)
    low = [up(first, -0.8, 0.6), up(last, -0.8, 0.6), up(last, 0.8, 0.6), up(first, 0.8, 0.6)]
    high = [up(first, -0.8, 0), up(last, -0.8, 0), up(last, 0.8, 0), up(first, 0.8, 0)]
    return {**ELASTIC, "young": young, "corners": sum(low + high, []), "cells": cells}


def centre():
    """Of a ball of radius 1 that touches both flanks."""
    normals = np.array([[math.sin(LEFT), math.cos(LEFT)], [-math.sin(RIGHT), math.cos(RIGHT)]])
    x, z = np.linalg.solve(normals, [1, 1])
    return np.array([x, 0, z])


def groove(ball, gap, held, young=3000, cells=(6, 6, 2), **interface):
    point = (centre() + [0, 0, gap]).tolist()
    scene = {"schema": 1, "bodies": ["ball", "left", "right"], "left": flank(LEFT, -1, young, cells), "right": flank(RIGHT, 1, young, cells),
             "ball": {"type": "rigid", "reference": point, "mass": MASS, **ball(point)},
             "supports": ["ground"], "ground": {"surface": ["left.zmin", "right.zmin"], "components": ["x", "y", "z"]},
             "loads": ["weight"], "weight": {"body": "ball", "gravity": [0, 0, -GRAVITY], "curve": [0, 0, 1, 1]},
             "interfaces": ["one", "two"], "steps": {"count": 1}, "output": {"vtu": "last"}}
    if held:
        scene["supports"].append("guide")
        scene["guide"] = {"body": "ball", "components": held}
    for name, side in (("one", "left"), ("two", "right")):
        scene[name] = {"nonmortar": f"{side}.zmax", "mortar": "ball.surface" if "surfaces" not in scene else "rim", **interface}
    return scene


def sphere(point):
    return {"from": "analytic", "shape": "sphere", "point": point, "radius": 1}


def statics(verdicts, driver):
    """A ball in closed form falls by its weight into a groove of unlike flanks, without friction."""
    for name, gap in (("touching", 0.0), ("falling", 0.05)):
        result = run(driver, f"groove_{name}", groove(sphere, gap, ["y", "rx", "ry", "rz"], normals="committed"))
        weight = MASS * GRAVITY
        # Along the normals of the step's start, the flat flanks'; those of now lean by 1e-4 with the dents.
        exact = np.linalg.solve([[math.sin(LEFT), -math.sin(RIGHT)], [math.cos(LEFT), math.cos(RIGHT)]], [0, weight])
        for interface, normal in (("one", exact[0]), ("two", exact[1])):
            force = np.linalg.norm(result.resultant(interface))
            verdicts.near(f"ball in a groove, {name}: force of flank {interface}", force, normal, STATICS_BOUND, "statics", weight)
        six = body(result)
        verdicts.near(f"ball in a groove, {name}: weight", six["contact_force"][2], weight, STATICS_BOUND, "statics", weight)
        verdicts.below(f"ball in a groove, {name}: force across", np.abs(six["contact_force"][:2]).max() / weight, STATICS_BOUND, "statics")
        moment = np.abs(six["contact_moment"] + six["reaction_moment"]).max()
        verdicts.below(f"ball in a groove, {name}: moments", moment / weight, STATICS_BOUND, "statics")


def faceted(point):
    x, y, z = point
    return {"from": "box", "ball": point, "lower": [x - 1, y - 1, z - 1], "upper": [x + 1, y + 1, z + 1], "cells": [12, 12, 12]}


SIDES = [f"ball.{axis}{end}" for axis in "xyz" for end in ("min", "max")]


def settles(verdicts, driver):
    """A ball of facets, free in six unknowns, in a soft groove, loaded by its weight and then by a moment. It starts 0.02 deep in it, so that
    friction is there at once: without it nothing tells how the ball is turned."""
    scene = groove(faceted, -0.02, None, 150, (12, 10, 3), friction=0.4)
    scene["surfaces"] = ["rim"]
    scene["rim"] = {"of": SIDES, "within": [-9, -9, -9, 9, 9, 9]}
    scene["one"]["mortar"] = scene["two"]["mortar"] = "rim"
    scene["loads"].append("turn")
    turn = np.array([0.1, 1.0, 0.2])
    scene["turn"] = {"body": "ball", "moment": turn.tolist(), "curve": [1, 0, 2, 1]}
    scene["steps"] = {"end": 2, "count": 4}
    results = {ranks: run(driver, "groove_friction", scene, label=f"groove_friction_{ranks}", ranks=ranks) for ranks in (1, 2)}
    weight = MASS * GRAVITY
    for step in (1, 3):
        six, factor = body(results[1], step=step), (step - 1) / 2
        verdicts.below(f"free ball, step {step + 1}: forces", np.abs(six["contact_force"] - [0, 0, weight]).max() / weight, STATICS_BOUND,
                       "statics")
        verdicts.below(f"free ball, step {step + 1}: moments", np.abs(six["contact_moment"] + factor * turn).max() / weight, STATICS_BOUND,
                       "statics")
        sum_of = results[1].resultant("one", step) + results[1].resultant("two", step)
        verdicts.below(f"free ball, step {step + 1}: action and reaction", np.abs(sum_of + six["contact_force"]).max() / weight,
                       STATICS_BOUND, "Newton's third law")
    one, two = (body(results[ranks]) for ranks in (1, 2))
    same(verdicts, "free ball, two ranks", one, two)


# --- surfaces from files, either side, condensed ------------------------------------------------------------------------
CORNERS = np.array([[x, y, z] for z in (0, 0.5) for y in (0.3, 0.7) for x in (0.3, 0.7)])
# Two triangles a side; some turn inward, which the reader mends.
TRIANGLES = [(0, 1, 3), (0, 3, 2), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 3, 7),
             (1, 7, 5)]


def stl_text():
    facets = ["\n".join(["facet normal 0 0 0", "outer loop", *("vertex {} {} {}".format(*CORNERS[k]) for k in t), "endloop", "endfacet"])
              for t in TRIANGLES]
    return "\n".join(["solid punch", *facets, "endsolid punch", ""])


def stl_bytes():
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    facets = np.zeros(len(TRIANGLES), record)
    facets["corners"] = [CORNERS[list(t)] for t in TRIANGLES]
    return bytes(80) + np.uint32(len(TRIANGLES)).tobytes() + facets.tobytes()


def msh_text():
    """Gmsh's format 4.1: surface elements alone."""
    nodes = [str(k + 1) for k in range(8)] + [" ".join(map(str, x)) for x in CORNERS]
    elements = [f"{k + 1} {a + 1} {b + 1} {c + 1}" for k, (a, b, c) in enumerate(TRIANGLES)]
    return "\n".join(["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "1", '2 7 "surface"', "$EndPhysicalNames", "$Entities",
                      "0 0 1 0", "1 0.3 0.3 0 0.7 0.7 0.5 1 7 0", "$EndEntities", "$Nodes", "1 8 1 8", "2 1 0 8", *nodes, "$EndNodes",
                      "$Elements", "1 12 1 12", "2 1 2 12", *elements, "$EndElements", ""])


def punch(description, surface, **interface):
    """A rigid punch pressed by a force beside its middle, and pushed, against a block."""
    scene = {"schema": 1, "bodies": ["punch", "block"],
             "punch": {"type": "rigid", "reference": [0.45, 0.52, 0.5], **description},
             "block": {**ELASTIC, "lower": [0, 0, -0.5], "upper": [1, 1, 0], "cells": [5, 5, 3]},
             "supports": ["ground"], "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
             "loads": ["press"], "press": {"body": "punch", "force": [1, 0.5, -10], "moment": [0.1, -0.2, 0.3]},
             "interfaces": ["foot"], "steps": {"count": 2}, "output": {"vtu": "last"}}
    sides = {"nonmortar": surface, "mortar": "block.zmax"}
    if interface.pop("swap", False):
        sides = {"nonmortar": "block.zmax", "mortar": surface}
    scene["foot"] = {**sides, "friction": 0.5, "new_contact": "friction", **interface}
    return scene


BOX = {"from": "box", "lower": [0.3, 0.3, 0], "upper": [0.7, 0.7, 0.5], "cells": [1, 1, 1], "cell": "tet"}


def surfaces(verdicts, driver):
    """The same cube from a box, from STL in text and binary, from surface elements of Gmsh."""
    (driver.output / "punch.stl").write_text(stl_text())
    (driver.output / "punch_binary.stl").write_bytes(stl_bytes())
    (driver.output / "punch.msh").write_text(msh_text())
    files = {"STL": {"from": "stl", "file": "punch.stl"}, "binary STL": {"from": "stl", "file": "punch_binary.stl"},
             "Gmsh's surface elements": {"from": "gmsh", "file": "punch.msh"}}
    foot = {"of": "punch.surface", "within": [0, 0, -0.1, 1, 1, 0.1]}
    reference = None
    for what, description in files.items():
        name = "cube_" + what.lower().replace(" ", "_").replace("'", "")
        scene = punch(description, "foot_only")
        scene["surfaces"] = ["face"]
        scene["face"] = foot
        scene["foot"]["nonmortar"] = "face"
        six = body(run(driver, name, scene), "punch")
        reference = reference or six
        error = np.abs(six["displacement"] - reference["displacement"]).max() / np.abs(reference["displacement"]).max()
        bound = 1e-6 if what == "binary STL" else SAME_BOUND  # single precision
        verdicts.below(f"cube from {what}: displacement", error, bound, "the same cube")
        verdicts.near(f"cube from {what}: force", six["contact_force"][2], 10, STATICS_BOUND, "statics", 10)
    cases = {"rigid side non-mortar": {}, "rigid side mortar": {"swap": True}, "mortar, dual": {"swap": True, "basis": "dual"},
             "mortar, augmented": {"swap": True, "form": "augmented"}, "non-mortar, dual": {"basis": "dual"}}
    found = {}
    for what, options in cases.items():
        scene = punch(BOX, "punch.zmin", **options)
        result = run(driver, "cube_" + what.replace(", ", "_").replace(" ", "_").replace("-", ""), scene)
        six = found[what] = body(result, "punch")
        force, moment = np.array([1, 0.5, -10]), np.array([0.1, -0.2, 0.3])
        verdicts.below(f"{what}: forces", np.abs(six["contact_force"] + force).max() / 10, STATICS_BOUND, "statics")
        verdicts.below(f"{what}: moments", np.abs(six["contact_moment"] + moment).max() / 10, STATICS_BOUND, "statics")
        verdicts.below(f"{what}: supports", np.abs(np.array(result.steps[-1]["reactions"]["ground"]) + force).max() / 10, STATICS_BOUND,
                       "statics")
    same(verdicts, "rigid side non-mortar, two ranks", found["rigid side non-mortar"],
         body(run(driver, "cube_ranks", punch(BOX, "punch.zmin"), ranks=2), "punch"))
    scene = {**punch(BOX, "punch.zmin", swap=True, basis="dual"), "unknowns": "displacements"}
    for ranks in (1, 2):
        result = run(driver, "cube_condensed", scene, label=f"cube_condensed_{ranks}", ranks=ranks)
        same(verdicts, f"condensed, {ranks} ranks", found["mortar, dual"], body(result, "punch"))


def same(verdicts, what, one, two):
    for key, value in one.items():
        verdicts.below(f"{what}: {key}", np.abs(two[key] - value).max() / max(np.abs(value).max(), 1e-3), SAME_BOUND, "the same")


# --- turns --------------------------------------------------------------------------------------------------------------
def turns(verdicts, driver):
    """A punch above the block is moved, and turned once round and a quarter about its reference point."""
    import meshio

    scene = punch({**BOX, "lower": [0.3, 0.3, 0.2], "upper": [0.7, 0.7, 0.7]}, "punch.zmin")
    turn, steps = 2.5 * math.pi, 10
    del scene["loads"], scene["press"]
    scene["supports"].append("drive")
    scene["drive"] = {"body": "punch", "components": ["x", "y", "z", "rx", "ry", "rz"], "value": [0.1, 0, 0], "rotate": [0, 0, turn]}
    scene["steps"] = {"count": steps}
    result = run(driver, "turns", scene)
    six = body(result, "punch")
    verdicts.near("turned: sum of the steps' rotations", six["rotation"][2], turn, 1e-12, "as prescribed")
    quarter = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    verdicts.below("turned: the matrix", np.abs(six["turned"].reshape(3, 3) - quarter).max(), 1e-12, "a quarter turn")
    drawn = meshio.read(result.directory / f"rigid_punch_{steps}.vtu")
    point = np.array(scene["punch"]["reference"])
    exact = point + [0.1, 0, 0] + (drawn.points - point) @ quarter.T
    verdicts.near("turned: vertices that are drawn", len(drawn.points), 8, 0, "a cube")
    verdicts.below("turned: where they are", np.abs(drawn.points + drawn.point_data["displacement"] - exact).max(), 1e-12, "a rigid motion")


# --- the same body meshed, 1000 times stiffer ---------------------------------------------------------------------------
def stiff_scene(is_rigid):
    """A plate on a block, pressed, more on its right half, and pushed along."""
    press, tilt, push, half, top = 10.0, 0.1, 0.1, 1.1, 2.0
    finite = {"type": "box", "young": 1000, "poisson": 0.3, "material": "neo_hooke"}
    box = {"lower": [-half, -half, 0], "upper": [half, half, top], "cells": [4, 4, 4]}
    scene = {"schema": 1, "bodies": ["plate", "block"],
             "plate": {"type": "rigid", "from": "box", "reference": [0, 0, top], **box} if is_rigid else
             {**finite, **box, "young": 1e6},
             "block": {**finite, "poisson": 0, "lower": [-1, -1, -8], "upper": [1, 1, 0], "cells": [3, 3, 10]},
             "supports": ["ground"], "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
             "interfaces": ["head"], "head": {"nonmortar": "block.zmax", "mortar": "plate.zmin", "friction": 0.5},
             "probes": ["a", "b", "c"], "steps": {"count": 2}}
    for name, point in (("a", [-half, -half, 0]), ("b", [half, -half, 0]), ("c", [half, half, 0])):
        scene[name] = {"body": "plate", "point": point}
    area = 4 * half**2
    if is_rigid:  # the resultants at the middle of the top
        force, moment = [push, 0, -press - tilt], [0, tilt * half / 2, 0]
        scene |= {"loads": ["press"], "press": {"body": "plate", "force": force, "moment": moment}}
    else:
        scene |= {"loads": ["press", "more"], "press": {"surface": "plate.zmax", "traction": [push / area, 0, -press / area]},
                  "surfaces": ["right"], "right": {"of": "plate.zmax", "within": [0, -2, 0, 2, 2, 9]},
                  "more": {"surface": "right", "traction": [0, 0, -tilt / (area / 2)]}}
    return scene


def stiff(verdicts, driver):
    found = {}
    for what in (True, False):
        result = run(driver, f"stiff_{what}".lower(), stiff_scene(what))
        found[what] = np.array([result.steps[-1]["probes"][name] for name in "abc"])
    error = np.abs(found[True] - found[False]).max() / np.abs(found[False]).max()
    verdicts.below("rigid plate against one 1000 times stiffer: displacement", error, STIFF_BOUND, "the meshed one")


# What holds bodies that nothing else holds is 1e-6 of the largest diagonal entry, and goes with the residual; contact's entries are a
# tenth of that at least.
SHIFT = 1e-5


# --- the tangent --------------------------------------------------------------------------------------------------------
def tangent_scene(swap):
    """As jacobian_states.yaml, but the upper body is rigid, moved in part and loaded in part."""
    low, high = (-0.6, 1.6) if swap else (0, 1)  # the mortar side covers the other one
    corners = [low, low, -0.03, high, low, 0.03, high, high, 0.04, low, high, -0.02]
    corners += [low, low, 0.5, high, low, 0.5, high, high, 0.5, low, high, 0.5]
    sides = ["upper.zmin", "lower.zmax"]
    return {"schema": 1, "bodies": ["upper", "lower"],
            "upper": {"type": "rigid", "from": "box", "cell": "tet", "cells": [3, 3, 1], "corners": corners, "reference": [0.4, 0.6, 0.3]},
            "lower": {**ELASTIC, "cell": "tet", "cells": [4, 4, 1], "young": 2.5, "lower": [-0.37, -0.43, -0.5], "upper": [1.31, 1.29, 0]},
            "supports": ["grip", "ground"],
            "grip": {"body": "upper", "components": ["x", "z", "ry"], "value": [0.03, 0, -0.04], "rotate": [0, 0.01, 0]},
            "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
            "loads": ["push"], "push": {"body": "upper", "force": [0, 0.01, 0], "moment": [0.002, 0, 0.004]},
            "interfaces": ["contact"],
            "contact": {"nonmortar": sides[swap], "mortar": sides[1 - swap], "friction": 0.3, "new_contact": "friction"},
            "steps": {"count": 1}}


def tangent(verdicts, driver):
    # Where a support turns the body about two axes by an angle, the third turn moves nodes along that axis, too.
    turned = {"components": ["z", "rx", "ry"], "value": [0, 0, -0.04], "rotate": [0.03, 0.04, 0]}
    for swap, what, grip in ((0, "rigid non-mortar side", {}), (1, "rigid mortar side", {}), (0, "rigid, turned about two axes", turned)):
        scene = tangent_scene(swap)
        scene["grip"] |= grip
        if grip:
            scene["push"]["moment"] = [0, 0, 0.004]
        result = run(driver, f"tangent_{swap}_{len(grip)}", scene, "-test_jacobian_blocks")
        blocks(verdicts, what, result, SHIFT if grip else 0.0)
        angle = np.linalg.norm(body(result, "upper")["rotation"])
        verdicts.at_least(f"{what}: turned by", angle, 1e-2, "a turn that the tangent must know")


# --- Hertz between two flats --------------------------------------------------------------------------------------------
HALF_WIDTH = 0.05
PER_WIDTH = 10


def hertz_scene():
    """A disc of radius 1, the half x > 0, between a flat that is held and one that is pressed by a force."""
    facet = HALF_WIDTH / PER_WIDTH
    fine = [facet * k for k in range(14)]
    across = fine + [0.085, 0.11, 0.15, 0.21, 0.3, 0.43, 0.6, 0.8, 1]
    down = [-1 + x for x in (0, 0.005, 0.01, 0.016, 0.024, 0.034, 0.05, 0.075, 0.11, 0.17, 0.26, 0.4, 0.6, 0.8)]
    modulus = 1000 / (1 - 0.3**2)
    force = math.pi * HALF_WIDTH**2 * modulus / 4  # of the whole disc
    flat = {"type": "rigid", "from": "box", "cells": [1, 1]}
    return {"schema": 1, "model": "plane_strain", "bodies": ["disc", "top", "bottom"],
            "disc": {**ELASTIC, "ball": [0, 0], "x": across, "y": down + [0] + [-y for y in reversed(down)]},
            "top": {**flat, "reference": [0, 1], "lower": [-0.1, 1], "upper": [0.5, 1.2]},
            "bottom": {**flat, "reference": [0, -1], "lower": [-0.1, -1.2], "upper": [0.5, -1]},
            "surfaces": ["north", "south"],
            "north": {"of": "disc.ymax", "within": [0, 0.9, 0.2, 2]}, "south": {"of": "disc.ymin", "within": [0, -2, 0.2, -0.9]},
            "supports": ["symmetry", "guide", "ground"],
            "symmetry": {"surface": "disc.xmin", "components": ["x"]},
            "guide": {"body": "top", "components": ["x", "rz"]}, "ground": {"body": "bottom", "components": ["x", "y", "rz"]},
            "loads": ["press"], "press": {"body": "top", "force": [0, -force / 2]},
            "interfaces": ["above", "below"],
            "above": {"nonmortar": "north", "mortar": "top.ymin", "round": "circle", "nonmortar_radius": 1},
            "below": {"nonmortar": "south", "mortar": "bottom.ymax", "round": "circle", "nonmortar_radius": 1},
            "steps": {"count": 1}}, force, modulus


def hertz(verdicts, driver):
    scene, force, modulus = hertz_scene()
    result = run(driver, "hertz_flats", scene)
    same(verdicts, "disc between flats, two ranks", body(result, "top"), body(run(driver, "hertz_flats", scene, label="hertz_ranks", ranks=2), "top"))
    for name in ("above", "below"):
        table = result.interface(name)
        pressing = np.abs(table["fy"])
        half_width = 2 * math.sqrt((pressing * table["X"] ** 2).sum() / pressing.sum())
        verdicts.near(f"disc between flats, {name}: half-width", half_width, HALF_WIDTH, HERTZ_BOUND, "Hertz")
    # Johnson, Contact mechanics, (5.57), of both halves.
    approach = 2 * force / (math.pi * modulus) * (2 * math.log(4 / HALF_WIDTH) - 1)
    top = body(result, "top")
    verdicts.near("disc between flats: approach", -top["displacement"][1], approach, HERTZ_BOUND, "Johnson")
    verdicts.near("disc between flats: force", top["contact_force"][1], force / 2, STATICS_BOUND, "statics", force)
    bottom = body(result, "bottom")
    verdicts.near("disc between flats: reaction", bottom["reaction_force"][1], force / 2, STATICS_BOUND, "statics", force)


# --- a roller that finds its own way ------------------------------------------------------------------------------------
DRAG, PRESS = 0.6, 0.02


def roller_scene():
    """A rigid roller between two plates, of which the upper one is pressed down and then dragged. Nothing else holds it."""
    plate = {**ELASTIC, "cells": [44, 5]}
    return {"schema": 1, "model": "plane_strain", "bodies": ["roller", "floor", "plate"],
            "roller": {"type": "rigid", "from": "box", "reference": [0, 0], "ball": [0, 0], "lower": [-1, -1], "upper": [1, 1], "cells": [24, 24]},
            "floor": {**plate, "lower": [-0.9, -1.4], "upper": [1.3, -1]}, "plate": {**plate, "lower": [-1.3, 1], "upper": [0.9, 1.4]},
            "surfaces": ["rim"], "rim": {"of": [f"roller.{side}" for side in ("xmin", "xmax", "ymin", "ymax")], "within": [-9, -9, 9, 9]},
            "supports": ["ground", "down", "drag"],
            "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
            "down": {"surface": "plate.ymax", "components": ["y"], "value": [0, -2 * PRESS], "curve": [0, 0, 1, 1]},
            "drag": {"surface": "plate.ymax", "components": ["x"], "value": [DRAG, 0], "curve": [1, 0, 2, 1]},
            "interfaces": ["low", "high"],
            "low": {"nonmortar": "floor.ymax", "mortar": "rim", "friction": 0.5, "new_contact": "friction"},
            "high": {"nonmortar": "plate.ymin", "mortar": "rim", "friction": 0.5, "new_contact": "friction"},
            "steps": {"stages": [1, 2, 2, 15]}, "output": {"vtu": "last"}}


def rolls(verdicts, driver):
    result = run(driver, "roller", roller_scene())
    start, end = body(result, "roller", 1), body(result, "roller")
    moved, turned = (end[key] - start[key] for key in ("displacement", "rotation"))
    verdicts.near("roller: its centre moves", moved[0], DRAG / 2, ROLLING_BOUND, "half as far as the plate")
    verdicts.near("roller: it turns", -turned[2], DRAG / 2, ROLLING_BOUND, "the way over the radius", DRAG / 2)
    load = np.abs(result.resultant("low")).max()
    verdicts.below("roller: forces", np.abs(end["contact_force"]).max() / load, STATICS_BOUND, "statics")
    verdicts.below("roller: moments", np.abs(end["contact_moment"]).max() / load, STATICS_BOUND, "statics")


# --- turned while it is pressed -----------------------------------------------------------------------------------------
ANGLES, PRESSED = (0.02, -0.02, 0.1), 10


def turned_and_pressed(verdicts, driver):
    """A punch that is free to move, whose turn and whose load grow in proportion: its corner is turned into the block before
    anything presses it, all that touches slips at the first iterate, and friction alone holds the punch along the block."""
    for angle in ANGLES:
        scene = {"schema": 1, "model": "plane_strain", "bodies": ["punch", "block"],
                 "punch": {"type": "rigid", "from": "box", "reference": [0.35, 0.1], "lower": [0.1, 0], "upper": [0.6, 1], "cells": [4, 2]},
                 "block": {**ELASTIC, "lower": [0, -1], "upper": [1.5, 0], "cells": [9, 5]}, "supports": ["ground", "guide"],
                 "ground": {"surface": "block.ymin", "components": ["x", "y"]},
                 "guide": {"body": "punch", "components": ["rz"], "rotate": angle},
                 "loads": ["press"], "press": {"body": "punch", "force": [0, -PRESSED]}, "interfaces": ["foot"],
                 "foot": {"nonmortar": "punch.ymin", "mortar": "block.ymax", "friction": 0.4, "new_contact": "friction"},
                 "steps": {"count": 2}, "output": {"vtu": "none", "csv": "none"}}
        result = run(driver, f"turned_and_pressed_{angle}", scene)
        six = body(result, "punch")
        verdicts.near(f"punch turned by {angle}: force", six["contact_force"][1], PRESSED, STATICS_BOUND, "statics")
        verdicts.below(f"punch turned by {angle}: force along", abs(six["contact_force"][0]) / PRESSED, STATICS_BOUND, "statics")
        verdicts.near(f"punch turned by {angle}: turn", six["rotation"][2], angle, STATICS_BOUND, "prescribed")
        verdicts.true(f"punch turned by {angle}: no step is cut", result.summary["cutbacks"] == 0, "the first step finds it")


def spins_freely(verdicts, driver):
    """A ball that falls onto a floor without friction, whose turn is left free: normals are those of the step's start, upright, so that
    nodes aside of its pole have a moment, which no turn of it ends. The run says what is missing by its name."""
    scene = {"schema": 1, "bodies": ["ball", "floor"], "ball": {"type": "rigid", "reference": [0, 0, 1.05], "mass": MASS, **sphere([0, 0, 1.05])},
             "floor": {**ELASTIC, "lower": [-1, -1, -0.6], "upper": [1.1, 1.2, 0], "cells": [9, 9, 3]}, "supports": ["ground", "guide"],
             "ground": {"surface": "floor.zmin", "components": ["x", "y", "z"]}, "guide": {"body": "ball", "components": ["x", "y"]},
             "loads": ["weight"], "weight": {"body": "ball", "gravity": [0, 0, -GRAVITY]}, "interfaces": ["foot"],
             "foot": {"nonmortar": "floor.zmax", "mortar": "ball.surface"}, "steps": {"count": 1}}
    result = run(driver, "spins_freely", scene, "-steps_smallest", "1", "-output_vtu", "none", expect=None)
    verdicts.true("ball without friction, its turn free: told", result.exit_code == 2 and "nothing tells how ball is turned" in result.text,
                  "not converged, and what to do")


# --- rolling over parts -------------------------------------------------------------------------------------------------
def rolling_scene():
    """A rigid cylinder in space that is pressed onto a block and drawn along it, across the border of two ranks' parts."""
    return {"schema": 1, "bodies": ["roller", "block"],
            "roller": {"type": "rigid", "from": "box", "reference": [-0.6, 0, 0.5], "cylinder": [-0.6, 0, 0.5], "axis": "y",
                       "lower": [-1.1, -0.3, 0], "upper": [-0.1, 0.3, 1], "cells": [8, 2, 8]},
            "block": {**ELASTIC, "lower": [-1, -0.2, -0.4], "upper": [1, 0.2, 0], "cells": [24, 2, 3]},
            "surfaces": ["rim"], "rim": {"of": ["roller.xmin", "roller.xmax", "roller.zmin", "roller.zmax"], "within": [-9, -9, -9, 9, 9, 9]},
            "supports": ["ground", "guide", "draw"], "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
            "guide": {"body": "roller", "components": ["y", "rx", "rz"]},
            "draw": {"body": "roller", "components": ["x"], "value": [1.2, 0, 0], "curve": [1, 0, 2, 1]},
            "loads": ["press"], "press": {"body": "roller", "force": [0, 0, -5], "curve": [0, 0, 1, 1]},
            "interfaces": ["contact"], "contact": {"nonmortar": "block.zmax", "mortar": "rim", "friction": 0.5, "new_contact": "friction"},
            "steps": {"stages": [1, 1, 2, 24]}, "output": {"vtu": "last", "csv": "last"}}


def over_parts(verdicts, driver):
    results = {ranks: run(driver, "rolling", rolling_scene(), label=f"rolling_{ranks}", ranks=ranks) for ranks in (1, 2)}
    one = body(results[1], "roller")
    same(verdicts, "rolling across parts", one, body(results[2], "roller"))
    verdicts.near("rolling across parts: it turns", one["rotation"][1], 1.2 / 0.5, ROLLING_BOUND, "the way over the radius", 2.4)
    verdicts.near("rolling across parts: force", one["contact_force"][2], 5, STATICS_BOUND, "statics", 5)
