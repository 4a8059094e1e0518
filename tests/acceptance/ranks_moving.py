"""Contact on several ranks that moves: parts get new mortar facets and the partition follows the contact, and the answers stay those
of one rank. A process that is killed ends the run."""

import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
from condensed import TIGHT
from mpi import environment
from ranks import CONDENSED, QUIET, both, compare
from scene import SceneError, write

# A block that slides over four times its length of a rail, across all that any partition has.
SLIDING = {
    "schema": 1,
    "bodies": ["block", "rail"],
    "block": {"type": "box", "lower": [0.1, 0.1, 0.5], "upper": [1.1, 0.9, 1], "cells": [4, 3, 2], "young": 1000, "poisson": 0.3},
    "rail": {"type": "box", "lower": [0, 0, 0], "upper": [6, 1, 0.5], "cells": [21, 4, 1], "young": 2000, "poisson": 0.3},
    "supports": ["ground", "grip"],
    "ground": {"surface": "rail.zmin", "components": ["x", "y", "z"]},
    "grip": {"surface": "block.zmax", "components": ["x", "y", "z"], "value": [4, 0.03, -0.01], "curve": [0, 0, 1, 1]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "block.zmin", "mortar": "rail.zmax", "friction": 0.3},
    "steps": {"count": 10},
}
# The same with the multipliers on the rail: what is in contact wanders over the partition. Hardly covered nodes are carried, so parts have
# twelve rings of facets: the rail is long enough for many more.
WANDERING = {
    **SLIDING,
    "rail": {**SLIDING["rail"], "upper": [14, 1, 0.5], "cells": [49, 4, 1]},
    "grip": {**SLIDING["grip"], "value": [12, 0.03, -0.01]},
    "contact": {"nonmortar": "rail.zmax", "mortar": "block.zmin", "friction": 0.3},
    "steps": {"count": 24},
}
# Steps beyond any margin: parts get more mortar facets within them. Four times the length of the block in four of them.
LEAPING = {**SLIDING, "steps": {"count": 4}}
# Meshes that overlap by more than two facets, and a clearance of as much: bodies that touch, pressed and drawn along.
DEEP = {
    "schema": 1,
    "bodies": ["upper", "lower"],
    "upper": {"type": "box", "lower": [0.1, 0.1, -0.3], "upper": [2.9, 1, 0.7], "cells": [22, 7, 1], "young": 1000, "poisson": 0.3},
    "lower": {"type": "box", "lower": [0, 0, -1], "upper": [3, 1.1, 0], "cells": [25, 8, 1], "young": 2000, "poisson": 0.3},
    "supports": ["ground", "grip"],
    "ground": {"surface": "lower.zmin", "components": ["x", "y", "z"]},
    "grip": {"surface": "upper.zmax", "components": ["x", "y", "z"], "value": [0.03, 0.01, -0.005]},
    "interfaces": ["contact"],
    "contact": {"nonmortar": "upper.zmin", "mortar": "lower.zmax", "friction": 0.3, "offset": 0.3},
    "steps": {"count": 2},
}
# The mortar facets that lie near two facets of margin, two rings and a step of the block are less than this part of all.
PART_OF_RAIL = 0.8
# A run that has lost a process ends within so many seconds.
ENDS = 60


# Scene, label, options: on four and eight ranks, however few processors there are.
MANY = (
    ("two_blocks", "", ()),
    ("two_blocks", "dual, carrying, condensed", ("-contact_basis", "dual", *CONDENSED)),
    ("ball_on_plane_friction", "", ()),
    ("patch_tied", "", ()),
    ("third_body", "", ()),
    ("block_zone_mu05", "", ()),
)


# Half a tube that is pressed into a slab and drawn along it, of linear materials: a curved surface, and the other way round one with few
# of the slab's facets near.
IRONING = ("-die_file", "../meshes/ironing_tube_coarse.msh", "-slab_cells", "36,4,2", "-down_value", "0,0,-0.3", "-steps_stages", "1,3,2,8",
           "-slab_material", "linear", "-die_material", "linear")
SWAPPED = ("-contact_nonmortar", "die.contact", "-contact_mortar", "slab.zmax")


def ranks_moving(verdicts, driver):
    wandering(verdicts, driver, (3,))
    sliding(verdicts, driver, (2,))
    killed(verdicts, driver)


def ranks_many(verdicts, driver):
    for scene, label, options in MANY:
        compare(verdicts, driver, scene, label, options, (4, 8))
    sliding(verdicts, driver, (4, 8))
    wandering(verdicts, driver, (4, 8))
    leaping(verdicts, driver, (2, 4))
    moving(verdicts, driver, "leaping near", LEAPING, (3,), ("-contact_search_distance", "0.2", "-contact_form", "augmented"))
    # None of these steps is too long for its weights: after such a one rounding would decide how long the next ones are.
    moving(verdicts, driver, "sliding of frozen weights", SLIDING, (3,), ("-contact_weights", "committed", "-steps_count", 40))
    compare(verdicts, driver, "ironing_3d", "", IRONING, (3,))
    compare(verdicts, driver, "ironing_3d", "swapped", (*IRONING, *SWAPPED), (3,))
    deep(verdicts, driver, (3, 8))


