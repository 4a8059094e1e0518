"""Matrices of petsc4py."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .skin import Integers

if TYPE_CHECKING:
    import scipy.sparse


def added(matrix: Any, share: scipy.sparse.csr_matrix, numbers: Integers) -> None:
    """Adds entries, whose rows and columns have these numbers in the matrix; -1: none."""
    from petsc4py import PETSc

    rows = numbers.astype(PETSc.IntType)
    matrix.setValuesIJV(share.indptr.astype(PETSc.IntType), rows[share.indices], share.data, addv=PETSc.InsertMode.ADD_VALUES,
                        rowmap=rows)
