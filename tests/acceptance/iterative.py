"""Checks of `solver: iterative`: multigrid on the reduced form takes Newton's method the way of the direct solver, in few
iterations, on several ranks too; and where it cannot be, or does not get through, the run says so."""

import numpy as np
from condensed import FEWER, QUIET, difference, iterations
from scene import interfaces, write

# Answers: of all steps, over the largest displacement and the model's forces.
SAME = 1e-8
# GMRES to 1e-10 of the true residual. 1e-8, which takes a fifth less, is what docs/accuracy.md counts.
MOST = 60
# Scene, label, options; the interfaces of all get dual multipliers.
SCENES = (("block_bottom_mu02", "", ()), ("two_blocks", "", ()), ("ball_on_block", "", ()))
LONG = (
    ("two_blocks", "stiff above", ("-upper_young", "1e5")),
    ("two_blocks", "held by contact", ("-grip_components", "z", "-contact_friction", "1")),
    ("two_blocks", "finer below", ("-lower_cells", "17,17,8")),
    ("two_blocks", "finer above", ("-upper_cells", "16,16,8")),
    ("two_blocks", "nearly incompressible", ("-upper_poisson", "0.45", "-lower_poisson", "0.45")),
    ("cattaneo_line", "", ()),
    ("patch_tied", "", ()),
    ("jacobian_states", "", ()),
    ("hertz_line_coarse", "", ()),
    ("hertz_line_fine", "", ()),
    ("turned_shaft", "", ("-snes_rtol", "1e-9")),  # its steps begin at 1e-13 of the forces: rounding would decide whether to iterate
)


# A sheet pressed on another one that does not move: each node that is free is one of the contact, and multigrid has no body to know.
SHEET = {"type": "box", "cells": [4, 4, 1], "young": 1000, "poisson": 0.3}
PRESSED = {
    "schema": 1,
    "bodies": ["upper", "lower"],
    "upper": {**SHEET, "lower": [0.03, 0.03, 0], "upper": [1.03, 1.03, 0.05]},
    "lower": {**SHEET, "lower": [0, 0, -0.05], "upper": [1, 1, 0]},
    "supports": ["ground", "grip", "guide"],
    "ground": {"surface": ["lower.zmin", "lower.zmax"], "components": ["x", "y", "z"]},
    "grip": {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0.03, 0, -1e-4]},
    "guide": {"surface": "upper.zmin", "components": ["x", "y"], "value": [0.03, 0, 0]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax"},
    "steps": {"count": 1},
}


# A block between a rigid plate and a rigid tool in closed form, in a frame that is turned; both are pressed and turned by forces, and the plate has a
# support that lets it go.
RIGID = {
    "schema": 1,
    "bodies": ["block", "plate", "tool"],
    "block": {"type": "box", "cells": [4, 4, 6], "lower": [0, 0, 0], "upper": [1, 1, 0.6], "young": 1000, "poisson": 0.3},
    "plate": {"type": "rigid", "from": "box", "lower": [-0.2, -0.2, 0.6], "upper": [1.2, 1.2, 0.8], "cells": [3, 3, 1], "reference": [0.5, 0.5, 0.7]},
    "tool": {"type": "rigid", "from": "analytic", "shape": "cylinder", "point": [-0.7, 0.5, 0.3], "direction": [0, 1, 0], "radius": 0.7, "reference": [-0.7, 0.5, 0.3]},
    "supports": ["foot", "hold", "guide"],
    "foot": {"surface": "block.zmin", "components": ["x", "y", "z"]},
    "hold": {"body": "plate", "components": ["rx", "ry", "rz"], "until": 0.5},
    "guide": {"body": "tool", "components": ["rx", "ry", "rz"]},
    "loads": ["press", "push"],
    "press": {"body": "plate", "force": [0.5, 0.2, -8], "moment": [0.2, 0.1, 0.05]},
    "push": {"body": "tool", "force": [2, 0.2, -0.1]},
    "interfaces": ["top", "side"],
    "top": {"nonmortar": "block.zmax", "mortar": "plate.zmin", "friction": 0.4},
    "side": {"nonmortar": "flank", "mortar": "tool.surface", "friction": 0.3},
    "surfaces": ["flank"],
    "flank": {"of": "block.xmin", "within": [-0.1, -0.1, 0.1, 0.1, 1.1, 0.4]},
    "frame": {"rotate": [20, 10, 5]},
    "steps": {"count": 2},
}


