"""Checks of the iterations of `solver: iterative` without multipliers: they hardly grow with the model, contact costs hardly more than a
tie, with friction or without, over several steps, on two ranks; and cases that are hard for multigrid do without the direct solver."""

from condensed import QUIET
from iterative import as_direct, dual
from scene import write

# Cells along an edge of the upper block: 4344 and 13140 unknowns.
SIZES = (8, 12)
# GMRES to 1e-8. Aggregates across the interface took 18 and 24 iterations where nodes slip, up to 32, and 25 without friction.
TO = ("-iterative_ksp_rtol", "1e-8")
LAWS = {"tied": ("-contact_law", "tied", "-contact_friction", "0"), "slipping": (),
        "frictionless": ("-contact_law", "none", "-contact_friction", "0")}
# Mean and most of a size; the larger one's mean over the smaller one's; over the tie's mean. Measured: 11.7, 12, 1.10, 1.16.
MEAN, MOST, GROWTH, OVER_TIED = 13, 14, 1.2, 1.25
# Scene, label, options, and how many iterations to 1e-10 a solve may take. Measured: 11, 18, 23. It was the direct solver for all of the first one, 26
# and 67.
HARD = (("third_body", "a body 1e13 times as stiff", (), 20), ("ball_on_block", "stretched cells", (), 22),
        ("two_blocks", "non-mortar body 1000 times as stiff", ("-upper_young", "2e6"), 30))
# Nothing touches it.
ALONE = {
    "schema": 1,
    "bodies": ["block"],
    "block": {"type": "box", "cells": [4, 4, 4], "lower": [0, 0, 0], "upper": [1, 1, 1], "young": 1000, "poisson": 0.3},
    "supports": ["ground", "grip"],
    "ground": {"surface": "block.zmin", "components": ["x", "y", "z"]},
    "grip": {"surface": "block.zmax", "components": ["x", "y", "z"], "value": [0.01, 0, -0.005]},
    "steps": {"count": 1},
}


def multigrid(verdicts, driver):
    means = {law: [on_blocks(verdicts, driver, law, n) for n in SIZES] for law in LAWS}
    for law, (small, large) in means.items():
        verdicts.below(f"{law}: growth of the iterations", large / small, GROWTH, f"{SIZES[1]} cells along an edge over {SIZES[0]}")
        for n, mean, tied in zip(SIZES, (small, large), means["tied"]):
            verdicts.below(f"{law}, {n} cells: over those of tied bodies", mean / tied, OVER_TIED, "means")
    on_blocks(verdicts, driver, "slipping", SIZES[0], "five steps", "-steps_count", "5")
    on_blocks(verdicts, driver, "slipping", SIZES[0], "two ranks", ranks=2)
    for scene, label, options, most in HARD:
        linear = driver.run(scene, *dual(scene), *options, *QUIET, "-unknowns", "displacements", "-solver", "iterative",
                            label=label.replace(" ", "_")).summary["linear_solver"]
        verdicts.below(f"{label}: iterations of a solve", linear["most"], most, f"{linear['iterations']} in {linear['solves']} solves")
        verdicts.true(f"{label}: without the direct solver", linear["direct"] == 0, f"{linear}")
    path, options = write(ALONE, driver.output / "alone.yaml"), (*QUIET, "-unknowns", "displacements")
    direct = driver.run(path, *options, label="alone_direct")
    as_direct(verdicts, "no interfaces", driver.run(path, *options, "-solver", "iterative", label="alone"), direct)


def on_blocks(verdicts, driver, law, n, label="", *options, ranks=1):
    """The mean of a run's solves."""
    cells = ("-upper_cells", f"{n},{n},{n}", "-lower_cells", f"{n + 1},{n + 1},{n}")
    name = ", ".join(part for part in (law, f"{n} cells", label) if part)
    linear = driver.run("two_blocks", *dual("two_blocks"), *LAWS[law], *cells, *options, *QUIET, "-unknowns", "displacements", "-solver", "iterative",
                        *TO, label=name.replace(",", "").replace(" ", "_"), ranks=ranks).summary["linear_solver"]
    mean = linear["iterations"] / linear["solves"]
    verdicts.below(f"{name}: mean of the iterations", mean, MEAN, f"{linear['iterations']} in {linear['solves']} solves")
    verdicts.below(f"{name}: most of a solve", linear["most"], MOST, "GMRES to 1e-8")
    return mean
