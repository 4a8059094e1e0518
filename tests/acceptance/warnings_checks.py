"""What a run must say by itself: bodies that nothing holds, the material `linear` outside its range, multipliers that the
equations do not determine. And what it must not say of a problem that is as it should be."""

import math

from scene import SceneError, write

# A block on a base, both free to move along the surface unless something is added.
PUNCH = {
    "schema": 1,
    "bodies": ["punch", "base"],
    "punch": {"type": "box", "lower": [0.5, 0.5, 0.5], "upper": [1.5, 1.5, 1.5], "cells": [3, 3, 2]},
    "base": {"type": "box", "lower": [0, 0, 0], "upper": [2, 2, 0.5], "cells": [5, 5, 2]},
    "supports": ["bottom"],
    "bottom": {"surface": "base.zmin", "components": ["z"]},
    "loads": ["press"],
    # So little that the dent, in which the punch is held a little where the mesh is coarse, counts as nothing.
    "press": {"surface": "punch.zmax", "traction": [0, 0, -1]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "punch.zmin", "mortar": "base.zmax"},
    # Uniform, so that it converges, wherever it drifts.
    "steps": {"count": 1},
    "output": {"vtu": "none", "csv": "none"},
}
for body in PUNCH["bodies"]:
    PUNCH[body] |= {"young": 1000, "poisson": 0.0}

HELD, NORMAL = "x,y,z", "z"
SLIDES, ALL = "move along x, y and turn about z", "move along x, y, z and turn about x, y, z"
ALONG, BOTH = "move along x", {"punch": SLIDES, "base": SLIDES}
FRICTION, TIED = ("-contact_friction", 0.3), ("-contact_law", "tied")
# (what it is, components of the base's bottom, options, what nothing holds, what contact alone must hold)
ADRIFT = (
    ("frictionless, on a base held along z", NORMAL, (), BOTH, {"punch": ALL, "base": SLIDES}),
    ("with friction, on a base held along z", NORMAL, FRICTION, BOTH, {"punch": ALL, "base": SLIDES}),
    ("tied, to a base held along z", NORMAL, TIED, BOTH, {"punch": ALL, "base": SLIDES}),
    ("frictionless, on a base held along y, z", "y,z", (), {"punch": SLIDES, "base": ALONG}, {"punch": ALL, "base": ALONG}),
    ("frictionless, on a base that is held", HELD, (), {"punch": SLIDES}, {"punch": ALL}),
    ("with friction, on a base that is held", HELD, FRICTION, {}, {"punch": ALL}),
    ("tied, to a base that is held", HELD, TIED, {}, {"punch": ALL}),
)
# Two blocks, one on the other, that turn as one.
TURNED = {
    **PUNCH,
    "punch": PUNCH["punch"] | {"lower": [0, 0, 0.5], "upper": [2, 2, 1], "cells": [3, 3, 2]},
    "supports": ["bottom", "top"],
    "bottom": {"surface": "base.zmin", "components": ["x", "y", "z"], "rotate": [0, math.pi / 2, 0]},
    "top": {"surface": "punch.zmax", "components": ["x", "y", "z"], "rotate": [0, math.pi / 2, 0], "value": [0, 0, -0.01]},
    "contact": PUNCH["contact"] | {"friction": 0.3},
    "steps": {"count": 45},
}
del TURNED["loads"], TURNED["press"]
# Two layers tied along the middle, both clamped at a wall. Three nodes across the upper layer there face two across the lower one.
CLAMPED = {
    "schema": 1,
    "bodies": ["upper", "lower"],
    "upper": {"type": "box", "lower": [0, 0, 0.5], "upper": [3, 1, 1], "cells": [5, 2, 2], "young": 1e3, "poisson": 0},
    "lower": {"type": "box", "lower": [0, 0, 0], "upper": [3, 1, 0.5], "cells": [7, 1, 2], "young": 1e3, "poisson": 0},
    "supports": ["wall"],
    "wall": {"surface": ["upper.xmin", "lower.xmin"], "components": ["x", "y", "z"]},
    "loads": ["tip"],
    "tip": {"surface": ["upper.xmax", "lower.xmax"], "traction": [0, 0, -0.1]},
    "interfaces": ["middle"],
    "middle": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "law": "tied"},
    "steps": {"count": 1},
    "output": {"vtu": "none", "csv": "none"},
    "probes": ["end"],
    "end": {"body": "upper", "point": [3, 0, 1]},
}
OTHER_SIDE = ("-middle_nonmortar", "lower.zmax", "-middle_mortar", "upper.zmin")
# (what it is, options, ranks, are there multipliers at the wall whose conditions are surplus)
AT_THE_WALL = (
    ("three nodes over two at a wall", (), 1, True),
    ("the same on two ranks", (), 2, True),
    ("in other units", ("-upper_young", 1e11, "-lower_young", 1e11, "-tip_traction", "0,0,-1e7"), 1, True),
    ("two nodes over three", OTHER_SIDE, 1, True),
    ("two nodes over three, a thousand times stiffer", (*OTHER_SIDE, "-lower_young", 1e6), 1, True),
    ("dual, two nodes over three", (*OTHER_SIDE, "-middle_basis", "dual"), 1, True),
    ("one layer clamped alone", ("-wall_surface", "lower.xmin"), 1, False),
)
# Both layers move along the wall, or are moved apart there.
MOVED = ("-supports", "wall,other", "-wall_surface", "upper.xmin", "-other_surface", "lower.xmin", "-other_components", "x,y,z")
WARNS_HELD, WARNS_LINEAR = "nothing holds what follows", "whose material is linear"


def warnings(verdicts, driver):
    held(verdicts, driver)
    linear(verdicts, driver)
    redundant(verdicts, driver)
    lonely(verdicts, driver)


