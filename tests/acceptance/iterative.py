"""Checks of `solver: iterative`: multigrid on the reduced form takes Newton's method the way of the direct solver, in few
iterations, on several ranks too; and where it cannot be, or does not get through, the run says so."""

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


def iterative(verdicts, driver):
    for scene in SCENES:
        compare(verdicts, driver, *scene)
    compare(verdicts, driver, write(PRESSED, driver.output / "pressed.yaml"), "", ())
    on_two_ranks(verdicts, driver)
    with_multipliers(verdicts, driver)
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
        linear = run.summary["linear_solver"]
        reason = f"{linear['iterations']} in {linear['solves']} solves"
        verdicts.below(f"{name}: iterative against direct", difference(run, direct), SAME, "of all steps")
        more = [b - a for a, b in zip(iterations(direct), iterations(run))]
        verdicts.below(f"{name}: Newton iterations of a step, more or less by", max(map(abs, more)), FEWER, f"{more}")
        verdicts.below(f"{name}: iterations of a solve", linear["most"], MOST, reason)
        verdicts.true(f"{name}: without the direct solver", linear["direct"] == 0, reason)
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