def moving(verdicts, driver, what, scene, several, options=()):
    """A slide whose parts are renewed, and shared out anew, equals one rank's. Returns the runs on several ranks."""
    path = write(scene, driver.output / f"{what.split()[0]}.yaml")
    tag = what.replace(" ", "_")
    one = driver.run(path, *TIGHT, *options, *QUIET, label=f"{tag}_1")
    runs = []
    for ranks in several:
        runs.append(driver.run(path, *TIGHT, *options, *QUIET, label=f"{tag}_{ranks}", ranks=ranks))
        both(verdicts, f"{what}, {ranks} ranks", path, one, runs[-1])
        contact = runs[-1].summary["interfaces"]["contact"]
        anew = contact["halo_grown"] + contact["halo_renewed"] + contact["rebalanced"]
        verdicts.at_least(f"{what}, {ranks} ranks: shared out anew", anew, 4, "times")
    return runs


def sliding(verdicts, driver, several):
    runs = moving(verdicts, driver, "sliding", SLIDING, several)
    for run in runs:
        verdicts.at_least("sliding: new mortar facets", run.summary["interfaces"]["contact"]["halo_renewed"], 4, "times")
    held = max(rank["mortar_facets_held"] for rank in runs[0].summary["interfaces"]["contact"]["ranks"])
    verdicts.below("sliding: mortar facets of a rank, over all", held / 84, PART_OF_RAIL, "at the end")
    moving(verdicts, driver, "sliding dual condensed", SLIDING, several, ("-contact_basis", "dual", *CONDENSED))


def wandering(verdicts, driver, several):
    for run in moving(verdicts, driver, "wandering", WANDERING, several):
        contact = run.summary["interfaces"]["contact"]
        verdicts.at_least("wandering: the partition has followed", contact["rebalanced"], 1, "times")


def leaping(verdicts, driver, several):
    for what, options in (("leaping", ()), ("leaping dual condensed", ("-contact_basis", "dual", *CONDENSED))):
        for run in moving(verdicts, driver, what, LEAPING, several, options):
            grown = run.summary["interfaces"]["contact"]["halo_grown"]
            verdicts.at_least(f"{what}: more mortar facets within steps", grown, 1, "times")


def deep(verdicts, driver, several):
    """Offsets, and bodies that start several facets deep in each other, in parts."""
    path = write(DEEP, driver.output / "deep.yaml")
    one = driver.run(path, *TIGHT, *QUIET, label="deep_1")
    for ranks in several:
        run = driver.run(path, *TIGHT, *QUIET, label=f"deep_{ranks}", ranks=ranks)
        both(verdicts, f"deep, {ranks} ranks", path, one, run)
        owners = [rank["nodes"] for rank in run.summary["interfaces"]["contact"].get("ranks", [])]
        verdicts.at_least(f"deep, {ranks} ranks: parts with nodes", sum(n > 0 for n in owners), ranks, f"{owners}")


def killed(verdicts, driver):
    """One process of three is killed after the first steps: the run ends, and what it has written can be read."""
    scene = {**SLIDING, "steps": {"count": 400}}
    path = write(scene, driver.output / "killed.yaml")
    directory = driver.output / "killed"
    directory.mkdir(parents=True, exist_ok=True)
    for old in directory.glob("interface_*.csv"):
        old.unlink()
    command = ["mpirun", "--oversubscribe", "-n", "3", str(driver.program), "-scene", str(path), "-output_dir", str(directory), *QUIET]
    process = subprocess.Popen(command, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        third = directory / "interface_contact_0003.csv"
        deadline = time.monotonic() + ENDS
        while not list(directory.glob("interface_contact_*3.csv")) and process.poll() is None and time.monotonic() < deadline:
            time.sleep(0.05)
        ranks = children(process.pid)
        if len(ranks) != 3 or process.poll() is not None:
            raise SceneError(f"killed: {len(ranks)} processes of three, and {third.name} was waited for")
        os.kill(ranks[-1], signal.SIGKILL)
        start = time.monotonic()
        code = process.wait(timeout=ENDS)
        verdicts.below("killed: seconds to the end of the run", time.monotonic() - start, ENDS, f"exit code {code}")
        verdicts.true("killed: the run has failed", code != 0, f"exit code {code}")
    except subprocess.TimeoutExpired:
        verdicts.failed("killed: the run goes on", f"after {ENDS} s")
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()
    tables = sorted(directory.glob("interface_contact_*.csv"))[:2]
    rows = [np.genfromtxt(table, delimiter=",", names=True, dtype=None, encoding="ascii").size for table in tables]
    verdicts.true("killed: earlier steps can be read", rows == [20, 20], f"{rows} nodes")


def children(pid):
    """The processes that one has started, and still has."""
    found = []
    for status in Path("/proc").glob("[0-9]*/stat"):
        try:
            behind_the_name = status.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended
        if int(behind_the_name[1]) == pid and behind_the_name[0] != "Z":
            found.append(int(status.parent.name))
    return sorted(found)
