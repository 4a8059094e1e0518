"""The driver's tangent against differences of its residual, at every Newton iterate of a scene with nodes in gap, stick
and slip: once over the whole matrix by PETSc's own -snes_test_jacobian, once block by block by -test_jacobian_blocks.

The blocks are rows of forces, of multipliers, and of the multipliers of the nodes in gap, in stick and in slip, by
columns of displacements and of multipliers. Each block's Frobenius error is taken relative to the contact's own entries
in it, since those of the bodies are a hundred times larger; where the contact has none, to the whole block.
"""

import math
import re

import numpy as np

from comparisons import multiplier

# The differences err by 3e-8 (PETSc's: one-sided, with steps of ONE_SIDED) and by 1e-9 (central: see jacobian_test.c);
# leaving out one term of the tangent changes a block by 1e-3 or more.
JACOBIAN_BOUND = 1e-7
# PETSc's own step of 1.5e-8 errs by 1e-7 where facets are not flat: the curvature's part, which falls with the step.
ONE_SIDED = ("-snes_test_err", 5e-9)

# Displacements and multipliers within one order: one step of differences then suits both, and one norm sees both.
LIKE_MAGNITUDES = 10

STATES = ("gap", "stick", "slip")
BLOCKS = 10  # 5 kinds of rows, 2 of columns
# Away from the solution, too: there the projected traction is not the multiplier.
ITERATES = 3
# Quadrilaterals stay stiffer and stick less: with these, too, all three states are there.
QUADS = ("-upper_cell", "hex", "-lower_cell", "hex", "-grip_value", "0.02,0.01,-0.02", "-contact_friction", "1")
NO_FRICTION = ("-contact_law", "none", "-contact_friction", "0")
# Without slip multipliers are larger: a softer body keeps them within one order of the displacements.
ROUGH = ("-contact_law", "rough", "-contact_friction", "0", "-upper_young", "1")
DUAL = ("-contact_basis", "dual")
CURRENT = ("-contact_normals", "current")
# mu decides at some nodes that slip, the limit at others.
TRESCA = ("-contact_law", "tresca", "-contact_shear_limit", "0.1")


def finite(material, dilatation):
    both = (("material", material), ("dilatation", dilatation))
    return tuple(word for body in ("upper", "lower") for key, value in both for word in (f"-{body}_{key}", value))


VARIANTS = {
    "multiplier form": (),
    "augmented form": ("-contact_form", "augmented"),
    "multiplier form, committed weights": ("-contact_weights", "committed"),
    "augmented form, committed weights": ("-contact_form", "augmented", "-contact_weights", "committed"),
    "multiplier form, reference weights": ("-contact_weights", "reference"),
    "multiplier form, conserving weights": ("-contact_weights", "conserving"),
    "multiplier form, slip by increment": ("-contact_slip", "increment"),
    "multiplier form, quadrilaterals": QUADS,
    "augmented form, quadrilaterals": ("-contact_form", "augmented", *QUADS),
    "no friction": NO_FRICTION,
    "no friction, augmented form": (*NO_FRICTION, "-contact_form", "augmented"),
    "neo-Hooke, mean, quadrilaterals": (*QUADS, *finite("neo_hooke", "mean")),
    "neo-Hooke, augmented form": (*finite("neo_hooke", "pointwise"), "-contact_form", "augmented"),
    "St. Venant-Kirchhoff, mean, quadrilaterals": (*QUADS, *finite("st_venant_kirchhoff", "mean")),
    "rough": ROUGH,
    "dual": DUAL,
    "dual, augmented form": (*DUAL, "-contact_form", "augmented"),
    "normals of now": CURRENT,
    "normals of now, augmented form": (*CURRENT, "-contact_form", "augmented"),
    "normals of now, dual": (*CURRENT, *DUAL),
    "no friction, normals of now": (*CURRENT, *NO_FRICTION),
    "shear limit": TRESCA,
    "shear limit, augmented form": (*TRESCA, "-contact_form", "augmented"),
    "rough, augmented form": (*ROUGH, "-contact_form", "augmented"),
}
# The states that a law knows; Coulomb's all three.
LAW_STATES = {"no friction": ("gap", "slip"), "rough": ("gap", "stick")}


def jacobian(verdicts, driver):
    for name, options in VARIANTS.items():
        label = name.replace(",", "").replace(" ", "_")
        run = driver.run("jacobian_states", *options, "-snes_test_jacobian", *ONE_SIDED, "-test_jacobian_blocks", label=label)
        magnitudes(verdicts, name, run)
        whole_matrix(verdicts, name, run)
        blocks(verdicts, name, run)


def magnitudes(verdicts, name, run):
    table = run.interface("contact")
    displacement = max(np.abs(table[u]).max() for u in ("ux", "uy", "uz"))
    ratio = np.abs(multiplier(table)).max() / displacement
    verdicts.below(f"{name}: multipliers over displacements", max(ratio, 1 / ratio), LIKE_MAGNITUDES, "units chosen so")


def whole_matrix(verdicts, name, run):
    """Every evaluation of the tangent, by PETSc's own test; but for the first one where differences cross a kink there: on which side it
    lies is chance."""
    ratios = [float(r) for r in re.findall(r"\|\|J - Jfd\|\|_F/\|\|J\|\|_F = ([^,\s]+)", run.text)]
    evaluations = run.newton_iterations
    verdicts.near(f"{name}: tangents that PETSc tested", len(ratios), evaluations, 0, "one an iteration")
    kinks = run.steps[0].get("jacobian_tests", [{}])[0].get("switches", 0) > 0
    verdicts.below(f"{name}: -snes_test_jacobian", worst(ratios[kinks:]), JACOBIAN_BOUND, "one-sided differences")


def blocks(verdicts, name, run, shift=0.0):
    """Every iterate at which all the law's states are there and no difference crosses a kink; the solution must be one.
    Not the first: without multipliers yet, the contact's own entries in the rows of forces are as good as zero. `shift`: by how much the
    tangent is meant to differ where bodies are loose (closing.c), over the contact's entries."""
    states = LAW_STATES.get(name.split(",")[0], STATES)
    tests = [test for step in run.steps for test in step["jacobian_tests"]]
    complete = lambda test: all(test[state] > 0 for state in states) and test["switches"] == 0
    chosen = [test for test in tests if test["iteration"] > 0 and complete(test)]
    counts = ", ".join(f"{tests[-1][state]} {state}" for state in STATES)
    verdicts.true(f"{name}: the solution has all states", chosen and chosen[-1] is tests[-1], counts)
    verdicts.at_least(f"{name}: iterates compared block by block", len(chosen), ITERATES, f"of {len(tests)}")
    for k in range(BLOCKS if chosen else 0):
        of_iterates = [test["blocks"][k] for test in chosen]
        quantity = f"{name}: rows {of_iterates[0]['rows']}, columns {of_iterates[0]['columns']}"
        errors = [relative(block) for block in of_iterates]
        held = (of_iterates[0]["rows"], of_iterates[0]["columns"]) == ("force", "displacement")
        verdicts.below(quantity, worst(errors), JACOBIAN_BOUND + (shift if held else 0.0), "central differences")


def relative(block):
    """A block of zeros must be exactly that: such terms do not depend on the unknown at all, differences included."""
    norm = block["contact_norm"] or block["norm"]
    return block["error"] / norm if norm else math.inf if block["error"] else 0.0


def worst(errors):
    """The largest; not a number, which fails, if one is or if there are none."""
    return max(errors) if errors and all(math.isfinite(e) for e in errors) else math.nan
