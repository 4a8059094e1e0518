"""Checks of systems without multipliers (`unknowns: displacements`): the answers and Newton's path are those with
multipliers, a solver that exchanges no rows gets through, and what cannot be condensed is refused by name."""

import numpy as np
from scene import SceneError, interfaces, write
from slider import SPRINGS, SWAPPED, SWAPPED_MESH, travel

# Both systems are solved to rounding of their forces: Newton's iterations are then those that it takes, not those that a
# residual just below or above the tolerance makes.
TIGHT = ("-snes_rtol", "1e-13")
# Displacements over the largest, forces over all of the model's; without row exchanges pivots of 1e-3 of the largest cost three digits.
SAME, UNPIVOTED = 1e-10, 1e-9
# An answer that is met a digit earlier saves an iteration.
FEWER = 1
QUIET = ("-output_csv", "none", "-output_vtu", "none")
# A slider that is pushed by its top: no node of the contact is prescribed. It leaves the channel's end.
PUSHED = ("-push_surface", "slider.zmax", "-slider_cells", "12,1,3")
OFF_THE_END = (*travel(1475, 25), *PUSHED, *SPRINGS, "-contact_weak_coverage", "0.5")

# Scene, label, options; the interfaces of all get dual multipliers. The first carry nodes.
SCENES = (
    ("press_fit", "swapped", (*SWAPPED, *SWAPPED_MESH)),
    ("press_fit", "off the end", OFF_THE_END),
    ("block_zone_mu05", "", ()),
    ("block_bottom_mu02", "", ()),
    ("block_bottom_mu02_current", "", ()),
    ("symmetry_plane", "", ("-snes_rtol", "1e-11")),  # the rounding of its forces is 3e-12 of them
    ("third_body", "", ()),
    ("patch_shear", "", ()),
    ("keys", "", ()),
    ("two_blocks", "", ()),
    ("ball_on_block", "", ()),
    ("jacobian_states", "", ()),
    ("shrink_fit", "", ()),
    ("rigid_punch", "", ()),
    ("patch_flat_5_7", "", ()),
    ("patch_tied", "", ()),
    ("patch_mixed", "", ()),
    ("patch_punch", "", ()),
)
LONG = (
    ("hertz_line_coarse", "", ()),
    ("cattaneo_line", "", ()),
    ("shrink_fit_out", "", ()),
    ("turned_shaft", "", ()),
    ("mindlin", "", ()),
)
CARRYING = 2
# Scene, options, exit code, words of the refusal.
REFUSED = (
    ("tied_beam", ("dual",), 1, "middle.nonmortar: 'wall' prescribes u_x of its node at [0., 0., 0.5]: with `unknowns: displacements`"),
    ("press_fit", ("dual",), 1, "contact.nonmortar: 'push' prescribes u_x of its node at [0., 0., 250.]: with `unknowns: displacements`"),
    ("two_blocks", ("standard",), 3, "condensation with standard multipliers"),
    ("two_blocks", ("dual", "-contact_form", "augmented"), 3, "asked for by `unknowns: displacements`"),
    ("two_blocks", ("dual", "-contact_decision", "points", "-contact_weights", "committed"), 3, "or take `decision: nodes`"),
)


def condensed(verdicts, driver):
    carrying = sum(compare(verdicts, driver, *scene) for scene in SCENES)
    verdicts.at_least("scenes with carried nodes", carrying, CARRYING, "of those above")
    open_everywhere(verdicts, driver)
    for scene, (basis, *options), code, words in REFUSED:
        refuse(verdicts, driver, scene, (basis, *options), code, words)