def with_rigid(verdicts, driver):
    """Rigid bodies beside multigrid, in both kinds of systems, on ranks: tools and rollers with equations of their own."""
    path = write(RIGID, driver.output / "rigid.yaml")
    all_held = {body: {"body": body, "components": ["x", "y", "z", "rx", "ry", "rz"], "value": [0, 0, -0.01] if body == "plate" else [0.005, 0, 0]} for body in ("plate", "tool")}
    held = write({**{k: v for k, v in RIGID.items() if k not in ("loads", "press", "push", "hold")}, "supports": ["foot", "grip", "guide"], "grip": all_held["plate"],
                  "guide": all_held["tool"]}, driver.output / "rigid_held.yaml")
    swapped = write({**RIGID, "top": {"nonmortar": "plate.zmin", "mortar": "block.zmax", "friction": 0.4}}, driver.output / "rigid_swapped.yaml")
    for scene, name, options, ranks in (
        (path, "rigid bodies, condensed", (*dual(path), "-unknowns", "displacements"), (1, 3)),
        (path, "rigid bodies, multipliers", (), (1, 2)),
        (path, "rigid bodies, augmented", ("-top_form", "augmented", "-side_form", "augmented"), (1,)),
        (swapped, "rigid bodies, non-mortar", (), (1, 2)),
        (held, "rigid bodies that are held, multipliers", (), (1, 2)),
        ("roller", "roller, condensed", (*dual("roller"), "-unknowns", "displacements"), (1,)),
        ("roller", "roller, multipliers", (), (1,)),
    ):
        tag = name.replace(",", "").replace(" ", "_")
        direct = driver.run(scene, *options, *QUIET, label=f"{tag}_direct")
        for n in ranks:
            run = driver.run(scene, *options, *QUIET, "-solver", "iterative", label=f"{tag}_iterative_{n}", ranks=n)
            as_direct(verdicts, f"{name}, {n} ranks", run, direct)
        where = [np.array(step["rigid"][body]["displacement"]) for step in run.steps for body in step["rigid"]]
        there = [np.array(step["rigid"][body]["displacement"]) for step in direct.steps for body in step["rigid"]]
        verdicts.below(f"{name}: where they are", max(np.abs(a - b).max() for a, b in zip(where, there)) / max(np.abs(b).max() for b in there), SAME, "of all steps")


def as_direct(verdicts, name, run, direct):
    linear = run.summary["linear_solver"]
    reason = f"{linear['iterations']} in {linear['solves']} solves"
    verdicts.below(f"{name}: iterative against direct", difference(run, direct), SAME, "of all steps")
    more = [b - a for a, b in zip(iterations(direct), iterations(run))]
    verdicts.below(f"{name}: Newton iterations of a step, more or less by", max(map(abs, more)), FEWER, f"{more}")
    verdicts.below(f"{name}: iterations of a solve", linear["most"], MOST, reason)
    verdicts.true(f"{name}: without the direct solver", linear["direct"] == 0, reason)


def iterative(verdicts, driver):
    for scene in SCENES:
        compare(verdicts, driver, *scene)
    compare(verdicts, driver, write(PRESSED, driver.output / "pressed.yaml"), "", ())
    on_two_ranks(verdicts, driver)
    with_multipliers(verdicts, driver)
    with_rigid(verdicts, driver)
    gives_up(verdicts, driver)


def iterative_scenes(verdicts, driver):
    for scene in LONG:
        compare(verdicts, driver, *scene)


