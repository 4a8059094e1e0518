"""The hosts without PETSc, in C and in Fortran, against the driver on the block scene.

The first three and the driver solve the same equations by full Newton steps from the same start and stop by the same test, so they must
agree in every nodal displacement and in the number of iterations of every step. The contract with a host: `HOST
[--current] FILE` prints a line `step N ... iterations K ...` per load step and writes to FILE a row X Y Z ux uy uz per
node of the block.

The other two have no multipliers among their unknowns, and a solver that does not pivot. Their answers are those of the
driver with dual multipliers, and they tell their smallest pivot.
"""

import re
import subprocess
from itertools import zip_longest

import numpy as np

from acceptance import COLD
from mpi import environment
from scene import SceneError

SCENE = "block_bottom_mu02"
HOSTS = {"C": "block_host", "Fortran": "block_fortran", "Fortran, elements called once,": "block_elements"}
# What those in Fortran add is of pairs of facets: the paper's element.
METHODS = {"C": "default", "Fortran": "paper", "Fortran, elements called once,": "paper"}
# The driver's Newton method made the hosts': full steps, no predictor.
SAME_METHOD = (*COLD, "-snes_linesearch_type", "basic")
# Required is 1e-9. What is left is the round-off of three linear solvers, some 1e-14, since Newton's last iteration goes
# far below its tolerance and the .vtu has all digits. A hundred times that is checked, to see small differences, too.
DISPLACEMENT_BOUND = 1e-12
# Without multipliers the iterates are others, and the last one lies elsewhere below the tolerance of 2e-11: 1.5e-12 is measured.
OTHER_ITERATES_BOUND = 1e-10
PROFILE_HOSTS = {"C": "profile_host", "Fortran": "profile_host_fortran"}
# Friction and push of the scene, with which half of the nodes slip at the end; the same at a friction of 1, for which nothing
# promises large pivots.
PROFILE_CASES = {"scene": ("0.2", "60"), "large friction": ("1", "300")}
# Over the largest diagonal entry: 0.022 and more are measured.
PIVOT_BOUND = 0.01
# Positions are computed by different formulas; nodes are a fifth of a unit apart.
SAME_PLACE = 1e-9


def hosts(verdicts, driver):
    for weights, options in (("reference", ()), ("current", ("--current",))):
        runs = {method: driver.run(SCENE, *SAME_METHOD, "-method", method, "-base_weights", weights, label=f"{weights}_{method}")
                for method in ("default", "paper")}
        for language, name in HOSTS.items():
            run = runs[METHODS[language]]
            verdicts.below(f"driver, {weights} weights, {METHODS[language]}: cut-backs", run.summary["cutbacks"], 0, "the hosts have none")
            places, displacements = sort_by_place(*block_nodes(run))
            iterations = [step["newton_iterations"] for step in run.steps]
            label = f"{language} host, {weights} weights"
            host_places, host_displacements, host_iterations = run_host(driver, name, weights, options)
            if host_places.shape != places.shape or not np.abs(host_places - places).max() <= SAME_PLACE:
                raise SceneError(f"{label}: its nodes are not those of the scene's block")
            error = np.abs(host_displacements - displacements).max() / np.abs(displacements).max()
            verdicts.below(f"{label}: nodal displacements", error, DISPLACEMENT_BOUND, "same equations as the driver")
            different = sum(a != b for a, b in zip_longest(host_iterations, iterations))
            verdicts.below(f"{label}: steps with other Newton iterations", different, 0, "same method as the driver")
    for weights, options in (("reference", ()), ("current", ("--current",))):
        for case, (friction, push) in PROFILE_CASES.items():
            scene = ("-base_friction", friction, "-push_traction", f"{push},0,0", "-base_basis", "dual")
            label = f"{case}, {weights} weights"
            of = ("-base_weights", weights, *scene)
            run = driver.run(SCENE, *SAME_METHOD, *of, label=f"dual_{friction}_{weights}")
            profile_hosts(verdicts, driver, run, label, weights, (*options, "--mu", friction, "--push", push))


def profile_hosts(verdicts, driver, run, label, weights, options):
    verdicts.below(f"driver, dual, {label}: cut-backs", run.summary["cutbacks"], 0, "the hosts have none")
    slipping = int((run.interface("base")["state"] == "slip").sum())
    verdicts.at_least(f"driver, dual, {label}: nodes that slip", slipping, 1, "a case in which rows are mixed")
    places, displacements = sort_by_place(*block_nodes(run))
    for language, name in PROFILE_HOSTS.items():
        host_places, host_displacements, _ = run_host(driver, name, weights, options)
        if host_places.shape != places.shape or not np.abs(host_places - places).max() <= SAME_PLACE:
            raise SceneError(f"{name}: its nodes are not those of the scene's block")
        error = np.abs(host_displacements - displacements).max() / np.abs(displacements).max()
        what = f"{language} host without multipliers, {label}"
        verdicts.below(f"{what}: nodal displacements", error, OTHER_ITERATES_BOUND, "same answer as the driver")
        log = (driver.output / f"{name}_{weights}.log").read_text()
        pivot = float(re.search(r"smallest pivot (\S+)", log).group(1))
        verdicts.at_least(f"{what}: smallest pivot", pivot, PIVOT_BOUND, "the largest diagonal entry")


def block_nodes(run):
    """Positions and displacements of the block's nodes: it lies above z = 0, the foundation below."""
    points, cells, displacement = run.mesh()
    above = points[cells["hexahedron"], 2].min(axis=1) > -SAME_PLACE
    nodes = np.unique(cells["hexahedron"][above])
    return points[nodes], displacement[nodes]


def sort_by_place(places, displacements):
    order = np.lexsort(np.round(places / SAME_PLACE).T)
    return places[order], displacements[order]


def run_host(driver, name, weights, options):
    """Places and displacements of the nodes, sorted by place, and the Newton iterations of each step."""
    program = driver.build / "c_examples" / name
    if not program.is_file():
        raise SceneError(f"{program} is not there: run `make build` first")
    path = driver.output / f"{name}_{weights}.txt"
    path.unlink(missing_ok=True)  # an old result must never be read as a new one
    done = subprocess.run(
        [str(program), *options, str(path)],
        env=environment(),
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    path.with_suffix(".log").write_text(done.stdout + done.stderr)
    if done.returncode != 0:
        raise SceneError(f"{name}: exit code {done.returncode}: {done.stderr.strip()}")
    table = np.loadtxt(path, ndmin=2)
    if table.shape[1] != 6:
        raise SceneError(f"{path}: {table.shape[1]} columns instead of 6")
    iterations = [int(k) for k in re.findall(r"^step +\d+ .*\biterations +(\d+)", done.stdout, re.MULTILINE)]
    return *sort_by_place(table[:, :3], table[:, 3:]), iterations