def open_everywhere(verdicts, driver):
    """A block that is lifted off another: forces on the other are the rounding of the first one's, and nothing else."""
    box = {"type": "box", "young": 1000, "poisson": 0.3}
    scene = {
        "schema": 1,
        "bodies": ["block", "ground"],
        "block": box | {"lower": [0, 0, 0.01], "upper": [1, 1, 0.51], "cells": [2, 2, 2]},
        "ground": box | {"lower": [-1, -1, -1], "upper": [2, 2, 0], "cells": [2, 2, 1]},
        "supports": ["still", "lift"],
        "still": {"surface": "ground.zmin", "components": ["x", "y", "z"]},
        "lift": {"surface": "block.zmax", "components": ["x", "y", "z"], "value": [0, 0, 0.01]},
        "interfaces": ["base"],
        "base": {"nonmortar": "block.zmin", "mortar": "ground.zmax", "friction": 0.3, "basis": "dual"},
        "steps": {"count": 2},
        "unknowns": "displacements",
    }
    run = driver.run(write(scene, driver.output / "open.yaml"), *QUIET, label="open")
    verdicts.true("a block that is lifted off: both steps at once", not run.summary["failed_attempts"], "nothing acts")


def condensed_full(verdicts, driver):
    """Minutes."""
    for scene in LONG:
        compare(verdicts, driver, *scene)


def compare(verdicts, driver, scene, label, options):
    """Whether nodes are carried."""
    name = f"{scene} {label}".strip()
    dual = [word for i in interfaces(scene) for word in (f"-{i}_basis", "dual", f"-{i}_weak_coverage", "0")]
    options = (*dual, *TIGHT, *options, *QUIET)
    tag = name.replace(" ", "_")
    whole = driver.run(scene, *options, label=f"{tag}_multipliers")
    small = driver.run(scene, *options, "-unknowns", "displacements", label=f"{tag}_displacements")
    plain = ("-unknowns", "displacements", "-pc_factor_mat_solver_type", "petsc")
    unpivoted = driver.run(scene, *options, *plain, label=f"{tag}_unpivoted")
    verdicts.below(f"{name}: condensed against multipliers", difference(small, whole), SAME, "of all steps")
    more = [b - a for a, b in zip(iterations(whole), iterations(small))]
    reason = f"{whole.newton_iterations} with multipliers, {small.newton_iterations} without"
    verdicts.below(f"{name}: Newton iterations of a step, more or less by", max(map(abs, more)), FEWER, reason)
    verdicts.below(f"{name}: Newton iterations of the run, more by", sum(more), FEWER, reason)
    pivot = unpivoted.summary.get("least_pivot")
    reason = f"least pivot {pivot:.1e} of the largest" if pivot else "nothing to solve"
    verdicts.below(f"{name}: without row exchanges", difference(unpivoted, whole), UNPIVOTED, reason)
    return any(of["nodes_carried"] > 0 for of in small.summary["interfaces"].values())


def iterations(run):
    return [step["newton_iterations"] for step in run.steps]


def difference(run, other):
    """Largest difference of displacements, over the largest, and of forces, over the model's."""
    if [s["t"] for s in run.steps] != [s["t"] for s in other.steps]:
        raise SceneError("the runs took different steps")
    worst = 0.0
    for kinds in (("probes",), ("reactions", "interfaces")):
        found, expected = (np.array([vectors(step, kinds) for step in r.steps]) for r in (run, other))
        if found.size:
            scale = np.abs(expected).max() if kinds == ("probes",) else max(s["reference_force"] for s in other.steps)
            worst = max(worst, np.abs(found - expected).max() / scale)
    return worst


def vectors(step, kinds):
    values = []
    for kind in kinds:
        for of in step[kind].values():
            values.extend(of["force"] if isinstance(of, dict) else of)
    return values


def refuse(verdicts, driver, scene, options, code, words):
    basis, *options = options
    given = [word for i in interfaces(scene) for word in (f"-{i}_basis", basis)]
    run = driver.run(scene, *given, *options, "-unknowns", "displacements", label=f"{scene}_{basis}_refused", expect=code)
    verdicts.true(f"{scene}, {' '.join((basis, *options))}: refused", words in " ".join(run.text.split()), words)
