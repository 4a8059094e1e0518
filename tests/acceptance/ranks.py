"""Checks of contact on several ranks: states, iterations and answers are those of one rank, whatever the partition. Each rank
has a part of each interface (program/contact/parts.c)."""

import re

import numpy as np
from condensed import TIGHT
from scene import interfaces, write

# Displacements over the largest, tractions and forces over theirs: ranks add the same numbers in another order.
SAME = 1e-9
# Forces of 1e-12 of Young's modulus are the rounding of a model without strain.
NOTHING = 1e-9
# Iterations are counted down to so much of the largest first residual of a step. Ranks add in another order, so that near 1e-13 of it rounding
# decides whether one more is made.
COUNTED = 1e-9
QUIET = ("-output_csv", "all", "-output_vtu", "none", "-options_left", "no")
# Columns of an interface's table that are measured together, each group over its largest number.
GROUPS = (
    ("ux", "uy", "uz"),
    ("nx", "ny", "nz"),
    ("lambda_n", "lambda_tx", "lambda_ty", "lambda_tz"),
    ("fx", "fy", "fz"),
    ("area_covered", "area_full"),
)
CONDENSED = ("-unknowns", "displacements")

# A plate that is clamped at one end and bent down on a floor at the other, where alone it turns: one rank refuses steps that are too
# large.
BENT = {
    "schema": 1,
    "method": "paper",
    "bodies": ["plate", "floor"],
    "plate": {"type": "box", "lower": [0, 0, 0.1], "upper": [8, 1, 0.6], "cells": [16, 2, 1], "young": 1000, "poisson": 0.3},
    "floor": {"type": "box", "lower": [-1, -1, -0.5], "upper": [9, 2, 0], "cells": [7, 3, 1], "young": 1000, "poisson": 0.3},
    "supports": ["clamp", "ground", "tip"],
    "clamp": {"surface": "plate.xmin", "components": ["x", "y", "z"]},
    "ground": {"surface": "floor.zmin", "components": ["x", "y", "z"]},
    "tip": {"surface": "plate.xmax", "components": ["z"], "value": [0, 0, -0.15]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "plate.zmin", "mortar": "floor.zmax", "friction": 0.2, "turn_max": 0.03, "lag_max": 100},  # the turn alone refuses
    "steps": {"count": 1},
}

# The last of the plate's nodes below.
TIP = 50

# Two thin sheets of so many facets a side; of the pairs each of two ranks has half, and those of a row of facets across. (In
# four steps: what begins a run is done in part by both.) No node is
# carried: parts would have twelve rings of facets, which is all of such a sheet.
SHEET = ("-upper_cells", "24,24,1", "-lower_cells", "25,25,1", "-output_csv", "none", "-output_vtu", "none", "-contact_weak_coverage", -1,
         "-steps_count", 4)
SHEET_NODES = 25 * 25
SHARE = 0.58

# Scene, label, options, ranks.
SHORT = (
    ("two_blocks", "", (), (2, 3, 4)),
    ("two_blocks", "dual, carrying, condensed", ("-contact_basis", "dual", *CONDENSED), (2, 3)),
    ("two_blocks", "augmented", ("-contact_form", "augmented"), (2,)),
    ("two_blocks", "normals of now", ("-contact_normals", "current"), (3,)),
    ("ball_on_plane", "", (), (2,)),
    ("ball_on_block", "points", ("-contact_decision", "points"), (3,)),
    ("patch_tied", "", (), (3,)),
    ("rigid_punch", "", (), (2,)),
    ("klarbring", "more ranks than nodes", (), (3, 5)),
    ("plane_block", "whole", (), (2,)),
)


def ranks(verdicts, driver):
    for scene in SHORT:
        compare(verdicts, driver, *scene)
    refused(verdicts, driver)
    shares(verdicts, driver)


def compare(verdicts, driver, scene, label, options, several):
    name = f"{scene if isinstance(scene, str) else scene.stem} {label}".strip()
    tag = name.replace(" ", "_").replace(",", "")
    one = driver.run(scene, *TIGHT, *options, *QUIET, label=f"{tag}_1")
    for ranks in several:
        other = driver.run(scene, *TIGHT, *options, *QUIET, label=f"{tag}_{ranks}", ranks=ranks)
        both(verdicts, f"{name}, {ranks} ranks", scene, one, other)
    return one


def both(verdicts, name, scene, one, other):
    taken, states, differs = measured(scene, one, other)
    verdicts.true(f"{name}: iterations", taken[0] == taken[1], f"{taken[0]} and {taken[1]}")
    verdicts.true(f"{name}: states", states == 0, f"{states} differ")
    verdicts.below(f"{name}: answers", differs, SAME, "of all steps and nodes")


