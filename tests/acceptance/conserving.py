"""Contact that conserves, in the plane and in space, linear and quadratic, standard and dual: what slides neither sinks nor rises, what swings in a
bowl comes up as high as it was, nothing gains; order and iterations. Minutes; conserving_free.py has more, and what is quick."""

import math

import numpy as np

from conserving_scenes import SWING, bowl, slide
from dynamics import energy, run, total

# The block rests 0.001 deep, and swings to twice that; coarse facets on coarse facets add half of that at most.
STATIC, DEEPEST = 0.001, 3
# What no step may give, over the energy of the scene; what the run may lose of it: at the first touch of a block that begins to swing.
NEVER_UP, LOST = 1e-10, 1e-5
# Degrees, of each of nine swings.
SWING_BOUND = 0.05
# A bowl's energy, over all of it: what nodes that come back into contact stop. 4 x 4, 8 x 8, 16 x 16 cells.
BOWL_LOST = {4: 1e-3, 8: 2e-4, 16: 1e-4}
# Of Newton's method, a step, in the mean over these scenes; finer meshes may take as many.
ITERATIONS, FINER = 3.5, 1.1
# Its default tolerance, over the forces.
NEWTON = 1e-11
# Of an observed order, on halvings in which nodes open and close at other times.
ORDER_BOUND = 0.5

KINDS = {2: ({}, {"basis": "dual"}, {"cell": "quad8"}, {"cell": "quad9", "basis": "dual"}), 3: ({}, {"basis": "dual"}, {"cell": "hex20"}, {"cell": "hex27", "basis": "dual"})}


def conserving(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    counts = slides(verdicts, driver) + swings(verdicts, driver)
    verdicts.below("Newton iterations a step, mean over the scenes", np.mean(counts), ITERATIONS, f"of {len(counts)} scenes")
    order(verdicts, driver)


def named(*parts, **more):
    return "_".join(str(part) for part in (*parts, *more.values()))


def conserves(verdicts, what, result):
    """Neither gains nor, by more than its impacts, loses; returns energy.csv."""
    table = energy(result)
    kept = total(table) - table["external_work"]
    verdicts.true(f"{what}: weights", result.summary["weights"]["c"] == {"weights": "conserving"}, "those that conserve")
    verdicts.below(f"{what}: what a step gives", np.diff(kept).max() / total(table).max(), NEVER_UP, "of the energy: nothing")
    return table


def iterations(result):
    """Of Newton's method, a step, down to its default tolerance."""
    of = lambda step: sum(norm <= NEWTON * step["reference_force"] for norm in step["residual_norms"][:-1])
    return np.mean([step["newton_iterations"] - of(step) for step in result.steps])


# --- slides -------------------------------------------------------------------------------------------------------------
def slides(verdicts, driver):
    """Over 100 facets; over ten, and in space over three, with every kind of facets."""
    cases = [(100, 2, {})] + [(10, 2, kind) for kind in KINDS[2][1:]] + [(3, 3, kind) for kind in KINDS[3]]
    taken = []
    for facets, d, kind in cases:
        what = named("slides over", facets, "facets,", "plane" if d == 2 else "space", **kind).replace("_", " ")
        result = run(driver, "slide", slide(facets, d, **kind), label=named("slide", facets, d, **kind))
        table = conserves(verdicts, what, result)
        heights = np.array([step["probes"]["corner"][d - 1] for step in result.steps])
        verdicts.within(f"{what}: lowest place over the static one", -heights.min() / STATIC, 1, DEEPEST, "nothing sinks, and it rests on its floor")
        verdicts.below(f"{what}: what contact takes", -table["contact_work"].min() / total(table).max(), LOST, "of the energy: hardly anything")
        taken.append(iterations(result))
    return taken


# --- a bowl -------------------------------------------------------------------------------------------------------------
def angles(result):
    """Of the block's middle from the lowest place, in degrees."""
    start = math.radians(SWING - 90)
    x = np.array([0.9 * math.cos(start), 0.9 * math.sin(start)]) + np.array([step["probes"]["middle"][:2] for step in result.steps])
    return np.degrees(np.arctan2(x[:, 0], -x[:, 1]))


def tops(angle):
    """The angles at which it turns back, by a parabola through three steps each."""
    a = np.abs(angle)
    found = []
    for k in range(1, len(a) - 1):
        if a[k - 1] <= a[k] > a[k + 1] and a[k] > SWING / 2:
            square, slope, value = np.polyfit([-1, 0, 1], a[k - 1 : k + 2], 2)
            found.append(value - slope**2 / (4 * square))
    return np.array(found)


def swings(verdicts, driver):
    """Nine swings from SWING degrees with linear cells, coarse and fine; the first with the others, and in space."""
    cases = [(n, 2, {}, 1050, 10.5) for n in BOWL_LOST] + [(4, 2, kind, 120, 1.2) for kind in KINDS[2][1:]] + [(4, 3, kind, 120, 1.2) for kind in KINDS[3][:3]]
    taken, by_cells = [], {}
    for n, d, kind, steps, end in cases:
        what = named("bowl,", n, "cells,", "plane" if d == 2 else "space", **kind).replace("_", " ")
        result = run(driver, "bowl", bowl(n, d, steps=steps, end=end, **kind), label=named("bowl", n, d, **kind))
        table, found = conserves(verdicts, what, result), tops(angles(result))
        verdicts.true(f"{what}: swings", len(found) >= (9 if end > 10 else 1), f"{len(found)}")
        verdicts.below(f"{what}: angles at which it turns back", np.abs(found[:9] - SWING).max(), SWING_BOUND, "as far up as it was")
        verdicts.below(f"{what}: what contact takes", -table["contact_work"].min() / total(table).max(), BOWL_LOST[n], "of the energy: hardly anything")
        verdicts.true(f"{what}: no loss is told", "energy_told" not in result.summary, "it starts with none, from which contact takes a part of nothing")
        taken.append(iterations(result))
        by_cells.setdefault(n, taken[-1])
    verdicts.below("bowl: iterations, 16 x 16 cells over 4 x 4", by_cells[16] / by_cells[4], FINER, f"{by_cells[4]:.3g} and {by_cells[16]:.3g}")
    return taken


def order(verdicts, driver):
    """The angle after 0.48 s, as steps are halved."""
    ends = [angles(run(driver, "order", bowl(4, steps=n, end=0.48), label=f"order_{n}"))[-1] for n in (40, 80, 160, 320)]
    errors = np.abs(np.diff(ends))
    verdicts.near("bowl: order in dt", math.log2(errors[0] / errors[-1]) / 2, 2, ORDER_BOUND, ", ".join(f"{e:.2g}" for e in errors) + " degrees")
