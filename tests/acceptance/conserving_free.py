"""Contact that conserves: free blocks that meet keep momentum and moment, in the plane and in space, linear and quadratic, standard and dual; ranks and
restarts of what slides, swings and meets; losses are told by what the bodies have at most."""

import numpy as np

from conserving import ITERATIONS, KINDS, conserves, iterations, named
from conserving_scenes import bowl, fall, free_blocks, slide
from dynamics import energy, run, total
from restart import BITS, COSTS, KEEP

# Momentum and its moment where Newton's method is asked for rounding; with friction that of a node whose gap is open half way.
KEPT, KEPT_FRICTION = 1e-12, 1e-4
TIGHT = ("-snes_rtol", "1e-14")
# Ranks add in another order, and steps add up what that makes.
RANKS_BOUND = 1e-10
# A loss from which on it is told.
TOLD = 0.01


def conserving_free(verdicts, driver):
    driver.output.mkdir(parents=True, exist_ok=True)
    counts = meets(verdicts, driver)
    verdicts.below("Newton iterations a step, mean over the scenes", np.mean(counts), ITERATIONS, f"of {len(counts)} scenes")
    ranks(verdicts, driver)
    goes_on(verdicts, driver)
    told(verdicts, driver)


# --- two free blocks ------------------------------------------------------------------------------------------------------
def meets(verdicts, driver):
    taken = []
    for d in (2, 3):
        for kind in (*KINDS[d], {"friction": 0.3}):
            what = named("free blocks,", "plane" if d == 2 else "space", **kind).replace("_", " ")
            result = run(driver, "blocks", free_blocks(d, **kind), *TIGHT, label=named("blocks", d, **kind))
            table = conserves(verdicts, what, result)
            for name, bound in (("momentum", KEPT), ("angular", KEPT_FRICTION if "friction" in kind else KEPT)):
                vector = np.array([table[f"{name}_{axis}"] for axis in "xyz"])
                verdicts.below(f"{what}: {name}", np.abs(vector - vector[:, :1]).max() / np.linalg.norm(vector[:, 0]), bound, "kept")
            verdicts.at_least(f"{what}: they meet", -table["contact_work"].min() / total(table)[0], TOLD, "contact takes what nodes lose that meet")
            verdicts.true(f"{what}: it is told", "impact" in result.summary.get("energy_told", {}), "more than 1 % of the energy")
            if "friction" not in kind:
                taken.append(iterations(result))
    return taken


# --- the driver ---------------------------------------------------------------------------------------------------------
def ranks(verdicts, driver):
    """1, 2 and 3 ranks."""
    scenes = {"slide": slide(10), "bowl": bowl(4, steps=60, end=0.6), "blocks": free_blocks(2, friction=0.3), "blocks_in_space": free_blocks(3, steps=20)}
    for name, scene in scenes.items():
        base = energy(run(driver, f"ranks_{name}", scene, *TIGHT))
        for n in (2, 3):
            other = energy(run(driver, f"ranks_{name}", scene, *TIGHT, label=f"ranks_{name}_{n}", ranks=n))
            apart = max(np.abs(other[key] - base[key]).max() for key in ("kinetic", "strain", "contact_work", "friction_dissipation")) / total(base).max()
            verdicts.below(f"{name}, {n} ranks", apart, RANKS_BOUND, "energies as on one")


def goes_on(verdicts, driver):
    """From the restart file of each step: the same bits."""
    for name, scene in {"bowl": bowl(4, steps=12, end=0.3), "blocks": free_blocks(2, steps=16, friction=0.3), "slide_in_space": slide(1, 3, steps=6)}.items():
        whole = run(driver, f"goes_on_{name}", scene, *BITS, *KEEP)
        differ = []
        for step in range(1, len(whole.steps)):
            again = run(driver, f"goes_on_{name}", scene, *BITS, *KEEP, "-restart", whole.directory / f"restart_{step}.bin", label=f"goes_on_{name}_again")
            differ += [(step, key) for key in whole.summary if key not in COSTS and whole.summary[key] != again.summary.get(key)]
        verdicts.true(f"{name}: restart from each of {len(whole.steps) - 1} steps", not differ, str(differ) if differ else "those bits")


def told(verdicts, driver):
    """A loss is told by what the bodies have at most, not by what they have in a first step: blocks that fall from a hair's breadth and from high up, and one that
    gets more energy up to the end."""
    for what, scene, when in (("by a hair", fall(1e-6, 40, 0.2), None), ("far", fall(0.05, 60, 0.3), "at the impact"), ("by little, drawn along", fall(1e-3, 10, 0.03, 5), "at the end")):
        result = run(driver, "fall", scene, label=f"fall_{what}".replace(" ", "_").replace(",", ""))
        e, note = total(energy(result)), result.summary.get("energy_told", {}).get("impact")
        found = note and ("at the end" if note["t"] == result.steps[-1]["t"] and np.diff(e).min() > 0 else "at the impact")
        verdicts.true(f"a block falls {what}: its loss is told", found == when, str(found))
