"""Two more measurements of `make study`: what contact takes of a Newton iteration, against size; and Newton's last
iterations on warped facets, rule by rule."""

import study_problems

# Cells along a side of the upper block; the last one has 50 000 unknowns.
SIZES = (6, 9, 13, 19)
# From here on a run is long enough for one.
LARGE = 19
# What was aimed at, of an iteration and of the bulk's own assembly.
SHARE_BOUND, ASSEMBLY_BOUND = 0.01, 0.15
# Rules, and for comparison what leaves out a part of the tangent.
TAILS = {
    "6 points": ("-contact_quadrature", "degree_4"),
    "7 points": (),
    "12 points": ("-contact_quadrature", "degree_6"),
    "36 points": ("-contact_quadrature", "degree_10"),
    "7 points, frozen normals": ("-contact_tangent", "frozen_normals"),
    "7 points, frozen weights": ("-contact_tangent", "frozen_weights"),
}
# The ball of ball_on_block, coarse and pressed in deep, in one step: facets of half a radian around, warped by a
# hundredth of their size. The tolerance is far below what a scene would ask for: to rounding.
TAIL_OPTIONS = ("-press_value", "0,0,-0.05", "-steps_count", 1, "-steps_smallest", 1, "-snes_rtol", "1e-15",
                "-snes_max_it", 30)
TAIL_MESH = 0.08


def count(repetitions):
    large = sum(n >= LARGE for n in SIZES)
    return repetitions * (len(SIZES) - large + len(TAILS)) + large


def shares(driver, repetitions):
    """Per size: contact's part of an iteration, and its search, integration, derivatives over the bulk's assembly."""
    rows = []
    for n in SIZES:
        cells = ("-upper_cells", f"{n},{n},{n}", "-lower_cells", f"{n + 1},{n + 1},{n}")
        runs = [driver.run("two_blocks", *cells, "-output_quiet", "true", label=f"share/{n}/{k}")
                for k in range(repetitions if n < LARGE else 1)]
        run = min(runs, key=lambda each: each.summary["seconds"]["total"])
        seconds, iterations = run.summary["seconds"], run.newton_iterations
        library = seconds["search"] + seconds["integration"] + seconds["contact_assembly"]
        whole = seconds["contact_forces"] + seconds["contact_tangent"]
        spent = seconds["bulk_assembly"] + seconds["linear_solve"] + whole
        rows.append({
            "cells": n, "unknowns": run.summary["unknowns"], "newton": iterations,
            "iteration": spent / iterations, "library": library / iterations, "whole": whole / iterations,
            "bulk": seconds["bulk_assembly"] / iterations, "solve": seconds["linear_solve"] / iterations,
            "library_share": library / spent, "whole_share": whole / spent,
            "library_over_bulk": library / seconds["bulk_assembly"],
            "whole_over_bulk": whole / seconds["bulk_assembly"],
        })
    return rows


def tails(driver, repetitions):
    """Per rule: the residual norms of the last step, and what the contact's integration and tangent cost."""
    rows = []
    mesh = study_problems.ball_mesh(TAIL_MESH)
    for label, choice in TAILS.items():
        options = (*mesh, *choice, *TAIL_OPTIONS, "-output_quiet", "true")
        folder = label.replace(",", "").replace(" ", "_")
        runs = [driver.run("ball_on_block", *options, label=f"tails/{folder}/{k}") for k in range(repetitions)]
        least = lambda *keys: min(sum(r.summary["seconds"][key] for key in keys) for r in runs)
        last = runs[0].steps[-1]
        rows.append({
            "label": label, "newton": runs[0].newton_iterations, "norms": last["residual_norms"],
            "integration": least("search", "integration"), "tangent": least("contact_assembly"),
            "pairs_integrated": runs[0].summary["interfaces"]["contact"]["pairs_integrated"],
            "pairs_linearised": runs[0].summary["interfaces"]["contact"]["pairs_linearised"],
        })
    return rows
