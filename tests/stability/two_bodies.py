"""Two bodies of the plane in contact, as cases of the matrix use them: the two-dimensional host of tests/plane."""

import sys
from pathlib import Path

import numpy as np
import scipy.sparse as sparse

import condition
from cell import Outcome
from library import Refused

sys.path.append(str(Path(__file__).resolve().parents[1] / "plane"))
from plane_cells import Body  # noqa: E402  (needs the path)
from plane_host import SPACES, Host, NotConverged, choices  # noqa: E402, F401
from plane_patch import pressed  # noqa: E402, F401

YOUNG, POISSON, MU = 1000.0, 0.3, 0.3
BLOCK, FLOOR = (0.0, 0.0, 1.0, 0.6), (-0.45, -0.5, 1.6, 0.0)
# Newton's method ends at 1e-9 of the displacements, after which its square is left; two runs, and tractions that are E over
# displacements of a hundredth.
SAME = 1e-9


def answered(check):
    """The run of a cell: `check(outcome, library)`; a refusal of the library or of Newton's method is the cell's."""

    def run(context):
        outcome = Outcome()
        try:
            check(outcome, context.library)
        except (Refused, NotConverged) as refusal:
            outcome.refusal = str(refusal)
        return outcome

    return run


def block_on_floor(library, model="strain", nodes=(4, 4), *, space="corner", floor=FLOOR, poisson=POISSON, **options):
    """A block over a floor that is held at its base."""
    at = np.array([1.0, 0, 1.0, 0]) if model == "ring" else np.zeros(4)
    boxes = [tuple(np.array(box) + at) for box in (BLOCK, floor)]
    bodies = [Body(cells, box, n, model, YOUNG, poisson) for cells, box, n in zip(((4, 2), (5, 2)), boxes, nodes)]
    return Host(library, bodies, ("bottom", "top"), **{"modulus": YOUNG, "mu": MU} | choices(space) | options)


def moved(host, down, along=0.0):
    """Values of a step: the block's top goes down and along, the floor's base stays."""
    block, floor = host.bodies
    top, base = block.x[:, 1].max(), floor.x[:, 1].min()
    fixed = host.on(1, 0, 0.0, lambda x: x[1] == base) | host.on(1, 1, 0.0, lambda x: x[1] == base)
    return fixed | host.on(0, 1, -down, lambda x: x[1] == top) | host.on(0, 0, along, lambda x: x[1] == top)


def answer(host):
    """Displacements, and multipliers over Young's modulus."""
    return np.concatenate([host.u, host.lam.ravel() / YOUNG])


def apart(one, two):
    return np.abs(one - two).max() / np.abs(two).max()


def kappa(host):
    """Condition number of the last matrix, rows and columns scaled."""
    return condition.of(sparse.csr_matrix(host.matrix))


def follow(host, path):
    """Solves the steps of a path of (down, along); the iterations of each."""
    return [host.step(moved(host, *at)) for at in path]
