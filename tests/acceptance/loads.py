"""Gravity, centrifugal forces, pressures that follow their surface, moments of reactions, stresses at nodes."""

import numpy as np

from jacobian import whole_matrix
from scene import write

# Rounding of some hundred unknowns, and Newton's tolerance of 1e-11.
EXACT_BOUND = 1e-10
# Sums of forces: what Newton's tolerance leaves.
STATICS_BOUND = 1e-9
# A disc of 40 quad8 around; 1.4e-5 is measured.
DISC_BOUND = 1e-3
# A bar twelve times as long as high whose end turns under a moment: the ends' own deformation; 0.5 % is measured.
BENDING_BOUND = 0.01
# Ranks add in another order.
RANKS_BOUND = 1e-11
# The .vtu has six digits of a stress; half of the last.
STRESS_DIGITS = 1e-5
YOUNG, POISSON, DENSITY, GRAVITY = 1000.0, 0.3, 2.0, 9.81


def loads(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    column(verdicts, driver)
    disc(verdicts, driver)
    compressed(verdicts, driver)
    cantilever(verdicts, driver)
    groove(verdicts, driver)
    points(verdicts, driver)
    spread(verdicts, driver)
    spread_in_the_plane(verdicts, driver)
    turns_too_far(verdicts, driver)
    rigid_face(verdicts, driver)


def column(verdicts, driver):
    """Under its own weight, without Poisson's effect: linear cells have the exact displacements at their nodes."""
    height = 3.0
    for cell in ("hex", "tet10", "hex20"):
        scene = {
            "schema": 1,
            "bodies": ["column"],
            "column": {"type": "box", "cell": cell, "lower": [0, 0, 0], "upper": [1, 1, height], "cells": [2, 2, 5],
                       "young": YOUNG, "poisson": 0, "density": DENSITY, "small_strain": True},
            "supports": ["ground"],
            "ground": {"surface": "column.zmin", "components": ["x", "y", "z"]},
            "loads": ["weight"],
            "weight": {"body": "column", "gravity": [0, 0, -GRAVITY]},
            "steps": {"count": 1},
        }
        run = driver.run(write(scene, driver.output / f"column_{cell}.yaml"))
        points, _, u = run.mesh()
        z = points[:, 2]
        exact = DENSITY * GRAVITY / YOUNG * (z**2 / 2 - height * z)
        error = np.abs(u[:, 2] - exact).max() / np.abs(exact).max()
        verdicts.below(f"column of {cell}: displacements", error, EXACT_BOUND, "closed form")
        weight = run.steps[-1]["reactions"]["ground"][2]
        verdicts.near(f"column of {cell}: reaction", weight, DENSITY * GRAVITY * height, STATICS_BOUND, "its weight")


def disc(verdicts, driver):
    """A disc with a bore in plane stress that turns about its middle."""
    bore, outer, speed = 1.0, 3.0, 2.0
    scene = {
        "schema": 1,
        "model": "plane_stress",
        "bodies": ["disc"],
        "disc": {"type": "box", "cell": "quad8", "polar": True, "lower": [bore, 0], "upper": [outer, 90], "cells": [8, 10],
                 "young": YOUNG, "poisson": POISSON, "density": DENSITY, "small_strain": True},
        "supports": ["left", "below"],
        "left": {"surface": "disc.ymax", "components": ["x"]},
        "below": {"surface": "disc.ymin", "components": ["y"]},
        "loads": ["turn"],
        "turn": {"body": "disc", "centrifugal": speed},
        "steps": {"count": 1},
        "probes": ["rim"],
        "rim": {"body": "disc", "point": [outer, 0]},
    }
    run = driver.run(write(scene, driver.output / "turning_disc.yaml"))
    exact = DENSITY * speed**2 * outer / (4 * YOUNG) * ((1 - POISSON) * outer**2 + (3 + POISSON) * bore**2)
    verdicts.near("turning disc: its rim moves out", run.steps[-1]["probes"]["rim"][0], exact, DISC_BOUND, "closed form")


def compressed(verdicts, driver):
    """A cube under a pressure on its surface of now: the same stretch s everywhere, with Cauchy's stress -p."""
    pressure = 400.0
    shear, lame = YOUNG / (2 + 2 * POISSON), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    low, high = 0.1, 1.0
    for _ in range(100):  # bisection: the stress grows with the stretch
        s = (low + high) / 2
        low, high = (s, high) if (shear * (s**2 - 1) + 3 * lame * np.log(s)) / s**3 < -pressure else (low, s)
    for cell in ("hex", "tet10"):
        scene = {
            "schema": 1,
            "bodies": ["cube"],
            "cube": {"type": "box", "cell": cell, "x": [0, 0.3, 1], "y": [0, 0.6, 1], "z": [0, 0.45, 1], "young": YOUNG,
                     "poisson": POISSON, "material": "neo_hooke"},
            "supports": ["x", "y", "z"],
            **{axis: {"surface": f"cube.{axis}min", "components": [axis]} for axis in "xyz"},
            "loads": ["press"],
            "press": {"surface": [f"cube.{axis}max" for axis in "xyz"], "pressure": pressure, "follower": True},
            "steps": {"count": 4},
        }
        run = driver.run(write(scene, driver.output / f"compressed_{cell}.yaml"), "-snes_test_jacobian")
        points, _, u = run.mesh()
        verdicts.below(f"compressed cube of {cell}: displacements", np.abs(u - (s - 1) * points).max(), EXACT_BOUND, "closed form")
        stress = run.point_field("stress_xx_yy_zz_xy_yz_xz")
        error = np.abs(stress + pressure * np.array([1, 1, 1, 0, 0, 0])).max() / pressure
        verdicts.below(f"compressed cube of {cell}: stress at nodes", error, STRESS_DIGITS, "closed form")
        whole_matrix(verdicts, f"compressed cube of {cell}", run)


def cantilever(verdicts, driver):
    """The moment at its foot is that of the load in the deformed state."""
    scene = {
        "schema": 1,
        "bodies": ["beam"],
        "beam": {"type": "box", "lower": [0, 0, 0], "upper": [5, 1, 1], "cells": [10, 2, 2], "young": YOUNG, "poisson": POISSON,
                 "material": "neo_hooke"},
        "supports": ["foot"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"], "origin": [0, 0.5, 0.5]},
        "loads": ["tip"],
        "tip": {"surface": "beam.xmax", "traction": [0, 0, -3]},
        "steps": {"count": 2},
    }
    run = driver.run(write(scene, driver.output / "cantilever.yaml"))
    points, _, u = run.mesh()
    tip = points[:, 0] == 5
    y, z = (np.round(2 * points[tip, k]).astype(int) for k in (1, 2))
    share = np.where(y == 1, 2, 1) * np.where(z == 1, 2, 1) / 16  # of a node in the uniform traction
    arm = (points + u)[tip] - [0, 0.5, 0.5]
    moment = np.cross(arm, share[:, None] * [0, 0, -3.0]).sum(axis=0)
    found = np.array(run.steps[-1]["moments"]["foot"])
    error = np.abs(found + moment).max() / np.abs(moment).max()
    verdicts.below("cantilever: moment of the reactions and of the load", error, STATICS_BOUND, "they balance")


def groove(verdicts, driver):
    """A wedge falls through a gap into a groove of two rigid walls, at 45 and at 30 degrees, without friction: statics has
    the forces."""
    steep, flat = np.radians(45), np.radians(30)
    along = {"left": np.array([-np.cos(steep), np.sin(steep)]), "right": np.array([np.cos(flat), np.sin(flat)])}
    normal = {"left": np.array([np.sin(steep), np.cos(steep)]), "right": np.array([-np.sin(flat), np.cos(flat)])}
    numbers = lambda corners: [float(c) for point in corners for c in point]
    common = {"type": "box", "young": YOUNG, "poisson": POISSON}
    walls = {}
    for side in along:  # counterclockwise, with the wall above
        inner, outer = np.zeros(2), 2 * along[side]
        top = [inner, outer] if side == "left" else [outer, inner]
        walls[side] = {**common, "corners": numbers([p - 0.5 * normal[side] for p in top[::-1]] + top), "cells": [13, 1]}
    tip = np.array([0.0, 0.02])
    wedge = [tip, tip + 1.3 * along["right"], tip + 1.3 * along["right"] + 1.1 * along["left"], tip + 1.1 * along["left"]]
    scene = {
        "schema": 1,
        "model": "plane_strain",
        "bodies": ["wedge", "left", "right"],
        "wedge": {**common, "corners": numbers(wedge), "cells": [7, 6], "density": DENSITY, "material": "neo_hooke"},
        **walls,
        "supports": ["still"],
        "still": {"body": ["left", "right"], "components": ["x", "y"]},
        "loads": ["weight"],
        "weight": {"body": "wedge", "gravity": [0, -GRAVITY]},
        "interfaces": ["one", "two"],
        "one": {"nonmortar": "wedge.xmin", "mortar": "left.ymax"},
        "two": {"nonmortar": "wedge.ymin", "mortar": "right.ymax"},
        "steps": {"count": 1},
    }
    run = driver.run(write(scene, driver.output / "groove.yaml"))
    weight = np.array([0, -DENSITY * GRAVITY * np.cross(wedge[1] - wedge[0], wedge[3] - wedge[0])])
    one, two = np.linalg.solve(np.array([normal["left"], normal["right"]]).T, -weight)
    for name, size, side in (("one", one, "left"), ("two", two, "right")):
        force = run.resultant(name)[:2]
        error = np.abs(force - size * normal[side]).max() / np.linalg.norm(weight)
        verdicts.below(f"wedge in a groove: force of the {side} wall", error, STATICS_BOUND, "statics")


def points(verdicts, driver):
    """A bar drawn at the four nodes of its end, without Poisson's effect: the same strain everywhere."""
    force, length = 5.0, 3.0
    corners = {f"pull{k}": [float(k // 2), float(k % 2), length] for k in range(4)}
    scene = {
        "schema": 1,
        "bodies": ["bar"],
        "bar": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, length], "cells": [1, 1, 4], "young": YOUNG, "poisson": 0, "small_strain": True},
        "supports": ["ground"],
        "ground": {"surface": "bar.zmin", "components": ["x", "y", "z"]},
        "loads": list(corners),
        **{name: {"body": "bar", "point": place, "force": [0, 0, force / 4]} for name, place in corners.items()},
        "steps": {"count": 1},
    }
    path = write(scene, driver.output / "points.yaml")
    for ranks in (1, 2):
        run = driver.run(path, ranks=ranks, label=f"points_{ranks}")
        at, _, u = run.mesh()
        error = np.abs(u[:, 2] - force / YOUNG * at[:, 2]).max() * YOUNG / (force * length)
        verdicts.below(f"forces on nodes, {ranks} ranks: displacements", error, EXACT_BOUND, "closed form")
        verdicts.near(f"forces on nodes, {ranks} ranks: reaction", -run.steps[-1]["reactions"]["ground"][2], force, STATICS_BOUND, "statics")


def beam(young, length, **load):
    return {
        "schema": 1,
        "bodies": ["beam"],
        "beam": {"type": "box", "cell": "hex20", "lower": [0, 0, 0], "upper": [length, 1, 1], "cells": [int(length), 2, 2], "young": young,
                 "poisson": 0, "small_strain": True},
        "supports": ["foot"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y", "z"]},
        "loads": ["tip"],
        "tip": {"surface": "beam.xmax", **load},
        "steps": {"count": 2},
        "probes": ["top", "bottom"],
        "top": {"body": "beam", "point": [length, 0.5, 1]},
        "bottom": {"body": "beam", "point": [length, 0.5, 0]},
    }


def spread(verdicts, driver):
    """What the foot feels is force and moment; under a moment the beam bends to an arc."""
    force, moment, point = np.array([1.0, -2.0, 3.0]), np.array([4.0, 5.0, -6.0]), np.array([7.0, 2.0, -1.0])
    path = write(beam(1e9, 4.0, force=force.tolist(), moment=moment.tolist(), point=point.tolist()), driver.output / "spread.yaml")
    forces = []
    for ranks in (1, 2, 3):
        step = driver.run(path, ranks=ranks, label=f"spread_{ranks}").steps[-1]
        forces.append(np.array(step["reactions"]["foot"] + step["moments"]["foot"]))
        exact = np.concatenate([force, moment + np.cross(point, force)])
        error = np.abs(forces[-1] + exact).max() / np.abs(exact).max()
        verdicts.below(f"spread force and moment, {ranks} ranks: reactions", error, STATICS_BOUND, "statics")
    apart = max(np.abs(f - forces[0]).max() for f in forces) / np.abs(forces[0]).max()
    verdicts.below("spread force and moment: reactions on 1, 2, 3 ranks", apart, RANKS_BOUND, "the same")
    length, bend = 12.0, 0.01
    run = driver.run(write(beam(YOUNG, length, moment=[0, bend, 0]), driver.output / "bent.yaml"))
    probes = run.steps[-1]["probes"]
    turn = probes["top"][0] - probes["bottom"][0]  # over the height, 1
    verdicts.near("spread moment: turn of the end", turn, bend * length / (YOUNG / 12), BENDING_BOUND, "M L / (E I)")


def spread_in_the_plane(verdicts, driver):
    force, moment = np.array([2.0, -1.0]), 0.7
    scene = {
        "schema": 1,
        "model": "plane_stress",
        "bodies": ["beam"],
        "beam": {"type": "box", "cell": "quad8", "lower": [0, 0], "upper": [4, 1], "cells": [8, 2], "young": 1e9, "poisson": 0.3, "small_strain": True},
        "supports": ["foot"],
        "foot": {"surface": "beam.xmin", "components": ["x", "y"]},
        "loads": ["tip"],
        "tip": {"surface": "beam.xmax", "force": force.tolist(), "moment": moment},
        "steps": {"count": 1},
    }
    step = driver.run(write(scene, driver.output / "spread_plane.yaml")).steps[-1]
    exact = np.array([*force, moment + 4 * force[1] - 0.5 * force[0]])
    found = np.array([*step["reactions"]["foot"][:2], step["moments"]["foot"][2]])
    verdicts.below("spread force and moment in the plane: reactions", np.abs(found + exact).max() / np.abs(exact).max(), STATICS_BOUND, "statics")


def rigid_face(verdicts, driver):
    """A rubber bar whose end is tied to a rigid plate, under a moment and a force at the plate's reference point: the end turns far and
    keeps its shape, the foot feels both where they are now, and a plate that is turned so far needs this moment."""
    force, moment = np.array([0.0, 4.0, -10.0]), np.array([0.0, 0.0, 60.0])
    common = {
        "schema": 1,
        "bodies": ["bar", "plate"],
        "bar": {"type": "box", "young": YOUNG, "poisson": POISSON, "material": "neo_hooke", "lower": [0, 0, 0], "upper": [1, 1, 3], "cells": [2, 2, 4]},
        "plate": {"type": "rigid", "from": "box", "lower": [0, 0, 3], "upper": [1, 1, 3.2], "cells": [1, 1, 1], "reference": [0.5, 0.5, 3]},
        "supports": ["foot"],
        "foot": {"surface": "bar.zmin", "components": ["x", "y", "z"]},
        "interfaces": ["tie"],
        "tie": {"nonmortar": "bar.zmax", "mortar": "plate.zmin", "law": "tied"},
        "steps": {"count": 3},
    }
    path = write({**common, "loads": ["twist"], "twist": {"body": "plate", "force": force.tolist(), "moment": moment.tolist()}}, driver.output / "rigid_face.yaml")
    steps = []
    for ranks in (1, 2):
        run = driver.run(path, ranks=ranks, label=f"rigid_face_{ranks}")
        steps.append(run.steps[-1])
        plate = run.steps[-1]["rigid"]["plate"]
        points, cells, u = run.mesh()
        nodes = np.unique(cells["hexahedron"])
        points, u = points[nodes], u[nodes]
        end = points[:, 2] == 3
        at = lambda x: np.array([np.linalg.norm(a - b) for a in x for b in x])
        verdicts.below(f"rigid face, {ranks} ranks: its shape", np.abs(at((points + u)[end]) - at(points[end])).max(), STATICS_BOUND, "distances of its nodes")
        found = np.array(run.steps[-1]["reactions"]["foot"])
        verdicts.below(f"rigid face, {ranks} ranks: force at the foot", np.abs(found + force).max() / np.abs(force).max(), STATICS_BOUND, "statics")
        exact = moment + np.cross(np.array([0.5, 0.5, 3]) + plate["displacement"], force)
        found = np.array(run.steps[-1]["moments"]["foot"])
        verdicts.below(f"rigid face, {ranks} ranks: moment at the foot", np.abs(found + exact).max() / np.abs(exact).max(), STATICS_BOUND, "of the place of now")
    turn = np.linalg.norm(plate["rotation"])
    verdicts.at_least("rigid face: turn", turn, 0.5, "radians: far")
    apart = np.abs(np.array(steps[0]["rigid"]["plate"]["rotation"]) - steps[1]["rigid"]["plate"]["rotation"]).max()
    verdicts.below("rigid face: 1 and 2 ranks", apart, STATICS_BOUND, "the same turn")


def turns_too_far(verdicts, driver):
    """A moment whose surface turns beyond what dead arms bear is refused; a force at its middle has no arm."""
    scene = beam(YOUNG, 12.0, moment=[0, 1.0, 0])
    run = driver.run(write(scene, driver.output / "turned.yaml"), expect=2)
    verdicts.true("a spread moment that turns far: refused", "the surface of 'tip' has turned by" in run.text, "by name")
    reached = max((step["t"] for step in run.steps if step["converged"]), default=0)
    turn = reached * 12.0 / (YOUNG / 12)
    verdicts.within("a spread moment that turns far: turn of the last step", turn, 0.0, 0.021, "up to there")
    scene = beam(YOUNG, 12.0, force=[0, 0, -0.1])
    verdicts.true("a force at the middle", driver.run(write(scene, driver.output / "unarmed.yaml")).exit_code == 0, "goes on")
