"""Contact in matrices of petsc4py: on one process, renumbered, and from one process into a matrix of two."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse
import stickslip
from bodies import Blocks

HERE = Path(__file__).resolve().parent
# Where root runs the tests, as in containers, Open MPI asks for the first two; with a single core for the third.
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
# Sums of the same numbers in another order.
ROUNDING = 1e-13
# Two linear solvers' rounding, over the unknowns.
SAME = 1e-11
PARALLEL = """
import numpy as np
from petsc4py import PETSc
from bodies import Blocks

rank, made = PETSc.COMM_WORLD.getRank(), Blocks()
contact = made.contact()
x = contact.start()
matrix = PETSc.Mat().createAIJ((contact.size, contact.size), comm=PETSc.COMM_WORLD)
matrix.setUp()
matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
numbers = np.arange(contact.size)[::-1].copy()  # of the first unknowns on the last process
if rank == 0:
    contact.add_to(matrix, x, numbers)
matrix.assemble()
first, last = matrix.getOwnershipRange()
mine = contact.tangent(x).toarray()[numbers[first:last]][:, numbers]
found = np.zeros((last - first, contact.size))
for row in range(first, last):
    columns, values = matrix.getRow(row)
    found[row - first, columns] = values
# Each process writes a file of its own: lines of two processes may be mixed on one terminal.
np.savetxt(f"found_{rank}.txt", [np.abs(found - mine).max() / np.abs(mine).max(), last - first])
"""


@pytest.fixture(scope="module")
def PETSc():
    if importlib.util.find_spec("petsc4py") is None:
        pytest.skip("matrices of PETSc need petsc4py, which is not installed (Debian: python3-petsc4py)")
    from petsc4py import PETSc

    return PETSc


def empty(PETSc, size):
    matrix = PETSc.Mat().createAIJ((size, size), nnz=0, comm=PETSc.COMM_SELF)
    matrix.setOption(PETSc.Mat.Option.NEW_NONZERO_ALLOCATION_ERR, False)
    return matrix


def scipy_of(matrix):
    offsets, columns, values = matrix.getValuesCSR()
    return scipy.sparse.csr_matrix((values, columns, offsets), matrix.getSize()).toarray()


def test_the_share_of_contact_is_added(PETSc):
    made = Blocks()
    contact = made.contact()
    x, matrix = contact.start(), empty(PETSc, contact.size)
    for times in (1, 2):
        contact.add_to(matrix, x)
        matrix.assemble()
        share = contact.tangent(x).toarray()
        np.testing.assert_allclose(scipy_of(matrix), times * share, rtol=0, atol=ROUNDING * np.abs(share).max())


def test_numbers_and_what_has_none(PETSc):
    made = Blocks()
    contact = made.contact()
    x, numbers = contact.start(), np.full(contact.size, -1)
    free = np.setdiff1d(np.arange(contact.size), made.fixed)
    numbers[free] = np.arange(len(free))[::-1]
    matrix = empty(PETSc, len(free))
    contact.add_to(matrix, x, numbers)
    matrix.assemble()
    share = contact.tangent(x).toarray()[np.ix_(free[::-1], free[::-1])]
    np.testing.assert_allclose(scipy_of(matrix), share, rtol=0, atol=ROUNDING * np.abs(share).max())
    with pytest.raises(stickslip.Error, match="^numbers: shape"):
        contact.add_to(matrix, x, numbers[1:])


def test_a_step_is_solved_by_petsc_alone(PETSc):
    """Newton's method with PETSc's matrix and MUMPS, against the package's."""
    made, grip = Blocks(), (2e-3, 8e-4, -5e-3)
    contact = made.contact()
    expected, iterations = made.solve(made.contact(), grip)
    free = np.setdiff1d(np.arange(contact.size), made.fixed)
    numbers, x, K = np.full(contact.size, -1), contact.start(), made.K.tocsr()
    numbers[free] = np.arange(len(free))
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    x[made.fixed] = made.values(grip)
    for _ in range(iterations + 2):
        r = np.zeros(contact.size)
        r[: contact.n_host] = made.residual(x[: contact.n_host])
        contact.add_residual(x, r)
        matrix = empty(PETSc, len(free))
        rows = numbers[: contact.n_host].astype(PETSc.IntType)
        matrix.setValuesIJV(K.indptr, rows[K.indices], K.data, addv=True, rowmap=rows)
        contact.add_to(matrix, x, numbers)
        matrix.assemble()
        solver.setOperators(matrix)
        step = matrix.createVecLeft()
        solver.solve(PETSc.Vec().createWithArray(r[free], comm=PETSc.COMM_SELF), step)
        x[free] -= step.array
    assert contact.balanced(x)
    np.testing.assert_allclose(x, expected, rtol=0, atol=SAME * np.abs(expected).max())


def test_one_process_adds_to_the_rows_of_two(PETSc, tmp_path):
    if shutil.which("mpiexec") is None:
        pytest.skip("two processes need mpiexec, which is not installed")
    (tmp_path / "parallel.py").write_text(PARALLEL)
    path = os.pathsep.join([str(Path(stickslip.__file__).parents[1]), str(HERE), str(HERE.parent / "examples"), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(["mpiexec", "-n", "2", sys.executable, "parallel.py"], cwd=tmp_path, capture_output=True, text=True, timeout=200,
                          env={**os.environ, **ENVIRONMENT, "PYTHONPATH": path})
    assert done.returncode == 0, done.stderr
    for rank in range(2):
        largest, rows = np.loadtxt(tmp_path / f"found_{rank}.txt")
        assert rows > 0 and largest <= ROUNDING, f"process {rank}: {rows} rows, {largest}"
