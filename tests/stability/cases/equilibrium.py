"""What a test of convergence must not be taken in by: multiplier rows that are small because the augmentation or their unit
is, and a body that has nothing to do with the contact but large forces."""

import host
from acceptance import in_units
from cell import series
from comparisons import difference

SCENE = "block_bottom_mu02_current"
FEW = ("-steps_count", "6")  # press in three, then push until half of the bottom slips: gap, stick and slip all occur
# Answers are known to the tolerance of the contact, 1e-10, times a few.
ANSWER = 1e-9
# Below the least augmentation that has to work nothing but a refusal is allowed beside the answer.
TINY = ("1e-8", "1e-9", "1e-10", "1e-11", "1e-12", "1e-14")
LEAST = 1e-8
LARGE = ("1e1", "3e1", "1e2", "3e2", "6e2", "1e3")
NOT_IN_EQUILIBRIUM = r"the contact is not in equilibrium|states of nodes repeat|states in the last iterations"
# name: (length, stress) of the new unit in the old one
SYSTEMS = {
    "mm": (1e3, 1.0),
    "m_Pa": (1e-3, 1e6),
    "um_GPa": (1e6, 1e-3),
    "inch_psi": (1 / 25.4, 145.04),
    "1e-9_1e20": (1e-9, 1e20),
    "1e12_1e-15": (1e12, 1e-15),
}
# Young's modulus of a body elsewhere, which is compressed by a thousandth of its size; the block's is 1000.
THIRD = ("1e3", "1e7", "1e10", "1e13", "1e16", "1e20")


def compared(context, *options, length=1.0, force=1.0, scene=SCENE):
    """The Outcome of a run beside that of the default."""
    default = context.solve(SCENE, *FEW, name="default")
    run = context.solve(scene, *FEW, *options)
    result = host.outcome(run)
    if result.refusal is None:
        error = difference(run, default, length=length, force=force)
        result.below("displacements and forces", error, ANSWER, "the answer of the default")
    return result


def augmentation(scale):
    return lambda context: compared(context, "-base_augmentation_scale", scale)


def bare_rows(name):
    length, stress = SYSTEMS[name]
    options = ("-base_row_scale", "none", *in_units(length, stress))
    return lambda context: compared(context, *options, length=length, force=stress * length**2)


def third(young):
    return lambda context: compared(context, "-third_young", young, scene="third_body")


def cells():
    refuse = lambda scale: NOT_IN_EQUILIBRIUM if float(scale) < LEAST else None
    small, large = "equilibrium, augmentation far below its default", "equilibrium, augmentation above its default"
    yield from series(small, TINY, augmentation, quick=("1e-9", "1e-12"), may_refuse=refuse)
    yield from series(large, LARGE, augmentation, quick=("1e3",))
    yield from series("equilibrium, rows in their own unit", SYSTEMS, bare_rows, quick=("m_Pa",))
    yield from series("equilibrium, modulus of a third body", THIRD, third, quick=("1e13",))