def dual(scene):
    return [word for i in interfaces(scene) for word in (f"-{i}_basis", "dual", f"-{i}_weak_coverage", "0")]


def compare(verdicts, driver, scene, label, options):
    name = f"{scene if isinstance(scene, str) else scene.stem} {label}".strip()
    tag = name.replace(" ", "_")
    options = (*dual(scene), *options, *QUIET, "-unknowns", "displacements")
    direct = driver.run(scene, *options, label=f"{tag}_direct")
    run = driver.run(scene, *options, "-solver", "iterative", label=f"{tag}_iterative")
    linear = run.summary["linear_solver"]
    reason = f"{linear['iterations']} in {linear['solves']} solves"
    verdicts.below(f"{name}: iterative against direct", difference(run, direct), SAME, "of all steps")
    more = [b - a for a, b in zip(iterations(direct), iterations(run))]
    steps = f"{direct.newton_iterations} with the direct solver, {run.newton_iterations} without"
    verdicts.below(f"{name}: Newton iterations of a step, more or less by", max(map(abs, more)), FEWER, steps)
    verdicts.below(f"{name}: Newton iterations of the run, more by", sum(more), FEWER, steps)
    verdicts.below(f"{name}: iterations of a solve", linear["most"], MOST, reason)
    verdicts.true(f"{name}: without the direct solver", linear["direct"] == 0, reason)


# With multipliers among the unknowns: scene, label, options, ranks. Supports hold each body, or the form is augmented.
MULTIPLIERS = (
    ("two_blocks", "multipliers", (), 1),
    ("two_blocks", "multipliers, two ranks", (), 2),
    ("ball_on_plane", "multipliers", (), 1),
    ("symmetry_plane", "multipliers", (), 2),
    ("two_blocks", "augmented, held by contact", ("-grip_components", "z", "-contact_friction", "1", "-contact_form", "augmented"), 1),
)


def with_multipliers(verdicts, driver):
    """Multigrid on the bodies, LU for the multipliers: the answers of the direct solver; a body that contact alone holds is refused."""
    for scene, label, options, ranks in MULTIPLIERS:
        name = f"{scene} {label}"
        tag = name.replace(",", "").replace(" ", "_")
        options = (*options, *QUIET)
        direct = driver.run(scene, *options, label=f"{tag}_direct")
        run = driver.run(scene, *options, "-solver", "iterative", label=f"{tag}_iterative", ranks=ranks)
        as_direct(verdicts, name, run, direct)
    held = ("-grip_components", "z", "-contact_friction", "1", *QUIET, "-solver", "iterative")
    run = driver.run("two_blocks", *held, label="held_by_contact_alone", expect=1)
    verdicts.true("multipliers, held by contact alone: refused by name", "solver: a body is held by contact alone" in run.text, "exit code 1")


def on_two_ranks(verdicts, driver):
    options = (*dual("two_blocks"), *QUIET, "-unknowns", "displacements", "-solver", "iterative")
    one = driver.run("two_blocks", *options, label="one_rank")
    two = driver.run("two_blocks", *options, label="two_ranks", ranks=2)
    verdicts.below("two ranks against one", difference(two, one), SAME, "of all steps")
    verdicts.below("two ranks: iterations of a solve", two.summary["linear_solver"]["most"], MOST, "GMRES")


def gives_up(verdicts, driver):
    """With hardly any iterations allowed, every system goes to the direct solver, and the run says it once."""
    options = (*dual("two_blocks"), *QUIET, "-unknowns", "displacements", "-solver", "iterative")
    run = driver.run("two_blocks", *options, "-iterative_ksp_max_it", "2", label="gives_up")
    linear = run.summary["linear_solver"]
    verdicts.true("two iterations: the direct solver does it", linear["direct"] == linear["solves"] > 0, f"{linear}")
    times = " ".join(run.text.split()).count("multigrid does not solve a linear system")
    verdicts.true("two iterations: said once", times == 1, f"{times} times")
