"""Condition number of a Newton matrix that PETSc has written (-ksp_view_mat binary:FILE), rows and columns scaled.

Scaled: rows and columns are divided by the square roots of their largest entries until all largest entries are 1 (Ruiz'
equilibration); what is left does not come from units or sizes of facets. The 1-norm condition number is estimated from
a sparse factorisation (Higham and Tisseur's estimator in SciPy), usually exact, at most a few times too small.
"""

import struct

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

SWEEPS = 30  # each halves the logarithms of what is left
MATRIX = 1211216  # PETSc's mark of a matrix file


def read(path):
    """The matrix of a file in PETSc's binary format."""
    data = path.read_bytes()
    mark, n, columns, entries = struct.unpack(">4i", data[:16])
    if mark != MATRIX or n != columns:
        raise ValueError(f"{path}: no square matrix of PETSc's")
    lengths = np.frombuffer(data, ">i4", n, 16).astype(int)
    column = np.frombuffer(data, ">i4", entries, 16 + 4 * n).astype(int)
    values = np.frombuffer(data, ">f8", entries, 16 + 4 * (n + entries)).astype(float)
    matrix = sparse.csr_matrix((values, column, np.concatenate(([0], np.cumsum(lengths)))), shape=(n, n))
    matrix.eliminate_zeros()
    return matrix


def scaled(matrix):
    for _ in range(SWEEPS):
        for axis in (1, 0):
            largest = np.sqrt(abs(matrix).max(axis=axis).toarray().ravel())
            scale = sparse.diags(1 / np.where(largest > 0, largest, 1))
            matrix = (scale @ matrix if axis == 1 else matrix @ scale).tocsr()
    return matrix


def of(matrix):
    """Condition number of the scaled matrix; infinite where it is singular."""
    matrix = scaled(matrix).tocsc()
    try:
        factors = linalg.splu(matrix)
    except RuntimeError:  # exactly singular
        return float("inf")
    inverse = linalg.LinearOperator(
        matrix.shape, matvec=factors.solve, rmatvec=lambda b: factors.solve(b, "T"), dtype=float
    )
    return float(linalg.onenormest(matrix) * linalg.onenormest(inverse))