def held(verdicts, driver):
    scene = write(PUNCH, driver.output / "punch.yaml")
    for k, (what, components, options, nothing, contact) in enumerate(ADRIFT):
        run = driver.run(scene, "-bottom_components", components, *options, label=f"punch_{k}")
        found, said = run.summary.get("held_by_nothing", {}).get("bodies", {}), run.text.count(WARNS_HELD)
        verdicts.true(f"punch {what}: held by nothing {found or ''}", found == nothing, f"{nothing or 'nothing is free'}")
        verdicts.true(f"punch {what}: {said} warnings", said == bool(nothing), "once, or not at all")
        found = run.summary.get("held_by_contact", {})
        verdicts.true(f"punch {what}: contact alone holds {found}", found == contact, "a note")
    # In a frame that is turned by 90 degrees about x the punch slides along x and z.
    run = driver.run(scene, "-bottom_components", HELD, "-frame_rotate", "90,0,0", label="punch_frame")
    found = run.summary.get("held_by_nothing", {}).get("bodies", {})
    verdicts.true(f"punch, the frame turned: {found}", found == {"punch": "move along x, z and turn about y"}, "")


def linear(verdicts, driver):
    scene = write(TURNED, driver.output / "turned.yaml")
    run = driver.run(scene, label="turned_linear", expect=None)
    if run.exit_code not in (0, 2):
        raise SceneError(f"the blocks that turn ended with {run.exit_code}")
    said = run.text.count(WARNS_LINEAR)
    verdicts.true(f"turned by 90 degrees, linear: {said} warnings", said == 2, "one a body, whatever becomes of it")
    within = [v["within_range"] for v in run.summary["linear_materials"].values()]
    verdicts.true("turned by 90 degrees, linear: within range nowhere", within == [False, False], "summary.json")
    law = ("-punch_material", "neo_hooke", "-base_material", "neo_hooke")
    run = driver.run(scene, *law, label="turned_neo_hooke")
    verdicts.true("turned by 90 degrees, neo_hooke: silent", WARNS_LINEAR not in run.text, "it is right")
    # Uniform compression by the load over E.
    for pressure, warns in ((10, 0), (25, 0), (40, 2), (100, 2)):
        run = driver.run(
            write({**PUNCH, "punch": TURNED["punch"]}, driver.output / "block.yaml"),
            *("-bottom_components", HELD, *FRICTION, "-press_traction", f"0,0,-{pressure}"),
            label=f"pressed_{pressure}",
        )
        said = run.text.count(WARNS_LINEAR)
        verdicts.true(f"pressed by {pressure / 10} %, linear: {said} warnings", said == warns, "from 3 % on")
    run = driver.run("block_bottom_mu02", label="small_strain")
    silent = WARNS_LINEAR not in run.text and WARNS_HELD not in run.text
    verdicts.true("the block, with small_strain: silent", silent, "the scene says that the linear theory is meant")


def redundant(verdicts, driver):
    scene = write(CLAMPED, driver.output / "clamped.yaml")
    for k, (what, options, ranks, expected) in enumerate(AT_THE_WALL):
        run = driver.run(scene, *options, label=f"clamped_{k}", ranks=ranks)
        found = run.summary.get("redundant", {}).get("middle", {})
        at = found.get("position", [None])[0]
        verdicts.true(f"{what}: left out {found or 'nothing'}", expected == bool(found) and at in (0, None), "at the wall")
        bent = run.steps[-1]["probes"]["end"][2]
        first = bent if k == 0 else first
        if ranks == 2:
            verdicts.near("two ranks bend as one does", bent, first, 1e-9 * abs(first), "displacement of the tip")
    for value, refused in (("0,0,0.01", False), ("0,0,0", True)):
        run = driver.run(
            scene, *MOVED, "-wall_value", value, "-other_value", "0,0,0.01", label=f"moved_{refused}", expect=2 if refused else 0
        )
        told = "apart along z at (0., " in run.text
        verdicts.true(f"layers moved {'apart' if refused else 'alike'} at the wall: {'told' if told else 'silent'}", told == refused, "by the node's place")


# A disc of few cells that a plate presses on a floor: all of it on one node, or less than a facet.
DISC = {
    "schema": 1,
    "model": "plane_strain",
    "bodies": ["disc", "floor"],
    "disc": {"type": "box", "ball": [0, 0.5], "lower": [-0.5, 0], "upper": [0.5, 1], "young": 1000, "poisson": 0.3, "small_strain": True},
    "floor": {"type": "box", "lower": [-1, -1], "upper": [1, 0], "young": 1000, "poisson": 0.3},
    "supports": ["ground", "hub"],
    "ground": {"surface": "floor.ymin", "components": ["x", "y"]},
    "hub": {"body": "disc", "within": [-0.1, 0.4, 0.1, 0.6], "components": ["x", "y"], "value": [0, -0.006]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "disc.ymin", "mortar": "floor.ymax"},
    "steps": {"count": 2},
    "output": {"vtu": "none", "csv": "none"},
}
SMALLER = "the contact is smaller than its facets"


def lonely(verdicts, driver):
    for decision in ("nodes", "points"):
        for cells, told in ((8, True), (64, False)):
            scene = DISC | {name: DISC[name] | {"cells": [cells, cells]} for name in ("disc", "floor")}
            scene["contact"] = DISC["contact"] | {"decision": decision}
            run = driver.run(write(scene, driver.output / f"disc_{decision}_{cells}.yaml"), label=f"disc_{decision}_{cells}")
            verdicts.true(f"disc, {decision}, {cells} cells: {'told' if told else 'silent'}", (SMALLER in run.text) == told, "facets as large as the contact")