def measured(scene, one, other):
    """The iterations of each step of both runs, how many states differ, and by how much the answers do."""
    steps = range(1, len(one.steps) + 1)
    tables = [[run.interface(i, step) for run in (one, other)] for i in interfaces(scene) for step in steps]
    states = sum(np.count_nonzero(here["state"] != there["state"]) for here, there in tables)
    return [counted(run.steps) for run in (one, other)], states, max(apart(tables, group) for group in GROUPS)


def counted(steps):
    enough = COUNTED * max(step["residual_norms"][0] for step in steps)
    return [sum(norm > enough for norm in step["residual_norms"]) for step in steps]


def apart(tables, columns):
    """The largest difference over the largest number of its kind in any step and interface."""
    vectors = lambda table: np.stack([table[c] for c in columns], axis=1)
    largest = max(np.abs(vectors(here)).max() for here, _ in tables)
    differs = max(np.abs(vectors(there) - vectors(here)).max() for here, there in tables)
    return differs / largest if largest > NOTHING else differs


def refused(verdicts, driver):
    """One rank's refusal is a refusal of the step on all: the same cut-backs, the same answer, and its sentence has the
    numbers of the whole. Where several ranks refuse, the first of them speaks."""
    path = write(BENT, driver.output / "bent.yaml")
    one = driver.run(path, *TIGHT, *QUIET, label="bent_1")
    other = driver.run(path, *TIGHT, *QUIET, label="bent_3", ranks=3)
    both(verdicts, "bent, 3 ranks", path, one, other)
    here, there = ([attempt["why"] for attempt in run.summary["failed_attempts"]] for run in (one, other))
    verdicts.at_least("bent: refused steps", len(here), 1, here[0] if here else "none")
    words = [[re.sub(r"[0-9.]+", "#", why) for why in run] for run in (here, there)]
    verdicts.true("bent, 3 ranks: refused for the same reasons", words[0] == words[1], f"{len(there)} refusals")
    same = sum(a == b for a, b in zip(here, there))
    verdicts.at_least("bent, 3 ranks: refused by the rank of the tip alone", same, 1, f"node {TIP}: {there}")
    tip = [why for why in there if f"non-mortar node {TIP} " in why]
    verdicts.at_least("bent, 3 ranks: nodes in the interface's numbers", len(tip), 1, f"node {TIP}")


def shares(verdicts, driver):
    """Who holds and does what is told, and is balanced: with as many nodes over the other surface as beyond it, too."""
    for label, options in (("covered", ()), ("half covered", ("-lower_upper", "0.5,1,0.8"))):
        tag = label.replace(" ", "_")
        one = driver.run("two_blocks", *SHEET, *options, label=f"shares_{tag}_1")
        run = driver.run("two_blocks", *SHEET, *options, label=f"shares_{tag}_2", ranks=2)
        whole, contact = (r.summary["interfaces"]["contact"] for r in (one, run))
        nodes = sum(rank["nodes"] for rank in contact["ranks"])
        verdicts.true(f"{label}: each node is owned once", nodes == SHEET_NODES, f"{nodes} of {SHEET_NODES}")
        for kind in ("pairs_integrated", "pairs_linearised"):
            part = max(rank[kind] for rank in contact["ranks"]) / whole[kind]
            verdicts.below(f"{label}: {kind} of a rank, over those of one", part, SHARE, "half, and a row of facets")


# The rounding of its forces is above 1e-13 of them.
ROUNDED = ("-snes_rtol", "1e-11")
# Wider. Not `two_floors`, which meets a singular matrix on purpose: how many iterations lead there is rounding.
LONG = (
    ("ball_on_plane_friction", "", (), (2, 3)),
    ("block_bottom_mu02_current", "", (), (2, 3)),
    ("block_zone_mu05", "", (), (2, 3)),
    ("third_body", "", (), (2, 3)),
    ("symmetry_plane", "", (), (2, 3)),
    ("patch_flat_5_7", "", (), (2, 3)),
    ("patch_mixed", "", (), (2, 3)),
    ("patch_punch", "", (), (2, 3)),
    ("patch_shear", "", (), (2, 3)),
    ("patch_gmsh", "", (), (2, 3)),
    ("shrink_fit", "", (), (2, 3)),
    ("keys", "", (), (2,)),
    ("tied_gap", "", (), (2, 3)),
    ("press_fit", "carrying", ("-contact_weak_coverage", "0.5"), (2, 3)),
    ("turned_shaft", "", ROUNDED, (3,)),
    ("hertz_line_coarse", "", (), (2,)),
    ("incline", "", (), (2, 3)),
    ("torsion_disc", "", (), (3,)),
    ("plane_hertz", "whole", (), (2,)),
    ("ring_ball", "whole", (), (2,)),
    ("two_blocks", "dual, carrying, condensed, four ranks", ("-contact_basis", "dual", *CONDENSED), (4,)),
)


def ranks_scenes(verdicts, driver):
    for scene in LONG:
        compare(verdicts, driver, *scene)
